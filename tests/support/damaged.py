"""Content of files in which one value is gone, or another one: what readers make of each is theirs to say."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from typing import Any

from plantar.errors import PlantarError

GONE = object()
OTHER_TEXTS = (None, "x", "nan", "1 2", "0")


def damaged(content: Any) -> Iterator[tuple[str, Any]]:
    """JSON or YAML with one value gone, a word, or zero or less where it is a number, and where; of a list the first
    item stands for all."""
    if not isinstance(content, dict | list):
        return
    keys = list(content) if isinstance(content, dict) else [0] if content else []
    for key in keys:
        number = isinstance(content[key], int | float)
        for other in (GONE, "x", -1.5, 0) if number else (GONE, "x"):
            changed = content.copy()
            if other is GONE:
                del changed[key]
            else:
                changed[key] = other
            yield f"{key} {'gone' if other is GONE else repr(other)}", changed
        for where, part in damaged(content[key]):
            changed = content.copy()
            changed[key] = part
            yield f"{key}.{where}", changed


def damaged_xml(text: str) -> Iterator[tuple[str, str]]:
    """XML with one attribute gone or changed, or one element gone or twice, and which; the first of those alike."""
    root, seen = ET.fromstring(text), set[str]()
    for parent in list(root.iter()):
        for name, value in list(parent.attrib.items()):
            where = f"{parent.tag} {name}"
            if where in seen:
                continue
            seen.add(where)
            for other in OTHER_TEXTS:
                if other is None:
                    del parent.attrib[name]
                else:
                    parent.set(name, other)
                yield f"{where} {other!r}", ET.tostring(root, encoding="unicode")
                parent.set(name, value)
        for place, child in enumerate(list(parent)):
            where = f"{parent.tag}/{child.tag}"
            if where in seen:
                continue
            seen.add(where)
            parent.remove(child)
            yield f"{where} gone", ET.tostring(root, encoding="unicode")
            parent.insert(place, child)
            parent.insert(place, child)
            yield f"{where} twice", ET.tostring(root, encoding="unicode")
            parent.remove(child)


def told(read: Callable[[Any], str], content: Any) -> str:
    """What is read of it, or the line with which it is refused."""
    try:
        return read(content)
    except PlantarError as error:
        return f"refused: {error}"

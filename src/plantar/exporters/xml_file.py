"""XML robot models in and out: bounded, without entities, comments kept."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from plantar.conventions import Array
from plantar.errors import ExportError
from plantar.files import read_bounded
from plantar.robot.urdf import LIMIT

DEPTH_LIMIT = 200  # levels of nesting: a humanoid's MJCF has about fifteen


def load_xml(path: Path, root_tag: str) -> ET.Element:
    """The file's root element. ExportError: unreadable, an entity, too deep, or another kind of file."""
    content = read_bounded(path, LIMIT, ExportError)
    try:
        root = ET.fromstring(content, parser=ET.XMLParser(target=_Bounded(path)))
    except (ET.ParseError, ValueError) as error:
        raise ExportError(f"is not readable XML: {error}", path=path) from error
    if root.tag != root_tag:
        raise ExportError(f"is not a <{root_tag}> file but <{root.tag}>", path=path)
    return root


class _Bounded(ET.TreeBuilder):
    """Builds the tree with its comments and refuses nesting that would exhaust the stack later."""

    def __init__(self, path: Path) -> None:
        super().__init__(insert_comments=True)
        self._path, self._depth = path, 0

    def start(self, tag: str, attrs: dict[str, str], /) -> ET.Element:
        self._depth += 1
        if self._depth > DEPTH_LIMIT:
            raise ExportError("is nested too deeply", path=self._path, valid=f"{DEPTH_LIMIT} levels")
        return super().start(tag, attrs)

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        """Whatever the file's encoding, a declared DOCTYPE is seen here, before any entity is."""
        raise ExportError("declares a DOCTYPE or an entity", path=self._path, valid="plain XML")

    def end(self, tag: str, /) -> ET.Element:
        self._depth -= 1
        return super().end(tag)


def to_text(root: ET.Element, head: Iterable[str]) -> str:
    """The XML as text, with the lines of `head` as a comment before the root."""
    ET.indent(root)
    lines = "\n".join(f"  {line}" for line in head).replace("--", "- -")
    return f'<?xml version="1.0"?>\n<!--\n{lines}\n-->\n{ET.tostring(root, encoding="unicode")}\n'


def child_of(parent: ET.Element, tag: str) -> ET.Element:
    """The first child of that tag, made where there is none."""
    found = parent.find(tag)
    return ET.SubElement(parent, tag) if found is None else found


def numbers(values: Sequence[float] | Array) -> str:
    """Numbers as they stand in XML attributes: all digits that matter, no noise below 1e-12."""
    array = np.asarray(values, float).ravel()
    return " ".join(f"{0.0 if abs(value) < 1e-12 else value:.12g}" for value in array)


def vector(text: str | None, size: int, what: str, default: float = 0.0) -> Array:
    """`size` numbers from an attribute or element's text; the default where there is none."""
    if text is None or not text.strip():
        return np.full(size, default)
    try:
        values = np.array([float(part) for part in text.split()])
    except ValueError:
        values = np.empty(0)
    if values.shape != (size,) or not np.isfinite(values).all():
        raise ExportError(f"{what} is not {size} numbers", value=text[:60])
    return values

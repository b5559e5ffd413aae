"""The part `Raises:` of docstrings, where several errors share a line, with a line for each: as napoleon reads it."""

from __future__ import annotations

import re
from typing import Any

HEAD = "Raises:"
# One error or several that share a sentence, as in "RobotError, LogError: it cannot be read".
ERROR = re.compile(r"(?:(?<=^)|(?<=[.:] ))(?=[A-Z]\w*(?:Error|Extra)(?:, [A-Z]\w*(?:Error|Extra))*: )")


def line_for_each(lines: list[str]) -> list[str]:
    """The same docstring; errors of its part `Raises:` stand on lines of their own, with all that is said of them."""
    place = next((number for number, line in enumerate(lines) if line.strip() == HEAD), None)
    if place is None:
        return lines
    indent = len(lines[place]) - len(lines[place].lstrip())
    end = place + 1
    while end < len(lines) and lines[end].strip() and len(lines[end]) - len(lines[end].lstrip()) > indent:
        end += 1
    said = " ".join(line.strip() for line in lines[place + 1 : end])
    errors = [part.strip() for part in ERROR.split(said) if part.strip()]
    return [*lines[: place + 1], *(f"{' ' * (indent + 4)}{error}" for error in errors), *lines[end:]]


def setup(app: Any) -> dict[str, Any]:
    """Before napoleon, whose priority is the usual 500."""

    def process(app: Any, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
        lines[:] = line_for_each(lines)

    app.connect("autodoc-process-docstring", process, priority=400)
    return {"parallel_read_safe": True}

"""Every limit by which plantar decides, read from the source: `docs/reference/limits.md` is what this prints.

    python docs/extensions/limits_reference.py

A limit is a constant of a module, in capitals, that is a number or a few of them and has a comment that says what it
is, at the end of the line or above it. What has none is no limit but an encoding, a place of a column or a unit.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import plantar

SOURCE = Path(plantar.__file__).parent
PAGE = Path(__file__).resolve().parents[1] / "reference" / "limits.md"
ROOMS = {
    "conventions": "Everywhere",
    "logs": "Reading logs",
    "robot": "Robot files",
    "robot_guess": "A first robot file",
    "faults": "Faults of logs, sensors and robot files",
    "signals": "Filters and repairs of columns",
    "contact": "Contact, slip and stances",
    "sensors": "What sensors may have wrong",
    "models": "Laws of the bush",
    "model_selection": "Which law",
    "estimation": "Least squares, delays, drift",
    "feet": "Identified feet",
    "dynamics": "Equation of motion",
    "whole_body": "Inertial and joint parameters",
    "online": "In the control loop",
    "fleet": "Many robots and days",
    "motions": "Motions and balance",
    "design": "Designed motions",
    "exporters": "Exports",
    "comparison": "Comparison in a simulator",
}
HEAD = """\
# Limits

By these numbers plantar decides: what it refuses, repairs or tells of a log, which law it takes, and when it calls a
number usable. They stand in the source, each beside what it is for; this page is made from it
(`python docs/extensions/limits_reference.py`), and a test holds the two together: **a limit changes on this page or
not at all**. What depends on your robot stands in its [robot file](../robot_file.md) instead.
"""


@dataclass(frozen=True)
class Limit:
    """`value` as in the source; `reason`: its comment."""

    name: str
    value: str
    reason: str


def limits_in(text: str) -> Iterator[Limit]:
    """The limits of one module's source, in its order."""
    lines = text.splitlines()
    for node in ast.parse(text).body:
        names, value = _assigned(node)
        if value is None or not all(re.fullmatch(r"[A-Z][A-Z0-9_]*", name) for name in names):
            continue
        if not _is_number(value):
            continue
        if reason := _beside(lines[node.lineno - 1 : node.end_lineno]) or _above(lines, node.lineno):
            yield Limit(", ".join(names), _in_one_line(text, value), reason)


def page() -> str:
    """The whole page."""
    parts = [HEAD]
    for room, title in ROOMS.items():
        rows = [
            f"| `{_place(file)}` | `{limit.name}` | `{limit.value}` | {_cell(limit.reason)} |"
            for file in sorted((SOURCE / room).rglob("*.py")) or [SOURCE / f"{room}.py"]
            for limit in limits_in(file.read_text())
        ]
        if rows:
            parts.append(
                f"## {title}\n\n| where | limit | value | what it is |\n|---|---|---|---|\n" + "\n".join(rows)
            )
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _assigned(node: ast.stmt) -> tuple[list[str], ast.expr | None]:
    """Names and value of an assignment to one name, or to several at once."""
    if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
        return [node.target.id], node.value
    if not isinstance(node, ast.Assign) or len(node.targets) != 1:
        return [], None
    target = node.targets[0]
    parts = target.elts if isinstance(target, ast.Tuple) else [target]
    names = [part.id for part in parts if isinstance(part, ast.Name)]
    return (names, node.value) if names else ([], None)


def _is_number(value: ast.expr) -> bool:
    """A number, or one that is worked out of numbers and other limits; a tuple of them."""
    nodes = list(ast.walk(value))
    if any(isinstance(node, ast.Constant) and type(node.value) not in (int, float) for node in nodes):
        return False
    allowed = (
        ast.Constant, ast.UnaryOp, ast.BinOp, ast.operator, ast.unaryop, ast.Tuple, ast.Name, ast.Attribute,
        ast.expr_context, ast.Call,
    )  # fmt: skip
    return all(isinstance(node, allowed) for node in nodes) and any(
        isinstance(node, ast.Constant) for node in nodes
    )


def _in_one_line(text: str, value: ast.expr) -> str:
    return " ".join((ast.get_source_segment(text, value) or "").split())


def _beside(lines: list[str]) -> str:
    """The comments of a statement's lines."""
    tokens = tokenize.generate_tokens(io.StringIO("\n".join(lines)).readline)
    return " ".join(_words(token.string) for token in tokens if token.type == tokenize.COMMENT)


def _above(lines: list[str], lineno: int) -> str:
    first = lineno
    while first > 1 and lines[first - 2].startswith("#"):
        first -= 1
    return " ".join(_words(line) for line in lines[first - 1 : lineno - 1])


def _words(comment: str) -> str:
    return comment.lstrip("# ").strip()


def _place(file: Path) -> str:
    return file.relative_to(SOURCE).with_suffix("").as_posix()


def _cell(text: str) -> str:
    return text.replace("|", r"\|").replace("<", "&lt;")


if __name__ == "__main__":
    PAGE.write_text(page())

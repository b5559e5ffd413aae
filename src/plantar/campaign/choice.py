"""Which motions are most informative: the best sets of the campaign's logs beside the paper's composed motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from plantar.motions.select_motions import UNKNOWN, Choice, Selection
from plantar.report.content import Cell, Column, Table
from plantar.report.verdict import symbol
from plantar.results.numbers import MISSING, number, percent

COMPOSED: Final = "the paper's composed motion"
TOGETHER: Final = "all of them"


def choice_table(found: Selection) -> Table:
    """The best set of each size, the composed motion and all logs, by the intervals that they promise."""
    lines = []
    for name, choice in _named(found):
        key = max(choice.half_width_percent, key=lambda key: choice.half_width_percent[key])
        worst = MISSING if choice.worst >= UNKNOWN else f"{percent(choice.worst)} ({_place(key)})"
        marked = Cell(name, "good" if name == COMPOSED else "")
        logs = ", ".join(choice.motions) if name != TOGETHER else f"{len(choice.motions)} logs"
        lines.append((marked, logs, percent(choice.usual), worst, number(choice.condition_number, 3)))
    columns = [Column("set", numeric=False), Column("logs", numeric=False), Column("usual half width")]
    columns += [Column("widest"), Column("condition")]
    return Table.of("Which motions are most informative", columns, lines, remark=explained(found))


def explained(found: Selection) -> str:
    """What the ranking says of the composed motion, in words."""
    text = (
        "95 % half widths that a spring-damper fit to a set promises, in percent of the value, from its information "
        "matrices and from autocorrelated residuals; usual is their geometric mean over every K "
        "and C. "
    )
    if found.compared is None:
        return text
    rival = next((c for c in found.best if len(c.motions) == len(found.compared.motions)), found.best[-1])
    text += f"{COMPOSED.capitalize()} promises {percent(found.compared.usual)}"
    if set(rival.motions) == set(found.compared.motions):
        return f"{text}: no other set of {len(rival.motions)} promises more."
    text += f", the best set of {len(rival.motions)} {percent(rival.usual)}"
    enough = next((c for c in found.best if c.usual <= found.compared.usual), None)
    if enough is not None and len(enough.motions) < len(found.compared.motions):
        text += f"; {len(enough.motions)} suffice for what the composed motion promises"
    return f"{text}."


def choice_rows(found: Selection) -> list[dict[str, Any]]:
    """The same as data, with the half width of every parameter."""
    return [
        {
            "set": name,
            "motions": list(choice.motions),
            "usual_percent": choice.usual,
            "condition_number": choice.condition_number,
            "half_widths": [
                {"foot": foot, "axis": axis, "name": term, "percent": None if width >= UNKNOWN else width}
                for (foot, axis, term), width in choice.half_width_percent.items()
            ],
        }
        for name, choice in _named(found)
    ]


def _named(found: Selection) -> Iterator[tuple[str, Choice]]:
    for choice in found.best:
        yield f"best of {len(choice.motions)}", choice
    if found.compared is not None:
        yield COMPOSED, found.compared
    yield TOGETHER, found.together


def _place(key: tuple[str, str, str]) -> str:
    foot, axis, term = key
    return f"{symbol(term)} {foot} {axis}"

"""What a motion will not show, said before it is played: numbers that are weak, wrong or wide in its rehearsals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby, product
from typing import Any, Final

import numpy as np

from plantar.conventions import ROTATIONAL_AXES
from plantar.design.information import WANTED
from plantar.design.story import LONGEST, Design
from plantar.feet.fit.hidden_memory import SLIPS
from plantar.models import KelvinVoigt
from plantar.models.hysteresis import SURE_SLIP_ANGLE

FAR: Final = 1.5  # times its half width: a number that is so far off is wrong
WANTED_OF: Final = dict(zip(KelvinVoigt().terms, WANTED, strict=True))
TOLD_APART: Final = SLIPS / SURE_SLIP_ANGLE  # rad, what `identify feet` asks for


def foretold(found: Design, parameters: Sequence[Mapping[str, Any]]) -> list[str]:
    """A line for each axis of a foot that will be weak, and for each number that comes out wrong and is not called so.

    `parameters` as in MOTION.json. What an earlier result knows may be weak in the log of this motion alone.
    """
    notes, before = list[str](), [] if found.known is None else found.known.sure
    for (foot, axis), group in groupby(parameters, key=lambda row: (row["foot"], row["axis"])):
        rows = list(group)
        weak = sorted({one["factor"] for row in rows for one in row["at"] if not one["usable"]})
        if weak and (foot, axis) in before:
            notes.append(
                f"{foot} {axis} is known, and weak from this motion alone: identify both logs together"
            )
        elif weak:
            notes.append(_weak(found, foot, axis, rows, weak))
        notes += [text for row in rows if (text := _wrong(row)) is not None]
    for axis, name in product(ROTATIONAL_AXES, WANTED_OF):
        rows = [row for row in parameters if (row["axis"], row["name"]) == (axis, name)]
        notes += [text] if (text := _wide(found.settings.duration, axis, name, rows)) is not None else []
    return notes


def _weak(
    found: Design, foot: str, axis: str, rows: Sequence[Mapping[str, Any]], weak: Sequence[float]
) -> str:
    """Where an axis is weak, how uncertain its numbers are there, and what they would need."""
    at = ", ".join(f"{factor:.3g}" for factor in weak)
    widths = ", ".join(f"{row['name']} {_widest(row, weak)}" for row in rows)
    said = f"{foot} {axis} will be weak at {at} times the stiffness told: {widths}"
    place = ROTATIONAL_AXES.index(axis)
    bends = {
        one.factor: float(np.ptp(one.bushes[foot][:, place])) / 2
        for one in found.rehearsals
        if foot in one.bushes
    }
    least = min((bends[factor] for factor in weak if factor in bends), default=np.inf)
    if least >= TOLD_APART:
        return said
    most = bends[max(bends)] / TOLD_APART * found.factors[1] * found.told.stiffness
    advice = (
        "tell the stiffness more closely, or make the next motion with --after this one's result"
        if found.known is None
        else "this robot's soles do not hold what it takes to bend stiffer ones so far. What is found of them is the "
        "stiffness of the spring and of what slips together"
    )
    return (
        f"{said}. Over this range of stiffness the motion bends it by {1e3 * least:.3g} mrad to either side; rubber "
        f"that slips at {1e3 * SLIPS:.3g} mrad is surely told from its spring beyond {1e3 * TOLD_APART:.3g}. That "
        f"would need feet no stiffer than {most:.3g} N·m/rad: {advice}"
    )


def _widest(row: Mapping[str, Any], factors: Sequence[float]) -> str:
    widths = [one["half_width_percent"] for one in row["at"] if one["factor"] in factors]
    return "not identified" if None in widths else f"± {max(widths):.2g} %"


def _wrong(row: Mapping[str, Any]) -> str | None:
    """A number that rehearsals, whose truth is known, find wrong and call usable."""
    wrong = [
        one
        for one in row["at"]
        if one["usable"] and abs(one["error_percent"]) > FAR * one["half_width_percent"]
    ]
    if not wrong:
        return None
    at = ", ".join(f"{one['factor']:.3g}" for one in wrong)
    worst = max(abs(one["error_percent"]) for one in wrong)
    return (
        f"{row['foot']} {row['axis']} {row['name']} came out wrong at {at} times the stiffness told, by up to "
        f"{worst:.0f} %, and `identify feet` does not say so: do not use it"
    )


def _wide(duration: float, axis: str, name: str, feet: Sequence[Mapping[str, Any]]) -> str | None:
    """A number that one play leaves more unsure than is wanted where it is usable, and how much playing it takes."""
    at = zip(*(row["at"] for row in feet), strict=True)
    off = max((each[0]["error95_percent"] for each in at if all(one["usable"] for one in each)), default=0.0)
    wanted = 100 * WANTED_OF[name]
    if off <= wanted:
        return None
    plays = int(np.ceil((off / wanted) ** 2))
    longer = f", or one with --duration {plays * duration:g}" if plays * duration <= LONGEST else ""
    return (
        f"{axis} {name} will be up to {off:.2g} % off, where {wanted:g} % are wanted: noise, of which {plays} plays of "
        f"this motion that are identified together leave so little{longer}"
    )

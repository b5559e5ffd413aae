"""What a motion promises of each number: the worst of what `identify feet` finds in recordings of its rehearsals."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from plantar.conventions import NORMAL95
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.design.story import Design
from plantar.results.feet import FeetResult, Parameter
from plantar.twin.presets import DEFAULT, preset_named

SOFTENED: Final = {"stiffness": 1, "damping": 2}  # powers


def half_widths(found: Design, axis: str, name: str) -> dict[float, float | None]:
    """By factor, the 95 % half width of a parameter that is promised [% of its value]; None where it is not identified.

    The widest of all draws of a rehearsal, as the robot's sensors will have other zeros and noise, of both feet, which
    are mirrored, and of its neighbours where they are usable: where one is weak another law was found, which is of no
    other stiffness.
    """
    feet = found.robot.feet
    own = [
        _widest(row for foot in feet for row in _rows(one.results, foot, axis, name))
        for one in found.rehearsals
    ]
    lent = [
        width if all(usable(one, foot, axis, name) for foot in feet) else None
        for one, width in zip(found.rehearsals, own, strict=True)
    ]
    return {
        one.factor: width
        and max(each for each in (width, *lent[max(place - 1, 0) : place + 2]) if each is not None)
        for place, (one, width) in enumerate(zip(found.rehearsals, own, strict=True))
    }


def error95(one: Rehearsal, feet: Iterable[str], axis: str, name: str, truth: float) -> float | None:
    """What 95 % of plays are off by at most [% of the value], beside the sensors' gains; None where a draw does not
    identify it.

    Of `feet` together, which are mirrored: all show the same. `truth`: the value at the stiffness told.
    """
    found = [errors(one, foot, axis, name, truth) for foot in feet]
    if any(len(each) < len(one.results) for each in found) or not one.results:
        return None
    return NORMAL95 * float(np.sqrt(np.mean(np.square(found))))


def errors(one: Rehearsal, foot: str, axis: str, name: str, truth: float) -> list[float]:
    """By how much a parameter came out too large in each draw [% of what is true there].

    True is what stands on the floor of rehearsals: spring and damper K + C s in series with a floor that tilts by a
    share y of what the spring bends make K/(1 + y) and C/(1 + y)².
    """
    softer = (1 + one.yields.get((foot, axis), 0.0)) ** SOFTENED[name]
    values = (row.value for row in _rows(one.results, foot, axis, name))
    return [100 * (value * softer / (one.factor * truth) - 1) for value in values if value is not None]


def usable(one: Rehearsal, foot: str, axis: str, name: str) -> bool:
    """Whether every draw's result calls a parameter usable."""
    verdicts = [row.verdict for row in _rows(one.results, foot, axis, name)]
    return len(verdicts) == len(one.results) and set(verdicts) == {"usable"}


def delay(one: Rehearsal) -> tuple[float, float] | None:
    """Half width of the force sensors' delay and its error [s], the largest of all draws; None where one does not show
    it."""
    late = preset_named(DEFAULT).sensors.wrench_delay
    found = [result.sensor_delay for result in one.results if result is not None]
    known = [each for each in found if each is not None and each.measured]
    if not known or len(known) < len(one.results):
        return None
    errors = (each.wrench_delay - late for each in known)
    return NORMAL95 * max(each.std for each in known), max(errors, key=abs)


def vertical(one: Rehearsal, truth: float) -> tuple[float, float] | None:
    """Half width and error [%] of the sum of both feet's vertical compliances, each 1/`truth` [N/m], the largest of all
    draws; None where one does not show it."""
    halves, errors = list[float](), list[float]()
    for result in one.results:
        feet = [_rows([result], foot, "z", "stiffness") for foot in ("left", "right")]
        known = [row for rows in feet for row in rows if row.value and row.interval95 is not None]
        if len(known) < len(feet):
            return None
        total = sum(1 / row.value for row in known if row.value)
        low, high = (sum(1 / row.interval95[end] for row in known if row.interval95) for end in (1, 0))
        halves.append(50 * (high - low) / total)
        errors.append(100 * (total * truth / len(known) - 1))
    return (max(halves), max(errors, key=abs)) if halves else None


def _widest(rows: Iterable[Parameter]) -> float | None:
    known = [(row.interval95, row.value) for row in rows if row.interval95 is not None and row.value]
    return max((50 * (high - low) / abs(value) for (low, high), value in known), default=None)


def _rows(results: Sequence[FeetResult | None], foot: str, axis: str, name: str) -> list[Parameter]:
    found = (row for result in results if result is not None for row in result.parameters)
    return [row for row in found if (row.foot, row.axis, row.name) == (foot, axis, name)]

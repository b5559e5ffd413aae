"""A bush whose place the robot file calls exact, or nearly so, where the motions show it elsewhere.

A prior that is too narrow draws any place back to the robot file's, however well the motions show another: the
stiffness is wrong then, and its interval does not say so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import SHOWN
from plantar.feet.place.bush_place import about_its_place
from plantar.feet.place.place_notes import PLACE, WORTH_SAYING
from plantar.feet.place.spread import GUESSED, PlaceSpread
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty


def as_measured(robot: RobotModel, foot: str) -> PlaceSpread:
    """What the place of a foot's bush may be off by where a careful lab measured it."""
    usual = Uncertainty()
    known = replace(
        robot.uncertainty, bush_position=usual.bush_position, wrench_crosstalk=usual.wrench_crosstalk
    )
    return PlaceSpread.of(replace(robot, uncertainty=known), foot)


def shown_elsewhere(
    fits: Sequence[AxisFit],
    recordings: Sequence[Recording],
    told: PlaceSpread,
    usual: PlaceSpread,
    shared: bool,
) -> Note | None:
    """A warning where one of a standing foot's fits about the place as `told` turns about another one; None where none
    does, and where the robot file is hardly surer than is `usual`, or there is no prior as of `contact: always`."""
    if 2 * told.aside >= usual.aside:
        return None
    free = replace(told, aside=GUESSED, above=GUESSED)
    for fit in fits:
        moved = about_its_place(fit, recordings, free, shared)
        if moved is fit:
            continue  # it steps: its stances have shown the place already
        arms, std = np.array(moved.moment_arms), np.array(moved.place_std[:2])
        if (np.abs(arms) > np.maximum(SHOWN * np.hypot(std, usual.aside), WORTH_SAYING)).any():
            return Note(PLACE, "warning", _text(fit, told, usual))
    return None


def _text(fit: AxisFit, told: PlaceSpread, usual: PlaceSpread) -> str:
    return (
        f"{fit.foot} {fit.axis}: the torques turn about another point than feet.{fit.foot}.bush and "
        f"feet.{fit.foot}.wrench, which `uncertainty` says are known to {1e3 * told.aside:.2g} mm: taken as known to "
        f"{1e3 * usual.aside:.2g} mm; check the robot file"
    )

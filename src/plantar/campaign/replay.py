"""Identified feet in a simulator (the paper's future work): whose feet are compared, and how near each comes.

The others are rigid feet and feet with the numbers that other groups use.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import Hand
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.bush import GUESSES, Feet
from plantar.twin.play import planned, rolled
from plantar.twin.presets import preset_named
from plantar.twin.replay import Replayed, chest_attitude, feet_of, moved_onto, pitch_and_roll
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import exact_columns

IDENTIFIED: Final = "identified"
RIGID: Final = "rigid"
RECORD: Final = "none: the record against the truth"
CHEST: Final = ("chest pitch", "chest roll")


@dataclass(frozen=True)
class ReplayRow:
    """How far the simulated robot is from the recorded one in one motion: of the chest's pitch and roll the root mean
    square error [rad], of a foot's torque the mean absolute error [N.m]; None where the robot falls."""

    feet: str
    motion: str
    quantity: str
    unit: str
    error: float | None


@dataclass(frozen=True)
class Score:
    """Chest error of one kind of feet over all motions together, root mean square [rad]; None: it falls."""

    feet: str
    pitch: float | None
    roll: float | None

    @property
    def both(self) -> float | None:
        """Pitch and roll together [rad]."""
        return None if self.pitch is None or self.roll is None else float(np.hypot(self.pitch, self.roll))


def candidates(result: FeetResult, guesses: Sequence[str] = tuple(GUESSES)) -> dict[str, Feet | None]:
    """The kinds of feet to compare: identified, rigid (None), and the guesses in use elsewhere."""
    identified = feet_of(result)
    guessed = {name: dict.fromkeys(identified, GUESSES[name]) for name in guesses}
    return {IDENTIFIED: identified, RIGID: None} | guessed


def hands_of(robot: RobotModel, motions: Sequence[str]) -> dict[str, Hand]:
    """The operator's hand in those motions of the campaign that it leads."""
    return {name: hand for name in motions if (hand := planned(name, robot).hand) is not None}


def record_rows(
    robot: RobotModel, recorded: Sequence[MotionLog], preset: str, bushes: Feet
) -> tuple[ReplayRow, ...]:
    """How far the recorded attitude itself is from the truth, by the same measure: no simulation can get below."""
    physics, feet = preset_named(preset).physics(bushes, robot), cut_feet(describe(robot), robot)
    rows = []
    for log in recorded:
        columns = exact_columns(rolled(planned(log.name, robot), robot, physics), robot, feet)
        attitude = chest_attitude(robot, log)
        true = moved_onto(attitude, chest_attitude(robot, MotionLog(log.name, log.time, columns)))
        errors = np.sqrt(np.mean((pitch_and_roll(true) - pitch_and_roll(attitude[:, 2, :])) ** 2, axis=0))
        rows += [
            ReplayRow(RECORD, log.name, axis, "rad", float(error))
            for axis, error in zip(CHEST, errors, strict=True)
        ]
    return tuple(rows)


def replay_rows(
    replays: Sequence[Replayed], motions: Sequence[str], feet: Sequence[str]
) -> tuple[ReplayRow, ...]:
    """One row for each kind of feet, motion and quantity, also where the robot fell."""
    found = {(one.feet, one.motion): one for one in replays}
    places = list(dict.fromkeys(place for one in replays for place in one.torque))
    rows = []
    for name in feet:
        for motion in motions:
            one = found.get((name, motion))
            chest = one.chest_error() if one else (None, None)
            rows += [
                ReplayRow(name, motion, axis, "rad", error) for axis, error in zip(CHEST, chest, strict=True)
            ]
            for foot, axis in places:
                error = one.torque_error(foot, axis) if one else None
                rows.append(ReplayRow(name, motion, f"{foot} {axis} torque", "N.m", error))
    return tuple(rows)


def scores(rows: Sequence[ReplayRow]) -> tuple[Score, ...]:
    """Chest error of each kind of feet, all motions weighing the same."""
    names = dict.fromkeys(row.feet for row in rows)
    return tuple(Score(name, *(_pooled(rows, name, axis) for axis in CHEST)) for name in names)


def best_guess(rows: Sequence[ReplayRow]) -> str | None:
    """The guess whose chest comes nearest to the recorded one; None where none was tried or all fell."""
    known = (IDENTIFIED, RIGID, RECORD)
    errors = {one.feet: one.both for one in scores(rows) if one.feet not in known and one.both is not None}
    return min(errors, key=lambda name: errors[name]) if errors else None


def _pooled(rows: Sequence[ReplayRow], feet: str, quantity: str) -> float | None:
    errors = [row.error for row in rows if row.feet == feet and row.quantity == quantity]
    known = [error for error in errors if error is not None]
    return float(np.sqrt(np.mean(np.square(known)))) if known and len(known) == len(errors) else None

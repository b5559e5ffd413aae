"""Joints between IMU and foot that are not read as the robot file says: a few per cent too much, or late by themselves.

While a foot steps, joints bend its bush and turn the robot over it at the same time: an ankle or a hip that reads 3 %
too much makes the spring 8 % softer. What such a joint adds to the bush's angle is not what the bush itself does, and
the torque tells the two apart. Where a foot stands it is the other way round: such a joint hardly moves the numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, cast

import numpy as np

from plantar.contact.deflection import foot_motion, path_to
from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.estimation import Block, fit_blocks
from plantar.feet.recording import Recording, within_stances
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside, recordings_of
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate
from plantar.signals.orientation import attitude

MISREAD = "joint_misread"
SURE = 5.0  # deviations of what is misread
BETTER = 1.5  # times less is left of the squares than by the bush alone
ALIKE = 1.25  # times as much as the best one leaves: which of two joints it is, such motions do not tell
# What a joint may be misread by, that other checks do not see: more is another fault, or a joint that hardly matters.
GAIN, LATE = 0.2, 0.03  # share; s
SINGULAR = 1e6  # condition of the fit beyond which the motions do not tell


class Misread(NamedTuple):
    """A joint, its `kind` of misreading, by how much it turns more [share] or is read later [s], the squares that are
    then left, and whether another stiffness or damping follows, outside of its interval."""

    joint: str
    kind: str
    size: float
    squares: float
    matters: bool

    def __str__(self) -> str:
        if self.kind == "late":
            return f"'{self.joint}' {1e3 * abs(self.size):.2g} ms {'late' if self.size > 0 else 'early'}"
        return f"'{self.joint}' {1 / (1 + self.size):.3g} times"


def misread_joint_notes(
    robot: RobotModel, recordings: Sequence[Recording], wide: AxisFit, tangents: Sequence[Block]
) -> list[Note]:
    """A warning where the torque of a foot that steps goes far better with a joint that is read otherwise, and that
    moves stiffness or damping out of the interval of `wide`.

    tangents: the recordings' `tangent_blocks`.
    """
    if tangents[0].stances is None:
        return []
    alone = fit_blocks(tangents)
    found = sorted(_misread(robot, recordings, wide, tangents, alone.values), key=lambda one: one.squares)
    if not found or not found[0].matters or alone.squares < BETTER * found[0].squares:
        return []
    alike = [str(one) for one in found if one.squares <= ALIKE * found[0].squares]
    text = (
        f"{wide.foot} {wide.axis}: the torque follows the angle far better with a joint that was read otherwise: "
        f"{', or '.join(alike)}. Stiffness and damping follow it (valid: encoders whose angles are the links', all "
        "read at one moment)"
    )
    return [Note(MISREAD, "warning", text)]


def _misread(
    robot: RobotModel,
    recordings: Sequence[Recording],
    wide: AxisFit,
    tangents: Sequence[Block],
    usual: Array,
) -> Iterator[Misread]:
    """Each joint that is surely misread, one at a time; usual: (k,), the values with all as they are read."""
    chosen = recordings_of(tangents, recordings)
    columns = [_columns(robot, one, wide) for one in chosen]
    for joint, kind in columns[0]:
        wider = all_beside(tangents, [own[joint, kind][:, None] for own in columns])
        fit = fit_blocks(wider)
        size, std = float(fit.values[-1]), float(fit.std[-1])
        most = GAIN if kind == "gain" else LATE
        if SURE * std < abs(size) < most and fit.condition_number < SINGULAR:
            matters = not wide.holds(fit.values[:2] - usual[:2])
            yield Misread(joint, kind, size, fit.squares, matters)


def _columns(robot: RobotModel, recording: Recording, fit: AxisFit) -> dict[tuple[str, str], Array]:
    """Torque (n,) at the rows of a fit by joint and kind: for each share by which a joint turns more than is read, for
    each second by which it is read later."""
    rows, columns = recording.rows(fit.foot), dict[tuple[str, str], Array]()
    for joint, (shares, angle) in _turns(robot, recording, fit.foot).items():
        rate = differentiate(angle, recording.period)
        slope = differentiate(rate, recording.period)
        own = shares[:, ROTATIONAL_AXES.index(fit.axis)]
        for kind, turned, its_rate in (("gain", angle, rate), ("late", rate, slope)):
            torque = fit.values[0] * turned[rows] + fit.values[1] * its_rate[rows]
            columns[joint, kind] = own * np.nan_to_num(torque)
    # One bus often reads all joints of a leg.
    late = [column for (_, kind), column in columns.items() if kind == "late"]
    return columns | {(f"all joints to the {fit.foot} foot", "late"): np.sum(late, axis=0)}


def _turns(robot: RobotModel, recording: Recording, foot: str) -> dict[str, tuple[Array, Array]]:
    """Of each joint between IMU and foot, how much of its turn is the bush's in pitch and roll, (n, 2) at the rows of a
    fit, and its angle (N,) [rad] through the fit's filter."""
    key = (MISREAD, foot)  # both axes ask
    if key not in recording.kept:
        log, rows, found = recording.log, recording.rows(foot), dict[str, tuple[Array, Array]]()
        positions, (orientation, _) = log.positions(robot), attitude(log, robot.required_imu, [])
        path, still = path_to(robot, foot)[0], np.zeros((int(rows.sum()), 3))
        for joint in path.joints:
            turns = np.zeros_like(positions[rows])
            turns[:, joint] = 1.0
            shares = foot_motion(path, positions[rows], turns, orientation[rows], still).encoder_rate
            angle = within_stances(
                positions[:, [joint]], recording.period, recording.cutoff, recording.stances[foot]
            )
            found[robot.joint_names[joint]] = (shares, angle[:, 0])
        recording.kept[key] = found
    return cast(dict[str, tuple[Array, Array]], recording.kept[key])

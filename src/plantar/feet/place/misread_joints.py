"""Joints between IMU and foot that are not read as the robot file says: a few per cent too much, late by themselves or
all together, behind by the play of their encoder's drive, or with the other sign, which stands of both feet and other
joints may hide; or the IMU itself, whose soft mount lets it tilt as it is accelerated.

While a foot steps, joints bend its bush and turn the robot over it at the same time: an ankle or a hip that reads 3 %
too much makes the spring 8 % softer. What such a joint adds to the bush's angle is not what the bush itself does, and
the torque tells the two apart. Where a foot stands such a joint moves the stiffness less, and the damping as much;
an IMU that tilts by 2 mrad for each m/s² makes K 4 % too large and C up to 27 %.
"""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from plantar.contact.deflection import foot_motion, path_to
from plantar.conventions import NORMAL95, ROTATIONAL_AXES, SURE, Array, cross
from plantar.estimation import least_left
from plantar.feet.recording import Recording, within_stances
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note
from plantar.results.feet_rows import WEAK_WIDTH
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate
from plantar.signals.orientation import attitude

MISREAD = "joint_misread"
OUT_OF_TIME, IMU_SOFT = "imu_out_of_time", "imu_soft"
# Times less that is left of the squares than by the bush alone; play shows at its joint's turns only, and a soft mount
# beside hysteresis, which takes most of what it leaves. Of an IMU on a stiff one under standing feet 1.1 at most.
BETTER, BETTER_TURNING = 1.5, 1.3
# Behind the sign of an ankle or a hip the bush's place is moved by centimetres, which takes a part of what it leaves:
# 1.23 times less is left by the right joint's sign, 1.18 by other joints' at most, whose sizes are no signs.
BETTER_REVERSED = 1.2
BETTER_OF = {"play": BETTER_TURNING, "soft": BETTER_TURNING, "reversed": BETTER_REVERSED}
ALIKE = 1.25  # times as much as the best one leaves: which of two joints it is, such motions do not tell
# What a joint may be misread by, that other checks do not see: more is another fault, or a joint that hardly matters.
GAIN, LATE, PLAY, SOFT_MOUNT = 0.2, 0.03, 0.02, 0.02  # share; s; rad; rad per m/s²
ALL_LATE = 0.25  # s, likewise of all joints, which are late together where it is the IMU that is early
# A joint of the other sign turns by -2 of what is read more than is read: -2.4 to -1.4 where its bush was moved.
OTHER_SIGN, NEAR_IT = -2.0, 0.7
LEAST_TURN = 0.02  # rad: what turns by less, as a joint that is held, turns by what its servo gives way
SOFT_MOVES = 0.02  # share of stiffness or damping that a soft mount has to move
# Of an interval, by which play of a joint, or hysteresis of a sensor, moves its number: both stay behind only after a
# turn is far enough, so that the sign of a rate gives back half of what is missing at most.
PART = 0.5
SOFT = 0.1  # of a joint's fast rate, within which its sign changes: behind a filter it is no step
FAST = 98  # percentile


class Misread(NamedTuple):
    """A joint, its `kind` of misreading, and by how much it turns more [share], is read later [s] or is behind [rad];
    or the IMU and its tilt [rad per m/s²]. The squares that are then left, and whether another stiffness or damping
    follows, outside of its interval."""

    joint: str
    kind: str
    size: float
    squares: float
    matters: bool

    def __str__(self) -> str:
        if self.kind in ("late", "together"):
            when, imu = ("late", "early") if self.size > 0 else ("early", "late")
            which, also = (
                (self.joint, f" (or the IMU {imu})") if self.kind == "together" else (f"'{self.joint}'", "")
            )
            return f"{which} {1e3 * abs(self.size):.3g} ms {when}{also}"
        if self.kind == "soft":
            return f"{self.joint} tilts by {1e3 * abs(self.size):.2g} mrad for each m/s², as on a soft mount"
        if self.kind == "reversed":
            return f"the sign of '{self.joint}' reversed"
        if self.kind == "play":
            return f"'{self.joint}' {2e3 * self.size:.2g} mrad behind wherever it turns round"
        return f"'{self.joint}' {1 / (1 + self.size):.3g} times"


def misread_joint_notes(robot: RobotModel, tangent: Tangent, wide: AxisFit) -> list[Note]:
    """A warning where the torque goes far better with a joint, or an IMU, that is read otherwise, and that moves
    stiffness or damping out of the interval of `wide`.

    tangent: with all of the recordings' logs.
    """
    alone = tangent.least_squares
    each = [_columns(robot, one, wide) for one in tangent.recordings]
    names, told = each[0][0], [columns for _, columns in each]
    needed = np.array([BETTER_OF.get(kind, BETTER) for _, kind in names])
    left = needed * least_left(tangent.blocks, told) / alone.squares
    if left.min() > 1:
        return []
    close = {which: column for column, which in enumerate(names) if left[column] <= ALIKE}
    fits = (
        _misread(*which, tangent.beside([own[:, [column]] for own in told]), wide, alone.values)
        for which, column in close.items()
    )
    found = sorted((fit for fit in fits if fit is not None), key=lambda one: one.squares)
    if not found or not found[0].matters:
        return []
    if alone.squares < BETTER_OF.get(found[0].kind, BETTER) * found[0].squares:
        return []
    alike = [one for one in found if one.squares <= ALIKE * found[0].squares]
    text = (
        f"{wide.foot} {wide.axis}: the torque follows the angle far better if one error of measurement is taken off: "
        f"{', or '.join(map(str, alike))}. Stiffness and damping follow it (valid: encoders without play, whose angles "
        "are the links' and have the URDF's signs, all read at one moment; a stiff mount of the IMU)"
    )
    kinds = {one.kind for one in alike}
    code = OUT_OF_TIME if kinds == {"together"} else IMU_SOFT if kinds == {"soft"} else MISREAD
    return [Note(code, "warning", text)]


def _misread(joint: str, kind: str, wider: Tangent, wide: AxisFit, usual: Array) -> Misread | None:
    """A joint that is surely misread, by a tangent with its column as the last; usual: (k,), the values without it."""
    fit = wider.least_squares
    size, std = float(fit.values[-1]), float(fit.std[-1])
    if kind == "reversed":
        share = size / float(fit.values[0])
        sign = fit.values[0] > 0 and abs(size) > SURE * std and abs(share - OTHER_SIGN) < NEAR_IT
        return Misread(joint, kind, share, fit.squares, True) if sign else None
    most = {"gain": GAIN, "late": LATE, "together": ALL_LATE, "play": PLAY, "soft": SOFT_MOUNT}[kind]
    away = size if kind == "play" else abs(size)  # no drive is ahead of its joint
    if not (SURE * std < away < most and not fit.singular):
        return None
    moved = (fit.values[:2] - usual[:2]) / (PART if kind == "play" else 1.0)
    # A soft mount also moves what hysteresis and the bush's place are taken for: only a part of that shows here. An
    # axis whose stiffness is not known bends too little to tell what tilts.
    soft = kind == "soft" and NORMAL95 * float(wide.std[0]) < WEAK_WIDTH * abs(float(wide.values[0]))
    soft = soft and bool((np.abs(moved) > SOFT_MOVES * np.abs(usual[:2])).any())
    matters = soft or not wide.holds(moved)
    return Misread(joint, kind, size, fit.squares, matters)


def _columns(robot: RobotModel, recording: Recording, fit: AxisFit) -> tuple[list[tuple[str, str]], Array]:
    """Joints and kinds (c,), and the torque (n, c) of each at the rows of a fit: for each share by which a joint turns
    more than is read, for each second by which it is read later, for each radian by which it stays behind its own rate,
    for each N·m/rad of the stiffness by as much as it turns more, of those that turn;
    and for each radian by which the IMU tilts with each m/s²."""
    columns = dict[tuple[str, str], Array]()
    for joint, (shares, motion) in _turns(robot, recording, fit.foot).items():
        own = shares[:, ROTATIONAL_AXES.index(fit.axis)]
        for kind, first in (("gain", 0), ("late", 1)):
            columns[joint, kind] = own * (motion[:, first : first + 2] @ fit.values[:2])
        fast = float(np.percentile(np.abs(motion[:, 1]), FAST))
        turns = np.tanh(motion[:, 1] / (SOFT * fast)) if fast > 0 else np.zeros_like(own)
        columns[joint, "play"] = own * fit.values[0] * turns
        # The stiffness so far may be anything: a hip of the other sign makes it next to 0.
        columns[joint, "reversed"] = own * motion[:, 0] * (np.ptp(motion[:, 0]) > LEAST_TURN)
    # One bus often reads all joints of a leg.
    if late := [column for (_, kind), column in columns.items() if kind == "late"]:
        columns[f"all joints to the {fit.foot} foot", "together"] = np.sum(late, axis=0)
    tilts = _tilts(robot, recording, fit.foot)[:, ROTATIONAL_AXES.index(fit.axis)]
    columns["the IMU", "soft"] = tilts @ fit.values[:2]
    return [*columns], np.column_stack([*columns.values()])


def _tilts(robot: RobotModel, recording: Recording, foot: str) -> Array:
    """The bush's angles and their rates at the rows of a fit that an IMU sees which its mount lets tilt, its mass above
    or below, by 1 rad for each m/s² of acceleration, (n, 2, 2); zero where nothing is known."""
    log, name, period = recording.log, robot.required_imu.name, recording.period
    key = (MISREAD, foot, name)  # both axes ask
    if key not in recording.kept:
        acceleration = np.zeros((len(log), 3))
        if log.has_imu(name, "linear_acceleration"):
            acceleration = np.nan_to_num(log.linear_acceleration(name))
        mean = acceleration.mean(axis=0)
        up = mean / max(float(np.linalg.norm(mean)), np.finfo(float).tiny)
        turn = within_stances(cross(up, acceleration), period, recording.cutoff, recording.stances[foot])
        angles = np.einsum("nrk,nk->nr", recording.imu_turns[foot], turn)
        both = np.stack([angles, differentiate(angles, period)], axis=2)
        recording.kept[key] = np.nan_to_num(both[recording.rows(foot)])
    return cast(Array, recording.kept[key])


def _turns(robot: RobotModel, recording: Recording, foot: str) -> dict[str, tuple[Array, Array]]:
    """Of each joint between IMU and foot, at the rows of a fit: how much of its turn is the bush's in pitch and roll,
    (n, 2), and its angle [rad] through the fit's filter with two derivatives, (n, 3), zero where nothing is known."""
    key = (MISREAD, foot)  # both axes ask
    if key not in recording.kept:
        log, rows, period = recording.log, recording.rows(foot), recording.period
        positions, (orientation, _) = log.positions(robot), attitude(log, robot.required_imu, [])
        path, stances = path_to(robot, foot)[0], recording.stances[foot]
        angles = within_stances(positions[:, path.joints], period, recording.cutoff, stances)
        rates = differentiate(angles, period)
        motions = np.nan_to_num([each[rows] for each in (angles, rates, differentiate(rates, period))])
        positions, orientation, found = positions[rows], orientation[rows], dict[str, tuple[Array, Array]]()
        still = np.zeros((len(positions), 3))
        for place, joint in enumerate(path.joints):
            turns = np.zeros_like(positions)
            turns[:, joint] = 1.0
            shares = foot_motion(path, positions, turns, orientation, still).encoder_rate
            found[robot.joint_names[joint]] = (shares, motions[:, :, place].T)
        recording.kept[key] = found
    return cast(dict[str, tuple[Array, Array]], recording.kept[key])

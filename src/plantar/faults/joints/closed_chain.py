"""Encoders that repeat one value although their joint turns: told by the chain that two standing legs close.

Soles that stand do not move against each other. What moves them in the kinematics is a joint that was read wrong, and
the angle that holds them still is the joint's own. It also turns the ankle over the sole, so that the torque follows
the bush's angle again; a sole that slides only looks like a joint that turns.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from plantar.contact.deflection import BushState, bush_states
from plantar.contact.phases import LANDING_SHARE
from plantar.contact.relative_pose import relative_pose
from plantar.contact.slip_indicator import YAW_MOMENT_ARM
from plantar.conventions import GRAVITY, Array, Mask
from plantar.errors import clock
from plantar.faults.bush_frames import SAMPLES
from plantar.faults.channels import STEPS
from plantar.faults.joints.names import legs
from plantar.faults.stance_changes import BETTER
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel
from plantar.signals.segments import complete, longest_run, run_numbers, spread_out

CARRIES, IN_AIR = 0.6, 0.2  # of the weight: a foot that carries the robot alone, the other one with its zero
LIFTED = 0.005  # m: less is how soles lean and bushes give way; small robots lift their feet by a centimetre
SURELY = 0.8  # share of the samples
EACH = 0.2  # of the samples, in which each foot of a robot that steps carries it
LEAST_ANGLE = 0.01  # rad: less harms no fit of bushes that turn by degrees
# Of what the encoders' steps of all joints together make of the angle: rounding of a dozen joints stays within it.
ROUNDING = 2.0
FINEST = 0.05  # of the changes of a position, that are no larger than its encoder's step where that is coarse
LEAST_TIME = 3.0  # s at one value, both feet loaded: shorter stands are usual, and do little harm
STEP = 1e-3  # rad, by which a joint is turned to see what that moves
# Share of the soles' motion that is left with the legs exchanged: what sways is seldom symmetric.
EXCHANGED = 0.4
SURELY_CLOSED = 0.3  # likewise, where the torque does not tell
FOLLOWS = 0.3  # share of the torque's variance that may then not follow the bush's angle


@dataclass(frozen=True)
class _Stand:
    """Samples in which both feet stand: the IMU's attitude (n, 4), joints (n, n_joints), wrench of each foot (n, 6)."""

    robot: RobotModel
    orientation: Array
    positions: Array
    wrenches: Mapping[str, Array]

    @cached_property
    def as_read(self) -> dict[str, BushState]:
        return self.turned(0, 0.0)

    def turned(self, joint: int, angle: Array | float) -> dict[str, BushState]:
        """The feet's states with one joint turned further by an angle (n,) [rad]; their rates are left at 0."""
        positions = self.positions.copy()
        positions[:, joint] += angle
        still, rates = np.zeros_like(positions), np.zeros((len(positions), 3))
        return bush_states(self.robot, positions, still, self.orientation, rates, self.wrenches)


def check_closed_chain(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding for legs that are exchanged, seen standing or stepping, and for each encoder that stands while the
    closed chain moves its joint.

    The latter is fatal where the torque then follows the bush's angle again; else a sole may have slid.
    """
    imu = robot.imu
    orientation = None if imu is None else log.orientation(imu.name)
    if imu is None or orientation is None or len(robot.feet) != 2:
        return
    wrenches = {name: log.wrench(foot.wrench.name) for name, foot in robot.feet.items()}
    positions = log.positions(robot)
    whole = complete(orientation, positions, *wrenches.values())
    whole &= np.linalg.norm(np.nan_to_num(orientation), axis=1) > 0.5
    loads = np.array([np.linalg.norm(np.nan_to_num(each[:, :3]), axis=1) for each in wrenches.values()])
    loads /= robot.mass * GRAVITY
    known = whole.copy()
    for load, each in zip(loads, robot.feet.values(), strict=True):
        if each.contact != "always":
            known &= load > LANDING_SHARE

    def stand(rows: slice | NDArray[np.intp]) -> _Stand:
        chosen = {name: values[rows] for name, values in wrenches.items()}
        return _Stand(robot, orientation[rows], positions[rows], chosen)

    # What both legs hang on moves both soles alike: only the legs' own joints are asked.
    joints = [(foot, joint) for foot, leg in legs(robot).items() for joint in leg]
    recorded = [log.has(f"joint.{joint}.position") for _, joint in joints]
    standing = np.flatnonzero(known)
    alone = np.flatnonzero(whole & (loads.max(axis=0) > CARRIES) & (loads.min(axis=0) < IN_AIR))
    if all(recorded) and alone.size * log.period > LEAST_TIME:
        some = spread_out(alone, SAMPLES)
        yield from _carried_from_above(stand(some), loads[:, some].argmax(axis=0))
    if all(recorded) and standing.size * log.period > LEAST_TIME:
        some = spread_out(standing, SAMPLES)
        yield from _exchanged_legs(stand(some), run_numbers(known)[some])
    stands: dict[tuple[int, int], _Stand] = {}
    finest = {
        joint: _encoder_step(positions[:, robot.joint_names.index(joint)], FINEST)
        for _, joint in compress(joints, recorded)
    }
    for foot, joint in compress(joints, recorded):
        values = positions[:, robot.joint_names.index(joint)]
        stretch = _longest_at_one_value(values, known)
        length = stretch.stop - stretch.start
        if length * log.period < LEAST_TIME:
            continue
        if (stretch.start, stretch.stop) not in stands:
            rows = slice(stretch.start, stretch.stop, max(1, length // SAMPLES))
            stands[stretch.start, stretch.stop] = stand(rows)
        angle, sure = _own_angle(stands[stretch.start, stretch.stop], joint, foot, finest)
        if angle < max(LEAST_ANGLE, STEPS * _encoder_step(values)):
            continue
        when = f"t = {clock(log.time[stretch.start])} to {clock(log.time[stretch.stop - 1])} s"
        where = f"column 'joint.{joint}.position', {when}, value {values[stretch.start]:.6g}"
        why = f"stands still while the legs' closed chain moves it by {angle:.2g}"
        if sure:
            text = f"{where}: {why}; the encoder is dead (valid: leave such cells empty)"
            yield Finding("dead_channel", text, True)
        else:
            text = (
                f"{where}: {why}; is the encoder stuck, or did a sole slide? (valid: leave such cells empty)"
            )
            yield Finding("stuck_channel", text)


def _exchanged_legs(stand: _Stand, support: NDArray[np.intp]) -> Iterator[Finding]:
    """Whether soles that stand move far less with the joints of one leg read as the other's.

    support: (n,), the number of the double support that each sample belongs to; between two of them feet may step.
    """
    names = stand.robot.joint_names
    left, right = ([names.index(joint) for joint in leg] for leg in legs(stand.robot).values())
    if len(left) != len(right) or not left:
        return
    positions = stand.positions.copy()
    positions[:, left], positions[:, right] = stand.positions[:, right], stand.positions[:, left]
    # Axes of the two legs may point the same way or opposite ways.
    alike, mirrored = (
        np.ptp(stand.positions[:, left] + sign * stand.positions[:, right], axis=0) for sign in (-1, 1)
    )
    if np.minimum(alike, mirrored).max() < LEAST_ANGLE:  # exchanged, they read next to the same
        return
    soles = [_soles(one.as_read) for one in (stand, replace(stand, positions=positions))]
    supports = [support == number for number in np.unique(support)]
    as_read, exchanged = (
        sum(float(np.sum((one[own] - np.median(one[own], axis=0)) ** 2)) for own in supports) for one in soles
    )
    if exchanged < EXCHANGED**2 * as_read:
        first = ", ".join(repr(f"joint.{names[place]}.position") for place in (left[0], right[0]))
        text = f"columns {first}, ...: the legs look exchanged: so the soles on the floor move far less"
        yield Finding("joint_names", f"{text} (valid: each leg's joints under their own names)", True)


def _carried_from_above(stand: _Stand, carrying: NDArray[np.intp]) -> Iterator[Finding]:
    """Whether the foot that carries the robot alone is above the one in the air; `carrying`: (n,), which it is."""
    heights = np.array([state.sole_position[:, 2] for state in stand.as_read.values()])
    above = (heights[0] - heights[1]) * np.where(carrying == 0, 1, -1)
    steps = EACH < np.mean(carrying) < 1 - EACH  # a robot that a hand tilts on one foot may lower the other
    if steps and np.median(above) > LIFTED and np.mean(above > 0) > SURELY:
        text = (
            f"columns 'joint.*.position': the foot that carries the robot alone is {100 * np.median(above):.1f} cm "
            "higher than the one in the air; the legs' joints look exchanged, or the force sensors"
        )
        yield Finding(
            "joint_names", f"{text} (valid: each leg's joints and sensor under their own names)", True
        )


def _encoder_step(values: Array, share: float = 0.5) -> float:
    """The change of a position from sample to sample, where it changes, that a share of its changes are below, as
    usual the median; 0 where it never does."""
    steps = np.abs(np.diff(values))
    steps = steps[np.isfinite(steps) & (steps > 0)]
    return float(np.quantile(steps, share)) if steps.size else 0.0


def _longest_at_one_value(values: Array, known: Mask) -> slice:
    """The longest stretch of known samples that repeat one value."""
    same = np.concatenate([[False], np.diff(values) == 0]) & known
    return longest_run(same)


def _own_angle(stand: _Stand, name: str, foot: str, finest: Mapping[str, float]) -> tuple[float, bool]:
    """How far a joint of this foot's leg moved [rad] where that closes the chain, else 0; whether the torque follows.

    The soles' heights do not count: bushes give way under load. finest: the encoders' steps [rad] by joint.
    """
    joint, as_read = stand.robot.joint_names.index(name), stand.as_read
    apart = _soles(as_read)
    moves = (_soles(stand.turned(joint, STEP)) - apart) / STEP
    apart = apart - np.median(apart, axis=0)
    power = np.sum(moves**2, axis=1)
    if not power.min() > 0:
        return 0.0, False
    angle = -np.sum(moves * apart, axis=1) / power
    left = apart + moves * angle[:, None]
    total = float(np.sum(apart**2))
    missed = float(np.sqrt(np.sum(left**2) / total)) if total > 0 else np.inf
    if missed > BETTER or np.ptp(angle) < ROUNDING * _of_rounding(stand, moves, finest):
        return 0.0, False
    closed = stand.turned(joint, angle)[foot]
    axis = int(np.argmax(np.std(closed.deflection - as_read[foot].deflection, axis=0)))
    before, after = (_unexplained(state, axis) for state in (as_read[foot], closed))
    follows = after < min(FOLLOWS, BETTER * before)
    return (float(np.ptp(angle)) if follows or missed < SURELY_CLOSED else 0.0), follows


def _of_rounding(stand: _Stand, moves: Array, finest: Mapping[str, float]) -> float:
    """What the encoders' steps by joint make of the angle [rad] of a joint by which the soles move so, (n, 3) [m]."""
    apart, angles = _soles(stand.as_read), []
    for name, step in finest.items():
        moved = (_soles(stand.turned(stand.robot.joint_names.index(name), STEP)) - apart) / STEP
        angles.append(step * np.median(np.abs(np.sum(moved * moves, axis=1)) / np.sum(moves**2, axis=1)))
    return float(np.linalg.norm(angles))


def _soles(states: Mapping[str, BushState]) -> Array:
    """How two soles stand to each other on the ground, (n, 3) [m]."""
    pose = relative_pose(*states.values())
    return np.column_stack([pose.position[:, :2], YAW_MOMENT_ARM * np.unwrap(pose.yaw)])


def _unexplained(state: BushState, axis: int) -> float:
    """Share of the torque's variance that does not follow the deflection."""
    angle, torque = (values[:, axis] - values[:, axis].mean() for values in (state.deflection, state.torque))
    varied, moved = float(torque @ torque), float(angle @ angle)
    return 1.0 - float(angle @ torque) ** 2 / (varied * moved) if varied > 0 and moved > 0 else 1.0

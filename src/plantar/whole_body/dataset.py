"""A log made ready for eq. 1: the motion of every link, the feet's wrenches, the joints' torques."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from plantar.contact.phases import hoisted_note
from plantar.conventions import GRAVITY, Array, Mask
from plantar.dynamics import BaseParameters, Equation, Motion, base_parameters, model_parameters
from plantar.dynamics.base_motion import root_motion, root_motion_from_sole
from plantar.dynamics.consistency import Prior
from plantar.errors import DataError, RobotError
from plantar.estimation.errors_in_variables import FEWEST
from plantar.faults.imu import without_odd_accelerometer
from plantar.faults.log_faults import check_log, refuse_impossible
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.newton_euler import held_for_a_while
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import evenly_sampled
from plantar.signals.segments import run_ends
from plantar.whole_body.settings import DynamicsSettings

# rad/s: Coulomb friction is tanh(v / this); the sign alone would follow an encoder's noise.
COULOMB_SPEED = 0.02
STANDING_SHARE = 0.2  # of the weight, on one foot: it stands

Smooth = Callable[[Array], Array]


@dataclass(frozen=True)
class Body:
    """A robot as eq. 1 sees it."""

    robot: RobotModel
    equation: Equation
    base: BaseParameters
    prior: Prior

    @classmethod
    def of(cls, robot: RobotModel, *, floating: bool) -> Body:
        model: pin.Model = robot.floating_model if floating else robot.model
        equation = Equation(model)
        return cls(robot, equation, base_parameters(equation), Prior.around(model_parameters(model)))


@dataclass(frozen=True)
class Whole:
    """One log on one grid, filtered: the joints' motion, the root's (N, 9), wrenches as recorded, efforts.

    sense: of the joints' motion, what Coulomb friction follows, (N, n_joints): filtered after the step that it makes,
    as the efforts are.
    """

    log: MotionLog
    motion: Motion
    sense: Array
    wrenches: Mapping[str, Array]
    efforts: Mapping[str, Array]
    valid: Mask
    notes: tuple[Note, ...]


def prepare_whole(body: Body, log: MotionLog, settings: DynamicsSettings) -> Whole:
    """Even samples, filtered, differentiated, with the root's motion.

    Raises RobotError or LogError naming what is missing, DataError where a sensor reads something impossible or too
    few samples are left.
    """
    robot, tree = body.robot, body.equation.tree
    refuse_impossible(log, check_log(robot, log))
    even = evenly_sampled(log if robot.imu is None else without_odd_accelerometer(robot.imu.name, log))
    notes = [*even.notes, *log.joint_notes(robot)]
    names = tree.names
    moving = [name for name in names if even.has(f"joint.{name}.position")]
    if not moving:
        raise DataError("holds no joint positions", path=log.source, valid="joint.<joint>.position")
    given = all(even.has(f"joint.{name}.velocity", f"joint.{name}.acceleration") for name in moving)
    period = even.period

    def smooth(values: Array) -> Array:
        return values if given else low_pass(values, period, settings.cutoff)

    def stacked(quantity: str, derived: Array | None) -> Array:
        columns = []
        for k, name in enumerate(names):
            values = even.joint(name, quantity) if name in moving else np.zeros(len(even))
            if values is not None:
                columns.append(smooth(values))
            else:
                columns.append(np.zeros(len(even)) if derived is None else derived[:, k])
        return np.column_stack(columns)

    q = stacked("position", None)
    v = stacked("velocity", differentiate(q, period))
    a = stacked("acceleration", None) if given else differentiate(v, period)
    if not given:
        text = f"{log.name}: accelerations derived; all signals through one zero-phase low-pass at "
        notes.append(Note("filtered", "info", text + f"{settings.cutoff:g} Hz"))
    base, known = np.tile(body.equation.rest, (len(even), 1)), np.ones(len(even), dtype=bool)
    wrenches: dict[str, Array] = {}
    if body.equation.floating:
        base, known = _root(body, even, q, v, a, smooth, notes)
        if (held := held_for_a_while(robot, even)).any():
            known &= ~held
            said = hoisted_note(log.name, even.time, held, "left out")
            notes.append(replace(said, severity="warning"))
        wrenches = {name: smooth(even.wrench(foot.wrench.name)) for name, foot in robot.feet.items()}
    efforts = {name: smooth(values) for name in names if (values := even.joint(name, "effort")) is not None}
    motion = Motion(base, q, v, a)
    sense = np.column_stack([smooth(np.tanh(rate / COULOMB_SPEED)) for rate in v.T])
    valid = motion.finite & known
    for values in (*wrenches.values(), *(effort[:, None] for effort in efforts.values())):
        valid &= np.isfinite(values).all(axis=1)
    edge = 0 if given else round(1 / settings.cutoff / period)
    valid &= ~run_ends(valid, edge)
    left_out = int(np.sum(~valid))
    if valid.sum() < FEWEST:
        raise DataError(
            f"has {valid.sum()} samples that can be used", path=log.source, valid=f"{FEWEST} or more"
        )
    if left_out > 2 * edge:
        text = f"{log.name}: {left_out} of {len(even)} samples left out (NaN, gaps and their surroundings)"
        notes.append(Note("left_out", "info", text))
    return Whole(even, motion, sense, wrenches, efforts, valid, tuple(notes))


def _root(
    body: Body, log: MotionLog, q: Array, v: Array, a: Array, smooth: Smooth, notes: list[Note]
) -> tuple[Array, Mask]:
    """The root frame's motion (N, 9) and where it is known: from the IMU, else from a sole that stands still."""
    robot = body.robot
    if not robot.feet:
        raise RobotError("names no feet", path=robot.path, valid="feet whose sensors carry the robot")
    imu = robot.imu
    if imu is not None and log.has_imu(imu.name, "angular_velocity", "linear_acceleration"):
        link, placement = robot.frame(imu.placement)
        rate = smooth(log.angular_velocity(imu.name))
        acceleration = smooth(log.linear_acceleration(imu.name))
        measured = np.hstack([acceleration, rate, differentiate(rate, log.period)])
        known = np.ones(len(log), dtype=bool)
        return root_motion(body.equation, link, placement, measured, q, v, a), known
    standing = {name: _stands(body, log, name) for name in robot.feet}
    name = max(standing, key=lambda foot: int(standing[foot].sum()))
    if standing[name].sum() < FEWEST:
        valid = "IMU columns angular_velocity and linear_acceleration, or a foot that stands still"
        raise DataError("does not tell how the root link moves", path=log.source, valid=valid)
    link, placement = robot.frame(robot.feet[name].sole.placement)
    text = (
        f"{log.name}: no IMU acceleration and angular velocity; the root's motion comes from the {name} sole, taken as "
        "level and still where it carries the robot"
    )
    notes.append(Note("base_from_sole", "warning", text))
    return root_motion_from_sole(body.equation, link, placement, q, v, a), standing[name]


def _stands(body: Body, log: MotionLog, name: str) -> Mask:
    """Where a foot carries a fair share of the robot, by the force along its sole's normal."""
    foot = body.robot.feet[name]
    _, sensor = body.robot.frame(foot.wrench.placement)
    _, sole = body.robot.frame(foot.sole.placement)
    normal = sensor.rotation.T @ sole.rotation[:, 2]
    force = foot.wrench.sign * log.wrench(foot.wrench.name)[:, :3] @ normal
    return np.asarray(force > STANDING_SHARE * GRAVITY * body.robot.mass)

"""The estimator of controllers, from Python: deflection, stiffness and damping of each foot at every tick."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from plantar import _core
from plantar.choices import number_in
from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.errors import DataError
from plantar.feet.settings import DEFAULT_CUTOFF
from plantar.files import write_text
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import FIELDS, FootEstimate, foot_estimate
from plantar.online.estimator_model import Element, estimator_model
from plantar.online.replay import Replay
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel, load_robot
from plantar.signals.filters import LOWEST_CUTOFF

LONGEST_DELAY = 0.1  # s: sensors in a control loop that are later have a fault
OF_JOINTS = "joint compliance"  # among the causes of a result's intervals


class FootEstimator:
    """Where each foot stands, how its bush is bent, and what its stiffness and damping are now.

    The same object as `plantar::FootEstimator` in C++: it reads one tick after the other, with causal filters, and
    learns while it runs.

    Args:
        robot: the robot file, or what `load_robot` made of it.
        result: of `identify_feet`, for elements that slip in bushes with hysteresis, the slides' compliance, where bush
            and force sensor sit, the sensors' delay and the filter's cutoff; without one bushes are springs with
            dampers, and `identified` only where motions were large enough to show a hysteresis.
        wrench_delay: how late the force sensors are against the IMU [s], > 0: late. None takes the result's; without a
            result none, and widens the damping's deviation by what the robot file's `uncertainty` allows.
        cutoff: of the filter that deflection, rate and torque pass before they are compared [Hz]; None takes the
            result's, 5 without one.

    Raises:
        RobotError: the robot file has no IMU or no feet. SettingsError: a value out of its range.

    Example:
        >>> import plantar
        >>> estimator = plantar.FootEstimator("robot.yaml", wrench_delay=0.0)
        >>> replay = estimator.replay(plantar.open_log("sway_1.csv"))
        >>> replay.column("left", "pitch.deflection").shape
        (1201,)
    """

    def __init__(
        self,
        robot: RobotModel | str | os.PathLike[str],
        result: FeetResult | None = None,
        *,
        wrench_delay: float | None = None,
        cutoff: float | None = None,
    ) -> None:
        number_in("cutoff", cutoff, LOWEST_CUTOFF, math.inf, "Hz", optional="the result's, or 5 Hz")
        number_in(
            "wrench_delay", wrench_delay, -LONGEST_DELAY, LONGEST_DELAY, "s", optional="taken as 0, unsure"
        )
        self.robot = robot if isinstance(robot, RobotModel) else load_robot(robot)
        self._model = estimator_model(
            self.robot,
            cutoff=_cutoff(result) if cutoff is None else cutoff,
            wrench_delay=_delay(self.robot, result, wrench_delay),
            elements=_elements(result),
            compliance={} if result is None else result.compliance,
            linear=_linear(result),
            misplaced=_misplaced(result),
            bends={} if result is None else result.joint_compliance,
            unsure=_unsure(result),
        )
        self._core = _core.FootEstimator(self._model)
        self._rows = np.empty((len(self.robot.feet), len(FIELDS)))

    def step(
        self,
        time: float,
        position: ArrayLike,
        wrench: Mapping[str, ArrayLike],
        *,
        velocity: ArrayLike | None = None,
        attitude: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
    ) -> dict[str, FootEstimate]:
        """One tick.

        Args:
            time: [s]. position, velocity: (n_joints,), in the order of `robot.joint_names` [rad or m, and per second].
            wrench: (6,) of each foot by name, as its sensor reads [N, N·m].
            attitude: w x y z, IMU to world, (4,); without it `angular_velocity` and `acceleration` say where up is.
            angular_velocity: of the IMU in its own frame, (3,) [rad/s]; without it, from the attitude.
            acceleration: proper, in the IMU's frame, (3,) [m/s²].

        Returns:
            Each foot's estimate, finite whatever was read.

        Raises:
            DataError: an array has the wrong size, or a foot has no wrench.
        """
        joints = len(self.robot.joint_names)
        missing = [name for name in self.robot.feet if name not in wrench]
        if missing:
            raise DataError(
                f"no wrench of foot '{missing[0]}' (valid: one for each of {', '.join(self.robot.feet)})"
            )
        forces = [_sized(f"wrench of foot '{name}'", wrench[name], 6) for name in self.robot.feet]
        self._core.step(
            time,
            _sized("position", position, joints),
            _row("velocity", velocity, joints),
            _row("attitude", attitude, 4),
            _row("angular velocity", angular_velocity, 3),
            _row("acceleration", acceleration, 3),
            np.array(forces),
            self._rows,
        )
        return {name: foot_estimate(row) for name, row in zip(self.robot.feet, self._rows, strict=True)}

    def replay(self, log: MotionLog) -> Replay:
        """Feed a recorded log, sample by sample; the estimator goes on from what it has learnt before.

        Args:
            log: with encoders, the IMU's attitude (or angular velocity and acceleration) and the feet's wrenches.

        Returns:
            Each foot's estimate at each sample, and how long each step took.

        Raises:
            LogError: a column is missing.
        """
        *_, whole = self.replay_in_pieces(log, math.inf)
        return whole

    def replay_in_pieces(self, log: MotionLog, seconds: float) -> Iterator[Replay]:
        """The same, and what the log says until then after each piece of it.

        Args:
            log: as for `replay`. seconds: how long a piece is [s].

        Yields:
            The log so far; the last one is all of it.

        Raises:
            LogError: a column is missing.
        """
        robot, imu = self.robot, self.robot.imu
        assert imu is not None, "checked where the model was made"
        attitude = log.orientation(imu.name)
        gyroscope = attitude is None or log.has_imu(imu.name, "angular_velocity")
        turning = log.angular_velocity(imu.name) if gyroscope else None
        acceleration = log.linear_acceleration(imu.name) if attitude is None else None
        position = np.ascontiguousarray(log.positions(robot))
        wrench = np.stack([log.wrench(foot.wrench.name) for foot in robot.feet.values()], axis=1)
        time, wrench = np.ascontiguousarray(log.time), np.ascontiguousarray(wrench)
        rows, latency = np.empty((len(log), len(robot.feet), len(FIELDS))), np.empty(len(log))
        size = int(min(max(seconds / log.period, 1.0), len(log)))
        for begin in range(0, len(log), size):
            piece = slice(begin, min(begin + size, len(log)))
            self._core.replay(
                time[piece],
                position[piece],
                None,  # a controller's own filter makes recorded velocities late
                None if attitude is None else attitude[piece],
                None if turning is None else turning[piece],
                None if acceleration is None else acceleration[piece],
                wrench[piece],
                rows[piece],
                latency[piece],
            )
            until = slice(piece.stop)
            yield Replay(log.time[until], tuple(robot.feet), rows[until], latency[until])

    def write_model(self, path: str | os.PathLike[str]) -> Path:
        """Write the file that `plantar::load_model` reads in C++.

        Args:
            path: of the file.

        Returns:
            The file's path.

        Raises:
            PlantarError: it cannot be written.
        """
        write_text(Path(path), self._model)
        return Path(path)


def _delay(robot: RobotModel, result: FeetResult | None, told: float | None) -> tuple[float, float]:
    """The force sensors' delay and its deviation [s]: as told, as a batch fit has found it, or not known."""
    if told is not None:
        return told, 0.0
    if result is not None and result.sensor_delay is not None:
        return result.sensor_delay.wrench_delay, result.sensor_delay.std
    return 0.0, robot.uncertainty.wrench_delay


def _cutoff(result: FeetResult | None) -> float:
    """What a batch fit has used: up to where angle and torque hang together."""
    used = None if result is None else result.settings.get("cutoff")
    return float(used) if isinstance(used, int | float) and used >= LOWEST_CUTOFF else DEFAULT_CUTOFF


def _elements(result: FeetResult | None) -> dict[tuple[str, Axis], Element]:
    """The elements that slip in a batch result, by foot and axis."""
    rows = () if result is None else result.parameters
    known = {(row.foot, row.axis, row.name): row for row in rows if row.value is not None}
    found = {}
    for (foot, axis, name), angle in known.items():
        torque = known.get((foot, axis, "slip_torque"))
        if name == "slip_angle" and angle.value and torque is not None and torque.value is not None:
            found[foot, axis] = Element(angle.value, torque.value, torque.std or abs(torque.value))
    return found


def _linear(result: FeetResult | None) -> list[tuple[str, Axis]]:
    """Feet and axes whose stiffness a batch result calls usable; `_elements` says in which of them something slips."""
    rows = () if result is None else result.parameters
    return [
        (row.foot, axis)
        for row in rows
        for axis in ROTATIONAL_AXES
        if row.axis == axis and row.name == "stiffness" and row.verdict == "usable"
    ]


def _misplaced(result: FeetResult | None) -> dict[tuple[str, Axis], tuple[float, float, float, float]]:
    """Where a batch fit has found bush and force sensor: aside, above [m], turned, leaning [rad]."""
    models = () if result is None else result.models
    return {(one.foot, one.axis): (*one.moment_arms, one.turned, one.leans) for one in models}


def _unsure(result: FeetResult | None) -> dict[tuple[str, Axis], tuple[float, float]]:
    """By foot and axis, the deviations of stiffness and damping [share] by how far joints bend, as a batch fit has left
    them."""
    if result is None or not result.joint_compliance:
        return {}
    left = {
        (row.foot, row.axis, row.name): row.variance_shares.get(OF_JOINTS, 0.0) for row in result.diagnosis
    }

    def share(foot: str, axis: Axis, name: str) -> float:
        row = result.parameter(foot, axis, name)
        if not row.std or not row.value:
            return 0.0
        return abs(row.std / row.value) * math.sqrt(left.get((foot, axis, name), 0.0))

    return {
        (one.foot, one.axis): (share(one.foot, one.axis, "stiffness"), share(one.foot, one.axis, "damping"))
        for one in result.models
    }


def _row(what: str, values: ArrayLike | None, size: int) -> Array | None:
    return None if values is None else _sized(what, values, size)


def _sized(what: str, values: ArrayLike, size: int) -> Array:
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.shape != (size,):
        raise DataError(f"{what}: an array of shape {array.shape} (valid: {(size,)})")
    return array

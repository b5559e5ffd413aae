"""The fit of what force sensors get wrong, from both sides of Newton's law."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from plantar.robot.model import RobotModel
from plantar.sensors.moments.moment_errors import moment_errors
from plantar.sensors.moments.moment_fit import MomentFit, moments_of
from plantar.sensors.moments.sensor_errors import STIFF
from plantar.sensors.newton_euler import NewtonEulerResidual


def fit_moments(
    robot: RobotModel,
    residuals: Sequence[NewtonEulerResidual],
    stepping: Collection[str],
    bending: float = STIFF,
) -> MomentFit | None:
    """`stepping`: names of the logs in which feet step; `bending`: as of `prior_deviations`."""
    steps = [one.pair.label in stepping for one in residuals]
    logs = [moment_errors(robot, *one) for one in zip(residuals, steps, strict=True)]
    return moments_of(robot, logs, any(steps), bending)

"""Inertial parameters from the base link's motion and the ground's wrench, without any joint torque (eq. 2)."""

from __future__ import annotations

from collections.abc import Sequence

from plantar.conventions import WRENCH_AXES
from plantar.errors import RobotError, located
from plantar.logs.motion_log import MotionLog
from plantar.results.dynamics import INERTIA_SCHEMA, DynamicsResult
from plantar.robot.model import RobotModel
from plantar.whole_body.covariance import uncertainty
from plantar.whole_body.equations import inertial_samples
from plantar.whole_body.regularised_fit import RegularisedProblem
from plantar.whole_body.regularised_result import result_of
from plantar.whole_body.scores import Place
from plantar.whole_body.settings import DynamicsSettings
from plantar.whole_body.whole_logs import Progress, prepare_logs

# The six axes of the ground's wrench in the base link's frame.
AXES = tuple(Place(row, "N" if row < 3 else "N.m", axis=axis) for row, axis in enumerate(WRENCH_AXES))


def identify_inertia(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    validate: Sequence[MotionLog] = (),
    settings: DynamicsSettings | None = None,
    progress: Progress = lambda _: None,
) -> DynamicsResult:
    """Fit the inertial parameters of a floating-base robot to `logs` and score them, also on `validate`.

    Every link is physically consistent and as near to the URDF's as held-out stretches of `logs` allow. Raises
    RobotError, LogError or DataError with one line when the input cannot serve, MissingExtra without clarabel.
    """
    settings = settings or DynamicsSettings()
    if robot.base == "fixed":
        message = "a fixed base has no base rows to identify from"
        raise RobotError(located(message, path=robot.path, valid="plantar identify joints"))
    made = prepare_logs(robot, logs, validate, settings, progress)
    body = made.body
    fitted, unseen = (
        [inertial_samples(body, whole, made.calibration) for whole in wholes]
        for wholes in (made.fitted, made.unseen)
    )
    fit = RegularisedProblem(body.equation, body.base, body.prior, fitted).solve(progress)
    progress("deviations")
    trust = uncertainty(fit, fitted)
    said = {**settings.to_dict(), "weights": [float(weight) for weight in fit.weights.values()]}
    return result_of(INERTIA_SCHEMA, made, fit, trust, fitted, unseen, AXES, said)

"""Inertial parameters from the base link's motion and the ground's wrench, without any joint torque (eq. 2)."""

from __future__ import annotations

from plantar.choices import settings_of
from plantar.conventions import WRENCH_AXES
from plantar.errors import RobotError
from plantar.logs.inputs import LogInputs, RobotInput, robot_of
from plantar.results.dynamics import INERTIA_SCHEMA, DynamicsResult
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
    robot: RobotInput,
    logs: LogInputs,
    validate: LogInputs = (),
    settings: DynamicsSettings | None = None,
    progress: Progress = lambda _: None,
) -> DynamicsResult:
    """Inertial parameters of a floating-base robot from IMU, encoders and feet, without joint torques (eq. 2).

    Every link stays physically consistent and as near to the URDF's as held-out parts of `logs` allow.

    Args:
        robot: a robot with a floating base, an IMU and feet, or the path of its robot file.
        logs: logs to fit, or their paths; one or several.
        validate: logs to score only.
        settings: what to choose by hand.
        progress: called with a line for each step.

    Returns:
        Base parameters with 95 % intervals, each link's ten parameters beside the URDF's [kg, kg·m, kg·m²], scores of
        the ground's wrench [N, N·m], and the URDF with what was found.

    Raises:
        RobotError, LogError, DataError: the input cannot be used, in one line. MissingExtra: clarabel is not installed.

    Example:
        >>> import plantar
        >>> result = plantar.identify_inertia("walker.yaml", "walk.csv")
        >>> 20.0 < result.mass < 25.0
        True
    """
    robot = robot_of(robot)
    settings = settings_of(settings, DynamicsSettings)
    if robot.base == "fixed":
        message = "a fixed base has no base rows to identify from"
        raise RobotError(message, path=robot.path, valid="plantar identify joints")
    made = prepare_logs(robot, logs, validate, settings, progress)
    body = made.body
    fitted, unseen = (
        [inertial_samples(body, whole, made.calibration) for whole in wholes]
        for wholes in (made.fitted, made.unseen)
    )
    fit = RegularisedProblem.of(body.equation, body.base, body.prior, fitted).solve(progress)
    progress("deviations")
    trust = uncertainty(fit, fitted)
    said = {**settings.to_dict(), "weights": [float(weight) for weight in fit.weights.values()]}
    return result_of(INERTIA_SCHEMA, made, fit, trust, fitted, unseen, AXES, said)

"""Friction, springs, offsets and actuator inertia of the joints, with the inertias known or found together (eq. 3)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal

import numpy as np
import pyarrow as pa

from plantar.conventions import Array
from plantar.errors import DataError, RobotError, located
from plantar.estimation.intervals import interval95
from plantar.identify.calibration import calibrate
from plantar.identify.dynamics_result import (
    JOINTS_SCHEMA,
    DynamicsResult,
    DynamicsScore,
    JointParameter,
    score_row,
)
from plantar.identify.inertia import (
    check_logs,
    fit_notes,
    inputs_of,
    residual_rows,
    result_of,
)
from plantar.identify.pulled_covariance import Uncertainty, uncertainty
from plantar.identify.pulled_fit import PulledFit, PulledProblem, Samples, errors_of
from plantar.identify.whole_body import (
    TERM_UNITS,
    Body,
    Calibration,
    DynamicsSettings,
    Whole,
    inertial_samples,
    joint_samples,
    prepare_whole,
)
from plantar.log import MotionLog
from plantar.notes import Note
from plantar.result import Verdict
from plantar.robot import RobotModel

FRICTION = ("viscous", "coulomb", "offset")  # of a joint that the robot file does not describe
SPRUNG = (*FRICTION, "stiffness")  # cables and covers: taken where held-out data speak for it
POSITIVE = ("viscous", "coulomb", "stiffness", "inertia")
USABLE_SHARE = 0.2  # half width of the interval over the value
OFFSET_SHARE = (
    0.05  # of the joint's rms torque: an offset known to within it is usable even where it is near zero
)

Progress = Callable[[str], None]
Inertia = Literal["together", "first", "known"]


def identify_joints(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    validate: Sequence[MotionLog] = (),
    settings: DynamicsSettings | None = None,
    progress: Progress = lambda _: None,
    *,
    inertia: Inertia = "together",
) -> DynamicsResult:
    """Fit the joints' own parameters to `logs` and score them, also on `validate`.

    inertia: "together" fits the inertial parameters with them, "first" takes those of eq. 2 (floating bases), "known"
    the URDF's.

    Terms are those of the robot file; a joint that it does not describe has viscous and Coulomb friction and an offset,
    and a spring where held-out stretches of `logs` are predicted better with it. Passive joints need no effort.
    Fitted inertias stay physically consistent and as near to the URDF's as held-out stretches allow. Raises RobotError,
    LogError or DataError with one line when the input cannot serve, MissingExtra without clarabel.
    """
    settings = settings or DynamicsSettings()
    check_logs(logs, validate)
    floating = robot.base == "floating"
    if inertia == "first" and not floating:
        message = "a fixed base has no base rows to identify inertias from first"
        raise RobotError(located(message, path=robot.path, valid="inertia: together, known"))
    body = Body.of(robot, floating=floating)
    progress("prepare the logs")
    fitted = [prepare_whole(body, log, settings) for log in logs]
    unseen = [prepare_whole(body, log, settings) for log in validate]
    calibration, notes = Calibration(np.eye(3)), list[Note]()
    if floating:
        calibration, notes = calibrate(body, fitted, as_recorded=settings.as_recorded)
    given, said = _given(body, fitted, calibration, inertia, progress)
    terms, fit, choice = _chosen(body, fitted, calibration, given, progress)
    progress("deviations")
    recordings = [joint_samples(body, whole, calibration, terms) for whole in fitted]
    trust = uncertainty(fit, recordings)
    validation, residuals = _score(body, fit, fitted, unseen, calibration, terms)
    return result_of(
        JOINTS_SCHEMA,
        body,
        fit,
        trust,
        inputs=inputs_of(logs, validate),
        settings={
            **settings.to_dict(),
            "inertia": inertia,
            "terms": {joint: list(chosen) for joint, chosen in terms.items()},
        },
        validation=validation,
        residuals=residuals,
        notes=[*(note for whole in fitted + unseen for note in whole.notes), *notes, *said, *choice],
        parameters=_parameters(body, fit, trust, terms, recordings),
    )


def _given(
    body: Body, fitted: Sequence[Whole], calibration: Calibration, inertia: Inertia, progress: Progress
) -> tuple[Array | None, list[Note]]:
    """The inertial parameters that eq. 3 is to take as they are, if any: the URDF's, or those of eq. 2."""
    if inertia == "together":
        return None, []
    if inertia == "known":
        text = "inertias taken from the URDF as known: the joints' deviations leave their errors out"
        return body.prior.cad, [Note("inertia_known", "info", text)]
    recordings = [inertial_samples(body, whole, calibration) for whole in fitted]
    fit = PulledProblem(body.equation, body.base, body.prior, recordings).solve(progress)
    text = (
        "inertias identified first, from the base rows (eq. 2): the joints' deviations leave their errors out"
    )
    return fit.inertial, [Note("inertia_first", "info", text), *fit_notes(fit)]


def _chosen(
    body: Body,
    fitted: Sequence[Whole],
    calibration: Calibration,
    inertial: Array | None,
    progress: Progress,
) -> tuple[dict[str, tuple[str, ...]], PulledFit, list[Note]]:
    """Terms of every joint that takes part, and the fit with them; inertial: given parameters, if any."""
    measured = _measured_joints(body, fitted)
    described = body.robot.joints
    fits = []
    for default in (FRICTION, SPRUNG):
        terms = {name: described[name].terms if name in described else default for name in measured}
        recordings = [joint_samples(body, whole, calibration, terms) for whole in fitted]
        problem = PulledProblem(body.equation, body.base, body.prior, recordings)
        fits.append((terms, problem.solve(progress) if inertial is None else problem.with_known(inertial)))
        if all(name in described for name in measured):
            return terms, fits[0][1], []
    errors = [_held_out(fit, fits[0][1]) for _, fit in fits]
    sprung = errors[1] < errors[0]
    terms, fit = fits[sprung]
    text = (
        f"joints that the robot file does not describe: {', '.join(SPRUNG if sprung else FRICTION)} (held-out error "
        f"{np.sqrt(errors[0]):.4g} without stiffness, {np.sqrt(errors[1]):.4g} with it)"
    )
    return terms, fit, [Note("terms", "info", text)]


def _held_out(fit: PulledFit, reference: PulledFit) -> float:
    """Smallest held-out error of a fit in the weights of another, so that both can be compared."""
    if not fit.trials:
        return float("inf")
    ratio = np.mean([(reference.weights[row] / fit.weights[row]) ** 2 for row in fit.weights])
    return float(errors_of(fit.trials).min() * ratio)


def _measured_joints(body: Body, fitted: Sequence[Whole]) -> tuple[str, ...]:
    """Joints with effort in every log, and the passive ones."""
    names = []
    for name in body.equation.tree.names:
        terms = body.robot.joints.get(name)
        if (terms is not None and terms.passive) or all(name in whole.efforts for whole in fitted):
            names.append(name)
    if not names:
        valid = "joint.<joint>.effort, or passive: true in the robot file"
        raise DataError(located("holds no joint torques", path=fitted[0].log.source, valid=valid))
    return tuple(names)


def _parameters(
    body: Body,
    fit: PulledFit,
    trust: Uncertainty,
    terms: Mapping[str, tuple[str, ...]],
    recordings: Sequence[Samples],
) -> tuple[JointParameter, ...]:
    rows = []
    for joint, name in enumerate(body.equation.tree.names):
        if name not in terms:
            continue
        row = body.equation.first_joint_row + joint
        torque = float(np.sqrt(np.mean(np.concatenate([one.measured[row] for one in recordings]) ** 2)))
        still = all(np.ptp(one.motion.positions[:, joint]) < 1e-3 for one in recordings)
        for term, value, std in zip(terms[name], fit.extras[row], trust.extras[row], strict=True):
            interval = interval95(float(value), float(std), trust.freedom)
            verdict, reason = _judge(term, float(value), interval, torque, still)
            rows.append(
                JointParameter(
                    name, term, TERM_UNITS[term], float(value), float(std), interval, verdict, reason
                )
            )
    return tuple(rows)


def _judge(
    term: str, value: float, interval: tuple[float, float], torque: float, still: bool
) -> tuple[Verdict, str]:
    half = (interval[1] - interval[0]) / 2
    if still and term != "offset":
        return "unidentifiable", "the joint hardly moves"
    if term in POSITIVE and value <= 0:
        impossible = interval[1] < 0
        return (
            "unidentifiable",
            "negative, which is impossible" if impossible else "zero lies in the interval",
        )
    if half <= USABLE_SHARE * abs(value) or (term == "offset" and half <= OFFSET_SHARE * torque):
        return "usable", "the interval is narrow"
    if interval[0] <= 0 <= interval[1]:
        return "unidentifiable", "zero lies in the interval"
    return "weak", f"the interval is {100 * half / abs(value):.0f} % of the value to each side"


def _score(
    body: Body,
    fit: PulledFit,
    fitted: Sequence[Whole],
    unseen: Sequence[Whole],
    calibration: Calibration,
    terms: Mapping[str, tuple[str, ...]],
) -> tuple[tuple[DynamicsScore, ...], pa.Table]:
    """Measured torque (plus what contacts carry) against predicted, joint by joint and all together."""
    names = tuple(name for name in body.equation.tree.names if name in terms)
    index = [body.equation.first_joint_row + body.equation.tree.names.index(name) for name in names]
    rows: list[DynamicsScore] = []
    tables: list[pa.Table] = []
    means: list[Array] = []
    kinds: tuple[tuple[Literal["direct", "cross"], Sequence[Whole]], ...] = (
        ("direct", fitted),
        ("cross", unseen),
    )
    for kind, wholes in kinds:
        for whole in wholes:
            missing = [name for name in names if name not in whole.efforts and not _passive(body, name)]
            if missing:
                raise DataError(
                    located("is missing", path=whole.log.source, column=f"joint.{missing[0]}.effort")
                )
            samples = joint_samples(body, whole, calibration, terms)
            measured = np.array([samples.measured[row] for row in index])
            predicted = fit.predict(samples)[index]
            cad = body.equation.inverse_dynamics(samples.motion, body.prior.cad)[index]
            if kind == "direct":
                means.append(measured.mean(axis=1))
            trivial = np.mean(means, axis=0)
            for k, name in enumerate(names):
                parts = (measured[k], predicted[k], cad[k], trivial[k])
                rows.append(score_row(kind, samples.name, "N.m", *parts, joint=name))
            rows.append(
                score_row(kind, samples.name, "N.m", measured, predicted, cad, trivial[:, None], joint="all")
            )
            tables.append(residual_rows(samples, kind, names, measured, predicted))
    return tuple(rows), pa.concat_tables(tables)


def _passive(body: Body, name: str) -> bool:
    return name in body.robot.joints and body.robot.joints[name].passive

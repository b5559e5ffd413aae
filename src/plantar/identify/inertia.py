"""Inertial parameters from the base link's motion and the ground's wrench, without any joint torque (eq. 2)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
import pyarrow as pa

from plantar.conventions import INERTIAL_NAMES, INERTIAL_UNITS, WRENCH_AXES, Array
from plantar.dynamics import parameter_name, solve_triangle
from plantar.dynamics.consistency import is_consistent
from plantar.errors import DataError, RobotError, located
from plantar.estimation.intervals import interval95, relative_std_percent
from plantar.identify.calibration import calibrate
from plantar.identify.dynamics_result import (
    INERTIA_SCHEMA,
    BaseParameter,
    DynamicsResult,
    DynamicsScore,
    InertialParameter,
    JointParameter,
    score_row,
)
from plantar.identify.identified_urdf import identified_urdf
from plantar.identify.pulled_covariance import Uncertainty, uncertainty
from plantar.identify.pulled_fit import PulledFit, PulledProblem, Samples
from plantar.identify.whole_body import (
    Body,
    Calibration,
    DynamicsSettings,
    Whole,
    inertial_samples,
    prepare_whole,
)
from plantar.log import MotionLog
from plantar.notes import Note, unique
from plantar.result import Input
from plantar.robot import RobotModel

UNITS = dict.fromkeys(WRENCH_AXES[:3], "N") | dict.fromkeys(WRENCH_AXES[3:], "N.m")
NAMED = 12  # unexcited parameters named in a note; more are counted

Progress = Callable[[str], None]


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
    check_logs(logs, validate)
    body = Body.of(robot, floating=True)
    progress("prepare the logs")
    fitted = [prepare_whole(body, log, settings) for log in logs]
    unseen = [prepare_whole(body, log, settings) for log in validate]
    calibration, notes = calibrate(body, fitted, as_recorded=settings.as_recorded)
    recordings = [inertial_samples(body, whole, calibration) for whole in fitted]
    fit = PulledProblem(body.equation, body.base, body.prior, recordings).solve(progress)
    progress("deviations")
    trust = uncertainty(fit, recordings)
    validation, residuals = _score(body, fit, fitted, unseen, calibration)
    return result_of(
        INERTIA_SCHEMA,
        body,
        fit,
        trust,
        inputs=inputs_of(logs, validate),
        settings={**settings.to_dict(), "weights": [float(weight) for weight in fit.weights.values()]},
        validation=validation,
        residuals=residuals,
        notes=[*(note for whole in fitted + unseen for note in whole.notes), *notes],
    )


def result_of(
    schema: str,
    body: Body,
    fit: PulledFit,
    trust: Uncertainty,
    *,
    inputs: tuple[Input, ...],
    settings: dict[str, Any],
    validation: tuple[DynamicsScore, ...],
    residuals: pa.Table,
    notes: Sequence[Note],
    parameters: tuple[JointParameter, ...] = (),
) -> DynamicsResult:
    """What eq. 2 and eq. 3 give alike, with notes on excitation and pull after those given."""
    robot = body.robot
    rank, condition, excitation = excitation_of(fit)
    model = robot.floating_model if body.equation.floating else robot.model
    return DynamicsResult(
        schema=schema,
        robot=robot.name,
        inputs=inputs,
        settings={**settings, "strength": fit.strength},
        rank=rank,
        condition_number=condition,
        base_parameters=base_rows(fit, trust),
        inertial_parameters=inertial_rows(fit),
        parameters=parameters,
        validation=validation,
        notes=unique([*notes, *excitation, *fit_notes(fit)]),
        urdf=identified_urdf(robot.urdf, model, fit.inertial),
        residuals=residuals,
    )


def check_logs(logs: Sequence[MotionLog], validate: Sequence[MotionLog]) -> None:
    """DataError where there is nothing to fit or two logs share a name."""
    if not logs:
        raise DataError("no logs to fit (valid: at least one)")
    names = [log.name for log in (*logs, *validate)]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise DataError(
            f"two logs are called '{twice}' (valid: names that differ, since results name motions by them)"
        )


def inputs_of(logs: Sequence[MotionLog], validate: Sequence[MotionLog]) -> tuple[Input, ...]:
    return (*(Input.of(log, "fit") for log in logs), *(Input.of(log, "validate") for log in validate))


def excitation_of(fit: PulledFit) -> tuple[int, float, list[Note]]:
    """Rank and condition number of the weighted regressor, and what the motions do not excite."""
    triangle = np.ascontiguousarray(fit.triangle)
    solution = solve_triangle(triangle)
    singular = np.linalg.svd(triangle[:-1, :-1], compute_uv=False)
    condition = float(singular[0] / singular[solution.rank - 1]) if solution.rank else float("inf")
    if solution.full:
        return solution.rank, condition, []
    n_base = len(fit.base)
    names = [fit.base.names[k] for k in np.flatnonzero(~solution.excited[:n_base])]
    listed = ", ".join(names[:NAMED]) + (f" and {len(names) - NAMED} more" if len(names) > NAMED else "")
    text = (
        f"the motions excite {solution.rank} of {len(solution.values)} directions; from the URDF, not from the data: "
        + listed
    )
    return solution.rank, condition, [Note("unexcited", "warning", text)]


def fit_notes(fit: PulledFit) -> list[Note]:
    """What the choice of the pull was, and whether it was at the end of its range."""
    if np.isinf(fit.strength):
        return []
    if not fit.trials:
        text = "too few samples to hold any out: a gentle pull towards the URDF was assumed"
        return [Note("pull", "warning", text)]
    held_out = {trial.strength: float(np.sqrt(trial.errors.mean())) for trial in fit.trials}
    text = (
        f"pulled towards the URDF with strength {fit.strength:g}: "
        f"held-out error {held_out[fit.strength]:.4g} of the fit's, "
        f"{held_out[min(held_out)]:.4g} at the gentlest pull, {held_out[max(held_out)]:.4g} at the strongest"
    )
    notes = [Note("pull", "info", text)]
    links = zip(fit.equation.links, fit.prior.cad.reshape(-1, len(INERTIAL_NAMES)), strict=True)
    impossible = [link for link, cad in links if not is_consistent(cad)]
    if impossible:
        text = f"inertias in the URDF that no body can have: {', '.join(impossible)}"
        notes.append(Note("cad_inconsistent", "warning", text))
    return notes


def base_rows(fit: PulledFit, trust: Uncertainty) -> tuple[BaseParameter, ...]:
    values = fit.base.grouping @ fit.inertial
    return tuple(
        BaseParameter(
            expression,
            float(value),
            float(std),
            interval95(float(value), float(std), trust.freedom),
            relative_std_percent(float(value), float(std)),
        )
        for expression, value, std in zip(fit.base.expressions, values, trust.base, strict=True)
    )


def inertial_rows(fit: PulledFit) -> tuple[InertialParameter, ...]:
    rows = []
    for index, (value, cad) in enumerate(zip(fit.inertial, fit.prior.cad, strict=True)):
        link, name = parameter_name(fit.equation.links, index).rsplit(".", 1)
        unit = INERTIAL_UNITS[index % len(INERTIAL_NAMES)]
        rows.append(InertialParameter(link, name, unit, float(value), float(cad)))
    return tuple(rows)


def _score(
    body: Body, fit: PulledFit, fitted: Sequence[Whole], unseen: Sequence[Whole], calibration: Calibration
) -> tuple[tuple[DynamicsScore, ...], pa.Table]:
    """The six axes of the ground's wrench in the base link's frame, motion by motion."""
    rows: list[DynamicsScore] = []
    tables: list[pa.Table] = []
    trivial: Array | None = None
    kinds: tuple[tuple[Literal["direct", "cross"], Sequence[Whole]], ...] = (
        ("direct", fitted),
        ("cross", unseen),
    )
    samples: Samples
    means = []
    for kind, wholes in kinds:
        for whole in wholes:
            samples = inertial_samples(body, whole, calibration)
            measured = np.array([samples.measured[k] for k in range(6)])
            if kind == "direct":
                means.append(measured.mean(axis=1))
                trivial = np.mean(means, axis=0)
            assert trivial is not None
            predicted, cad = (
                body.equation.inverse_dynamics(samples.motion, parameters)[:6]
                for parameters in (fit.inertial, body.prior.cad)
            )
            for k, axis in enumerate(WRENCH_AXES):
                rows.append(
                    score_row(
                        kind,
                        samples.name,
                        UNITS[axis],
                        measured[k],
                        predicted[k],
                        cad[k],
                        trivial[k],
                        axis=axis,
                    )
                )
            tables.append(residual_rows(samples, kind, WRENCH_AXES, measured, predicted))
    return tuple(rows), pa.concat_tables(tables)


def residual_rows(
    samples: Samples,
    kind: Literal["direct", "cross"],
    names: Sequence[str],
    measured: Array,
    predicted: Array,
) -> pa.Table:
    """Measured and predicted of every row of one motion, sample by sample."""
    count = len(samples.time)
    columns: dict[str, object] = {
        "motion": pa.array([samples.name] * count).dictionary_encode(),
        "role": pa.array(["fit" if kind == "direct" else "validate"] * count).dictionary_encode(),
        "time": samples.time,
    }
    for name, true, guess in zip(names, measured, predicted, strict=True):
        columns[f"{name}.measured"] = true
        columns[f"{name}.predicted"] = guess
    return pa.table(columns)

"""Eq. 2 over any number of logs: every worker makes R factors of its own, which add up by a tree.

What `identify inertia` does with the factors of its logs is done with the sums: rows weighted by what they miss, links
that stay bodies, as near to the URDF as held-out folds allow. Then each worker says how its logs' residuals scatter,
which adds up as well. Logs are read for the factors and for the scatter, the first ones for the sensors' faults too.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import RowFactor
from plantar.errors import DataError, PlantarError, RobotError
from plantar.fleet.places import brought
from plantar.fleet.robots import FleetRobot, robot_at, robot_model
from plantar.fleet.unit import Failure
from plantar.fleet.work import one_thread
from plantar.logs.inputs import open_together
from plantar.notes import Note, unique
from plantar.results.dynamics import INERTIA_SCHEMA, DynamicsResult
from plantar.results.feet import Input
from plantar.whole_body.covariance import score_covariance, uncertainty_from
from plantar.whole_body.dataset import Body, Whole, prepare_whole
from plantar.whole_body.equations import Calibration, inertial_samples
from plantar.whole_body.folds import FOLDS, Folds, factors_of, pooled
from plantar.whole_body.regularised_fit import RegularisedFit, RegularisedProblem
from plantar.whole_body.regularised_result import (
    base_rows,
    excitation_of,
    fit_notes,
    identified_urdf,
    inertial_rows,
)
from plantar.whole_body.sensor_calibration import calibrate
from plantar.whole_body.settings import DynamicsSettings

CALIBRATED: Final = 12  # logs that the sensors are calibrated on
MOST_FOLDS: Final = 12  # more logs share folds: each fold costs fits, and ten thousand would tell no more
BRANCHES: Final = 8  # factors that one task adds up

UNSCORED: Final = Note(
    "not_scored",
    "info",
    "a fleet's logs are not scored: plantar identify inertia with --validate on some of them does it",
)

Factors = dict[int, RowFactor]


def inertia_over(
    client: Any,
    robot: str,
    logs: Sequence[str],
    settings: DynamicsSettings | None,
    progress: Callable[[str], None],
) -> DynamicsResult:
    """Inertial parameters of one robot from logs anywhere, on a Dask cluster.

    Up to twelve logs give what `identify_inertia` gives, without its scores; more share twelve folds for the choice of
    the regularisation. A log that cannot be used is left out, with a note.

    Args:
        client: a `distributed.Client`. robot: the place of the robot file. logs: places of logs.
        settings: as for `identify_inertia`. progress: called with a line for each step.

    Raises:
        RobotError: the robot file is wrong, or the base is fixed. DataError: no log can be used.
    """
    settings = settings or DynamicsSettings()
    known = robot_at(robot)
    model = robot_model(known)
    if model.base == "fixed":
        raise RobotError("a fixed base has no base rows to identify from", path=robot, valid="a floating one")
    if not logs:
        raise DataError("no logs to fit (valid: at least one)")
    progress("calibrate the sensors")
    first = tuple(logs[:CALIBRATED])
    calibration, notes = client.submit(_calibrated, known, first, settings, pure=False).result()
    parts = max(1, -(-FOLDS // len(logs)))
    progress(f"R factors of {len(logs)} logs")
    level = [
        client.submit(_made, known, log, settings, calibration, parts, place * parts, pure=False)
        for place, log in enumerate(logs)
    ]
    while len(level) > 1:
        level = [
            client.submit(_added, level[start : start + BRANCHES], pure=False)
            for start in range(0, len(level), BRANCHES)
        ]
    total: Summed = level[0].result()
    if not total.folds:
        raise DataError(f"no log can be used; the first one: {total.failures[0].error}")
    progress("fit")
    body = Body.of(model, floating=True)
    folds = Folds(body.base, [total.folds[number] for number in sorted(total.folds)])
    fit = RegularisedProblem(body.equation, body.prior, folds).solve(progress)
    progress("deviations")
    broken = {failure.log for failure in total.failures}
    used = [log for log in logs if log not in broken]
    found = (fit.inertial, fit.weights, fit.regularisation, fit.triangle)
    scored = client.gather(
        [client.submit(_scored, known, log, settings, calibration, *found, pure=False) for log in used]
    )
    trust = uncertainty_from(fit, scored)
    left_out = [Note("log_left_out", "warning", failure.error) for failure in total.failures]
    rank, condition, excitation = excitation_of(fit)
    urdf, moved = identified_urdf(model, fit)
    return DynamicsResult(
        schema=INERTIA_SCHEMA,
        robot=model.name,
        inputs=tuple(Input(log, None, "fit") for log in used),
        settings={
            **settings.to_dict(),
            "weights": [float(weight) for weight in fit.weights.values()],
            "strength": fit.regularisation,
        },
        rank=rank,
        condition_number=condition,
        base_parameters=base_rows(model, fit, trust),
        inertial_parameters=inertial_rows(fit),
        parameters=(),
        validation=(),
        notes=unique([*left_out, UNSCORED, *notes, *excitation, *fit_notes(fit), *moved]),
        urdf=urdf,
        residuals=None,
    )


@dataclass(frozen=True)
class Summed:
    """R factors by fold, of one log or of many, and the logs that could not be used."""

    folds: Mapping[int, Factors]
    failures: tuple[Failure, ...] = ()


def _made(
    robot: FleetRobot, log: str, settings: DynamicsSettings, calibration: Calibration, parts: int, first: int
) -> Summed:
    """One log's factors, cut in time into `parts`, for the folds from `first` on."""
    body = Body.of(robot_model(robot), floating=True)
    try:
        samples = inertial_samples(body, _prepared(body, log, settings), calibration)
    except PlantarError as error:
        return Summed({}, (Failure(log, str(error)),))
    bounds = pairwise(np.linspace(0, len(samples.time), parts + 1).astype(int))
    return Summed(
        {
            (first + part) % MOST_FOLDS: factors_of(body.equation, body.base, samples.select(slice(*bound)))
            for part, bound in enumerate(bounds)
        }
    )


def _added(some: Sequence[Summed]) -> Summed:
    """The factors of several logs as one: R of R factors on top of one another."""
    by_fold: dict[int, list[Factors]] = {}
    for one in some:
        for number, factors in one.folds.items():
            by_fold.setdefault(number, []).append(factors)
    folds = {
        number: {row: pooled([one[row] for one in own]) for row in own[0]} for number, own in by_fold.items()
    }
    return Summed(folds, tuple(failure for one in some for failure in one.failures))


def _calibrated(
    robot: FleetRobot, logs: Sequence[str], settings: DynamicsSettings
) -> tuple[Calibration, list[Note]]:
    """The sensors' mounts and faults, from those logs that can be used."""
    body = Body.of(robot_model(robot), floating=True)
    prepared: list[Whole] = []
    reason = ""
    for log in logs:
        try:
            prepared.append(_prepared(body, log, settings))
        except PlantarError as error:
            reason = reason or str(error)
    if not prepared:
        raise DataError(f"none of the first {len(logs)} logs can be used: {reason}")
    return calibrate(body, prepared, as_recorded=settings.as_recorded)


def _scored(
    robot: FleetRobot,
    log: str,
    settings: DynamicsSettings,
    calibration: Calibration,
    inertial: Array,
    weights: Mapping[int, float],
    regularisation: float,
    triangle: Array,
) -> tuple[Array, float]:
    """How one log's residuals of a fit scatter."""
    body = Body.of(robot_model(robot), floating=True)
    extras: dict[int, Array] = {row: np.zeros(0) for row in weights}
    fit = RegularisedFit(
        body.equation, body.base, body.prior, inertial, extras, weights, regularisation, (), triangle
    )
    return score_covariance(fit, inertial_samples(body, _prepared(body, log, settings), calibration))


def _prepared(body: Body, log: str, settings: DynamicsSettings) -> Whole:
    one_thread()
    with tempfile.TemporaryDirectory(prefix="plantar-") as folder:
        try:
            path = brought(log, Path(folder))
            (read,) = open_together([path], body.robot)
            return prepare_whole(body, read, settings)
        except PlantarError as error:
            raise DataError(str(error).replace(folder, log.rsplit("/", 1)[0])) from error

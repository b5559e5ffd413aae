"""Stiffness, damping and offset of each foot from what the robot recorded (paper, sections 3 and 4)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from plantar.conventions import DAMPING_UNIT, OFFSET_UNIT, ROTATIONAL_AXES, STIFFNESS_UNIT, Axis
from plantar.errors import DataError
from plantar.estimation import Block, LinearFit, fit_linear, interval95, relative_std_percent
from plantar.identify.height import Height, fit_height
from plantar.identify.recording import Recording, Role, moved_centre, prepare
from plantar.identify.residual_table import Predictions, residual_table
from plantar.identify.scoring import score_axis
from plantar.identify.settings import FeetSettings
from plantar.identify.systematic import with_systematic_errors
from plantar.identify.tipping import leave_out_tipping
from plantar.identify.verdicts import Evidence, judge
from plantar.log import MotionLog
from plantar.models import KelvinVoigt
from plantar.notes import Note, unique
from plantar.result import FeetResult, Input, Offset, Parameter, ValidationRow
from plantar.robot import Foot, Placement, RobotModel

UNITS = {"stiffness": STIFFNESS_UNIT, "damping": DAMPING_UNIT}
FEWEST_SAMPLES = 50  # of one recording, for it to take part in a fit

Progress = Callable[[str], None]


def identify_feet(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    validate: Sequence[MotionLog] = (),
    settings: FeetSettings | None = None,
    progress: Progress = lambda _: None,
) -> FeetResult:
    """Fit every foot's law in pitch and roll to `logs` together (eq. 6 and 7) and score it, also on `validate`.

    Raises RobotError, LogError or DataError with one line when the input cannot serve; what could be worked around
    is a note in the result. `progress` is called with a line for each step.
    """
    settings = settings or FeetSettings()
    check_names([*logs, *validate])
    fitted = prepare_all(robot, logs, "fit", settings, progress)
    unseen = prepare_all(robot, validate, "validate", settings, progress)
    if not any(recording.contacts[foot].standing.any() for recording in fitted for foot in robot.feet):
        raise DataError(f"{', '.join(log.name for log in logs)}: no foot carries load in any log (valid: a standing robot)")
    notes = [note for recording in fitted + unseen for note in recording.notes]
    progress("fit z")
    vertical = fit_height(fitted, robot, settings.cutoff)
    notes += vertical.notes
    fitted, unseen = ([moved_centre(one, vertical.compliance, settings.cutoff) for one in group] for group in (fitted, unseen))
    parameters: list[Parameter] = []
    offsets: list[Offset] = []
    rows: list[ValidationRow] = []
    predictions: Predictions = {}
    for foot in robot.feet:
        for axis in ROTATIONAL_AXES:
            progress(f"fit {foot} {axis}")
            fit = _fit_axis(fitted, foot, axis, settings, vertical)
            parameters += _parameters(fit, fitted, foot, axis)
            if fit is None:
                continue
            offsets += [
                Offset(foot, axis, motion, OFFSET_UNIT[axis], value, fit.offset_std(motion))
                for motion, value in fit.offsets.items()
            ]
            rows += score_axis(fitted + unseen, foot, axis, KelvinVoigt(), fit.values, fit.offsets, predictions)
    parameters += vertical.parameters
    notes += _feet_notes(robot, fitted)
    return FeetResult(
        robot=robot.name,
        inputs=(*(Input.of(log, "fit") for log in logs), *(Input.of(log, "validate") for log in validate)),
        settings=settings.to_dict(),
        model=settings.model,
        parameters=tuple(parameters),
        offsets=tuple(offsets),
        phases=tuple(
            phase
            for recording in fitted + unseen
            for foot, contact in recording.contacts.items()
            for phase in contact.phases(recording.name, foot, recording.time)
        ),
        validation=tuple(sorted(rows, key=lambda row: row.kind != "direct")),
        notes=unique(notes),
        robot_model=_robot_model(robot),
        residuals=residual_table(fitted + unseen, predictions),
    )


def prepare_all(
    robot: RobotModel, logs: Sequence[MotionLog], role: Role, settings: FeetSettings, progress: Progress
) -> list[Recording]:
    """Every log made ready, with samples of a tipping sole left out."""
    recordings = []
    for log in logs:
        progress(f"prepare {log.name}")
        recording = prepare(robot, log, role, settings)
        leave_out_tipping(robot, recording, settings)
        recordings.append(recording)
    return recordings


def check_names(logs: Sequence[MotionLog]) -> None:
    """DataError where two logs have one name: results name motions by them."""
    seen: dict[str, MotionLog] = {}
    for log in logs:
        if log.name in seen:
            message = f"two logs are called '{log.name}': {seen[log.name].source} and {log.source}"
            raise DataError(f"{message} (valid: file names that differ, since results name motions by them)")
        seen[log.name] = log


def _fit_axis(
    recordings: Sequence[Recording], foot: str, axis: Axis, settings: FeetSettings, vertical: Height
) -> LinearFit | None:
    """Eq. 7 for one axis of one foot, or None where no recording has samples that serve."""
    shared = settings.offset == "shared"
    blocks = blocks_of(recordings, foot, axis, drift=not shared)
    if not blocks:
        return None
    fit = fit_linear(blocks, shared_offset=shared)
    return with_systematic_errors(fit, blocks, recordings, foot, axis, settings, vertical)


def blocks_of(recordings: Sequence[Recording], foot: str, axis: Axis, *, drift: bool = True) -> list[Block]:
    """Eq. 6 for each recording in which the foot has enough samples that serve.

    `drift` adds a line in time to each recording's offset: the IMU's attitude drifts slowly.
    """
    column, law = ROTATIONAL_AXES.index(axis), KelvinVoigt()
    blocks = []
    for recording in recordings:
        used, bush = recording.used(foot), recording.bushes[foot]
        if used.sum() >= FEWEST_SAMPLES:
            regressor = law.regressor(bush.deflection[used, column], bush.rate[used, column])
            time = recording.time[used]
            nuisance = (time - time.mean())[:, None] if drift else None
            blocks.append(Block(recording.name, regressor, bush.torque[used, column], recording.period, nuisance))
    return blocks


def _parameters(
    fit: LinearFit | None, recordings: Sequence[Recording], foot: str, axis: Axis
) -> list[Parameter]:
    """The rows of table 1 for one axis, each with its verdict."""
    if fit is None:
        reason = f"the {foot} foot has no samples that serve in these logs"
        return [
            Parameter(foot, axis, term, UNITS[term][axis], None, None, None, None, "unidentifiable", reason,
                      f"record motions in which the {foot} foot stands")
            for term in KelvinVoigt().terms
        ]  # fmt: skip
    evidence = _evidence(fit, recordings, foot, axis)
    rows = []
    for place, term in enumerate(KelvinVoigt().terms):
        value, std = float(fit.values[place]), float(fit.std[place])
        interval = interval95(value, std, float(fit.freedom[place]))
        verdict, reason, advice = judge(foot, axis, term, value, interval, evidence)
        relative = relative_std_percent(value, float(fit.white_std[place]))
        rows.append(
            Parameter(foot, axis, term, UNITS[term][axis], value, std, interval, relative, verdict, reason, advice)
        )
    return rows


def _evidence(fit: LinearFit, recordings: Sequence[Recording], foot: str, axis: Axis) -> Evidence:
    column = ROTATIONAL_AXES.index(axis)
    seconds = moved = varied = missed = 0.0
    for recording in recordings:
        residual = fit.residuals.get(recording.name)
        if residual is None:
            continue
        used, bush = recording.used(foot), recording.bushes[foot]
        seconds += used.sum() * recording.period
        moved += float(np.sum((bush.deflection[used, column] - bush.deflection[used, column].mean()) ** 2))
        varied += float(np.sum((bush.torque[used, column] - bush.torque[used, column].mean()) ** 2))
        missed += float(np.sum(residual**2))
    samples = sum(len(residual) for residual in fit.residuals.values())
    return Evidence(seconds, float(np.sqrt(moved / samples)), 1 - missed / varied if varied else 0.0)


def _feet_notes(robot: RobotModel, recordings: Sequence[Recording]) -> list[Note]:
    notes = []
    for foot in robot.feet:
        if not any(recording.contacts[foot].standing.any() for recording in recordings):
            notes.append(Note("foot_never_stands", "warning", f"the {foot} foot carries no load in any log"))
    double = any(np.any(contact.support == 0) for recording in recordings for contact in recording.contacts.values())
    if len(robot.feet) > 1 and not double:
        notes.append(Note("no_double_support", "info", "no log has both feet on the ground: slip cannot be checked"))
    return notes


def _robot_model(robot: RobotModel) -> dict[str, Any]:
    """What an export needs of the robot: its URDF's path, and each foot's geometry."""

    def placed(placement: Placement) -> dict[str, Any]:
        return {"link": placement.link, "xyz": placement.xyz.tolist(), "rpy": placement.rpy.tolist()}

    def described(foot: Foot) -> dict[str, Any]:
        sole = {**placed(foot.sole.placement), "polygon": foot.sole.polygon.tolist()}
        return {"ankle": foot.ankle, "bush": placed(foot.bush), "sole": sole}

    return {"urdf": str(robot.urdf_path), "feet": {name: described(foot) for name, foot in robot.feet.items()}}

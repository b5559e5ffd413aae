"""Stiffness, damping and offset of each foot from what the robot recorded (paper, sections 3 and 4)."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np

from plantar.conventions import OFFSET_UNIT
from plantar.errors import DataError
from plantar.feet.assess.residual_table import residual_table
from plantar.feet.fit.axis import AxisFit
from plantar.feet.foot_fit import fit_foot
from plantar.feet.prepare import PreparedLogs, prepare_all
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.models import KelvinVoigt
from plantar.notes import Note, unique
from plantar.results.feet import FeetResult, Input, Offset
from plantar.robot.model import Foot, Placement, RobotModel


def identify_feet(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    validate: Sequence[MotionLog] = (),
    settings: FeetSettings | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> FeetResult:
    """Fit every foot's law in pitch and roll to `logs` together (eq. 6 and 7) and score it, also on `validate`.

    Raises RobotError, LogError or DataError with one line when the input cannot serve; what could be worked around
    is a note in the result. `progress` is called with a line for each step.
    """
    settings = settings or FeetSettings()
    if not logs:
        raise DataError("no logs to fit (valid: at least one)")
    return fit_prepared(robot, prepare_all(robot, logs, validate, settings, progress), progress)


def fit_prepared(
    robot: RobotModel, ready: PreparedLogs, progress: Callable[[str], None] = lambda _: None
) -> FeetResult:
    """`identify_feet` on logs that are ready. Raises DataError where no foot carries load in any of them."""
    logs = [recording.log for recording in ready.fitted]
    if not any(recording.contacts[foot].standing.any() for recording in ready.fitted for foot in robot.feet):
        names = ", ".join(log.name for log in logs)
        raise DataError(f"{names}: no foot carries load in any log (valid: a standing robot)")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        both = list(pool.map(lambda foot: fit_foot(ready, foot, progress), robot.feet))
    found = [fit for fit, _ in both]
    ready = _merged(ready, {foot: own for foot, (_, own) in zip(robot.feet, both, strict=True)})
    fits = [fit for each in found for fit in each.fits]
    parameters = [row for each in found for row in each.parameters]
    rows = [row for each in found for row in each.validation]
    predictions = {key: value for each in found for key, value in each.predictions.items()}
    return FeetResult(
        robot=robot.name,
        inputs=tuple(Input.of(recording.log, recording.role) for recording in ready.recordings),
        settings=ready.settings.to_dict(),
        model=_model(fits),
        parameters=(*parameters, *ready.vertical.parameters),
        offsets=tuple(offset for fit in fits for offset in _offsets(fit)),
        phases=tuple(
            phase
            for recording in ready.recordings
            for foot, contact in recording.contacts.items()
            for phase in contact.phases(recording.name, foot, recording.time)
        ),
        validation=tuple(sorted(rows, key=lambda row: row.kind != "direct")),
        notes=unique(
            [
                *ready.notes,
                *_feet_notes(robot, ready.fitted),
                *_model_notes(fits),
                *(note for each in found for note in each.notes),
            ]
        ),
        robot_model=_robot_model(robot),
        extras={
            "laws": [fit.to_dict() for fit in fits],
            "latency": ready.sensor_delay.to_dict(),
            "compliance": dict(ready.vertical.compliance),
            "diagnosis": [row for each in found for row in each.diagnosis],
        },
        residuals=residual_table(ready.recordings, predictions),
    )


def _merged(ready: PreparedLogs, by_foot: Mapping[str, PreparedLogs]) -> PreparedLogs:
    """The logs with each foot's contacts as its own fit left them."""
    fitted = tuple(
        replace(recording, contacts={foot: own.fitted[place].contacts[foot] for foot, own in by_foot.items()})
        for place, recording in enumerate(ready.fitted)
    )
    return replace(ready, fitted=fitted)


def _model(fits: Sequence[AxisFit]) -> str:
    """The law of most axes; of equally many, the richer one."""
    counts = Counter(fit.model.name for fit in fits)
    return max(counts, key=lambda name: (counts[name], name != KelvinVoigt.name), default=KelvinVoigt.name)


def _model_notes(fits: Sequence[AxisFit]) -> list[Note]:
    """Laws richer than spring and damper, and what a chosen law leaves open."""
    notes = []
    for fit in fits:
        where = f"{fit.foot} {fit.axis}"
        if fit.model.name != KelvinVoigt.name:
            stiffness, damping = fit.equivalent
            linear = f"as spring and damper K = {stiffness:.4g}, C = {damping:.4g}"
            text = f"{where}: {fit.model.name} ({fit.reason}); {linear}"
            notes.append(Note("law", "info", text))
        if fit.choice is not None and fit.choice.caution is not None:
            notes.append(Note("law_caution", "warning", f"{where}: {fit.choice.caution}"))
        notes += fit.notes
    return notes


def _offsets(fit: AxisFit) -> list[Offset]:
    unit = OFFSET_UNIT[fit.axis]
    return [
        Offset(fit.foot, fit.axis, motion, unit, value, fit.offset_std[motion])
        for motion, value in fit.offsets.items()
    ]


def _feet_notes(robot: RobotModel, recordings: Sequence[Recording]) -> list[Note]:
    notes = []
    for foot in robot.feet:
        if not any(recording.contacts[foot].standing.any() for recording in recordings):
            notes.append(Note("foot_never_stands", "warning", f"the {foot} foot carries no load in any log"))
    double = any(
        np.any(contact.support == 0) for recording in recordings for contact in recording.contacts.values()
    )
    if len(robot.feet) > 1 and not double:
        notes.append(
            Note("no_double_support", "info", "no log has both feet on the ground: slip cannot be checked")
        )
    return notes


def _robot_model(robot: RobotModel) -> dict[str, Any]:
    """What an export needs of the robot: its URDF's path, and each foot's geometry."""

    def placed(placement: Placement) -> dict[str, Any]:
        return {"link": placement.link, "xyz": placement.xyz.tolist(), "rpy": placement.rpy.tolist()}

    def described(foot: Foot) -> dict[str, Any]:
        sole = {**placed(foot.sole.placement), "polygon": foot.sole.polygon.tolist()}
        return {"ankle": foot.ankle, "bush": placed(foot.bush), "sole": sole}

    return {
        "urdf": str(robot.urdf_path),
        "feet": {name: described(foot) for name, foot in robot.feet.items()},
    }

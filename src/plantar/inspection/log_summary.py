"""One log at a glance: sampling, gaps, values, weight, contact, excitation, and what it can identify."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from plantar.contact.phases import DOUBLE, SINGLE, SUPPORTS
from plantar.conventions import GRAVITY, ROTATIONAL_AXES, Array
from plantar.errors import PlantarError
from plantar.faults.log_faults import check_log
from plantar.feet.first_look import look_at
from plantar.feet.identify import fit_prepared
from plantar.feet.prepare import prepare_checked
from plantar.feet.prepare_log import checked
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding, Note
from plantar.results.feet import Assumption, Parameter
from plantar.results.io import finite
from plantar.robot.guesses import guess_notes
from plantar.robot.model import RobotModel
from plantar.signals.resampling import Sampling, sampling


@dataclass(frozen=True)
class ColumnRange:
    """Least and largest value of a column, and how many samples hold none."""

    name: str
    least: float | None
    largest: float | None
    missing: int


@dataclass(frozen=True)
class FootSummary:
    """One foot: seconds in each support, mean load [N], used seconds, and rms of angle [rad] and rate [rad/s]."""

    foot: str
    double: float
    single: float
    load: float
    serving: float
    deflection_rms: Mapping[str, float]
    rate_rms: Mapping[str, float]


@dataclass(frozen=True)
class LogSummary:
    """What `plantar inspect` shows of one log. `carried` and `mass` are in kg."""

    name: str
    duration: float
    samples: int
    sampling: Sampling
    columns: tuple[ColumnRange, ...]
    carried: float | None
    mass: float
    feet: tuple[FootSummary, ...]
    parameters: tuple[Parameter, ...]
    findings: tuple[Finding, ...]
    notes: tuple[Note, ...]
    assumptions: tuple[Assumption, ...]

    def to_dict(self) -> dict[str, Any]:
        plain: dict[str, Any] = finite(asdict(self))
        return plain


def inspect_log(robot: RobotModel, log: MotionLog) -> LogSummary:
    """Everything about one log that can be said; a problem that would stop a fit is a fatal finding, not an error."""
    findings = []
    feet: tuple[FootSummary, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    assumptions: tuple[Assumption, ...] = ()
    notes = (
        *guess_notes(robot.path.name, robot.guesses),
        *robot.weight_notes,
        *log.notes,
        *log.joint_notes(robot),
    )
    try:
        findings = check_log(robot, log)
        if robot.feet and not any(finding.fatal for finding in findings):
            ready = prepare_checked(
                robot,
                [look_at(robot, True, checked(robot, log, findings))],
                [],
                FeetSettings(),
                lambda _: None,
            )
            feet = tuple(_foot(ready.fitted[0], foot) for foot in robot.feet)
            result = fit_prepared(robot, ready, residuals=False)
            parameters, notes, assumptions = result.parameters, result.notes, result.assumptions
    except PlantarError as error:
        findings.append(Finding("not_usable", str(error), True))
    return LogSummary(
        name=log.name,
        duration=log.duration,
        samples=len(log),
        sampling=sampling(log),
        columns=tuple(_range(name, log) for name in log.columns),
        carried=sum(foot.load for foot in feet) / GRAVITY if feet else None,
        mass=robot.mass,
        feet=feet,
        parameters=parameters,
        findings=tuple(findings),
        notes=notes,
        assumptions=assumptions,
    )


def _range(name: str, log: MotionLog) -> ColumnRange:
    values = log.columns[name]
    finite_values = values[np.isfinite(values)]
    if not finite_values.size:
        return ColumnRange(name, None, None, len(values))
    left_out = len(values) - finite_values.size
    return ColumnRange(name, float(finite_values.min()), float(finite_values.max()), left_out)


def _foot(recording: Recording, foot: str) -> FootSummary:
    bush, contact, period = recording.bushes[foot], recording.contacts[foot], recording.period
    used = contact.used

    def rms(values: Array) -> float:
        return float(np.std(values[used])) if used.any() else 0.0

    return FootSummary(
        foot=foot,
        double=period * int(np.sum(contact.support == SUPPORTS.index(DOUBLE))),
        single=period * int(np.sum(contact.support == SUPPORTS.index(SINGLE))),
        load=float(np.nanmean(bush.force_z)) if np.isfinite(bush.force_z).any() else 0.0,
        serving=period * int(used.sum()),
        deflection_rms={axis: rms(bush.deflection[:, i]) for i, axis in enumerate(ROTATIONAL_AXES)},
        rate_rms={axis: rms(bush.rate[:, i]) for i, axis in enumerate(ROTATIONAL_AXES)},
    )

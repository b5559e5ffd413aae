"""A result from its file, scored on logs that it has not seen."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from plantar.conventions import ROTATIONAL_AXES
from plantar.errors import DataError
from plantar.identify.recording import moved_centre, prepare
from plantar.identify.residual_table import Predictions
from plantar.identify.scoring import score_axis
from plantar.identify.settings import FeetSettings
from plantar.identify.tipping import leave_out_tipping
from plantar.log import MotionLog
from plantar.models import KelvinVoigt
from plantar.result import ValidationRow
from plantar.robot import RobotModel


def validate_feet(
    result: Mapping[str, Any],
    robot: RobotModel,
    logs: Sequence[MotionLog],
    progress: Callable[[str], None] = lambda _: None,
) -> list[ValidationRow]:
    """Cross-validation rows of a `plantar.feet/1` result on `logs`; each log's first second gives its offset.

    Raises DataError when the result names feet that the robot has not, or no log has samples to score.
    """
    feet = {row["foot"] for row in result["parameters"]}
    strangers = sorted(feet - set(robot.feet))
    if strangers:
        raise DataError(f"the result is about a foot '{strangers[0]}' (valid: {', '.join(robot.feet)})")
    known = {key: value for key, value in result["settings"].items() if key in FeetSettings.__dataclass_fields__}
    settings = FeetSettings(**known)
    compliance = {foot: _compliance(result, foot) for foot in robot.feet}
    recordings = []
    for log in logs:
        progress(f"prepare {log.name}")
        recording = prepare(robot, log, "validate", settings)
        leave_out_tipping(robot, recording, settings)
        recordings.append(moved_centre(recording, compliance, settings.cutoff))
    rows: list[ValidationRow] = []
    predictions: Predictions = {}
    for foot in sorted(feet):
        for axis in ROTATIONAL_AXES:
            values = [_value(result, foot, axis, term) for term in KelvinVoigt().terms]
            if None not in values:
                rows += score_axis(recordings, foot, axis, KelvinVoigt(), np.array(values, dtype=float), {}, predictions)
    if not rows:
        raise DataError("no log has samples of a standing foot that could be scored (valid: more than 1.3 s of stance)")
    return rows


def _compliance(result: Mapping[str, Any], foot: str) -> float:
    """The foot's vertical compliance [m/N] as the fit used it; 0 where the result has none."""
    stiffness = _value(result, foot, "z", "stiffness")
    return 1 / stiffness if stiffness else 0.0


def _value(result: Mapping[str, Any], foot: str, axis: str, name: str) -> float | None:
    wanted = (foot, axis, name)
    return next((p["value"] for p in result["parameters"] if (p["foot"], p["axis"], p["name"]) == wanted), None)

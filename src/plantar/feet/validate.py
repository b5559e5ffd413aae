"""A result from its file, scored on logs that it has not seen."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.errors import DataError
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.assess.scores import score_axis
from plantar.feet.exclusion.edge_rolling import leave_out_edges
from plantar.feet.exclusion.slip import leave_out_slip
from plantar.feet.fit.axis import AxisFit
from plantar.feet.prepare import check_names, common_tilt_error, recorded
from plantar.feet.recording import checked, moved_centre
from plantar.feet.sensors.sensor_delay import in_time, sensor_delay_of
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.models import MODELS, KelvinVoigt
from plantar.results.feet import ValidationRow
from plantar.robot.model import RobotModel


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
    check_names(logs)
    known = {
        key: value for key, value in result["settings"].items() if key in FeetSettings.__dataclass_fields__
    }
    settings = FeetSettings(**known)
    compliance = {foot: float(result.get("compliance", {}).get(foot, 0.0)) for foot in robot.feet}
    sensor_delay = sensor_delay_of(result)
    even = [in_time(robot, checked(robot, log), sensor_delay) for log in logs]
    tilt_error = common_tilt_error(robot, even)
    recordings = [recorded(robot, log, "validate", settings, tilt_error, progress) for log in even]
    leave_out_edges(robot, recordings, settings)
    for recording in recordings:
        leave_out_slip(robot, recording)
    recordings = [moved_centre(recording, compliance, settings.cutoff) for recording in recordings]
    rows: list[ValidationRow] = []
    predictions: Predictions = {}
    for foot in sorted(feet):
        for axis in ROTATIONAL_AXES:
            fit = _stored_fit(result, foot, axis)
            if fit is not None:
                rows += score_axis(recordings, foot, axis, fit, predictions)
    if not rows:
        raise DataError(
            "no log has samples of a standing foot that could be scored (valid: more than 1.3 s of stance)"
        )
    return rows


def _stored_fit(result: Mapping[str, Any], foot: str, axis: Axis) -> AxisFit | None:
    """The law of one axis as the result holds it, None where a number of it is missing."""
    models = [row for row in result.get("laws", ()) if (row["foot"], row["axis"]) == (foot, axis)]
    entry: Mapping[str, Any] = models[0] if models else {"law": KelvinVoigt.name}
    name = entry["law"]
    if name not in MODELS:
        raise DataError(f"the result's law '{name}' is unknown (valid: {', '.join(MODELS)})")
    model = MODELS[name]
    stored = {
        row["name"]: row["value"]
        for row in result["parameters"]
        if (row["foot"], row["axis"]) == (foot, axis)
    }
    numbers = [stored.get(term) for term in (*model.terms, *model.shape_terms)]
    if any(number is None for number in numbers):
        return None
    values = np.array(numbers, dtype=float)
    linear = entry.get("linear_equivalent", {})
    equivalent = (float(linear.get("stiffness", values[0])), float(linear.get("damping", values[1])))
    count, size = len(model.terms), len(values)
    return AxisFit(
        foot, axis, model, values[:count], values[count:], np.zeros((size, size)), np.ones(size), np.zeros(size),
        {}, {}, {}, equivalent, None, "stored",
    )  # fmt: skip

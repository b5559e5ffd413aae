"""A result from its file, scored on logs that it has not seen."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.errors import DataError
from plantar.feet.assess.scores import score_axis
from plantar.feet.fit.axis import FittedModel
from plantar.feet.prepare import prepare_unseen
from plantar.feet.sensors.sensor_delay import sensor_delay_of
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
    known = {
        key: value for key, value in result["settings"].items() if key in FeetSettings.__dataclass_fields__
    }
    compliance = {foot: float(result.get("compliance", {}).get(foot, 0.0)) for foot in robot.feet}
    recordings = prepare_unseen(
        robot, logs, FeetSettings(**known), sensor_delay_of(result), compliance, progress
    )
    rows: list[ValidationRow] = []
    for foot in sorted(feet):
        for axis in ROTATIONAL_AXES:
            fitted = _stored_model(result, foot, axis)
            if fitted is not None:
                rows += score_axis(recordings, fitted)[0]
    if not rows:
        raise DataError(
            "no log has samples of a standing foot that could be scored (valid: more than 1.3 s of stance)"
        )
    return rows


def _stored_model(result: Mapping[str, Any], foot: str, axis: Axis) -> FittedModel | None:
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
    count = len(model.terms)
    aside, above = entry.get("moment_arms", (0.0, 0.0))
    return FittedModel(
        foot=foot,
        axis=axis,
        model=model,
        values=values[:count],
        shape=values[count:],
        moment_arms=(float(aside), float(above)),
    )

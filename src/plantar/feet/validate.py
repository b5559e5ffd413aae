"""A result from its file, scored on logs that it has not seen."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.cores import blas_on_one_core
from plantar.errors import DataError
from plantar.feet.assess.scores import score_axis
from plantar.feet.prepare import prepare_unseen
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.settings import FeetSettings
from plantar.logs.inputs import LogInputs, RobotInput, logs_of, robot_of
from plantar.logs.stretches import LONGEST
from plantar.models import MODELS, KelvinVoigt
from plantar.notes import Note
from plantar.results.feet import AxisModel, FeetResult, ValidationRow
from plantar.results.feet_rows import LinearEquivalent
from plantar.results.usage import used_shares
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import stored_delay
from plantar.sensors.moments.bent_joints import stored_bends


@blas_on_one_core()
def validate_feet(
    result: FeetResult | str | os.PathLike[str],
    robot: RobotInput,
    logs: LogInputs,
    progress: Callable[[str], None] = lambda _: None,
) -> list[ValidationRow]:
    """Cross-validation of identified feet on logs that their fit has not seen (table 3).

    Each log's first second gives its offset and is left out of the score.

    Args:
        result: what `identify_feet` found, or the path of its `result.json`.
        robot: the robot of these logs, or the path of its robot file.
        logs: logs to score, or their paths; one or several.
        progress: called with a line for each step.

    Returns:
        A row for each log, foot and axis: mean, rms and largest error of the torque [N·m], beside the error of the
        offset alone.

    Raises:
        PlantarError: a file that is not a result. RobotError, LogError: a file that cannot be read. DataError: the
        result names feet that the robot has not, or no log has samples to score.

    Example:
        >>> import plantar
        >>> rows = plantar.validate_feet("out/feet/result.json", "robot.yaml", "squat.csv")
        >>> len(rows), all(row.mean_abs_error < row.zero_mean_abs for row in rows)
        (4, True)
    """
    rows, _ = scored_feet(result, robot, logs, progress)
    return rows


def scored_feet(
    result: FeetResult | str | os.PathLike[str],
    robot: RobotInput,
    logs: LogInputs,
    progress: Callable[[str], None],
) -> tuple[list[ValidationRow], list[Note]]:
    """The rows of `validate_feet`, and a warning for each log that was fitted, and for each foot of each log that
    has no row, with what its seconds are."""
    found = result if isinstance(result, FeetResult) else FeetResult.load(result, residuals=False)
    robot = robot_of(robot)
    feet = {row.foot for row in found.parameters}
    strangers = sorted(feet - set(robot.feet))
    if strangers:
        raise DataError(f"the result is about a foot '{strangers[0]}' (valid: {', '.join(robot.feet)})")
    known = {key: value for key, value in found.settings.items() if key in FeetSettings.__dataclass_fields__}
    compliance = {foot: found.compliance.get(foot, 0.0) for foot in robot.feet}
    bends = stored_bends(robot, found.joint_compliance)
    delay = stored_delay(found.sensor_delay)
    recordings = prepare_unseen(
        robot, logs_of(logs, robot, LONGEST), FeetSettings(**known), delay, compliance, progress, bends
    )
    rows: list[ValidationRow] = []
    for foot in sorted(feet):
        for axis in ROTATIONAL_AXES:
            fitted = _stored_model(found, foot, axis)
            if fitted is not None:
                rows += score_axis(recordings, fitted)[0]
    if not rows:
        raise DataError(
            "no log has samples of a standing foot that could be scored (valid: more than 1.3 s of stance)"
        )
    return rows, [*_of_another(found, robot), *_seen(found, recordings), *_unscored(rows, recordings, feet)]


def _of_another(found: FeetResult, robot: RobotModel) -> list[Note]:
    """A warning where the result and the robot file name different robots."""
    if found.robot == robot.name:
        return []
    text = f"the result is of '{found.robot}', the robot file of '{robot.name}': the errors are those of other feet"
    return [Note("other_robot", "warning", f"{text}, unless the robot was renamed")]


def _seen(found: FeetResult, recordings: Sequence[Recording]) -> list[Note]:
    """A warning for each log that the result was fitted to, as its file or under another name."""
    fitted = {row.sha256 for row in found.inputs if row.role == "fit"}
    seen = [one.name for one in recordings if one.log.sha256 and one.log.sha256 in fitted]
    text = "the result was fitted to this log: its errors say nothing of logs that the fit has not seen"
    return [Note("seen", "warning", f"{name}: {text}") for name in seen]


def _unscored(
    rows: Sequence[ValidationRow], recordings: Sequence[Recording], feet: Iterable[str]
) -> list[Note]:
    scored = {(row.motion, row.foot) for row in rows}
    notes = []
    for recording in recordings:
        for foot in sorted(feet):
            if (recording.name, foot) in scored:
                continue
            (share,) = used_shares(recording.contacts[foot].phases(recording.name, foot, recording.time))
            text = f"{recording.name}: the {foot} foot is not scored: "
            text += f"of {share.seconds:.1f} s {share.used:.1f} can be used. Left out: "
            reasons = share.reasons or "nothing, but the result has no model of this foot"
            notes.append(Note("not_scored", "warning", text + reasons))
    return notes


def _stored_model(result: FeetResult, foot: str, axis: Axis) -> FittedModel | None:
    """The model of one axis as the result holds it, None where a number of it is missing."""
    # Where the result has no entry.
    plain = AxisModel(foot, axis, KelvinVoigt.name, "", LinearEquivalent(0.0, 0.0))
    entry = next((row for row in result.models if (row.foot, row.axis) == (foot, axis)), plain)
    if entry.model not in MODELS:
        raise DataError(f"the result's model '{entry.model}' is unknown (valid: {', '.join(MODELS)})")
    model = MODELS[entry.model]
    stored = {row.name: row.value for row in result.parameters if (row.foot, row.axis) == (foot, axis)}
    numbers = [stored.get(term) for term in (*model.terms, *model.shape_terms)]
    if any(number is None for number in numbers):
        return None
    values = np.array(numbers, dtype=float)
    count = len(model.terms)
    return FittedModel(
        foot=foot,
        axis=axis,
        model=model,
        values=values[:count],
        shape=values[count:],
        moment_arms=entry.moment_arms,
        turned=entry.turned,
        leans=entry.leans,
        crosstalk=entry.crosstalk,
        imu_turned=entry.imu_turned,
    )

"""The motion that an axis' model misses although it holds where most moves; what drifts does not count as missed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.fit.axis import FittedModel
from plantar.feet.recording import Recording
from plantar.results.feet import ValidationRow
from plantar.results.scores import error_measures

HOLDS = 0.3  # mean error over that of a constant, of the liveliest motion: the model holds
MISSED = 0.5  # likewise, of a motion that contradicts it
LOADED = 0.1  # of the liveliest motion's torque: others hardly load the axis
DRIFT_PERIOD = 20.0  # s: attitudes wander more slowly, motions that were asked for are twice as quick or more


def contradiction(
    scores: Sequence[ValidationRow],
    fitted: FittedModel,
    recordings: Sequence[Recording],
    predictions: Predictions,
) -> ValidationRow | None:
    """Of `scores` of one axis, the motion that contradicts the others, as it is missed beside drift; None where none.

    A score holds the attitude's drift since the offset was found, up to the whole torque of a quiet motion. That says
    nothing against the stiffness, so a motion contradicts only if it is missed with its slow part and without.
    """
    missed = missed_motions(scores)
    if not missed:
        return None
    by_name = {recording.name: recording for recording in recordings}
    steady = missed_motions([beside_drift(row, fitted, by_name[row.motion], predictions) for row in scores])
    both = [row for row in steady if row.motion in {other.motion for other in missed}]
    return max(both, key=_share, default=None)


def missed_motions(rows: Sequence[ValidationRow]) -> list[ValidationRow]:
    """Of `rows` of one axis, those missed. Motions that hardly load the axis do not count, and where the model holds
    nowhere nothing contradicts it."""
    telling = [row for row in rows if row.zero_mean_abs > 0]
    if not telling:
        return []
    largest = max(telling, key=lambda row: row.zero_mean_abs)
    if _share(largest) > HOLDS:
        return []
    least = LOADED * largest.zero_mean_abs
    return [row for row in telling if row.zero_mean_abs > least and _share(row) > MISSED]


def beside_drift(
    row: ValidationRow, fitted: FittedModel, recording: Recording, predictions: Predictions
) -> ValidationRow:
    """The score without what is slower than `DRIFT_PERIOD`, in the error and in the torque alike.

    A foot that steps is scored with an offset of its own in each stance, which follows any drift.
    """
    if recording.stances[fitted.foot] is not None:
        return row
    prediction = predictions[recording.name, fitted.foot, fitted.axis]
    scored = prediction.scored
    measured = recording.bushes[fitted.foot].torque[scored, ROTATIONAL_AXES.index(fitted.axis)]
    both = np.column_stack([measured, measured - prediction.torque[scored]])
    slow = _slow(recording.time[scored])
    quick = both - slow @ np.linalg.lstsq(slow, both, rcond=None)[0]
    return replace(row, **error_measures(quick[:, 0], quick[:, 0] - quick[:, 1], 0.0))


def _slow(time: Array) -> Array:
    """A line and cosines down to DRIFT_PERIOD, (n, m), over the times (n,) [s] of samples."""
    length = max(time[-1] - time[0], 1e-9)
    share = (time - time[0]) / length
    orders = np.arange(int(2 * length / DRIFT_PERIOD) + 1)
    return np.column_stack([np.cos(np.pi * np.outer(share, orders)), share])


def _share(row: ValidationRow) -> float:
    return row.mean_abs_error / row.zero_mean_abs

"""The motion that an axis' model misses although it holds where most moves, beside drift and the IMU's mount."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, SHOWN, Array
from plantar.estimation.orthonormal import without
from plantar.estimation.slow_drift import drift_basis
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.prediction import predict
from plantar.results.feet import ValidationRow
from plantar.results.scores import error_measures

HOLDS = 0.3  # mean error over that of a constant, of the liveliest motion: the model holds
MISSED = 0.5  # likewise, of a motion that contradicts it
LOADED = 0.1  # of the liveliest motion's torque: others hardly load the axis
ROUNDS = 2  # of Gauss and Newton: a bush with a memory is not linear in its deflection


def contradiction(
    scores: Sequence[ValidationRow],
    fitted: FittedModel,
    recordings: Sequence[Recording],
    predictions: Predictions,
    mount: float,
) -> ValidationRow | None:
    """Of `scores` of one axis, the motion that contradicts the others, as it is missed beside drift; None where none.

    A score holds the attitude's drift since the offset was found, and where a joint turns the IMU against the foot,
    the IMU's mount (standard deviation `mount` [rad]): together up to the whole torque of a quiet motion. That says
    nothing against the stiffness, so a motion contradicts only if it is missed with both and beside both.
    """
    missed = missed_motions(scores)
    if not missed:
        return None
    by_name = {recording.name: recording for recording in recordings}
    steady = missed_motions(
        [beside_drift(row, fitted, by_name[row.motion], predictions, mount) for row in scores]
    )
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
    row: ValidationRow, fitted: FittedModel, recording: Recording, predictions: Predictions, mount: float
) -> ValidationRow:
    """The score without what drifts slowly (`estimation.slow_drift`), in error and torque alike, nor what a turn of the
    IMU by less than `SHOWN` times `mount` [rad] explains of the error.

    A foot that steps is scored with an offset of its own in each stance, which follows any drift.
    """
    if recording.stances[fitted.foot] is not None:
        return row
    prediction = predictions[recording.name, fitted.foot, fitted.axis]
    torque = recording.bushes[fitted.foot].torque[prediction.scored, ROTATIONAL_AXES.index(fitted.axis)]
    slow = drift_basis(recording.time[prediction.scored])

    def quick(values: Array) -> Array:
        return without(slow, values - np.mean(values))

    def left(turned: Array) -> Array:
        """What is missed with an IMU that is turned by `turned` (3,) [rad] beside the robot file's mount."""
        x, y, z = turned.tolist()
        found = predict(recording, replace(fitted, imu_turned=(x, y, z)))
        assert found is not None  # the row is a score of it
        return quick(torque - found.torque[prediction.scored])

    as_fitted = np.array(fitted.imu_turned)
    missed = left(as_fitted)
    if recording.imu_turns[fitted.foot].any() and mount:
        turned = _mount_that_fits(
            left, as_fitted, mount, np.count_nonzero(prediction.scored) * recording.period
        )
        missed = left(turned) if np.abs(turned).max() < SHOWN * mount else missed
    return replace(row, **error_measures(quick(torque), quick(torque) - missed, 0.0))


def _mount_that_fits(left: Callable[[Array], Array], start: Array, mount: float, seconds: float) -> Array:
    """The IMU's turn (3,) [rad] that makes what is `left` (n,) small, drawn to none by its deviation `mount`.

    What is left about a second apart is taken as independent.
    """
    turned = start
    for _ in range(ROUNDS):
        now = left(turned)
        slopes = np.column_stack([left(turned + step) - now for step in mount * np.eye(3)])
        weight = np.sqrt(seconds / len(now) / np.mean(now**2))
        rows = np.vstack([weight * slopes, np.eye(3)])
        turned = turned - mount * np.linalg.lstsq(rows, np.append(weight * now, turned / mount))[0]
    return turned


def _share(row: ValidationRow) -> float:
    return row.mean_abs_error / row.zero_mean_abs

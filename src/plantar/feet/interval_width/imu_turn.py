"""How far the turn of the IMU in its mount, as far as it is not known, moves the fit of a foot that steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.estimation import effect_of, influences_of
from plantar.feet.interval_width.cause import Cause
from plantar.feet.place.imu_mount import ImuTurn, turn_columns
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import blocks_of

NAME = "imu turn"


def imu_turn_causes(fit: AxisFit, recordings: Sequence[Recording], turn: ImuTurn) -> list[Cause]:
    """What is not known of the turn, as far as it moves the fit of a foot that steps; others have it in their place."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, fit=fit)
    if blocks[0].stances is None or not turn.covariance.any():
        return []
    columns = turn_columns(fit, recordings, blocks)
    effects = effect_of(influences_of(blocks), columns) @ np.linalg.cholesky(turn.covariance)
    return [Cause(NAME, np.sqrt(np.sum(effects**2, axis=1)), 1.0)]

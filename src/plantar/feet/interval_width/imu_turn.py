"""How far the turn of the IMU in its mount, as far as it is not known, moves the fit of a foot that steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.estimation import effect_of
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.imu_mount import ImuTurn, turn_columns
from plantar.feet.fit.regression_data import blocks_of
from plantar.feet.interval_width.systematic import Cause
from plantar.feet.recording import Recording

NAME = "imu turn"


def imu_turn_causes(fit: AxisFit, recordings: Sequence[Recording], turn: ImuTurn) -> list[Cause]:
    """What is not known of the turn, as far as it moves the fit of a foot that steps; others have it in their place."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, fit=fit)
    if blocks[0].stances is None or not turn.covariance.any():
        return []
    columns = turn_columns(fit, recordings, [block.label for block in blocks])
    ways = np.linalg.cholesky(turn.covariance).T
    effects = [effect_of(blocks, [own @ way for own in columns]) for way in ways]
    return [Cause(NAME, np.sqrt(np.sum(np.square(effects), axis=0)), 1.0)]

"""How far the turn of the IMU in its mount, as far as it is not known, moves the fit of a foot that steps."""

from __future__ import annotations

import numpy as np

from plantar.feet.interval_width.cause import Cause
from plantar.feet.place.imu_columns import imu_columns
from plantar.feet.place.imu_mount import ImuTurn
from plantar.feet.regression.tangent import Tangent

NAME = "imu turn"


def imu_turn_causes(tangent: Tangent, turn: ImuTurn) -> list[Cause]:
    """What is not known of the turn, as far as it moves the fit of a foot that steps; others have it in their place."""
    if not tangent.steps or not turn.covariance.any():
        return []
    effects = tangent.effect(tangent.rows(lambda one: imu_columns(one, tangent.fit)))
    effects = effects @ np.linalg.cholesky(turn.covariance)
    return [Cause(NAME, np.sqrt(np.sum(effects**2, axis=1)), 1.0)]

"""The torque that a turned IMU makes of one axis, and whether columns of a place show in the motions at all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation import Block
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import model_columns

TURN_STEP = 1e-3  # rad, of the differences that stand for derivatives
UNSEEN = 1e-4  # of the torque's rms: what one deviation of a place adds beside it is as good as nothing


def imu_columns(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N, 3) for each radian by which the IMU is turned about its axes, under a fit's model."""

    def turned(angle: float, axis: Array) -> Array:
        x, y, z = np.array(fit.imu_turned) + angle * axis
        return model_columns(recording, fit.foot, fit.axis, replace(fit, imu_turned=(x, y, z))) @ fit.values

    turns = [(turned(TURN_STEP, axis) - turned(-TURN_STEP, axis)) / (2 * TURN_STEP) for axis in np.eye(3)]
    return np.column_stack(turns)


def that_show(blocks: Sequence[Block], columns: Sequence[Array], spreads: Array) -> Mask:
    """Which columns, by one deviation each, add anything to the torque that no offset takes up, (k,)."""
    moved = [own - own.mean(axis=0) for own in columns]
    torque = np.concatenate([block.response - block.response.mean() for block in blocks])
    added = spreads * np.sqrt(np.mean(np.concatenate(moved) ** 2, axis=0))
    return np.asarray(added > UNSEEN * np.sqrt(np.mean(torque**2)))

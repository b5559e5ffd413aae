"""The torque that a turned IMU makes of one axis, and whether columns of a place show in the motions at all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation import Block
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.model_columns import memory_path, own_torque, turn_effects
from plantar.models import BESIDE, KelvinVoigt

TURN_STEP = 1e-3  # rad, of the differences that stand for derivatives
UNSEEN = 1e-4  # of the torque's rms: what one deviation of a place adds beside it is as good as nothing


def imu_columns(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N, 3) for each radian by which the IMU is turned about its axes, under a fit's model."""

    effects = turn_effects(recording, fit.foot, fit.axis)
    linear = np.einsum("nrk,r->nk", effects, fit.values[: len(BESIDE)])
    if isinstance(fit.model, KelvinVoigt):
        return np.asarray(linear)
    path, steps = memory_path(recording, fit), TURN_STEP * np.moveaxis(effects, 0, 2)
    turned = [
        replace(path, deflection=path.deflection + angle, rate=path.rate + rate)
        for angle, rate in np.concatenate([steps, -steps], axis=1).swapaxes(0, 1)
    ]
    own = own_torque(recording, fit, turned, fit.shape[None, :])
    return np.asarray(linear + (own[:, :3] - own[:, 3:]) / (2 * TURN_STEP))


def that_show(blocks: Sequence[Block], columns: Sequence[Array], spreads: Array) -> Mask:
    """Which columns, by one deviation each, add anything to the torque that no offset takes up, (k,)."""
    moved = [own - own.mean(axis=0) for own in columns]
    torque = np.concatenate([block.response - block.response.mean() for block in blocks])
    added = spreads * np.sqrt(np.mean(np.concatenate(moved) ** 2, axis=0))
    return np.asarray(added > UNSEEN * np.sqrt(np.mean(torque**2)))

"""What a turn of the IMU in its mount does to one axis, and what an axis of a foot that steps shows of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from plantar.contact.sole_height import STEP
from plantar.conventions import Array, Mask
from plantar.estimation import Block, LinearFit
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.load_torque import late_encoder_torque
from plantar.feet.regression.model_columns import memory_path, own_torque, turn_effects
from plantar.feet.regression.tangent import Tangent
from plantar.models import BESIDE, KelvinVoigt

UNSEEN = 1e-4  # of the torque's rms: what one deviation of a place adds beside it is as good as nothing


class ImuTurn(NamedTuple):
    """`angles` [rad] about the IMU's own axes that put its angles right, the opposite of those by which it is turned
    beside the robot file's mount, and their `covariance` (3, 3)."""

    angles: tuple[float, float, float]
    covariance: Array

    @classmethod
    def unknown(cls, std: float) -> ImuTurn:
        """None, give or take `std` [rad] about each axis."""
        return cls((0.0, 0.0, 0.0), std**2 * np.eye(3))


class Told(NamedTuple):
    """What one axis tells of the turn: its `angles` (3,) [rad], and with which `information` (3, 3), none where its
    motions show nothing."""

    angles: Array
    information: Array


def with_turns(tangent: Tangent, mount: float) -> tuple[Tangent, Mask]:
    """One axis with more columns at its end, the torque for each radian of a turn; about which axes (3,).

    mount: deviation of the angles; about an axis about which one adds as good as nothing to the torque there is none.
    Before these stands what late encoders would add, so that none of it passes for a turn: a third of a millisecond had
    passed for two degrees about the axis that the legs swing about.
    """
    columns = tangent.rows(lambda one: imu_columns(one, tangent.fit))
    shown = that_show(tangent.blocks, columns, np.full(3, mount))
    late = tangent.rows(lambda one: late_encoder_torque(one, tangent.fit)[:, None])
    if any(column.any() for column in late):
        tangent = tangent.beside(late)
    return tangent.beside([own[:, shown] for own in columns]), shown


def turn_told(found: LinearFit, shown: Mask) -> list[Told]:
    """What a fit of `with_turns` tells of the turn; empty where its motions do not tell it from the bush."""
    if not shown.any() or found.singular:
        return []
    own = slice(len(found.values) - int(shown.sum()), len(found.values))
    angles, information = np.zeros(3), np.zeros((3, 3))
    angles[shown] = found.values[own]
    information[np.ix_(shown, shown)] = np.linalg.inv(found.covariance[own, own])
    return [Told(angles, information)]


def imu_columns(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N, 3) for each radian by which the IMU is turned about its axes, under a fit's model."""

    effects = turn_effects(recording, fit.foot, fit.axis)
    linear = np.einsum("nrk,r->nk", effects, fit.values[: len(BESIDE)])
    if isinstance(fit.model, KelvinVoigt):
        return np.asarray(linear)
    path, steps = memory_path(recording, fit), STEP * np.moveaxis(effects, 0, 2)
    turned = [
        replace(path, deflection=path.deflection + angle, rate=path.rate + rate)
        for angle, rate in np.concatenate([steps, -steps], axis=1).swapaxes(0, 1)
    ]
    own = own_torque(recording, fit, turned, fit.shape[None, :])
    return np.asarray(linear + (own[:, :3] - own[:, 3:]) / (2 * STEP))


def that_show(blocks: Sequence[Block], columns: Sequence[Array], spreads: Array) -> Mask:
    """Which columns, by one deviation each, add anything to the torque that no offset takes up, (k,)."""
    moved = [own - own.mean(axis=0) for own in columns]
    torque = np.concatenate([block.response - block.response.mean() for block in blocks])
    added = spreads * np.sqrt(np.mean(np.concatenate(moved) ** 2, axis=0))
    return np.asarray(added > UNSEEN * np.sqrt(np.mean(torque**2)))

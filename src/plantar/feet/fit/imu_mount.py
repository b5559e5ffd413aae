"""What a turn of the IMU in its mount does to one axis of a foot that steps, and what that axis shows of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.estimation import effect_of, fit_blocks
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.bush_place import imu_columns
from plantar.feet.fit.regression_data import beside, blocks_of
from plantar.feet.fit.systematic import Cause
from plantar.feet.recording import Recording

SINGULAR = 1e6  # condition of a fit beyond which its motions do not show the turn
NAME = "imu turn"


class ImuTurn(NamedTuple):
    """`angles` [rad] by which the IMU is turned about its own axes beside the robot file's mount, and their
    `covariance` (3, 3)."""

    angles: tuple[float, float, float]
    covariance: Array

    @classmethod
    def unknown(cls, std: float) -> ImuTurn:
        """None, give or take `std` [rad] about each axis."""
        return cls((0.0, 0.0, 0.0), std**2 * np.eye(3))


def turn_of_axis(fit: AxisFit, recordings: Sequence[Recording]) -> ImuTurn | None:
    """The turn (3,) that one axis shows and its covariance; None where its motions do not show it."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, fit=fit)
    size = blocks[0].regressor.shape[1]
    columns = _columns(fit, recordings, [block.label for block in blocks])
    found = fit_blocks([beside(block, own) for block, own in zip(blocks, columns, strict=True)])
    own = slice(size, size + 3)
    if not found.condition_number < SINGULAR:
        return None
    x, y, z = found.values[own].tolist()
    return ImuTurn((x, y, z), found.covariance[own, own])


def imu_turn_causes(fit: AxisFit, recordings: Sequence[Recording], turn: ImuTurn) -> list[Cause]:
    """What is not known of the turn, as far as it moves the fit of a foot that steps; others have it in their place."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, fit=fit)
    if blocks[0].stances is None or not turn.covariance.any():
        return []
    columns = _columns(fit, recordings, [block.label for block in blocks])
    ways = np.linalg.cholesky(turn.covariance).T
    effects = [effect_of(blocks, [own @ way for own in columns]) for way in ways]
    return [Cause(NAME, np.sqrt(np.sum(np.square(effects), axis=0)), 1.0)]


def _columns(fit: AxisFit, recordings: Sequence[Recording], labels: Sequence[str]) -> list[Array]:
    """Torque of the used samples for each radian of a turn, (n, 3) of each recording that is named."""
    by_name = {recording.name: recording for recording in recordings}
    return [imu_columns(by_name[label], fit)[by_name[label].rows(fit.foot)] for label in labels]

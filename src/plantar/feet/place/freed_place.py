"""The place of a standing foot's bush and sensors, free to be another beside what is asked of its recordings.

What a fit found of the place explains some of what recordings differ by: of a small motion a force sensor turned by a
degree makes as much as a stiffness off by some per cent. Held where it was found, it hides half of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.estimation import Block, LinearFit
from plantar.feet.place.bush_place import SINGULAR, place_torques
from plantar.feet.place.imu_columns import that_show
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit


class FreedPlace(NamedTuple):
    """Torques (n, p) of each block for a deviation of each of p numbers of the place, and how many deviations the robot
    file's place is from where a fit has it, `file` (p,)."""

    torques: list[Array]
    file: Array

    @classmethod
    def of(
        cls, fit: AxisFit, recordings: Sequence[Recording], blocks: Sequence[Block], spread: PlaceSpread
    ) -> FreedPlace:
        """Of the blocks' recordings, what shows in their torque."""
        labels = {block.label for block in blocks}
        chosen = [one for one in recordings if one.name in labels]
        columns = [place_torques(one, fit)[one.rows(fit.foot)] for one in chosen]
        tried = np.flatnonzero(that_show(blocks, columns, spread.expected) & (spread.expected > 0))
        spreads = spread.expected[tried]
        found = np.array([*fit.moment_arms, fit.turned, *fit.imu_turned])
        found[1] -= spread.height
        return cls([own[:, tried] * spreads for own in columns], -found[tried] / spreads)

    def drawn(self, fit: LinearFit) -> tuple[Array, Array]:
        """Values (k,) and their covariance (k, k) of a fit whose last p columns are these, which are drawn to the robot
        file's by a deviation each. A fit that cannot tell them from the others stays as it is."""
        size, count = len(fit.values), len(self.file)
        covariance, own = fit.covariance[:size, :size], slice(size - count, size)
        if not count or fit.condition_number > SINGULAR:
            return fit.values, covariance
        follows = covariance[:, own] @ np.linalg.inv(covariance[own, own] + np.eye(count))
        return fit.values + follows @ (self.file - fit.values[own]), covariance - follows @ covariance[own]

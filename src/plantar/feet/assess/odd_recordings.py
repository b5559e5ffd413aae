"""Recordings whose stiffness is not that of the others: another floor, another sole, a joint read wrongly.

The fit of all then lies somewhere between the recordings. Its interval allows for that, but nobody learns which one it
is; or a memory is made up for what they disagree in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.estimation import Block, fit_blocks, influences_of
from plantar.estimation.random_effects import Differences, share_between
from plantar.feet.interval_width.between_recordings import among, beside_one
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside
from plantar.models import BESIDE, KelvinVoigt
from plantar.notes import Note

CODE = "recording_odd"
SURE = 5.0  # deviations by which a recording must differ, those by which the others differ among one another included
MUCH = 0.05  # of the stiffness; rubber that is warmer or stood under load before makes 1 to 3 %


# Of the stiffness: a recording that makes less moves by a tenth of what the largest does, and all else that is wrong
# is divided by that.
TELLS = 0.01


class Odd(NamedTuple):
    """The recording at `place`, whose stiffness is the `share` (deviation `std`) beside that of the others, which
    differ by the share `apart`."""

    place: int
    share: float
    std: float
    apart: float


def odd_recordings(wide: AxisFit, tangent: Sequence[Block], shared: bool) -> list[Note]:
    """A warning of the recording whose stiffness is far from the others'; of two that differ, of both.

    tangent: the recordings' `tangent_blocks`. Those are compared that tell the stiffness. Where a memory leaves less
    than one stiffness more does, it is the memory that makes small motions stiffer than large ones. Not of a foot that
    steps: see `walks` of the result.
    """
    if tangent[0].stances is not None or shared or len(tangent) < 2:
        return []
    blocks = [replace(block, regressor=block.regressor[:, : len(BESIDE)], noise=None) for block in tangent]
    fit = fit_blocks(blocks)
    torques = [block.regressor @ fit.values for block in blocks]
    told = [float(own[0] @ torque) for own, torque in zip(influences_of(blocks), torques, strict=True)]
    tell = np.flatnonzero(np.array(told) > TELLS * fit.values[0]).tolist()
    if len(tell) < 2 or not fit.values[0] > 0:
        return []
    every = beside_one(blocks, torques, tell[0])
    odd = furthest(among(every, tell))
    if odd is None:
        return []
    place = tell[odd.place]
    if not isinstance(wide.model, KelvinVoigt):
        own = [torque[:, None] * float(each == place) for each, torque in enumerate(torques)]
        if fit_blocks(tangent).squares < fit_blocks(all_beside(blocks, own)).squares:
            return []
    if len(tell) == 2:
        others = f"{blocks[tell[1 - odd.place]].label}, and nobody knows which is right"
    else:
        others = f"{len(tell) - 1} other recordings, which agree within {100 * odd.apart:.2g} % (standard deviation)"
    text = (
        f"{blocks[place].label}: {wide.foot} {wide.axis}: stiffness is {100 * odd.share:+.2g} ± {100 * odd.std:.2g} % "
        f"beside that of {others}. Was it recorded on another floor, on another sole, or with a joint read otherwise? "
        "Leave it out, or fit it alone"
    )
    return [Note(CODE, "warning", text)]


def furthest(found: Differences) -> Odd | None:
    """The recording that is surely and much beside the others, as far as these agree; None where none is."""
    count = len(found.shares) + 1
    shares = np.append(0.0, found.shares)
    covariance = np.zeros((count, count))
    covariance[1:, 1:] = found.covariance
    tried = [_beside_others(shares, covariance, place) for place in range(count)]
    sure = [one for one in tried if abs(one.share) > max(MUCH, SURE * one.std)]
    return max(sure, key=lambda one: abs(one.share) / one.std, default=None)


def _beside_others(shares: Array, covariance: Array, place: int) -> Odd:
    """One recording beside the mean of the others, weighted by how well each is known and by how far they differ."""
    others = [each for each in range(len(shares)) if each != place]
    apart = _apart(shares[others], covariance[np.ix_(others, others)])
    # A step from the first to the second of two values, each with its own deviation beside the common first recording.
    spread = covariance + apart**2 * np.eye(len(shares))
    step = np.eye(len(shares)) - np.eye(len(shares))[place]
    among = step[others] @ spread @ step[others].T
    weight = np.linalg.solve(among, np.ones(len(others)))
    variance = 1.0 / float(weight.sum())
    share = float(variance * weight @ (shares[place] - shares[others]))
    return Odd(place, share, float(np.sqrt(variance)), apart)


def _apart(shares: Array, covariance: Array) -> float:
    """By which share these differ among one another; nothing is known of one alone."""
    if len(shares) < 2:
        return 0.0
    step = np.eye(len(shares))[1:] - np.eye(len(shares))[0]
    beside = Differences(step @ shares, step @ covariance @ step.T)
    return share_between([beside], beside.resolution).share

"""Recordings whose stiffness is not that of the others: another floor, another sole, a joint read wrongly.

The fit of all then lies somewhere between the recordings. Its interval allows for that, but nobody learns which one it
is; or a memory is made up for what they disagree in.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from plantar.conventions import NORMAL95, Array
from plantar.estimation import Block, fit_blocks, influences_of, interval95
from plantar.estimation.errors_in_variables import attenuation
from plantar.estimation.random_effects import LEAST, Differences, share_between
from plantar.feet.interval_width.between_recordings import among, beside_one
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside, beside, recordings_of
from plantar.models import BESIDE, KelvinVoigt
from plantar.notes import Note
from plantar.results.walk_rows import WalkStiffness

CODE = "recording_odd"
SURE = 5.0  # deviations from the others' mean; their own scatter is part of a deviation
MUCH = 0.05  # of the stiffness; rubber that is warmer or stood under load before makes 1 to 3 %
# Of the stiffness: a recording that makes less moves by a tenth of what the largest does, and all else that is wrong
# is divided by that.
TELLS = 0.01


class Odd(NamedTuple):
    """The recording at `place`: its stiffness less the others' mean, as a `share` of it, with deviation `std`; `apart`:
    the share by which the others scatter."""

    place: int
    share: float
    std: float
    apart: float


def odd_recordings(wide: AxisFit, tangent: Sequence[Block], shared: bool) -> list[Note]:
    """A warning of the standing recording whose stiffness is far from the others'; of two that differ, of both.

    tangent: the recordings' `tangent_blocks`. Those are compared that tell the stiffness. Where a memory leaves less
    than one stiffness more does, it is the memory that makes small motions stiffer than large ones.
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
    odd = furthest(among(beside_one(blocks, torques, tell[0]), tell))
    if odd is not None and not isinstance(wide.model, KelvinVoigt):
        place = tell[odd.place]
        own = [torque[:, None] * float(each == place) for each, torque in enumerate(torques)]
        if fit_blocks(tangent).squares < fit_blocks(all_beside(blocks, own)).squares:
            return []
    return _notes(odd, wide, [blocks[place].label for place in tell])


def odd_walks(
    wide: AxisFit, walks: Sequence[WalkStiffness], recordings: Sequence[Recording], tangent: Sequence[Block]
) -> list[Note]:
    """The same of fitted walks, each by itself, by the scatter of its own stances; and of those of the `recordings` in
    which the foot stands meanwhile. tangent: as of `odd_recordings`."""
    known = [(row.motion, row.stiffness, row.interval95) for row in walks if row.role == "fit"]
    if known:
        known += _standing(wide.foot, recordings_of(tangent, recordings), tangent)
    stiffness = float(wide.values[0])
    if len(known) < 2 or not stiffness > 0:
        return []
    shares = np.array([value for _, value, _ in known]) / stiffness
    # An interval of few stances is wide by Student's quantile, so that few that scatter little by chance are not sure.
    std = np.array([high - low for _, _, (low, high) in known]) / (2 * NORMAL95 * stiffness)
    covariance = np.diag(std[1:] ** 2) + std[0] ** 2
    odd = furthest(Differences(shares[1:] - shares[0], covariance))
    return _notes(odd, wide, [name for name, _, _ in known])


def _standing(
    foot: str, recordings: Sequence[Recording], blocks: Sequence[Block]
) -> Iterator[tuple[str, float, tuple[float, float]]]:
    """Name, stiffness and 95 % interval of each recording in which the foot stands, by the columns of walks."""
    for recording, block in zip(recordings, blocks, strict=True):
        if recording.stances[foot] is None and block.common_nuisance is not None:
            alone = beside(replace(block, stances=None, common_nuisance=None), block.common_nuisance)
            found = fit_blocks([alone])
            noise = attenuation([alone], found.values, shared_offset=False)
            if noise is not None:  # angles that are mostly noise give no slope
                value, std, freedom = found.values[0] + noise[0], found.std[0], found.freedom[0]
                yield block.label, float(value), interval95(float(value), float(std), float(freedom))


def _notes(odd: Odd | None, fit: AxisFit, names: Sequence[str]) -> list[Note]:
    if odd is None:
        return []
    others = (
        f"{len(names) - 1} other recordings, which agree within {100 * odd.apart:.2g} % (standard deviation)"
    )
    if len(names) == 2:
        others = f"{names[1 - odd.place]}, and nobody knows which is right"
    text = (
        f"{names[odd.place]}: {fit.foot} {fit.axis}: stiffness is {100 * odd.share:+.2g} ± {100 * odd.std:.2g} % "
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
    # Of this recording less each other one: both ends of a difference may be off by `apart` as well.
    spread = covariance + apart**2 * np.eye(len(shares))
    step = np.eye(len(shares)) - np.eye(len(shares))[place]
    differences = step[others] @ spread @ step[others].T
    weight = np.linalg.solve(differences, np.ones(len(others)))
    variance = 1.0 / float(weight.sum())
    share = float(variance * weight @ (shares[place] - shares[others]))
    return Odd(place, share, float(np.sqrt(variance)), apart)


def _apart(shares: Array, covariance: Array) -> float:
    """By which share these differ among one another; nothing is known of one alone. Never 0: without noise a covariance
    is."""
    if len(shares) < 2:
        return LEAST
    step = np.eye(len(shares))[1:] - np.eye(len(shares))[0]
    beside = Differences(step @ shares, step @ covariance @ step.T)
    return share_between([beside], float(np.sqrt(np.mean(np.diag(beside.covariance))))).share

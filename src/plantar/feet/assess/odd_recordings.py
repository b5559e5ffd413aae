"""Recordings whose stiffness is not that of the others: another floor, another sole, a joint read wrongly.

The fit of all then lies somewhere between the recordings. Its interval allows for that, but nobody learns which one it
is; or a memory is made up for what they disagree in.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import NORMAL95, SURE
from plantar.estimation import fit_blocks, influences_of, interval95
from plantar.estimation.errors_in_variables import attenuation
from plantar.estimation.random_effects import Differences, Odd, furthest
from plantar.feet.interval_width.between_recordings import among, beside_angle_errors, beside_one
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside, beside
from plantar.feet.regression.tangent import Tangent
from plantar.models import BESIDE, KelvinVoigt
from plantar.notes import Note
from plantar.results.walk_rows import WalkStiffness

CODE = "recording_odd"
MUCH = 0.05  # of the stiffness; rubber that is warmer or stood under load before makes 1 to 3 %
FAR = 0.75  # of the stiffness of all together: no rubber is so far off, but a wrong sign or unit is
# Of the stiffness: a recording that makes less moves by a tenth of what the largest does, and all else that is wrong
# is divided by that.
TELLS = 0.01


def odd_recordings(tangent: Tangent, wide: AxisFit) -> list[Note]:
    """A warning of the standing recording whose stiffness is far from the others'; of two that differ, of both.

    Those are compared that tell the stiffness. Where a memory leaves less than one stiffness more does, it is the
    memory that makes small motions stiffer than large ones.
    """
    if tangent.steps or tangent.shared:
        return []
    blocks = [
        replace(block, regressor=block.regressor[:, : len(BESIDE)], noise=None) for block in tangent.blocks
    ]
    fit = fit_blocks(blocks)
    torques = [block.regressor @ fit.values for block in blocks]
    told = [float(own[0] @ torque) for own, torque in zip(influences_of(blocks), torques, strict=True)]
    tell = np.flatnonzero(np.array(told) > TELLS * fit.values[0]).tolist()
    if len(tell) < 2 or not fit.values[0] > 0:
        return []
    differences, stiffness = among(beside_one(blocks, torques, tell[0]), tell), float(fit.values[0])
    differences = beside_angle_errors(differences, blocks, fit.residuals, stiffness, tell)
    odd = furthest(differences, MUCH, SURE)
    if odd is not None and not isinstance(wide.model, KelvinVoigt):
        place = tell[odd.place]
        own = [torque[:, None] * float(each == place) for each, torque in enumerate(torques)]
        if tangent.least_squares.squares < fit_blocks(all_beside(blocks, own)).squares:
            return []
    return _notes(odd, wide, [blocks[place].label for place in tell])


def odd_walks(tangent: Tangent, wide: AxisFit, walks: Sequence[WalkStiffness]) -> list[Note]:
    """The same of fitted walks, each by itself, by the scatter of its own stances; and of the recordings in which the
    foot stands meanwhile."""
    known = [(row.motion, row.stiffness, row.interval95) for row in walks if row.role == "fit"]
    if known:
        known += _standing(tangent)
    stiffness = float(wide.values[0])
    if len(known) < 2 or not stiffness > 0:
        return []
    shares = np.array([value for _, value, _ in known]) / stiffness
    # An interval of few stances is wide by Student's quantile, so that few that scatter little by chance are not sure.
    std = np.array([high - low for _, _, (low, high) in known]) / (2 * NORMAL95 * stiffness)
    covariance = np.diag(std[1:] ** 2) + std[0] ** 2
    odd = furthest(Differences(shares[1:] - shares[0], covariance), MUCH, SURE)
    return _notes(odd, wide, [name for name, _, _ in known])


def _standing(tangent: Tangent) -> Iterator[tuple[str, float, tuple[float, float]]]:
    """Name, stiffness and 95 % interval of each recording in which the foot stands, by the columns of walks."""
    for recording, block in zip(tangent.recordings, tangent.blocks, strict=True):
        if recording.stances[tangent.fit.foot] is None and block.common_nuisance is not None:
            alone = beside(replace(block, stances=None, common_nuisance=None), block.common_nuisance)
            found = fit_blocks([alone])
            noise = attenuation([alone], found.values, shared_offset=False)
            if noise is not None:  # angles that are mostly noise give no slope
                value, std, freedom = found.values[0] + noise[0], found.std[0], found.freedom[0]
                yield block.label, float(value), interval95(float(value), float(std), float(freedom))


def _notes(odd: Odd | None, fit: AxisFit, names: Sequence[str]) -> list[Note]:
    if odd is None:
        return []
    far, others = abs(odd.share) > FAR, f"{len(names) - 1} other recordings"
    if len(names) == 2:
        others = f"{names[1 - odd.place]}, and nobody knows which is right"
    elif not far:
        others += f", which agree within {100 * odd.apart:.2g} % (standard deviation)"
    beside = f"is {100 * odd.share:+.2g} ± {100 * odd.std:.2g} % beside"
    why = "Was it recorded on another floor, on another sole, or with a joint read otherwise?"
    if far:
        beside = "is nowhere near"
        why = "Has a joint, the IMU or a force sensor another sign, unit or axis in it?"
    text = f"{names[odd.place]}: {fit.foot} {fit.axis}: stiffness {beside} that of {others}. {why}"
    return [Note(CODE, "warning", f"{text} Leave it out, or fit it alone")]

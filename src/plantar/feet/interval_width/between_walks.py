"""Walks that differ by more than their stances show, as the walks at hand tell it.

Walks whose stances agree are alike, walks whose stances scatter are not: in eleven walks of a real humanoid a stance's
stiffness is off by a quarter, and walks differ by about as much as the stances of one of them leave open.
"""

from __future__ import annotations

import numpy as np

from plantar.estimation.random_effects import HEAVY, resolution, share_between
from plantar.estimation.stance_least_squares import FEWEST_RECORDINGS
from plantar.feet.interval_width.between_recordings import (
    Apart,
    AxisDifferences,
    differences_of,
    effects_of,
)
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.tangent import Tangent

NAME = "between walks"


def between_walks(tangent: Tangent, every: Apart) -> list[Cause]:
    """By how much another walk may differ: a share of spring and damper, as this axis shows it, or `every` axis
    together where that is more.

    A walk by itself leaves what is usual. From FEWEST_RECORDINGS on the fit's own deviation holds what differs. Of a
    memory's numbers each walk's are not looked at: they are taken to be as unsure by it as the stiffness is.
    """
    fit, blocks = tangent.fit, tangent.blocks
    stiffness = max(abs(float(fit.values[0])), 1e-300)
    if len(blocks) >= FEWEST_RECORDINGS:
        moved = np.abs(fit.numbers) * float(tangent.least_squares.std[0]) / stiffness
        moved[:2] = 0.0
        return [Cause(NAME, moved, 1.0, len(blocks) - 1)]
    effects = effects_of(tangent)
    differences = differences_of(tangent, effects)
    if differences is None:
        deviation = float(tangent.least_squares.std[0])
        own = Apart(share_between([], deviation / stiffness).share, int(HEAVY))
    else:
        own = _shown(differences)
    apart = max(own, every, key=lambda each: each.share)
    by_share = np.sqrt(np.sum(effects**2, axis=0))
    moved = np.abs(fit.numbers) * by_share[0] / stiffness
    moved[:2] = by_share[:2]
    return [Cause(NAME, moved, apart.share, apart.others)]


def _shown(axis: AxisDifferences) -> Apart:
    """By which share walks differ as one axis shows it: before they are compared, by as much as they can be told
    apart by."""
    share = share_between([axis.differences], resolution([axis.differences])).share
    return Apart(share, len(axis.recordings) - 1)

"""Walks that differ by more than their stances show, as the walks at hand tell it.

Walks whose stances agree are alike, walks whose stances scatter are not: in eleven walks of a real humanoid a stance's
stiffness is off by a quarter, and walks differ by about as much as the stances of one of them leave open.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array
from plantar.estimation.random_effects import HEAVY, resolution, share_between
from plantar.estimation.stance_least_squares import FEWEST_RECORDINGS, jackknife
from plantar.estimation.stance_problem import StanceProblem
from plantar.feet.interval_width.between_recordings import (
    Apart,
    AxisDifferences,
    differences_of,
    effects_of,
)
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.regression_data import blocks_of, data_set_of
from plantar.feet.regression.tangent import Tangent
from plantar.model_selection.model_fit import refits_without_each
from plantar.models import BESIDE

NAME = "between walks"


def between_walks(tangent: Tangent, every: Apart) -> list[Cause]:
    """By how much another walk may differ: a share of spring and damper, as this axis shows it, or `every` axis
    together where that is more.

    A walk by itself leaves what is usual. From FEWEST_RECORDINGS on the fit's own deviation holds what differs. A
    memory's numbers are as unsure by it as the stiffness is, or as refits without one walk each show.
    """
    fit, blocks = tangent.fit, tangent.blocks
    stiffness = max(abs(float(fit.values[0])), 1e-300)
    memory = _memory_without_each(tangent)
    if len(blocks) >= FEWEST_RECORDINGS:
        moved = np.abs(fit.numbers) * float(tangent.least_squares.std[0]) / stiffness
        moved[:2] = 0.0
        return [Cause(NAME, np.maximum(moved, memory), 1.0, len(blocks) - 1)]
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
    return [Cause(NAME, np.maximum(apart.share * moved, memory), 1.0, apart.others)]


def _memory_without_each(tangent: Tangent) -> Array:
    """Deviations of a memory's numbers as refits without one walk each show them, (k + s,); 0 of spring and damper, of
    a single walk, and without a memory.

    Where it slips in few stances the squares have corners and the fit's own deviation says how they rise to either
    side of one, not that another walk has its corner elsewhere.
    """
    fit, recordings = tangent.fit, tangent.recordings
    moved = np.zeros(len(fit.numbers))
    if fit.model.remembers and len(recordings) > 1:
        blocks = blocks_of(recordings, fit.foot, fit.axis)
        share = StanceProblem.drawn_together(blocks).own_share
        sets = [data_set_of(each, fit.foot, fit.axis, share, *fit.place[1:]) for each in recordings]
        refits = refits_without_each(fit.model, fit.shape, fit.initial_states, sets, recordings[0].cutoff)
        own = len(BESIDE)
        moved[own:] = np.sqrt(np.diag(jackknife(refits)[0]))[own:]
    return moved


def _shown(axis: AxisDifferences) -> Apart:
    """By which share walks differ as one axis shows it: before they are compared, by as much as they can be told
    apart by."""
    share = share_between([axis.differences], resolution([axis.differences])).share
    return Apart(share, len(axis.recordings) - 1)

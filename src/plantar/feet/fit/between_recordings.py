"""Recordings that differ by more than each shows of itself: the rubber warms up, the feet stand a little otherwise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.estimation import effect_of, fit_blocks
from plantar.estimation.least_squares import values_without_each
from plantar.estimation.random_effects import share_between
from plantar.estimation.stance_least_squares import FEWEST_RECORDINGS, jackknife
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.regression_data import beside, tangent_blocks
from plantar.feet.fit.systematic import Cause
from plantar.feet.recording import Recording

NAME = "between recordings"


def between_recordings(
    fit: AxisFit, recordings: Sequence[Recording], prior: float, shared: bool
) -> list[Cause]:
    """By how much recordings move the fit beyond their own deviations; of feet that step `systematic` knows it.

    From FEWEST_RECORDINGS on refits without one of them each (jackknife) say it, whatever it is that differs. Fewer are
    taken to differ by a share of spring and damper, at least the robot file's `prior`.
    """
    blocks = tangent_blocks(recordings, fit, drift=not shared)
    if blocks[0].stances is not None or shared or len(blocks) < 2:
        return []
    whole = fit_blocks(blocks)
    if len(blocks) >= FEWEST_RECORDINGS:
        covariance, freedom = jackknife(values_without_each(blocks))
        beyond = np.diag(covariance) - whole.std**2
        return [Cause(NAME, np.sqrt(np.maximum(beyond, 0.0)), 1.0, float(freedom[0]))]
    torques = [block.regressor[:, :2] @ fit.values[:2] for block in blocks]

    def alone(own: int) -> list[Array]:
        return [torque * float(place == own) for place, torque in enumerate(torques)]

    # Against the first: a share that all have in common is the spring's own.
    columns = [
        np.column_stack(each) for each in zip(*(alone(own) for own in range(1, len(blocks))), strict=True)
    ]
    found = fit_blocks([beside(block, own) for block, own in zip(blocks, columns, strict=True)])
    size = blocks[0].regressor.shape[1]
    ends = slice(size, size + len(blocks) - 1)
    own = float(whole.std[0]) / max(abs(float(fit.values[0])), 1e-300)
    spread = max(prior, share_between(found.values[ends], found.covariance[ends, ends], own))
    effects = np.array([effect_of(blocks, alone(own)) for own in range(len(blocks))])
    return [Cause(NAME, np.sqrt(np.sum(effects**2, axis=0)), spread, len(blocks) - 1.0)]

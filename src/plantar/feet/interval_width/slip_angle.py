"""No slip angle is known better than the step of its derivative: nearer than that, corners of the squares do not show.

Where an element of the rubber's memory begins to slip, the sum of squares has a corner, and a fit comes to rest in one
of them. The derivative there says how the squares rise to either side of the corner, not how far away the next one is.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plantar.estimation import fit_blocks
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.regression_data import blocks_of
from plantar.feet.regression.tangent import Tangent
from plantar.model_selection.variable_projection import SHAPE_STEP
from plantar.models import BESIDE

NAME = "slip angle"
UNRESOLVED = SHAPE_STEP / 2  # deviation, as a share: the derivative is taken over twice as much either way
# Likewise of feet that step: what sensors and robot file may get wrong moves no slip angle there (see `Tangent`). Of 24
# in walks of simulated robots (HRP-2, TALOS, G1, Alexander) the root mean square of the errors was 2.4 %. Spring and
# damper did not follow: states at landings make up for it.
UNRESOLVED_IN_STEPS = 0.025


def slip_angle_causes(tangent: Tangent) -> list[Cause]:
    """What an element's angle that is claimed to be known better than it can be lacks, and what follows it: how
    the fit's values are others beside a slip angle that is SHAPE_STEP larger and smaller."""
    fit, shared = tangent.fit, tangent.shared
    if fit.slip_angle is None:
        return []
    place = fit.model.shape_terms.index("slip_angle")
    known = float(fit.std[len(fit.values) + place]) / fit.slip_angle
    least = UNRESOLVED_IN_STEPS if tangent.steps else UNRESOLVED
    if not known < least:
        return []
    ends = []
    for share in (1 + SHAPE_STEP, 1 - SHAPE_STEP):
        shape = fit.shape.copy()
        shape[place] = share * fit.slip_angle
        moved = replace(fit, shape=shape)
        blocks = blocks_of(tangent.recordings, fit.foot, fit.axis, drift=not shared, fit=moved)
        ends.append(np.append(fit_blocks(blocks, shared_offset=shared).values, shape))
    effect = (ends[0] - ends[1]) / (2 * SHAPE_STEP)
    effect[: len(BESIDE)] *= UNRESOLVED / least
    return [Cause(NAME, effect, float(np.sqrt(least**2 - known**2)))]

"""The best motion of a family within its limits: a search that the seed fixes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.design.family import CHANNELS, SHAPES
from plantar.design.information import Criterion, badness
from plantar.design.reach import Reach

TRIES: Final = 2000
TOLD: Final = 200  # tries between two words of progress
CHANGED: Final = 0.15  # of the coefficients in each try
GROW, SHRINK = 1.5, 0.9  # of the step: the one-fifth rule (I. Rechenberg, 1973)
SMALLEST: Final = 1e-3  # step
BODY: Final = 0.1  # of a channel of the body at the start, where a foot's has 1


def best_motion(
    reach: Reach,
    criterion: Criterion,
    random: np.random.Generator,
    progress: Callable[[str], None] = lambda _: None,
) -> Array:
    """Coefficients (size,) of the best motion within the limits.

    An evolution strategy of one parent and one child: amplitudes and phases of some sines change together, the size
    follows from the tightest limit.
    """
    units = np.array([1.0 / reach.used(row) for row in np.eye(reach.lines.size)])
    weights = [1.0 if channel.startswith(reach.feet) else BODY for channel in CHANNELS]
    shape = random.standard_normal(reach.lines.size) * np.repeat(weights, SHAPES)

    def scaled(shape: Array) -> Array:
        coefficients = shape * units
        return np.asarray(coefficients / reach.used(coefficients))

    best = scaled(shape)
    least = badness(reach, best, criterion)
    step = 0.5
    for count in range(TRIES):
        changed = random.random(shape.size) < CHANGED
        child = shape + step * random.standard_normal(shape.size) * changed * np.sqrt(np.mean(shape**2))
        tried = scaled(child)
        value = badness(reach, tried, criterion)
        if value < least:
            shape, best, least, step = child, tried, value, min(step * GROW, 2.0)
        else:
            step = max(step * SHRINK**0.5, SMALLEST)
        if count % TOLD == 0:
            progress(f"search: {100 * count // TRIES} %")
    return best

"""The best motion of a family within its limits: a search that the seed fixes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.design.family import CHANNELS
from plantar.design.information import Criterion, badness
from plantar.design.reach import Reach

TRIES: Final = 1200
TOLD: Final = 100  # tries between two words of progress
GROW, SHRINK = 1.5, 0.9  # of the step: the one-fifth rule (I. Rechenberg, 1973)
BODY: Final = 0.1  # of a channel of the body at the start, where a foot's has 1


def best_motion(
    reach: Reach,
    criterion: Criterion,
    random: np.random.Generator,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[Array, float]:
    """Coefficients (size,) of the largest motion within the limits, and its badness.

    An evolution strategy of one parent and one child: amplitudes and phases of all sines change together, the size
    follows from the tightest limit.
    """
    units = _units(reach)
    shape = random.standard_normal(reach.lines.size) * _weights(reach)

    def scaled(shape: Array) -> Array:
        coefficients = shape * units
        return np.asarray(coefficients / reach.nearest(coefficients))

    best = scaled(shape)
    least = badness(reach, best, criterion)
    step = 0.3
    for count in range(TRIES):
        child = shape + step * random.standard_normal(shape.size) * np.sqrt(np.mean(shape**2))
        tried = scaled(child)
        value = badness(reach, tried, criterion)
        if value < least:
            shape, best, least, step = child, tried, value, min(step * GROW, 1.0)
        else:
            step = max(step * SHRINK**0.25, 1e-3)
        if count % TOLD == 0:
            progress(f"search {100 * count // TRIES} %: widest interval ±{100 * np.exp(least):.3g} %")
    return best, least


def _units(reach: Reach) -> Array:
    """How large each coefficient alone may be, (size,)."""
    return np.array([1.0 / reach.nearest(row) for row in np.eye(reach.lines.size)])


def _weights(reach: Reach) -> Array:
    each = reach.lines.size // len(CHANNELS)
    return np.repeat([1.0 if channel.startswith(("left", "right")) else BODY for channel in CHANNELS], each)

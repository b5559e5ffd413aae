"""The best motion of a family within its limits: a search that the seed fixes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.design.family import CHANNELS, SHAPES
from plantar.design.information import Criterion, badness
from plantar.design.reach import Reach

TRIES: Final = 2000  # changes of a motion that are tried
SCALED: Final = 2  # times to the tightest limit: rubber that slips is not linear
TOLD: Final = 200  # tries between two words of progress
CHANGED: Final = 0.15  # of the coefficients in each try
BEGIN, SMALLEST = 0.5, 3e-3  # steps
GROW, SHRINK = 1.5, 0.95  # of the step: a rule of one success in nine (after I. Rechenberg, 1973)
# Where the search begins: over the left foot, whose ankle moves more than the other and than the body.
START: Final = {"left": 1.0, "right": 0.3}
BODY: Final = 0.1  # for the rest of the body
LOADED: Final = 2.0  # for the load that goes from foot to foot, which all of them need


def best_motion(
    reach: Reach,
    criterion: Criterion,
    random: np.random.Generator,
    known: Array | float = 0.0,
    progress: Callable[[str], None] = lambda _: None,
) -> Array:
    """Coefficients (size,) of the best motion within the limits; `known` as in `half_widths`.

    An evolution strategy of one parent and one child: amplitudes and phases of some sines change together, the size
    follows from the tightest limit.
    """
    units = np.array([1.0 / reach.used(row) for row in np.eye(reach.lines.size)])
    shape = random.standard_normal((len(CHANNELS), SHAPES)) * [
        [START.get(c.split(".")[0], BODY)] for c in CHANNELS
    ]
    shape[CHANNELS.index("centre.y"), 0] = LOADED
    shape = shape.ravel()

    def scaled(shape: Array) -> Array:
        coefficients = shape * units
        for _ in range(SCALED):
            coefficients = coefficients / reach.used(coefficients)
        return np.asarray(coefficients)

    best = scaled(shape)
    least = badness(reach, best, criterion, known)
    step = BEGIN
    for count in range(TRIES):
        changed = random.random(shape.size) < CHANGED
        child = shape + step * random.standard_normal(shape.size) * changed * np.sqrt(np.mean(shape**2))
        tried = scaled(child)
        value = badness(reach, tried, criterion, known)
        if value < least:
            shape, best, least, step = child, tried, value, min(step * GROW, 2.0)
        else:
            step *= SHRINK
            if step < SMALLEST:  # no way on along any small step: another corner of the limits
                step = BEGIN
        if count % TOLD == 0:
            progress(f"search: {100 * count // TRIES} %")
    return best

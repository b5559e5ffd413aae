"""What rubber remembers: beside the spring stands an element that slips."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.models.elastoplastic import Elastoplastic
from plantar.models.hysteresis import Path

# Until it slips the element is a spring of this share of the bush's own, in pitch and roll: the hysteresis of HRP-2's
# feet is 7 to 10 % of their largest torques.
SHARE: Final = (1.0, 0.5)
SECANT: Final = 0.6  # of its stiffness that is left in sways of twice that angle, on the whole
NEARBY: Final = 1.05  # times: another angle, whose difference shows what the angle changes


def remembered(deflections: Array, slip_angles: Sequence[float]) -> Array:
    """The stretch [rad] of elements with slip angles (a,) [rad] beside deflections (R, N), from rest, (R, a, N)."""
    angles, (count, samples) = np.array(slip_angles), deflections.shape
    ends = samples * np.arange(count + 1)
    path = Path(np.ascontiguousarray(deflections).ravel(), np.column_stack([ends[:-1], ends[1:]]))
    states = Elastoplastic().states(path, angles[:, None], np.zeros((count, angles.size)))
    return np.moveaxis(states.reshape(count, samples, -1) * angles, 1, -1)

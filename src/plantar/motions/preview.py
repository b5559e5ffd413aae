"""The centre of mass that a zero-moment point asks for: the linear inverted pendulum, all of the future known.

A point mass at constant height h over a ZMP p obeys c̈ = (g/h) (c - p). Preview control (Kajita 2003) follows a ZMP
with a finite look ahead; a walk planned as a whole is the same with all of it: a boundary value problem, at rest over
the ZMP at both ends.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_banded

from plantar.conventions import GRAVITY, Array


def natural_frequency(height: float) -> float:
    """ω = sqrt(g/h) [rad/s] of a pendulum whose mass is `height` [m] above the floor."""
    return float(np.sqrt(GRAVITY / height))


def centre_over(zmp: Array, height: float, period: float) -> Array:
    """Horizontal centre of mass (N, 2) [m] whose pendulum has the ZMP (N, 2) [m], sampled every `period` [s]."""
    stiff = (natural_frequency(height) * period) ** 2
    bands = np.ones((3, len(zmp)))
    bands[1] = -(2 + stiff)
    bands[1, [0, -1]], bands[0, 1], bands[2, -2] = 1.0, 0.0, 0.0
    right = -stiff * zmp
    right[[0, -1]] = zmp[[0, -1]]
    return np.asarray(solve_banded((1, 1), bands, right))

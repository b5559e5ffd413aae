"""A known load on an exported foot, and what its settled angle and the decay after release must give back."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import simpson

from export_robots import TRUTH

LOAD = {"pitch": 5.0, "roll": 4.0, "z": 300.0}  # N·m, N
SIDE = {"left": "LLEG", "right": "RLEG"}
DIRECTION = {"roll": 0, "pitch": 1, "z": 2}
TOLERANCE = 0.005


def joint_name(foot: str, axis: str) -> str:
    return f"{SIDE[foot]}_BUSH_{axis.upper()}"


def check(
    foot: str, axis: str, load: float, settled: float, times: np.ndarray, decay: np.ndarray, rest: float = 0.0
) -> None:
    """K from the settled deflection; C from the decay: integrated over it, m q̈ + C q̇ + K q = 0 leaves
    C·q(0) = K·∫q dt, whatever the sole's mass m, for both ends are at rest."""
    k, c, _ = TRUTH[foot][axis]
    assert load / (settled - rest) == pytest.approx(k, rel=TOLERANCE)
    area = simpson(decay - rest, x=times)
    assert k * area / (decay[0] - decay[-1]) == pytest.approx(c, rel=TOLERANCE)

"""Of a long log the stretch that moves most is searched for lags."""

from __future__ import annotations

import numpy as np

from plantar.sensors.delays.lagged_log import _liveliest


def test_the_stretch_in_which_the_force_changes_most_is_searched() -> None:
    force = np.zeros((1000, 3))
    force[600:700, 0] = np.sin(np.arange(100.0))
    assert _liveliest(force, slice(100, 900), 800) == slice(100, 900)
    found = _liveliest(force, slice(100, 900), 200)
    assert found.stop - found.start == 200
    assert found.start <= 600
    assert found.stop >= 700
    ahead = _liveliest(force, slice(650, 900), 40)
    assert 650 <= ahead.start < 700

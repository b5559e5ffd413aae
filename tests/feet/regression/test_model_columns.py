"""The path that a model's memory follows."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.feet.regression.model_columns import memory_path

COUNT = 2000
DRIFT = 1e-4 * PERIOD * np.arange(COUNT)  # rad


@pytest.mark.parametrize("axis", ROTATIONAL_AXES)
def test_a_memory_follows_the_path_without_the_drift_that_was_found(axis: Axis) -> None:
    """What the attitude drifts by is no motion of the rubber: it is taken off again, in its own recording alone."""
    true = swayed(COUNT)
    fit = SimpleNamespace(
        foot=FOOT,
        axis=axis,
        imu_turned=(0.0, 0.0, 0.0),
        drifts={"drifts": SimpleNamespace(at=lambda _: DRIFT)},
    )
    steady, drifts = (
        made_recording(name, more + true, 400 * true) for name, more in (("steady", 0.0), ("drifts", DRIFT))
    )
    one, other = (memory_path(each, fit).deflection for each in (steady, drifts))  # type: ignore[arg-type]
    known = np.isfinite(one)
    assert known.sum() > COUNT / 2
    np.testing.assert_allclose(other[known], one[known], atol=1e-7)

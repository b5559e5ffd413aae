"""Zeros of an encoder that drops out, and zeros that are its angle."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.signals.dropouts import dropped_samples, without_dropouts

TIME = np.arange(0.0, 40.0, 0.005)
ANGLE = 0.1 + 0.05 * np.sin(0.8 * TIME)
COUNT = 2 * np.pi / 20000  # rad, of an encoder


def dropping(values: np.ndarray, length: int = 40, every: int = 1000) -> tuple[np.ndarray, np.ndarray]:
    gone = np.arange(len(values)) % every >= every - length
    return np.where(gone, 0.0, values), gone


@pytest.mark.parametrize("values", [ANGLE, np.round(ANGLE / COUNT) * COUNT, np.full_like(ANGLE, -0.3)])
@pytest.mark.parametrize("length", [1, 40])
def test_zeros_between_jumps_are_dropped(values: np.ndarray, length: int) -> None:
    read, gone = dropping(values, length)
    found = dropped_samples(read)
    inner = gone & (TIME < 39.5)  # the last stretch ends with the log
    assert found[inner].all()
    assert found.sum() <= inner.sum() + 2 * (len(TIME) // 1000)


@pytest.mark.parametrize(
    "values",
    [
        np.round((ANGLE - 0.1) / COUNT) * COUNT,  # passes zero in counts
        np.where(np.sin(0.8 * TIME) > 0, ANGLE - 0.1, 0.0),  # rests at zero, and leaves it smoothly
        np.where(TIME < 5, 0.0, ANGLE),  # switched on
        np.where((TIME > 5) & (TIME < 6), 0.0, ANGLE),  # once: too little to tell
        np.zeros_like(TIME),
        np.where(np.sin(3 * TIME) > 0.9, 0.0017, 0.0),  # nearly always within half a step
        np.round((ANGLE - 0.1) / 0.0017)
        * 0.0017
        * (1 + 1e-15 * np.arange(TIME.size) % 3e-15),  # coarse, with rounding
    ],
)
def test_zeros_that_are_the_angle_stay(values: np.ndarray) -> None:
    assert not dropped_samples(values).any()


def test_only_positions_of_joints_are_looked_at() -> None:
    read, _ = dropping(ANGLE)
    names = ["joint.knee.position", "joint.knee.velocity", "wrench.left_foot.force.z"]
    log = without_dropouts(MotionLog("dropping", TIME, dict.fromkeys(names, read)))
    assert [name for name in names if np.isnan(log.column(name)).any()] == names[:1]
    whole = MotionLog("whole", TIME, dict.fromkeys(names, ANGLE))
    assert without_dropouts(whole) is whole

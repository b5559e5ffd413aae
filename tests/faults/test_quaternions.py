"""Quaternions: ways to read them, and turns between them against a library's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.faults.quaternions import misread, readings, turns_between


def test_turns_are_those_of_a_library_small_large_and_through_either_sign() -> None:
    random = np.random.default_rng(0)
    before, after = random.normal(size=(2, 300, 4))
    after[:100] = before[:100] + 1e-5 * after[:100]
    after[100:110] = -before[100:110]
    start, stop = (Rotation.from_quat(each, scalar_first=True) for each in (before, after))
    assert turns_between(before, after) == pytest.approx((start.inv() * stop).as_rotvec(), abs=1e-12)


def test_readings_of_a_quaternion() -> None:
    """A turn by 0.2 rad about z: as it is, misread as about x by nearly half a turn, and backwards."""
    still = np.array([[1.0, 0.0, 0.0, 0.0]])
    w, z = np.cos(0.1), np.sin(0.1)
    turns = {
        name: turns_between(still, read)[0] for name, read in readings(np.array([[w, 0.0, 0.0, z]])).items()
    }
    assert turns["as it is"] == pytest.approx([0, 0, 0.2])
    assert turns["inverted"] == pytest.approx([0, 0, -0.2])
    assert turns["read as x y z w"] == pytest.approx([np.pi - 0.2, 0, 0])


def test_each_misreading_says_what_is_valid() -> None:
    for reading, valid in (("read as x y z w", "w x y z"), ("inverted", "body to world")):
        found = misread("chest", "turns", reading)
        assert found.text == f"columns 'imu.chest.orientation.*': turns; {reading} it agrees (valid: {valid})"
        assert (found.code, found.fatal) == ("quaternion_order", True)

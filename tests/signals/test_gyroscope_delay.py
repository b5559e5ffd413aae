"""How far a gyroscope is behind the orientation beside it, how well that is told, and what a filter makes of it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.logs.motion_log import MotionLog
from plantar.signals.gyroscope_delay import (
    GyroscopeDelay,
    gyroscope_delay,
    log_gyroscope_delay,
    of_a_filter,
)

PERIOD = 0.005
TIME = PERIOD * np.arange(6000)


def test_its_deviation_is_how_the_delay_scatters() -> None:
    """Over draws of white noise: three axes, in the band of the filter."""
    random, found = np.random.default_rng(1), []
    turning = np.column_stack([np.cos(2 * np.pi * hertz * TIME) for hertz in (0.5, 0.8, 1.1)])
    for _ in range(60):
        one = gyroscope_delay(turning + random.normal(0, 0.05, turning.shape), turning, PERIOD)
        assert one is not None
        found.append(one)
    scatter = np.sqrt(np.mean([one.late**2 for one in found]))
    assert scatter == pytest.approx(np.median([one.std for one in found]), rel=0.25)


def test_noise_of_a_gyroscope_makes_slow_turns_look_no_less_late() -> None:
    random, slow = np.random.default_rng(2), 2 * np.pi * 0.2
    turning = 0.02 * np.column_stack([np.cos(slow * TIME), np.sin(slow * TIME), np.cos(1.3 * slow * TIME)])
    late = 0.02 * np.column_stack(
        [np.cos(slow * (TIME - 0.02)), np.sin(slow * (TIME - 0.02)), np.cos(1.3 * slow * (TIME - 0.02))]
    )
    read = [late + random.normal(0, 0.01, late.shape) for _ in range(20)]
    found = [gyroscope_delay(one, turning + random.normal(0, 0.002, late.shape), PERIOD) for one in read]
    assert np.mean([one.late for one in found if one is not None]) == pytest.approx(0.02, rel=0.1)


@pytest.mark.parametrize("late", [0.02, 0.06, 0.12])
def test_a_delay_of_quick_turns_is_found_beyond_its_first_order(late: float) -> None:
    """As of steps: of 3 Hz, 60 ms are a radian."""
    turning, read = (
        np.column_stack(
            [
                np.cos(2 * np.pi * hertz * (TIME - by)) + np.cos(6 * np.pi * (TIME - by))
                for hertz in (0.3, 0.5, 0.8)
            ]
        )
        for by in (0.0, late)
    )
    found = gyroscope_delay(read, turning, PERIOD)
    assert found is not None
    assert found.late == pytest.approx(late, abs=2e-4)
    assert found.explained > 0.99


def test_a_log_without_orientation_or_gyroscope_tells_nothing() -> None:
    assert log_gyroscope_delay(MotionLog("empty", TIME, {}), "chest") is None


def test_a_log_tells_what_its_columns_tell() -> None:
    """Rates that were read 20 ms late beside an orientation that sways about two axes."""
    sways = [0.1 * np.sin(2 * np.pi * hertz * TIME) for hertz in (0.4, 0.7)]
    turns = Rotation.from_euler("yx", np.column_stack(sways))
    rates = np.gradient(turns.as_matrix(), PERIOD, axis=0)
    skew = np.einsum("nji,njk->nik", turns.as_matrix(), rates)
    body = np.column_stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]])
    columns = {
        f"imu.chest.orientation.{axis}": part for axis, part in zip("xyzw", turns.as_quat().T, strict=True)
    }
    late = np.roll(body, 4, axis=0)
    late[:4] = late[4]
    columns |= {f"imu.chest.angular_velocity.{axis}": part for axis, part in zip("xyz", late.T, strict=True)}
    found = log_gyroscope_delay(MotionLog("late", TIME, columns), "chest")
    assert found is not None
    assert found.late == pytest.approx(0.02, abs=5e-4)


@pytest.mark.parametrize(("late", "std", "told"), [
    (0.004, 0.0013, True), (0.004, 0.0014, False), (-0.004, 0.0001, True),
    (0.00049, 0.0001, False), (0.00051, 0.0001, True), (0.0049, 0.0001, True),
    (0.1, 0.0001, True), (-0.0049, 0.0001, True), (-0.0051, 0.0001, False),
])  # fmt: skip
def test_a_delay_is_a_filter_s_where_it_is_sure_and_not_early(late: float, std: float, told: bool) -> None:
    assert of_a_filter(late, std) is told
    assert GyroscopeDelay(late, std, 1.0).shown is told

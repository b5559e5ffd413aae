"""Which logs are searched for lags, and of a long one which stretch: the one that moves most."""

from __future__ import annotations

import numpy as np
import pytest

from biped import WEIGHT, record, sway, times
from feet_trials import without
from plantar.estimation.delays.lag_search import search_lags
from plantar.robot.model import RobotModel
from plantar.sensors.delays.lagged_log import _liveliest, lagged_log


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


@pytest.mark.parametrize(("share", "searched"), [(0.0028, False), (0.0033, True)])
def test_a_force_that_hardly_moves_shows_no_lag(robot: RobotModel, share: float, searched: bool) -> None:
    """Less than three thousandths of the weight, as a deviation; half of it on each foot, the rest stands still."""
    log = record(sway(duration=60.0))
    still = {name: np.full(len(log), values[0]) for name, values in log.columns.items()}
    push = np.sqrt(2) * share * WEIGHT * np.sin(np.pi * log.time)
    for foot in robot.feet:
        still[f"wrench.{foot}.force.x"] += push / 2
    assert (lagged_log(robot, log.with_columns(still)) is not None) == searched


def test_a_log_is_searched_alike_at_any_rate(robot: RobotModel) -> None:
    """What postures and drifting zeros do is taken off below one frequency, however many samples a second has."""
    motion = sway(duration=40.0)
    slow, fast = (lagged_log(robot, record(motion, at=times(motion, rate))) for rate in (40.0, 200.0))
    assert slow is not None
    assert fast is not None
    assert fast.period == pytest.approx(slow.period)
    np.testing.assert_allclose(fast.wrenches, slow.wrenches, atol=1e-9)
    for side in ("predicted", "measured"):
        one, other = (np.std(getattr(grid, side), axis=-2) for grid in (slow, fast))
        np.testing.assert_allclose(other, one, rtol=0.05, atol=0.02 * one.max())


def test_logs_of_unlike_rates_are_searched_at_the_same_lags(robot: RobotModel) -> None:
    """Their grids are compared lag by lag, with and without an accelerometer."""
    motion = sway(duration=40.0)
    logs = [record(motion, at=times(motion, rate)) for rate in (45.0, 70.0, 200.0)]
    for each in (logs, [without(log, "linear_acceleration") for log in logs]):
        grids = [grid for grid in (lagged_log(robot, log) for log in each) if grid is not None]
        assert len(grids) == 3
        for grid in grids:
            np.testing.assert_array_equal(grid.wrenches, grids[0].wrenches)
            np.testing.assert_array_equal(grid.encoders, grid.wrenches)
        assert search_lags(grids).missed.shape == (3,)

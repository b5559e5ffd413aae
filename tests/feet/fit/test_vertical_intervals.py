"""Deviation and interval of the vertical stiffness, a reciprocal; what is known of one foot from the other."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import special

from biped import VERTICAL, record, sway
from biped_robot import FEET
from feet_trials import LINEAR, codes, noisy
from plantar.feet.fit.compliances import Compliances
from plantar.feet.identify import identify_feet
from plantar.robot.model import RobotModel

FREEDOM = 4  # of one recording of 20 s


@pytest.mark.parametrize("seed", range(3))
def test_the_interval_holds_the_truth_and_is_students(robot: RobotModel, seed: int) -> None:
    """Half its width in compliance over Student's t is the stiffness' deviation over the stiffness squared."""
    found = identify_feet(robot, [noisy(record(sway(seed=seed)), seed)], settings=LINEAR)
    for foot in FEET:
        row = found.parameter(foot, "z", "stiffness")
        low, high = row.interval95
        assert low < VERTICAL < high
        half = (1 / low - 1 / high) / 2
        assert row.std == pytest.approx(half * row.value**2 / special.stdtrit(FREEDOM, 0.975), rel=1e-6)


def test_a_quiet_sensor_does_not_make_a_constant_load_move(robot: RobotModel) -> None:
    """0.3 N of noise: a variance in N² is small, and is compared with a variance."""
    log = record(sway(seed=1))
    random = np.random.default_rng(1)
    quiet = log.with_columns(
        {
            name: values + 0.3 * random.standard_normal(len(log))
            for name, values in log.columns.items()
            if ".force." in name
        }
    )
    assert "z_sum_only" in codes(identify_feet(robot, [quiet], settings=LINEAR))


@pytest.mark.parametrize("difference_std", [1e-7, 2e-6, 2e-5])
def test_one_foot_is_the_mean_and_half_of_what_is_known_of_the_difference(difference_std: float) -> None:
    """Feet of one robot are alike to 0.15 of the sum; the data's difference is drawn to that as Bayes has it."""
    total, total_std, difference = 4e-5, 5e-7, 3e-6
    prior = 0.15 * total
    found = Compliances(
        total, difference, np.diag([total_std**2, difference_std**2]), 20.0, np.array([1e-8, 1e-8])
    )
    gain = prior**2 / (prior**2 + difference_std**2)
    left = 0.5 * np.hypot(total_std, np.sqrt(gain) * difference_std)
    for side in (1.0, -1.0):
        value, std = found.of(side)
        assert value == pytest.approx(0.5 * (total + side * gain * difference), rel=1e-9)
        assert std == pytest.approx(left, rel=1e-9)

"""The vertical axis: what the loads of two standing feet tell about their compliances, and what they do not."""

from __future__ import annotations

import numpy as np
import pytest

from biped import VERTICAL, record, sway
from biped_robot import FEET
from feet_trials import LINEAR, codes, noisy
from plantar.feet.fit.vertical_stiffness import fit_vertical_stiffness
from plantar.feet.identify import identify_feet
from plantar.robot.model import RobotModel


def test_noise_on_a_constant_total_load_tells_the_feet_not_apart(robot: RobotModel) -> None:
    """As regressors, changes that are mere noise would split the sum of the compliances at random."""
    for seed in range(3):
        log = noisy(record(sway(seed=seed)), seed)
        found = identify_feet(robot, [log], settings=LINEAR)
        rows = [found.parameter(foot, "z", "stiffness") for foot in FEET]
        assert "z_sum_only" in codes(found)
        assert rows[0].value == pytest.approx(rows[1].value, rel=1e-3)
        assert sum(1 / row.value for row in rows if row.value) == pytest.approx(2 / VERTICAL, rel=0.05)
        assert {row.verdict for row in rows} == {"weak"}


def test_no_moving_weight_shows_no_vertical_stiffness(robot: RobotModel) -> None:
    found = identify_feet(robot, [noisy(record(sway(shift=0.0)), 1)], settings=LINEAR)
    assert "z_unknown" in codes(found)


def test_where_no_log_shows_it_rubber_may_be_as_soft_as_rubber_is(robot: RobotModel) -> None:
    """What is known of rubber is known however few the logs are."""
    found = fit_vertical_stiffness([], robot)
    assert found.compliance == dict.fromkeys(robot.feet, 0.0)
    assert found.compliance_std == dict.fromkeys(robot.feet, 1e-5)  # m/N
    assert found.freedom == np.inf
    assert {(row.value, row.verdict) for row in found.parameters} == {(None, "unidentifiable")}

"""The vertical axis: what the loads of two standing feet tell about their compliances, and what they do not."""

from __future__ import annotations

import numpy as np
import pytest

from biped import VERTICAL, record, sway
from biped_robot import FEET
from feet_trials import LINEAR, codes, noisy
from plantar.estimation import Block
from plantar.feet.fit.vertical_stiffness import Compliances, _compliances, _row, fit_vertical_stiffness
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
    found = fit_vertical_stiffness([], robot, {})
    assert found.compliance == dict.fromkeys(robot.feet, 0.0)
    assert found.compliance_std == dict.fromkeys(robot.feet, 1e-5)  # m/N
    assert found.freedom == np.inf
    assert {(row.value, row.verdict) for row in found.parameters} == {(None, "unidentifiable")}


def compliances(share: float, apart: float) -> Compliances:
    """A sum of 8 µm/N known to a share of it (standard deviation), a difference to so many µm/N."""
    covariance = np.diag([(share * 8e-6) ** 2, (1e-6 * apart) ** 2])
    return Compliances(8e-6, 1e-6, covariance, np.inf, np.array([0.01 * 8e-6, 0.0]))


@pytest.mark.parametrize(
    ("half", "told_apart", "verdict"),
    [
        (0.14, True, "usable"), (0.16, True, "weak"), (0.49, True, "weak"), (0.51, True, "unidentifiable"),
        (0.14, False, "weak"), (0.51, False, "unidentifiable"),
    ],
)  # fmt: skip
def test_a_stiffness_is_judged_by_its_width_and_by_whether_feet_are_told_apart(
    half: float, told_apart: bool, verdict: str
) -> None:
    found = compliances(0.01, 0.1 if told_apart else 100.0)
    assert found.separable == told_apart
    row = _row("left", 4e-6, half * 4e-6 / 1.96, found, 0.0)
    assert row.verdict == verdict
    assert row.value == pytest.approx(250e3)
    assert row.std == pytest.approx(250e3 * half / 1.96), "the same share of the stiffness"
    assert row.interval95 == pytest.approx((250e3 / (1 + half), 250e3 / (1 - half)), rel=1e-3)
    assert row.relative_std_percent == pytest.approx(1.0)
    assert row.reason.startswith(f"95 % interval of the compliance ±{100 * half:.2g} %")
    assert ("only the sum of both compliances shows" in row.reason) == (not told_apart)
    assert (row.advice is None) == (verdict == "usable")


def test_feet_that_are_not_told_apart_have_half_of_the_sum_each_and_may_differ_by_a_seventh() -> None:
    """Of one robot's feet the difference is 0.15 of the sum, as a rule; what shows it takes its place."""
    together, apart = compliances(0.02, 1e6), compliances(0.02, 0.001)
    for side in (1.0, -1.0):
        value, std = together.of(side)
        assert value == pytest.approx(4e-6, rel=1e-3)
        assert std == pytest.approx(0.5 * np.hypot(0.02 * 8e-6, 0.15 * 8e-6), rel=1e-3)
        value, std = apart.of(side)
        assert value == pytest.approx(4e-6 + side * 0.5e-6, rel=1e-3)
        assert std == pytest.approx(0.5 * 0.02 * 8e-6, rel=1e-3)


def test_a_total_load_that_never_changes_leaves_the_difference_to_the_likeness_of_feet() -> None:
    moved = 100.0 * np.sin(np.linspace(0.0, 60.0, 2000))
    height = 8e-6 * moved + 1e-5 * np.sin(np.linspace(0.0, 500.0, 2000))
    block = Block("sway", np.column_stack([moved, 0.0 * moved]), height - height.mean(), 0.05, 1)
    found = _compliances([block], [])
    assert found.total == pytest.approx(8e-6, rel=0.02)
    assert found.difference == 0.0
    assert not found.separable
    _, std = found.of(1.0)
    assert std == pytest.approx(0.5 * np.hypot(np.sqrt(found.covariance[0, 0]), 0.15 * found.total), rel=0.02)


@pytest.mark.parametrize(
    ("gain", "verdict"), [(0.02, "usable"), (0.14, "weak"), (0.6, "unidentifiable"), (1.2, "unidentifiable")]
)
def test_what_a_force_sensor_may_be_off_by_the_stiffness_may_be_off_by(gain: float, verdict: str) -> None:
    row, half = (
        _row("left", 4e-6, 0.1 * 4e-6 / 1.96, compliances(0.01, 0.1), gain),
        float(np.hypot(0.1, gain)),
    )
    assert row.verdict == verdict
    assert row.std == pytest.approx(250e3 * half / 1.96, rel=1e-3)
    high = 250e3 / (1 - half) if half < 1 else np.inf
    assert row.interval95 == pytest.approx((250e3 / (1 + half), high), rel=1e-3)


def test_no_vertical_stiffness_is_usable_of_sensors_that_miss_a_third_of_the_weight(
    robot: RobotModel,
) -> None:
    """Somebody carries the robot, or the sensors read too little: nobody can tell."""
    log = record(sway(shift=0.3))
    light = log.with_columns({name: 0.7 * log.column(name) for name in log.columns if "wrench." in name})
    rows = [row for row in identify_feet(robot, [light], settings=LINEAR).parameters if row.axis == "z"]
    assert len(rows) == 2
    for row in rows:
        assert row.value is None or row.interval95[0] < VERTICAL < row.interval95[1]
        assert row.verdict != "usable"

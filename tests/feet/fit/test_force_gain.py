"""Gains of force sensors against the URDF's weight, and what they do to verdicts."""

from __future__ import annotations

from pathlib import Path

import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot, robot_entry
from feet_trials import LINEAR, codes
from plantar.feet.fit.force_gain import force_gain_errors
from plantar.feet.identify import identify_feet
from plantar.feet.prepare_log import checked, prepare
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

SHIFTING = sway(shift=0.7, duration=30.0)


@pytest.fixture(scope="module")
def weighed(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    """The biped with links that somebody has weighed: its trunk is most of it."""
    return make_robot(tmp_path_factory.mktemp("weighed"), uncertainty={"link_mass": 0.01})


def scaled(log: MotionLog, **gains: float) -> MotionLog:
    """The log with force and torque of some feet multiplied."""
    return log.with_columns(
        {
            name: gain * values
            for foot, gain in gains.items()
            for name, values in log.columns.items()
            if name.startswith(f"wrench.{foot}.")
        }
    )


def errors(robot: RobotModel, log: MotionLog) -> dict[str, float]:
    found = force_gain_errors(robot, [prepare(robot, checked(robot, log), "fit")])
    return {foot: each.share for foot, each in found.items() if each.sure}


def test_sensors_that_carry_the_weight_are_right(weighed: RobotModel) -> None:
    for log in (record(SHIFTING), scaled(record(SHIFTING), left=1.03, right=0.98)):
        assert errors(weighed, log) == {}


@pytest.mark.parametrize("gain", [1.12, 0.88])
def test_both_gains_are_found_without_a_shift_of_weight(weighed: RobotModel, gain: float) -> None:
    found = errors(weighed, scaled(record(sway()), left=gain, right=gain))
    assert found == pytest.approx({"left": gain - 1, "right": gain - 1}, abs=0.01)


def test_a_shift_of_weight_shows_whose_gain_it_is(weighed: RobotModel) -> None:
    assert errors(weighed, scaled(record(SHIFTING), left=1.12)) == pytest.approx({"left": 0.12}, abs=0.02)


@pytest.mark.parametrize(("left", "right", "feet"), [
    (1.06, 1.015, {"left", "right"}), (1.06, 0.98, {"left"}), (1.01, 1.01, set()),
])  # fmt: skip
def test_a_foot_that_is_off_the_same_way_less_is_counted_too(
    weighed: RobotModel, left: float, right: float, feet: set[str]
) -> None:
    log = scaled(record(SHIFTING), left=left, right=right)
    assert set(force_gain_errors(weighed, [prepare(weighed, checked(weighed, log), "fit")])) == feet


def test_a_robot_file_that_doubts_its_masses_allows_more(tmp_path: Path, weighed: RobotModel) -> None:
    log = scaled(record(sway()), left=1.12, right=1.12)
    assert errors(weighed, log)
    assert errors(make_robot(tmp_path, uncertainty={"link_mass": 0.05}), log) == {}


def test_forces_zeroed_under_load_and_robots_that_hang_say_nothing(
    tmp_path: Path, weighed: RobotModel
) -> None:
    log = record(sway())
    zeroed = log.with_columns(
        {name: log.column(name) - 0.8 * log.column(name).mean() for name in log.columns if "force.z" in name}
    )
    assert errors(weighed, zeroed) == {}
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    feet = {name: {**foot, "contact": "always"} for name, foot in feet.items()}
    always = make_robot(tmp_path, feet=feet, uncertainty={"link_mass": 0.01})
    assert errors(always, scaled(log, left=1.12, right=1.12)) == {}


def test_intervals_hold_both_a_wrong_gain_and_wrong_masses(weighed: RobotModel) -> None:
    """12 % more force and torque on the left: its numbers are 12 % too large, and those of the right foot are right."""
    found = identify_feet(weighed, [scaled(record(SHIFTING), left=1.12)], settings=LINEAR)
    assert "force_gain" in codes(found)
    for (foot, axis), law in TRUTH.items():
        for name, truth in (("stiffness", law.stiffness), ("damping", law.damping)):
            row = found.parameter(foot, axis, name)
            assert row.interval95 is not None
            assert row.half_width_percent is not None
            if foot == "left":
                assert row.interval95[0] < truth < row.interval95[1]
                assert row.half_width_percent > 10
                assert row.verdict == "weak"
            else:
                assert row.half_width_percent < 3  # the usual gain of a force sensor
    limits = {(each.foot, each.axis, each.name): each.limit for each in found.diagnosis}
    assert limits["left", "pitch", "stiffness"] == "force gain"
    assert "force_gain" not in codes(identify_feet(weighed, [record(SHIFTING)], settings=LINEAR))

"""One log made ready: what its force sensors read in the air is taken off, but of a foot that always stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import drawn_up, record, sway
from estimator_text import untold
from plantar.contact.reasons import Reason
from plantar.conventions import GRAVITY
from plantar.errors import DataError, RobotError
from plantar.feet.prepare_log import _lifted, checked, prepare
from plantar.logs.motion_log import MotionLog, imu_columns, wrench_columns
from plantar.robot.model import RobotModel
from plantar.sensors.newton_euler import with_gyroscope

ZERO = np.array([4.0, -3.0, 20.0, 0.5, -0.4, 0.2])  # N, N·m


def stepping(zero: np.ndarray) -> MotionLog:
    """Feet that swing in turn for a second, twice as long between; the left force sensor reads `zero` beside."""
    log = record(sway("steps", duration=24.0))
    sole = {foot: log.wrench(foot) for foot in ("left", "right")}
    phase = np.mod(log.time, 6.0)[:, None]
    left, right = (phase > 1.0) & (phase < 2.0), (phase > 4.0) & (phase < 5.0)
    both = sole["left"] + sole["right"]
    read = {
        "left": np.where(left, 0.0, np.where(right, both, sole["left"])) + zero,
        "right": np.where(right, 0.0, np.where(left, both, sole["right"])),
    }
    columns = {foot: dict(zip(wrench_columns(foot), read[foot].T, strict=True)) for foot in read}
    log = log.with_columns(columns["left"] | columns["right"])
    return drawn_up(drawn_up(log, "left", left[:, 0]), "right", right[:, 0])


def test_what_a_sensor_reads_in_the_air_is_taken_off_and_told(robot: RobotModel) -> None:
    right, found = (prepare(robot, stepping(zero), "fit") for zero in (0.0 * ZERO, ZERO))
    for state in ("wrench", "torque", "force_z"):
        for foot in ("left", "right"):
            ours, theirs = (getattr(one.raw[foot], state) for one in (found, right))
            np.testing.assert_allclose(ours, theirs, atol=1e-6)
    rows = [row for row in found.zeros if row.foot == "left"]
    assert len(rows) == 4
    for row in rows:
        assert (*row.force_zero, *row.torque_zero) == pytest.approx(ZERO)
    (note,) = [note for note in found.notes if note.code == "air_zero" and "left foot" in note.text]
    assert note.text.startswith("steps: left foot: in the air its force sensor reads 4, -3, 20 N (4 swings")


@pytest.mark.parametrize(
    ("count", "told"),
    [
        (0, r"robot\.yaml: names no feet \(valid: feet: \{left: \.\.\., right: \.\.\.\}\)$"),
        (4, r"robot\.yaml: names 4 feet \(valid: two: the feet of a biped\)$"),
    ],
)
def test_feet_that_are_no_biped_s_are_refused(robot: RobotModel, count: int, told: str) -> None:
    feet = {str(place): robot.feet["left"] for place in range(count)}
    other = replace(robot, feet=feet)
    with pytest.raises(RobotError, match=told):
        checked(other, record(sway(duration=2.0)))
    with pytest.raises(RobotError, match=told):
        untold(other)


def test_an_accelerometer_that_drivers_fill_with_zeros_is_no_accelerometer(robot: RobotModel) -> None:
    log = record(sway(duration=4.0))
    names = imu_columns("chest", "linear_acceleration")
    zeros = checked(robot, log.with_columns({name: np.zeros(len(log)) for name in names}))
    assert log.has(*names)
    assert not zeros.has(*names)
    assert [note.severity for note in zeros.notes if "hold no value; not used" in note.text] == ["warning"]


def test_without_an_orientation_an_accelerometer_has_to_show_gravity(robot: RobotModel) -> None:
    log = record(sway(duration=4.0))
    small = {name: 0.05 * log.column(name) for name in imu_columns("chest", "linear_acceleration")}
    odd = log.with_columns(small)
    assert not checked(robot, odd).has(*small)
    with pytest.raises(
        DataError,
        match=r"^sway: columns 'imu\.chest\.linear_acceleration\.\*': its usual norm is 0\.49, as of an "
        r"acceleration without gravity; not used \(valid: m/s², about 9\.81 at rest\)$",
    ):
        checked(robot, odd.without(imu_columns("chest", "orientation")))


def test_a_foot_that_sways_is_not_in_the_air(robot: RobotModel) -> None:
    """It carries a tenth of the weight at times, and each time the same, but its sole stays where the other is."""
    log = record(sway("sway", duration=12.0))
    column, both = (
        "wrench.left.force.z",
        sum(log.column(f"wrench.{foot}.force.z") for foot in ("left", "right")),
    )
    light = np.mod(log.time, 3.0) < 1.0
    left = np.where(light, 0.1 * both, log.column(column))
    log = log.with_columns({column: left, "wrench.right.force.z": both - left})
    assert not prepare(robot, log, "fit").zeros
    assert {row.foot for row in prepare(robot, drawn_up(log, "left", light), "fit").zeros} == {"left"}
    # On a step of 5 cm it is higher all the time, also while it carries the robot.
    heavy = np.mod(log.time, 3.0) > 2.0
    left = np.where(heavy, 0.8 * both, left)
    log = log.with_columns({column: left, "wrench.right.force.z": both - left})
    on_step = drawn_up(log, "left", np.ones(len(log), dtype=bool), height=0.05)
    assert not prepare(robot, on_step, "fit").zeros
    on_step = drawn_up(on_step, "left", light)
    assert {row.foot for row in prepare(robot, on_step, "fit").zeros} == {"left"}


def test_one_swing_is_enough_of_a_foot_that_is_lifted(robot: RobotModel) -> None:
    """It touches the floor for a while before and behind, which is no part of the swing."""
    log = record(sway("sway", duration=16.0))
    column, both = (
        "wrench.left.force.z",
        sum(log.column(f"wrench.{foot}.force.z") for foot in ("left", "right")),
    )
    swing, touch = np.abs(log.time - 8.0) < 1.5, np.abs(log.time - 8.0) < 5.0
    left = np.where(swing, 0.0, np.where(touch, 0.15 * both, log.column(column)))
    log = log.with_columns({column: left + ZERO[2], "wrench.right.force.z": both - left})
    (row,) = prepare(robot, drawn_up(log, "left", swing), "fit").zeros
    assert (row.foot, row.force[2]) == ("left", pytest.approx(ZERO[2], abs=0.5))


def test_a_foot_above_one_that_carries_nothing_has_not_stepped(robot: RobotModel) -> None:
    """A robot on a hoist with one leg drawn up: its sole is higher than the other, which does not carry it."""
    raw = prepare(robot, record(sway("sway", duration=4.0)), "fit").raw
    left, right = raw["left"], raw["right"]
    raised = left.sole_position + np.array([0.0, 0.0, 0.1])
    up = replace(left, sole_position=raised, force_z=np.zeros(len(left.force_z)))
    for share, lifted in ((0.4, False), (0.6, True)):
        carries = replace(right, force_z=np.full(len(right.force_z), share * robot.mass * GRAVITY))
        found = _lifted(robot, {"left": up, "right": carries}, "left")
        assert found.all() == found.any() == lifted


def always_standing(robot: RobotModel, *feet: str) -> RobotModel:
    """The robot whose sensors of these feet were zeroed under load."""
    stand = {name: replace(robot.feet[name], contact="always") for name in feet}
    return replace(robot, feet={**robot.feet, **stand})


def test_a_foot_that_always_stands_has_nothing_taken_off(robot: RobotModel) -> None:
    """Zeroed under load, it reads next to nothing while it carries, too."""
    found = prepare(always_standing(robot, "left"), stepping(ZERO), "fit")
    assert {row.foot for row in found.zeros} == {"right"}
    assert not any("left foot" in note.text for note in found.notes if note.code == "air_zero")


def test_a_robot_zeroed_under_load_is_not_told_its_weight(robot: RobotModel) -> None:
    log = record(sway("sway", duration=12.0))
    names = [f"wrench.{foot}.force.z" for foot in ("left", "right")]
    zeroed = log.with_columns({name: log.column(name) - log.column(name).mean() for name in names})
    codes = [
        {note.code for note in prepare(one, zeroed, "fit").notes}
        for one in (robot, always_standing(robot, "left", "right"))
    ]
    assert "weight" in codes[0]
    assert "weight" not in codes[1]


def test_a_foot_zeroed_under_load_is_not_struck(robot: RobotModel) -> None:
    """Its force is no share of the weight that a blow could be measured by."""
    log = record(sway("sway", duration=12.0))
    shaken = 60.0 * np.random.default_rng(0).normal(size=len(log)) * (np.abs(log.time - 6.0) < 0.3)
    struck = log.with_columns({"wrench.left.force.x": log.column("wrench.left.force.x") + shaken})
    auto, always = (prepare(one, struck, "fit") for one in (robot, always_standing(robot, "left")))
    assert auto.contacts["left"].left_out_for([Reason.IMPACT]).any()
    assert not always.contacts["left"].left_out_for([Reason.IMPACT]).any()


def test_newtons_law_needs_sensors_that_know_the_load(robot: RobotModel) -> None:
    log = record(sway("sway", duration=2.0))
    assert with_gyroscope(robot, log) is not None
    assert with_gyroscope(always_standing(robot, "right"), log) is None


def test_of_a_long_log_what_moves_is_made_ready(robot: RobotModel) -> None:
    log = record(sway(duration=20.0))
    time = np.arange(0.0, 720.0, 0.05)
    columns = {
        name: np.interp(time % 20.0, log.time - log.time[0], values) for name, values in log.columns.items()
    }
    ready = checked(robot, MotionLog("long", time, columns))
    assert "long_recording" in {note.code for note in ready.notes}
    assert not {"gaps", "resampled"} & {note.code for note in ready.notes}
    assert len(ready) == 600 * 20

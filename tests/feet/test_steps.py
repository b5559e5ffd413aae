"""A foot that steps, through the whole identification: each stance, each walk and each swing stands in the result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from biped import TRUTH, BushModel, record, sway
from biped_robot import make_robot, robot_entry
from feet_trials import LINEAR, STANDS, STEP, ZERO, noisy, stepping
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.place.place_notes import BUSH_TURNED
from plantar.feet.prepare_log import prepare
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty
from plantar.signals.filters import low_pass
from plantar.signals.resampling import evenly_sampled

WRENCH = [f"wrench.left.{part}.{axis}" for part in ("force", "torque") for axis in "xyz"]
CLOSE = 0.1  # of K: some seconds of a small roll, with the load's moment arms beside it


@pytest.fixture(scope="module")
def found(robot: RobotModel) -> FeetResult:
    logs = [stepping(record(sway(f"walk_{seed}", seed, duration=15.0))) for seed in (1, 2, 3)]
    return identify_feet(robot, logs[:2], logs[2:], LINEAR)


def test_stances_and_walks_of_both_axes_and_all_recordings_are_in_the_result(found: FeetResult) -> None:
    keys = {(row.foot, row.axis, row.motion, row.role) for row in found.walks}
    roles = {"walk_1": "fit", "walk_2": "fit", "walk_3": "validate"}
    assert keys == {
        ("left", axis, motion, role) for axis in ("pitch", "roll") for motion, role in roles.items()
    }
    assert {(row.foot, row.axis, row.motion, row.role) for row in found.stances} == keys
    for axis in ("pitch", "roll"):
        truth = TRUTH["left", axis].stiffness
        walks = [row.stiffness for row in found.walks if row.axis == axis]
        assert walks == pytest.approx([truth] * 3, rel=CLOSE)
        stances = [row for row in found.stances if row.axis == axis]
        assert 24 <= len(stances) <= 30
        assert np.median([row.stiffness for row in stances]) == pytest.approx(truth, rel=CLOSE)
        assert all(0.5 < row.end - row.start < STANDS for row in stances)


def test_each_swing_shows_the_sensors_zero(found: FeetResult) -> None:
    for motion in ("walk_1", "walk_2", "walk_3"):
        rows = [row for row in found.swing_zeros if row.motion == motion]
        assert {row.foot for row in rows} == {"left"}
        assert len(rows) >= 8
        assert [row.force[2] for row in rows] == pytest.approx([ZERO] * len(rows), abs=0.5)
        assert [row.force_zero[2] for row in rows] == pytest.approx([ZERO] * len(rows), abs=0.5)
        assert all(STANDS < np.mod(row.time, STEP) < STEP for row in rows)


def test_a_walk_is_scored_by_a_fit_of_standing_logs_that_found_the_imu_turned(robot: RobotModel) -> None:
    unsure = replace(robot, uncertainty=Uncertainty())
    logs = [noisy(record(sway(f"sway_{seed}", seed, duration=30.0)), seed) for seed in (3, 4)]
    known = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
    result = identify_feet(unsure, logs, [stepping(record(sway("walk", 1, duration=15.0)))], known)
    assert any(any(model.imu_turned) for model in result.models if model.foot == "left")
    assert "internal_error" not in {note.code for note in result.notes}
    scored = {(row.foot, row.axis) for row in result.validation if row.motion == "walk"}
    assert {("left", "pitch"), ("left", "roll")} <= scored


def test_the_residuals_say_what_is_not_the_bushs(found: FeetResult) -> None:
    assert found.residuals is not None
    table = found.residuals.to_pydict()
    mine = (np.array(table["foot"]) == "left") & np.array(table["used"])
    angle, rate, predicted, offset = (
        np.array(table[f"pitch.{name}"])[mine] for name in ("deflection", "rate", "predicted", "offset")
    )
    stiffness, damping = (found.parameter("left", "pitch", name).value for name in ("stiffness", "damping"))
    assert predicted - offset == pytest.approx(stiffness * angle + damping * rate, abs=1e-6)


def test_the_zero_is_taken_off(found: FeetResult) -> None:
    assert found.residuals is not None
    table = found.residuals.to_pydict()
    swings = (np.array(table["foot"]) == "left") & (np.array(table["support"]) == "air")
    assert np.median(np.array(table["force_z"])[swings]) == pytest.approx(0.0, abs=0.5)


def test_a_walk_recorded_too_slowly_is_told(robot: RobotModel) -> None:
    logs = [stepping(record(sway(f"walk_{seed}", seed, duration=15.0))) for seed in (1, 2)]
    slow = [
        log.with_columns({name: np.repeat(log.column(name)[::20], 20)[: len(log)] for name in WRENCH})
        for log in logs
    ]
    notes = {
        log.name: [note for note in prepare_log(robot, log) if note.code == "sparse_stances"] for log in slow
    }
    assert all(
        len(found) == 1 and "reads 6 values in a usual stance" in found[0].text for found in notes.values()
    )
    assert not [note for note in prepare_log(robot, logs[0]) if note.code == "sparse_stances"]


def prepare_log(robot: RobotModel, log: MotionLog) -> tuple[Note, ...]:
    return prepare(robot, evenly_sampled(log), "fit").notes


def test_a_bush_that_is_turned_in_the_robot_file_is_told_by_steps(tmp_path: Path) -> None:
    """Of two stiffnesses: each torque shows in the other, K of roll is off by more than its interval."""
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    for foot in feet.values():
        foot["bush"] = {**foot["bush"], "rpy": [0.0, 0.0, 0.2]}
    truth = {
        **TRUTH,
        ("left", "roll"): TRUTH["right", "roll"],
        ("left", "pitch"): BushModel(700.0, 22.0, -1.5),
    }
    logs = [stepping(record(sway(f"walk_{seed}", seed, duration=15.0, truth=truth))) for seed in (1, 2, 3)]
    told = identify_feet(make_robot(tmp_path / "turned", feet=feet), logs, settings=LINEAR)
    rows = [row for row in told.parameters if row.foot == "left" and row.axis != "z"]
    assert any("left: pitch's torque shows in roll" in row.reason for row in rows)
    assert not [row for row in rows if row.verdict == "usable"]
    right = identify_feet(make_robot(tmp_path / "right"), logs, settings=LINEAR)
    assert not [row for row in right.parameters if "shows in roll" in row.reason]


def test_a_leg_that_gives_way_is_no_turned_bush(robot: RobotModel) -> None:
    """Each torque shows a little in the other, and far more is left that nothing explains."""
    random, logs = np.random.default_rng(0), []
    for seed in (1, 2, 3):
        log = stepping(record(sway(f"walk_{seed}", seed, duration=30.0)))
        x, y = (log.column(f"wrench.left.torque.{axis}") for axis in "xy")
        rest = low_pass(random.standard_normal((len(log), 2)), log.period, 4.0) * 5.0 * (x != 0)[:, None]
        changed = {
            "wrench.left.torque.x": x + 0.06 * y + rest[:, 0],
            "wrench.left.torque.y": y + 0.10 * x + rest[:, 1],
        }
        logs.append(log.with_columns(changed))
    found = identify_feet(robot, logs, settings=LINEAR)
    assert not [note for note in found.notes if note.code == BUSH_TURNED]


def test_a_force_sensor_that_is_turned_is_found_from_steps(robot: RobotModel) -> None:
    """About the vertical: each axis' torque shows in the other. Left out, it is stiffness where both axes move."""
    turn, exact, read = 0.03, [], []
    for seed in (1, 2, 3):
        log = stepping(record(sway(f"walk_{seed}", seed, duration=15.0)))
        x, y = (log.column(f"wrench.left.torque.{axis}") for axis in "xy")
        turned = {"wrench.left.torque.x": x + turn * y, "wrench.left.torque.y": y - turn * x}
        exact.append(log)
        read.append(log.with_columns(turned))
    found = {
        name: identify_feet(robot, logs, settings=LINEAR) for name, logs in (("exact", exact), ("read", read))
    }
    by_axis = {model.axis: model.turned for model in found["read"].models if model.foot == "left"}
    assert by_axis == pytest.approx({"pitch": -turn, "roll": turn}, abs=0.006)
    for axis in ("pitch", "roll"):
        told, truth = (found[name].parameter("left", axis, "stiffness").value for name in ("read", "exact"))
        assert told == pytest.approx(truth, rel=0.004)


@pytest.mark.parametrize("steps", [False, True])
def test_in_stances_only_a_spring_and_one_that_slips_are_tried(
    steps: bool, robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stance is too short to tell more models apart, and there another model has to gain more."""
    tried: list[tuple[set[str], float]] = []

    def told(data_sets: object, models: Sequence[Any], *_: object, least_gain: float, **__: object) -> None:
        tried.append(({model.name for model in models}, least_gain))
        raise StopIteration

    monkeypatch.setattr("plantar.feet.fit.axis_fit.choose_model", told)
    monkeypatch.setattr("plantar.feet.fit.axis_fit.FULLY_EXPLAINED", 1.0)
    logs = [noisy(record(sway(f"walk_{seed}", seed, duration=12.0)), seed) for seed in (1, 2)]
    made = [prepare(robot, evenly_sampled(stepping(log) if steps else log), "fit") for log in logs]
    with pytest.raises(StopIteration):
        fit_axis(made, "left", "pitch", FeetSettings())
    usual = {"kelvin_voigt", "elastoplastic"}
    ((names, gain),) = tried
    assert names == usual if steps else names > usual
    assert gain == (0.5 if steps else 0.1)

"""A recording in memory: immutable, whole, and clear about what it lacks."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from example_robots import talos_file
from plantar.errors import LogError
from plantar.logs.inputs import logs_of
from plantar.logs.motion_log import COLUMN, MotionLog, imu_columns
from plantar.logs.readers import open_log
from plantar.logs.save import save_log
from plantar.notes import Note
from plantar.robot.model import RobotModel, load_robot


def make(**columns: list[float]) -> MotionLog:
    named = {name.replace("__", "."): np.array(values) for name, values in columns.items()}
    return MotionLog("tilt", np.arange(3) * 0.1, named)


def test_a_log_cannot_be_changed() -> None:
    position, time = np.array([1.0, 2.0, 3.0]), np.arange(3) * 0.1
    log = MotionLog("tilt", time, {"joint.a.position": position})
    with pytest.raises(ValueError, match="read-only"):
        log.time[0] = 5.0
    with pytest.raises(ValueError, match="read-only"):
        log.column("joint.a.position")[0] = 5.0
    with pytest.raises(TypeError):
        log.columns["joint.b.position"] = position  # type: ignore[index]
    with pytest.raises(FrozenInstanceError):
        log.name = "other"  # type: ignore[misc]
    position[0], time[0] = 9.0, -9.0
    assert log.column("joint.a.position")[0] == 1.0, "the caller's arrays are not shared"
    assert log.time[0] == 0.0
    assert position.flags.writeable, "and stay the caller's own"


def test_values_become_float64() -> None:
    log = MotionLog("tilt", np.arange(3), {"joint.a.position": np.array([1, 2, 3], dtype=np.float32)})
    assert log.time.dtype == log.column("joint.a.position").dtype == np.float64


def test_texts_are_no_numbers() -> None:
    with pytest.raises(
        LogError,
        match=r"^tilt, column 'joint\.a\.position': holds no numbers: could not convert string to "
        r"float: np\.str_\('on'\)$",
    ):
        MotionLog("tilt", np.arange(2.0), {"joint.a.position": np.array(["1", "on"])})
    with pytest.raises(
        LogError, match=r"^tilt, column 'time': holds no numbers: could not convert string to float: 'a'$"
    ):
        MotionLog("tilt", ["a", "b"], {})  # type: ignore[arg-type]


def test_lengths_and_time_are_checked() -> None:
    with pytest.raises(LogError, match=r"tilt, column 'joint\.a\.position': has 2 values where time has 3"):
        make(joint__a__position=[1.0, 2.0])
    for bad in ([0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [0.0, np.nan, 1.0]):
        with pytest.raises(LogError, match=r"column 'time', t = .* does not increase"):
            MotionLog("tilt", np.array(bad), {})
    with pytest.raises(LogError, match=r"^tilt, column 'time', t = 2 s, value 1\.5: does not increase$"):
        MotionLog("tilt", np.array([0.0, 1.0, 2.0, 1.5, 1.0]), {})
    with pytest.raises(LogError, match=r"^tilt, column 'time': holds fewer than two samples$"):
        MotionLog("tilt", np.array([0.0]), {})


def test_a_missing_column_is_named_with_its_neighbours() -> None:
    log = make(joint__knee__position=[1.0, 2.0, 3.0])
    with pytest.raises(
        LogError,
        match=r"^tilt, column 'joint\.kne\.position': is missing \(valid: the log has "
        r"joint\.knee\.position\)$",
    ):
        log.column("joint.kne.position")
    assert log.has("joint.knee.position")
    assert not log.has("joint.knee.position", "joint.hip.position")
    assert log.joint("knee", "effort") is None


def test_a_sensor_of_another_name_is_answered_with_the_names_that_the_log_has() -> None:
    log = make(wrench__lfoot__force__z=[1.0, 2.0, 3.0])
    assert log.devices("wrench") == ["wrench.lfoot"]
    assert log.devices("imu") == []
    with pytest.raises(
        LogError,
        match=r"is missing \(valid: in the robot file wrench\.name as the log has it: lfoot; and no foot without",
    ):
        log.column("wrench.left.force.z")
    with pytest.raises(
        LogError,
        match=r"^tilt, column 'wrench\.lfoot\.force\.x': is missing \(valid: the log has "
        r"wrench\.lfoot\.force\.z\)$",
    ):
        log.column("wrench.lfoot.force.x")


def test_vectors_are_stacked_in_the_contracts_order() -> None:
    parts = [f"wrench.left.{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]
    log = MotionLog(
        "tilt", np.arange(3.0), {name: np.full(3, float(i)) for i, name in enumerate(reversed(parts))}
    )
    np.testing.assert_array_equal(log.wrench("left")[0], [5, 4, 3, 2, 1, 0])
    assert log.orientation("chest") is None
    partial = MotionLog("tilt", np.arange(3.0), {"imu.chest.orientation.w": np.ones(3)})
    with pytest.raises(
        LogError,
        match=r"^tilt, column 'imu\.chest\.orientation\.x': is missing \(valid: the log has "
        r"imu\.chest\.orientation\.w\)$",
    ):
        partial.orientation("chest")


def test_each_sensor_has_its_own_columns() -> None:
    kinds = {"orientation": "wxyz", "angular_velocity": "xyz", "linear_acceleration": "xyz"}
    names = [f"imu.chest.{kind}.{axis}" for kind, axes in kinds.items() for axis in axes]
    names += [f"joint.knee.{kind}" for kind in ("position", "velocity", "acceleration", "effort")]
    log = MotionLog("tilt", np.arange(3.0), {name: np.full(3, float(i)) for i, name in enumerate(names)})
    orientation = log.orientation("chest")
    assert orientation is not None
    assert orientation[0].tolist() == [0, 1, 2, 3]
    assert log.angular_velocity("chest")[0].tolist() == [4, 5, 6]
    assert log.linear_acceleration("chest")[0].tolist() == [7, 8, 9]
    read = [log.joint("knee", kind) for kind in ("position", "velocity", "acceleration", "effort")]
    assert [values[0] for values in read if values is not None] == [10, 11, 12, 13]


@pytest.mark.parametrize(
    ("columns", "vertical"),
    [
        ({}, True),
        ({"force.x": 1.0}, False),
        ({"torque.z": 1.0}, False),
        ({"force.z": 0.0}, False),
        ({"torque.x": 2.0}, True),
    ],
)
def test_vertical_cells_read_no_horizontal_force_and_no_yaw(
    columns: dict[str, float], vertical: bool
) -> None:
    read = (
        {f"{kind}.{axis}": 0.0 for kind in ("force", "torque") for axis in "xyz"}
        | {"force.z": 300.0}
        | columns
    )
    log = MotionLog(
        "tilt", np.arange(3.0), {f"wrench.left.{name}": np.full(3, own) for name, own in read.items()}
    )
    assert log.vertical_only("left") == vertical
    assert not log.vertical_only("right")


def test_duration_and_period_survive_a_gap() -> None:
    time = np.concatenate([np.arange(10), np.arange(10) + 100]) * 0.01
    log = MotionLog("tilt", time, {})
    assert log.period == pytest.approx(0.01)
    assert log.duration == pytest.approx(1.09)
    assert len(log) == 20


def test_positions_follow_the_robot_and_missing_joints_stand_at_zero(robot: RobotModel) -> None:
    log = record(sway(duration=1.0))
    kept = {
        name: values
        for name, values in log.columns.items()
        if "neck" not in name and "right_ankle_roll" not in name
    }
    log = MotionLog(
        log.name, log.time, {**kept, "joint.tail.position": log.time, "joint.neck.effort": log.time}
    )
    positions = log.positions(robot)
    assert positions.shape == (len(log), len(robot.joint_names))
    for place, name in enumerate(robot.joint_names):
        expected = log.columns.get(f"joint.{name}.position", np.zeros(len(log)))
        np.testing.assert_array_equal(positions[:, place], expected)
    notes = {note.code: note.text for note in log.joint_notes(robot)}
    assert set(notes) == {"joint_missing", "joint_unknown"}
    assert "neck" in notes["joint_missing"]
    assert "right_ankle_roll" in notes["joint_missing"]
    assert "tail" in notes["joint_unknown"]
    assert "neck" not in notes["joint_unknown"]


def test_only_joints_that_no_foot_needs_are_cut_short(tmp_path: Path) -> None:
    """Of the robot's twenty or more arm and waist joints three are named; of the legs' six all."""
    robot, bare = load_robot(talos_file(tmp_path)), np.arange(3.0)
    every = {f"joint.{name}.position": bare for name in robot.joint_names}
    on_path = [name for name in robot.joint_names if name in robot.path_joints]
    others = [name for name in robot.joint_names if name not in robot.path_joints]
    without = [f"joint.{name}.position" for name in others]
    (note,) = MotionLog("a", bare, {k: v for k, v in every.items() if k not in without}).joint_notes(robot)
    assert note.text.endswith(
        f"{', '.join(others[:3])} and {len(others) - 3} more; none lies between IMU and feet"
    )
    needed = [f"joint.{name}.position" for name in on_path[:6]]
    (note,) = MotionLog("a", bare, {k: v for k, v in every.items() if k not in needed}).joint_notes(robot)
    assert note.text.endswith(", ".join(on_path[:6]))


def test_a_position_that_never_holds_a_value_was_not_recorded(tmp_path: Path, robot: RobotModel) -> None:
    """It would empty every row, and feet that stand would be said to carry nothing."""
    empty = np.full(5, np.nan)
    half = np.array([np.nan, 1.0, np.nan, 2.0, 3.0])
    columns = {
        "joint.left_ankle_pitch.position": empty,
        "joint.neck.position": half,
        "joint.neck.effort": empty,
    }
    log = MotionLog("empty", 0.01 * np.arange(5), columns)
    save_log(log, tmp_path / "empty.csv")
    for found in (open_log(tmp_path / "empty.csv", robot), *logs_of(log, robot)):
        assert list(found.columns) == ["joint.neck.position", "joint.neck.effort"]
        (note,) = (note for note in found.notes if note.code == "joint_empty")
        assert "joint.left_ankle_pitch.position" in note.text
        assert np.isfinite(found.positions(robot)[1]).all()
    whole = log.without_empty_joints()
    assert whole.without_empty_joints() is whole


def test_selecting_and_adding_leave_the_original_alone() -> None:
    log = make(joint__a__position=[1.0, 2.0, 3.0])
    part = log.select(slice(1, 3))
    assert len(part) == 2
    assert part.column("joint.a.position")[0] == 2.0
    assert len(log.select(np.array([True, False, True]))) == 2
    more = log.with_columns({"joint.a.effort": np.ones(3)}, Note("why", "info", "because"))
    assert more.has("joint.a.effort")
    assert not log.has("joint.a.effort")
    assert [note.code for note in more.notes] == ["why"]
    assert log.notes == ()


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("joint.leg_left_1.position", True),
        ("joint.a.b.acceleration", True),
        ("imu.chest.orientation.w", True),
        ("imu.chest.angular_velocity.w", False),
        ("wrench.l.torque.z", True),
        ("wrench.l.torque", False),
        ("joint..position", False),
        ("Joint.a.position", False),
        ("joint.a.position ", False),
    ],
)
def test_the_contracts_column_names(name: str, known: bool) -> None:
    assert bool(COLUMN.fullmatch(name)) == known


def test_an_imu_is_there_with_all_its_columns_or_not_at_all() -> None:
    time = np.arange(5) * 0.01
    names = imu_columns("chest", "angular_velocity", "orientation")
    assert names[:3] == tuple(f"imu.chest.angular_velocity.{axis}" for axis in "xyz")
    assert names[3:] == tuple(f"imu.chest.orientation.{axis}" for axis in "wxyz")
    log = MotionLog("still", time, dict.fromkeys(names[:3], np.zeros(5)))
    assert log.has_imu("chest", "angular_velocity")
    assert not log.has_imu("chest", "angular_velocity", "orientation")
    assert not log.has_imu("head", "angular_velocity")


def test_joints_that_no_foot_needs_are_told_in_short(robot: RobotModel) -> None:
    time = np.linspace(0.0, 1.0, 11)
    named = {f"joint.{name}.position": time for name in robot.joint_names}
    without = {name: values for name, values in named.items() if "neck" not in name}
    (note,) = MotionLog("a", time, without).joint_notes(robot)
    assert note.text.endswith("neck; none lies between IMU and feet")
    lacking = {name: values for name, values in without.items() if "left_ankle_roll" not in name}
    assert len(lacking) < len(without)
    (note,) = MotionLog("a", time, lacking).joint_notes(robot)
    assert "none lies" not in note.text


def test_what_is_no_joint_is_not_told_as_one(robot: RobotModel) -> None:
    time = np.linspace(0.0, 1.0, 11)
    columns = {f"joint.{name}.position": time for name in robot.joint_names}
    others = ("wrench.left.force.z", "imu.chest.orientation.w", "joint.neck.effort")
    assert MotionLog("a", time, columns | dict.fromkeys(others, time)).joint_notes(robot) == ()
    (note,) = MotionLog("a", time, columns | {"joint.tail.effort": time, others[0]: time}).joint_notes(robot)
    assert note.text == "a: recorded, but not in the URDF, not used: tail"

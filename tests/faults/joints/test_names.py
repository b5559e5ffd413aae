"""A log whose joints are not the URDF's is refused in one line, which proposes a naming."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot, write_robot
from plantar.cli import main
from plantar.errors import DataError
from plantar.faults.joints.names import check_joint_names, legs, recorded_joints
from plantar.faults.log_faults import check_log
from plantar.feet.identify import identify_feet
from plantar.inspection import inspect_log
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log
from renamed_joints import renamed


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway(duration=6.0))


def test_a_log_of_other_joints_is_an_error_that_proposes_the_prefix(tmp_path: Path, log: MotionLog) -> None:
    robot, other = make_robot(tmp_path), renamed(log, prefix="biped/")
    with pytest.raises(
        DataError,
        match=r"^sway: columns 'joint\.\*\.position': do not hold any joint of the URDF "
        r"\(left_ankle_pitch, left_ankle_roll, left_leg_x and 8 more\); the log's "
        r"biped/left_ankle_pitch, biped/left_ankle_roll, biped/left_leg_x and 8 more look like "
        r"them \(valid: 'joint_names: \{prefix: biped/\}' in the robot file\)$",
    ) as caught:
        identify_feet(robot, [other])
    assert "\n" not in str(caught.value)
    assert any(
        finding.code == "joint_names" and finding.fatal for finding in inspect_log(robot, other).findings
    )
    assert not [finding for finding in check_log(robot, log) if finding.code == "joint_names"]


def test_a_log_without_one_leg_is_an_error(tmp_path: Path, log: MotionLog) -> None:
    robot = make_robot(tmp_path)
    columns = {name: values for name, values in log.columns.items() if not name.startswith("joint.left_")}
    lame = MotionLog("lame", log.time, columns)
    (found,) = check_joint_names(robot, lame)
    assert found.fatal
    assert "any joint between IMU and left foot" in found.text
    without_neck = {name: values for name, values in log.columns.items() if "neck" not in name}
    fine = MotionLog("fine", log.time, without_neck)
    assert not list(check_joint_names(robot, fine))


def test_a_log_that_only_numbers_the_joints_is_an_error_that_names_the_order(
    tmp_path: Path, log: MotionLog
) -> None:
    robot = make_robot(tmp_path)
    numbers = {joint: str(place) for place, joint in enumerate(robot.joint_names)}
    (found,) = check_joint_names(robot, renamed(log, numbers))
    assert found.fatal
    assert found.text == (
        "columns 'joint.*.position': do not hold any joint of the URDF (left_ankle_pitch, left_ankle_roll, left_leg_x "
        "and 8 more); the log only numbers them: 0, 1, 10 and 8 more (valid: 'joint_names: {renamed: {left_leg_x: '0', "
        "left_leg_y: '1', left_leg_z: '2', ...}}' in the robot file, if the log has the URDF's order; plantar init "
        "writes it whole)"
    )


def test_inspect_prints_one_line_and_fails(
    tmp_path: Path, log: MotionLog, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_robot(tmp_path)
    save_log(renamed(log, prefix="b_"), tmp_path / "sway.csv")
    with pytest.raises(SystemExit) as left:
        main(["inspect", str(path), str(tmp_path / "sway.csv")])
    assert left.value.code == 1
    assert "joint_names: {prefix: b_}" in " ".join(capsys.readouterr().out.split())


def test_a_joint_without_any_value_is_not_recorded(log: MotionLog) -> None:
    empty = log.with_columns({"joint.neck.position": np.full(len(log), np.nan)})
    assert recorded_joints(log) - recorded_joints(empty) == {"neck"}


def test_a_joint_that_both_feet_hang_from_is_no_legs_own() -> None:
    """A waist lies between a chest's IMU and either foot."""
    paths = {"left": {"waist", "left_knee", "left_hip"}, "right": {"waist", "right_knee"}}
    robot = SimpleNamespace(
        imu=SimpleNamespace(placement=None),
        feet={name: SimpleNamespace(bush=name) for name in paths},
        joints_between=lambda _, bush: paths[bush],
        joint_names=("waist", "left_hip", "left_knee", "right_knee", "arm"),
    )
    assert legs(robot) == {"left": ["left_hip", "left_knee"], "right": ["right_knee"]}  # type: ignore[arg-type]

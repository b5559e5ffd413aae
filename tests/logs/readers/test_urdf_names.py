"""Logs read under the URDF's names, where the robot file says what the logs call the joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import URDF, make_robot, write_robot
from plantar.errors import LogError
from plantar.faults.log_faults import check_log
from plantar.logs.inputs import logs_of
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.save import save_log
from plantar.robot.model import load_robot
from renamed_joints import renamed


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway(duration=6.0))


def test_the_robot_file_says_what_the_log_calls_its_joints(tmp_path: Path, log: MotionLog) -> None:
    save_log(renamed(log, {"neck": "Hals"}, prefix="biped/"), tmp_path / "sway.csv")
    names = {"prefix": "biped/", "renamed": {"neck": "Hals"}}
    robot = make_robot(tmp_path, joint_names=names)
    read = open_log(tmp_path / "sway.csv", robot)
    for joint in robot.joint_names:
        if log.has(f"joint.{joint}.position"):
            np.testing.assert_allclose(
                read.column(f"joint.{joint}.position"), log.column(f"joint.{joint}.position"), atol=1e-12
            )
    assert not [found for found in check_log(robot, read) if found.code == "joint_names"]
    save_log(log, tmp_path / "own.csv")
    assert set(open_log(tmp_path / "own.csv", robot).columns) == set(log.columns), "the URDF's names stay"


def test_a_log_that_holds_a_joint_twice_is_refused(tmp_path: Path, log: MotionLog) -> None:
    both = {**log.columns, "joint.Hals.position": log.column("joint.left_ankle_roll.position")}
    save_log(MotionLog("twice", log.time, both), tmp_path / "twice.csv")
    robot = make_robot(tmp_path, joint_names={"renamed": {"left_ankle_roll": "Hals"}})
    with pytest.raises(
        LogError,
        match=r"twice\.csv, column 'joint\.Hals\.position': is 'joint\.left_ankle_roll\.position' by "
        r"the robot file's joint_names, which the log also holds \(valid: one of the two\)$",
    ):
        open_log(tmp_path / "twice.csv", robot)


def test_a_joint_that_is_not_recorded_follows_the_one_that_it_mimics(tmp_path: Path, log: MotionLog) -> None:
    file = write_robot(tmp_path)
    neck = '<joint name="neck" type="revolute">'
    mimic = f'{neck}<mimic joint="left_ankle_roll" multiplier="-2" offset="0.1"/>'
    (tmp_path / "biped.urdf").write_text(URDF.replace(neck, mimic))
    robot = load_robot(file)
    bare = {name: values for name, values in log.columns.items() if not name.startswith("joint.neck.")}
    save_log(MotionLog("bare", log.time, bare), tmp_path / "bare.csv")
    leader = log.column("joint.left_ankle_roll.position")
    (in_memory,) = logs_of(MotionLog("bare", log.time, bare), robot)
    for found in (open_log(tmp_path / "bare.csv", robot), in_memory):
        np.testing.assert_allclose(found.column("joint.neck.position"), 0.1 - 2 * leader, atol=1e-12)
        (note,) = found.notes
        assert note.code == "joint_mimics"
        assert "neck from left_ankle_roll" in note.text
    save_log(MotionLog("whole", log.time, bare | {"joint.neck.position": leader}), tmp_path / "whole.csv")
    whole = open_log(tmp_path / "whole.csv", robot)
    np.testing.assert_allclose(whole.column("joint.neck.position"), leader, atol=1e-12)
    assert not whole.notes, "what was recorded stays"

"""An encoder that keeps one value while its leg steps is told; a joint that no leg uses is not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from biped import record, sway
from plantar.faults.joints.stepping_joints import check_stepping_joints
from plantar.faults.log_faults import check_log
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

LIFTED = (("left", 6.0, 8.0), ("right", 10.0, 12.0), ("left", 14.0, 16.0))


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway(lifts=LIFTED))


def held(log: MotionLog, joints: Sequence[str], start: float, stop: float) -> MotionLog:
    """The log in which encoders repeat one value between two times [s], and no velocity tells otherwise."""
    columns = {name: values for name, values in log.columns.items() if not name.endswith(".velocity")}
    for joint in joints:
        values = columns[f"joint.{joint}.position"].copy()
        inside = (log.time >= start) & (log.time < stop)
        values[inside] = values[inside][0]
        columns[f"joint.{joint}.position"] = values
    return MotionLog(log.name, log.time, columns)


@pytest.mark.parametrize(("start", "stop"), [(0.0, 30.0), (5.0, 9.0), (13.0, 30.0)])
def test_an_encoder_that_stands_while_its_leg_steps_is_told(
    robot: RobotModel, log: MotionLog, start: float, stop: float
) -> None:
    dead = held(log, ["left_ankle_pitch"], start, stop)
    (found,) = check_stepping_joints(robot, dead)
    assert (found.code, found.fatal, found.severity) == ("stuck_channel", False, "warning")
    assert f"column 'joint.left_ankle_pitch.position', t = {start:g} to " in found.text
    said = found.text.partition(": stands still ")[2]
    assert said.startswith("while its leg steps and 'right_ankle_pitch' turns 0.0")
    assert said.endswith(" rad; is the encoder dead? (valid: leave such cells empty)")
    assert found in check_log(robot, dead)


@pytest.mark.parametrize(
    ("joints", "start", "stop"),
    [
        ([], 0.0, 0.0),
        (["left_ankle_pitch", "right_ankle_pitch"], 0.0, 30.0),  # nobody uses it
        (["left_ankle_pitch"], 0.0, 5.5),  # both feet stand
        (["left_ankle_pitch"], 8.5, 13.5),  # the other leg steps
        (["left_ankle_pitch"], 6.5, 7.5),  # held up
        (["left_ankle_pitch"], 5.0, 7.5),  # lifted once
    ],
)
def test_what_may_stand_still_is_not_told(
    robot: RobotModel, log: MotionLog, joints: Sequence[str], start: float, stop: float
) -> None:
    assert not list(check_stepping_joints(robot, held(log, joints, start, stop)))


def test_an_encoder_that_was_not_recorded_for_a_while_is_none_that_stands(
    robot: RobotModel, log: MotionLog
) -> None:
    gone = held(log, [], 0.0, 0.0)
    values = gone.column("joint.left_ankle_pitch.position").copy()
    values[500:900] = np.nan
    assert not list(
        check_stepping_joints(robot, gone.with_columns({"joint.left_ankle_pitch.position": values}))
    )


def test_a_foot_that_bounces_as_it_lands_makes_no_step(robot: RobotModel, log: MotionLog) -> None:
    """Its coarse encoder stands between two steps of its own for a fifth of a second, while the other leg turns."""
    forces = [f"wrench.{robot.feet['left'].wrench.name}.force.{axis}" for axis in "xyz"]
    bounces = ((log.time > 8.1) & (log.time < 8.15)) | ((log.time > 10.5) & (log.time < 10.55))
    bouncing = log.with_columns({name: np.where(bounces, 0.0, log.column(name)) for name in forces})
    assert not list(check_stepping_joints(robot, held(bouncing, ["left_ankle_pitch"], 10.4, 11.3)))
    assert list(check_stepping_joints(robot, held(bouncing, ["left_ankle_pitch"], 5.0, 11.6)))

"""A bush on a link above the ankle is told: the joint below it moves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from plantar.faults.bush_frames import check_bush_link
from plantar.faults.log_faults import check_log
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

TURNED = 0.02


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway())


@pytest.fixture
def above(robot: RobotModel) -> RobotModel:
    """The robot whose left bush hangs on the link above its last one."""
    carrier, _ = robot.frame(robot.feet["left"].bush)
    parent = robot.model.names[robot.model.parents[carrier]]
    link = next(
        frame.name for frame in robot.model.frames if frame.parentJoint == robot.model.parents[carrier]
    )
    assert parent.startswith("left_")
    foot = robot.feet["left"]
    moved = replace(foot, bush=replace(foot.bush, link=link))
    return replace(robot, feet={**robot.feet, "left": moved})


def test_a_bush_above_a_moving_joint_is_told(above: RobotModel, log: MotionLog) -> None:
    (found,) = check_bush_link(above, log)
    assert found.code == "bush_link"
    assert not found.fatal
    moved = float(np.ptp(log.column("joint.left_ankle_roll.position")))
    assert found.text == (
        "robot file, feet.left.bush.link: 'left_ankle_pitch' has the joint 'left_ankle_roll' below it: it moves by "
        f"{moved:.2g} rad and turns the sole unseen (valid: the last link of the leg)"
    )
    assert found in check_log(above, log)
    result = identify_feet(above, [log])
    left = [row for row in result.parameters if row.foot == "left" and row.axis != "z"]
    assert not [row for row in left if row.verdict == "usable"]


def test_the_last_link_and_joints_that_stand_are_fine(
    robot: RobotModel, above: RobotModel, log: MotionLog
) -> None:
    assert list(check_bush_link(robot, log)) == []
    joints = [name for name in log.columns if name.startswith("joint.left_ankle")]
    still = log.with_columns({name: np.clip(log.column(name), 0.0, TURNED) for name in joints})
    assert list(check_bush_link(above, still)) == []

"""Encoders that died: a position that stands still while the velocity beside it goes on."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from plantar.checks.log_checks import check_log
from plantar.errors import DataError
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

JOINT = "right_ankle_pitch"


def held(log: MotionLog, start: int, stop: int) -> MotionLog:
    """The log in which one encoder repeats its value between two samples."""
    name = f"joint.{JOINT}.position"
    values = log.column(name).copy()
    values[start:stop] = values[start]
    return log.with_columns({name: values})


@pytest.mark.parametrize(("start", "stop"), [(0, 2001), (700, 2001), (900, 1000)])
def test_a_position_that_stands_while_its_velocity_turns_is_refused(
    robot: RobotModel, start: int, stop: int
) -> None:
    log = held(record(sway()), start, stop)
    found = [finding for finding in check_log(robot, log) if finding.code == "dead_channel"]
    assert len(found) == 1
    assert found[0].fatal
    assert f"joint.{JOINT}.position" in found[0].text
    assert f"t = {log.time[start]:g}" in found[0].text
    with pytest.raises(DataError, match="the encoder is dead"):
        identify_feet(robot, [log])


def test_coarse_encoders_and_still_joints_are_not_dead(robot: RobotModel) -> None:
    log = record(sway())
    position, velocity = f"joint.{JOINT}.position", f"joint.{JOINT}.velocity"
    coarse = log.with_columns({position: np.round(log.column(position) / 5e-3) * 5e-3})
    still = log.with_columns({position: np.full(len(log), 0.1), velocity: np.full(len(log), 0.02)})
    silent = held(
        MotionLog(log.name, log.time, {k: v for k, v in log.columns.items() if k != velocity}), 0, 2001
    )
    for each in (coarse, still, silent):
        assert not [finding for finding in check_log(robot, each) if "encoder" in finding.text]

"""A robot whose joints bend beyond their encoders is played where its links were."""

from __future__ import annotations

from typing import Never

import numpy as np
import pytest

from before_gears import before_gears
from plantar.comparison import compare as room
from plantar.comparison.compare import compare
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import DelayEstimate
from plantar.robot.model import RobotModel
from plantar.sensors.delays.refined_delays import read_in_time
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2

COMPLIANCE, LATE = 2e-4, 0.03  # rad/(N.m), s
LEGS = [f"{side}LEG_JOINT{place}" for side in "LR" for place in range(6)]


class Planned(Exception):
    """Enough is known: nothing is to be simulated."""


def test_joints_are_played_where_the_links_were(monkeypatch: pytest.MonkeyPatch) -> None:
    """With forces that are late, the torques of the same moment bend the joints."""
    twin, planned = hrp2.robot(), list[MotionLog]()
    log = play_all(["Tilt3"], twin, PAPER, "ideal", [0])[0][0].log
    bent = read_in_time(twin, before_gears(twin, log, COMPLIANCE, LEGS), np.array([-LATE, -LATE, 0.0]))

    def plan_of(robot: RobotModel, log: MotionLog) -> Never:
        planned.append(log)
        raise Planned

    monkeypatch.setattr(room, "plan_of", plan_of)
    for bends in ({}, dict.fromkeys(LEGS, COMPLIANCE)):
        result = FeetResult(
            "hrp2_like", (), {}, "kelvin_voigt", (), (), (), (), (),
            sensor_delay=DelayEstimate(LATE, 0.0, True), joint_compliance=bends,
        )  # fmt: skip
        with pytest.raises(Planned):
            compare(result, twin, [bent])
    inside = slice(20, -20)  # what was shifted lacks its ends
    right, read, put = (one.positions(twin)[inside] for one in (log, *planned))
    assert np.abs(read - right).max() > 5e-3
    assert np.abs(put - right).max() < 0.03 * np.abs(read - right).max()

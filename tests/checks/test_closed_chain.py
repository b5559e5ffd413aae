"""Encoders that stand still while both legs' closed chain says that their joint moves."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sines, sway
from feet_trials import noisy
from plantar.checks.closed_chain import check_closed_chain
from plantar.errors import DataError
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return noisy(record(sway()), 1)


def stuck(log: MotionLog, joint: str, start: int = 0, stop: int = 2001) -> MotionLog:
    """The log in which one encoder repeats its value, so that the velocity made from it is zero."""
    position, velocity = (log.column(f"joint.{joint}.{kind}").copy() for kind in ("position", "velocity"))
    position[start:stop], velocity[start:stop] = position[start], 0.0
    return log.with_columns({f"joint.{joint}.position": position, f"joint.{joint}.velocity": velocity})


@pytest.mark.parametrize("joint", ["right_ankle_pitch", "left_ankle_roll"])
@pytest.mark.parametrize(("start", "stop"), [(0, 2001), (900, 2001), (300, 800)])
def test_a_stuck_encoder_is_found_and_named(
    robot: RobotModel, log: MotionLog, joint: str, start: int, stop: int
) -> None:
    spoilt = stuck(log, joint, start, stop)
    (finding,) = check_closed_chain(robot, spoilt)
    assert finding.fatal
    assert f"column 'joint.{joint}.position', t = {log.time[start + 1]:g}" in finding.text
    moved = float(np.ptp(log.column(f"joint.{joint}.position")[start:stop]))
    said = float(finding.text.split("moves it by ")[1].split(";")[0])
    assert said == pytest.approx(moved, rel=0.2)
    with pytest.raises(DataError, match="the encoder is dead"):
        identify_feet(robot, [spoilt])


def test_joints_that_stand_are_not_dead(robot: RobotModel) -> None:
    """Ankles that hold their angle, the one under a foot in the air, and encoders that read in coarse steps."""

    def still(t: np.ndarray) -> np.ndarray:
        return 0.0 * t + 0.02

    moving = sway()
    stands = sway(ankles={**moving.ankles, "right": (still, still)})
    assert not list(check_closed_chain(robot, record(stands)))
    lifted = sway(ankles=stands.ankles, lifts=(("right", -1.0, 30.0),))
    assert not list(check_closed_chain(robot, record(lifted)))
    log, name = record(moving), "joint.left_ankle_pitch.position"
    assert not list(
        check_closed_chain(robot, log.with_columns({name: np.round(log.column(name) / 0.05) * 0.05}))
    )


def test_exchanged_legs_are_refused(robot: RobotModel) -> None:
    """The torso turns to and fro, so that one leg reaches forward as the other reaches back."""
    log = record(sway(duration=20.0, torso=(sines(), sines(), sines((0.1, 0.3, 0.0)))))
    assert not list(check_closed_chain(robot, log))
    sides = {"left": "right", "right": "left"}
    exchanged = {
        name: log.column(name.replace(side, sides[side]))
        for name in log.columns
        for side in sides
        if name.startswith(f"joint.{side}_")
    }
    (found,) = check_closed_chain(robot, log.with_columns(exchanged))
    assert (found.code, found.fatal) == ("joint_names", True)
    assert "legs look exchanged" in found.text


def test_a_sole_that_slides_may_be_a_stuck_encoder(robot: RobotModel) -> None:
    """Its path may look like the angle of a joint that stands; the torque does not follow, so nothing is refused."""

    def still(t: np.ndarray) -> np.ndarray:
        return 0.0 * t

    log = record(sway(ankles={**sway().ankles, "right": (still, still)}))
    slide = log.column("joint.right_leg_x.position") + 0.01 * np.sin(1.1 * log.time)
    findings = list(check_closed_chain(robot, log.with_columns({"joint.right_leg_x.position": slide})))
    assert {(one.code, one.fatal) for one in findings} == {("stuck_channel", False)}
    assert all("did a sole slide" in one.text for one in findings)

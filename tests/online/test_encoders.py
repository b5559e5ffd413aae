"""An encoder that stands still for seconds while the robot moves, and good encoders that repeat themselves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import TRUTH, Motion, record, sines, sway, times
from biped_robot import write_robot
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.robot.model import RobotModel, load_robot

NOISE = 2e-5  # rad or m, of a good encoder
FINE = 1e-5  # rad or m, the steps of REEM-C's
COARSE = 1.5e-3  # rad or m, the steps of iCub's


@pytest.fixture
def robot(tmp_path: Path) -> RobotModel:
    return load_robot(write_robot(tmp_path))


def read(log: MotionLog, steps: float = 0.0) -> MotionLog:
    """What encoders of such steps read of a log; of no steps, noisy ones. IMU and force sensors have a little noise."""
    random, changed = np.random.default_rng(0), {}
    for name, values in log.columns.items():
        if not name.startswith("joint."):
            changed[name] = values + 1e-6 * random.normal(size=len(values))
        elif steps:
            changed[name] = steps * np.round(values / steps)
        else:
            changed[name] = values + NOISE * random.normal(size=len(values))
    return log.with_columns(changed)


def stuck(log: MotionLog, joints: tuple[str, ...], begin: float, end: float) -> MotionLog:
    during, changed = (log.time >= begin) & (log.time < end), {}
    for joint in joints:
        values = log.column(f"joint.{joint}.position").copy()
        values[during] = values[during][0]
        changed[f"joint.{joint}.position"] = values
    return log.with_columns(changed)


def frozen(replay: Replay, foot: str) -> np.ndarray:
    return (replay.column(foot, "flags").astype(int) & Flag.FROZEN) > 0


def replayed(robot: RobotModel, log: MotionLog) -> Replay:
    return FootEstimator(robot, wrench_delay=0.0).replay(log)


def standing_between(duration: float) -> Motion:
    """A sway that pauses: from 20 to 30 s nothing moves."""
    whole = sway(duration=duration)

    def paused(angle):  # type: ignore[no-untyped-def]
        return lambda t: angle(np.where(t < 20.0, t, np.maximum(t - 10.0, 20.0)))

    torso = tuple(paused(one) for one in whole.torso)
    ankles = {foot: tuple(paused(one) for one in both) for foot, both in whole.ankles.items()}
    return replace(whole, torso=torso, ankles=ankles, shift=0.0)


@pytest.mark.parametrize(
    ("steps", "rate", "seconds"),
    [(0.0, 100.0, 0.2), (0.0, 50.0, 0.2), (FINE, 200.0, 1.0), (COARSE, 100.0, 5.0)],
)
def test_an_encoder_that_stands_while_the_robot_moves_is_frozen(
    robot: RobotModel, steps: float, rate: float, seconds: float
) -> None:
    motion = sway(duration=60.0)
    log = read(record(motion, at=times(motion, rate)), steps)
    replay = replayed(robot, stuck(log, ("left_ankle_pitch",), 30.0, 38.0))
    told, time = frozen(replay, "left"), replay.time
    assert told[(time > 30.0 + seconds) & (time < 38.0)].all()
    assert not told[(time < 30.0) | (time > 38.2)].any()
    assert not frozen(replay, "right").any()
    found, truth = replay.estimate("left").pitch.stiffness.value, TRUTH["left", "pitch"].stiffness
    assert found == pytest.approx(truth, rel=0.02)


def test_an_encoder_that_stands_in_a_slow_motion_makes_no_other_ground(robot: RobotModel) -> None:
    """Too slow to tell it from a leg that stands while the other moves."""
    whole = sway(duration=80.0)

    def slowed(angle):  # type: ignore[no-untyped-def]
        return lambda t: angle(np.where(t < 50.0, t, 50.0 + 0.1 * (t - 50.0)))

    ankles = {foot: tuple(slowed(one) for one in both) for foot, both in whole.ankles.items()}
    slow = replace(whole, torso=tuple(slowed(one) for one in whole.torso), ankles=ankles)
    log = read(record(slow, at=times(slow, 200.0)), FINE)
    for begin in (52.0, 58.0, 64.0, 70.0):
        log = stuck(log, ("left_ankle_pitch",), begin, begin + 4.0)
    replay = replayed(robot, log)
    assert not (replay.column("left", "flags").astype(int) & Flag.GROUND_CHANGED).any()
    found = replay.estimate("left").pitch
    assert not found.identified
    assert abs(found.stiffness.value - TRUTH["left", "pitch"].stiffness) < found.stiffness.half_width


def test_a_whole_leg_of_noisy_encoders_that_stands_is_frozen(robot: RobotModel) -> None:
    log = read(record(sway(duration=60.0)))
    leg = tuple(f"left_{name}" for name in ("ankle_pitch", "ankle_roll", "leg_x", "leg_y", "leg_z"))
    told = frozen(replayed(robot, stuck(log, leg, 30.0, 34.0)), "left")
    assert told[3020:3400].all()


@pytest.mark.parametrize("steps", [0.0, FINE, COARSE])
@pytest.mark.parametrize("rate", [50.0, 200.0, 1000.0])
def test_encoders_in_good_health_may_repeat_themselves(robot: RobotModel, steps: float, rate: float) -> None:
    motion = standing_between(50.0)
    replay = replayed(robot, read(record(motion, at=times(motion, rate)), steps))
    assert not any(frozen(replay, foot).any() for foot in robot.feet)


def test_a_leg_may_stand_while_the_other_moves(robot: RobotModel) -> None:
    """Both have moved before, from rest, so that its encoders are known to be alive and without noise."""
    motion = sway(duration=60.0)
    still, quick = sines((0.0, 0.0, 0.0)), sines((0.1, 0.5, 0.0))

    def from_20_s(before, after):  # type: ignore[no-untyped-def]
        return lambda t: np.where(t < 20.0, before(np.maximum(t, 2.0)), after(t))

    ankles = {
        "left": tuple(from_20_s(one, still) for one in motion.ankles["left"]),
        "right": tuple(from_20_s(one, quick) for one in motion.ankles["right"]),
    }
    torso = tuple(from_20_s(one, still) for one in motion.torso)
    log = record(replace(motion, ankles=ankles, torso=torso, shift=0.0))
    for steps in (FINE, COARSE):
        assert not frozen(replayed(robot, read(log, steps)), "left").any()

"""A foot that steps: a centre of pressure that reads beside the sole in the middle of a stance, and one at its end."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import TRUTH, BushModel, record, sway
from biped_robot import FEET, robot_entry, write_robot
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.robot.model import RobotModel, load_robot

HARDENING = {
    key: BushModel(law.stiffness, law.damping, law.offset, 4e5) for key, law in TRUTH.items()
}  # doubles a torque at 32 mrad
ROUND = ((1, 1), (-1, 1), (-1, -1), (1, -1))  # a rectangle's corners
STRIDE, AIR = 3.0, 0.8  # s


def walk(truth: dict[tuple[str, str], BushModel], duration: float = 60.0) -> MotionLog:
    lifts = tuple(
        (foot, start, start + AIR)
        for place, foot in enumerate(FEET)
        for start in np.arange(3.0 + 0.5 * STRIDE * place, duration - STRIDE, STRIDE)
    )
    return record(replace(sway(duration=duration), lifts=lifts, truth=truth))


def soles(folder: Path, half_length: float) -> RobotModel:
    feet = robot_entry()["feet"]
    for foot in feet.values():  # type: ignore[attr-defined]
        foot["sole"]["polygon"] = [[half_length * x, 0.08 * y] for x, y in ROUND]
    return load_robot(write_robot(folder, feet=feet))


def test_what_reads_beside_the_sole_in_the_middle_of_a_stance_is_learnt_from(tmp_path: Path) -> None:
    """A sensor that is turned, or not where it was told to be, moves the centre of pressure, and not the sole. Without
    the largest torques, the spring that hardens would be another one."""
    log, found = walk(HARDENING), []
    for name, half_length in (("short", 0.07), ("long", 0.13)):
        replay = FootEstimator(soles(tmp_path / name, half_length), wrench_delay=0.0).replay(log)
        found.append(replay.estimate("left").pitch.stiffness.value)
        told = (replay.column("left", "flags").astype(int) & Flag.EDGE) > 0
        stands = replay.column("left", "contact") == Contact.STANCE
        assert (told[stands].mean() > 0.1) == (name == "short"), "it is told all the same"
    assert found[0] == pytest.approx(found[1], rel=0.08), "without the edges 13 % less"


def test_a_foot_that_rolls_until_it_lifts_is_left_out_from_there(tmp_path: Path) -> None:
    log = walk(TRUTH)
    torque = log.column("wrench.left.torque.y").copy()
    for begin in np.arange(3.0, 57.0, STRIDE):
        torque[(log.time > begin - 0.6) & (log.time < begin + 0.1)] += 60.0  # N·m: far beyond the sole
    rolling = log.with_columns({"wrench.left.torque.y": torque})
    found = FootEstimator(soles(tmp_path, 0.13), wrench_delay=0.0).replay(rolling).estimate("left").pitch
    assert found.stiffness.value == pytest.approx(TRUTH["left", "pitch"].stiffness, rel=0.02)

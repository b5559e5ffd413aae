"""A designed table in a simulation that shares nothing with the twin: it holds, and shows the feet."""

from __future__ import annotations

from pathlib import Path

import pytest

import design_samples
import plain_mujoco
from plain_mujoco import Springs, play_plainly
from plantar.design.trajectory import Trajectory
from plantar.feet.identify import identify_feet
from plantar.logs.readers import open_log
from plantar.logs.save import save_log
from plantar.twin.robots import hrp2

FEET = {"left": Springs((520.0, 450.0), (20.0, 18.0)), "right": Springs((470.0, 400.0), (19.0, 16.0))}
SHARE = 0.6  # of the amplitude: nobody rehearsed this motion


def test_plain_mujoco_plays_the_table_and_its_log_shows_the_feet(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Steps of plain MuJoCo take damping off, 3 % of it where they last 1 ms, half of that at half."""
    monkeypatch.setattr(plain_mujoco, "TIMESTEP", 5e-4)
    motion = Trajectory.of(
        "outside", design_samples.legs(), design_samples.reach().lines, SHARE * design_samples.coefficients()
    )
    save_log(motion.log(200.0), tmp_path / "motion.csv")
    robot = hrp2.robot()
    played = play_plainly(robot, open_log(tmp_path / "motion.csv"), FEET)
    assert played.tilt < 1e-3  # soles stay flat
    assert played.slid < 1e-3
    assert played.sunk < 1e-3
    result = identify_feet(robot, [played.log])
    for foot, springs in FEET.items():
        for place, axis in enumerate(("pitch", "roll")):
            for name, truth, off in (
                ("stiffness", springs.stiffness[place], 0.015),
                ("damping", springs.damping[place], 0.03),
            ):
                row = result.parameter(foot, axis, name)
                assert row.value == pytest.approx(truth, rel=off), (foot, axis, name)
                assert row.interval95 is not None
                assert row.interval95[0] < truth < row.interval95[1]

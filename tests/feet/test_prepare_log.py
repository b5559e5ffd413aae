"""One log made ready: what its force sensors read in the air is taken off, but of a foot that always stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from plantar.feet.prepare_log import prepare
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot.model import RobotModel

ZERO = np.array([4.0, -3.0, 20.0, 0.5, -0.4, 0.2])  # N, N·m


def stepping(zero: np.ndarray) -> MotionLog:
    """Feet that swing in turn for a second, twice as long between; the left force sensor reads `zero` beside."""
    log = record(sway("steps", duration=24.0))
    sole = {foot: log.wrench(foot) for foot in ("left", "right")}
    phase = np.mod(log.time, 6.0)[:, None]
    left, right = (phase > 1.0) & (phase < 2.0), (phase > 4.0) & (phase < 5.0)
    both = sole["left"] + sole["right"]
    read = {
        "left": np.where(left, 0.0, np.where(right, both, sole["left"])) + zero,
        "right": np.where(right, 0.0, np.where(left, both, sole["right"])),
    }
    columns = {foot: dict(zip(wrench_columns(foot), read[foot].T, strict=True)) for foot in read}
    return log.with_columns(columns["left"] | columns["right"])


def test_what_a_sensor_reads_in_the_air_is_taken_off_and_told(robot: RobotModel) -> None:
    right, found = (prepare(robot, stepping(zero), "fit") for zero in (0.0 * ZERO, ZERO))
    for state in ("wrench", "torque", "force_z"):
        for foot in ("left", "right"):
            ours, theirs = (getattr(one.raw[foot], state) for one in (found, right))
            np.testing.assert_allclose(ours, theirs, atol=1e-6)
    rows = [row for row in found.zeros if row.foot == "left"]
    assert len(rows) == 4
    for row in rows:
        assert (*row.force_zero, *row.torque_zero) == pytest.approx(ZERO)
    (note,) = [note for note in found.notes if note.code == "air_zero" and "left foot" in note.text]
    assert note.text.startswith("steps: left foot: in the air its force sensor reads 4, -3, 20 N (4 swings")


def test_a_foot_that_always_stands_has_nothing_taken_off(robot: RobotModel) -> None:
    """Zeroed under load, it reads next to nothing while it carries, too."""
    left = replace(robot.feet["left"], contact="always")
    found = prepare(replace(robot, feet={**robot.feet, "left": left}), stepping(ZERO), "fit")
    assert {row.foot for row in found.zeros} == {"right"}
    assert not any("left foot" in note.text for note in found.notes if note.code == "air_zero")

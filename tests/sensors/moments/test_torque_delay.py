"""Torques that are read at other moments than the forces of the same sensors are told, with how late they are."""

from __future__ import annotations

import re

import numpy as np
import pytest

from moments import fit_moments
from plantar.conventions import ROTATIONAL_AXES
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.moments.moment_fit import MomentFit, Part
from plantar.sensors.moments.torque_delay import TORQUES_LATE, torque_delay_notes
from plantar.sensors.newton_euler import newton_euler_residuals
from plantar.signals.resampling import shifted
from plantar.twin.robots import hrp2
from twin_samples import walked


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


def late(log: MotionLog, quantity: str, seconds: float) -> MotionLog:
    """A quantity is `force`, `torque` or one channel of it."""
    names = [name for name in log.columns if name.startswith("wrench.") and f".{quantity}" in name]
    moved = shifted(log.stack(names), log.period, -seconds)
    return log.with_columns(dict(zip(names, moved.T, strict=True)))


def told(twin: RobotModel, log: MotionLog) -> list[Note]:
    [residual] = newton_euler_residuals(twin, log)
    return torque_delay_notes(fit_moments(twin, [residual], [log.name]))


@pytest.mark.parametrize(
    ("quantity", "seconds", "words"),
    [("torque", 0.02, "behind"), ("torque", 0.008, "behind"), ("force", 0.02, "ahead")],
)
def test_channels_read_apart_are_told_with_their_delay(
    twin: RobotModel, quantity: str, seconds: float, words: str
) -> None:
    (note,) = told(twin, late(checked(twin, walked()), quantity, seconds))
    assert (note.code, note.severity) == (TORQUES_LATE, "warning")
    for each in note.text.split("their forces: ")[1].split(" (95 %)")[0].split(", "):
        value, reach, sense = re.findall(r"\S+ (\d+) ± (\d+) ms (\w+)", each)[0]
        assert sense == words
        assert float(value) == pytest.approx(1e3 * seconds, abs=float(reach) + 0.5)
        assert float(reach) < 0.5 * 1e3 * seconds
    assert [axis in note.text for axis in ROTATIONAL_AXES] == [True, True]


@pytest.mark.parametrize(("channel", "axis"), [("torque.y", "pitch"), ("torque.x", "roll")])
def test_torques_about_one_axis_alone_are_told_apart(twin: RobotModel, channel: str, axis: str) -> None:
    (note,) = told(twin, late(checked(twin, walked()), channel, 0.015))
    (each,) = note.text.split("their forces: ")[1].split(" (95 %)")[0].split(", ")
    assert each.startswith(f"{axis} 1")


def test_sensors_read_at_one_moment_are_not_told(twin: RobotModel) -> None:
    log = checked(twin, walked())
    assert told(twin, log) == []
    assert told(twin, late(late(log, "torque", 0.008), "force", 0.008)) == []
    assert torque_delay_notes(None) == []


@pytest.mark.parametrize(("std", "some"), [(0.001, 1), (0.01, 0)])
def test_a_delay_that_may_be_chance_is_not_told(std: float, some: int) -> None:
    fit = MomentFit(np.array([0.0, 0.0, 0.02]), [Part(std**2 * np.eye(3), 1e6)])
    assert len(torque_delay_notes(fit)) == some

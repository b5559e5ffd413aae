"""A torque that is exactly nothing wherever it is small, and channels that read in steps, hang or are dropped."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot
from plantar.conventions import Array
from plantar.faults.dead_band import DEAD_BAND, check_dead_bands
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

TORQUES = [f"wrench.left.torque.{axis}" for axis in "xy"]


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    folder: Path = tmp_path_factory.mktemp("biped")
    return make_robot(folder)


@pytest.fixture(scope="module")
def log() -> MotionLog:
    clean, random = record(sway()), np.random.default_rng(0)
    noise = 0.02 * random.standard_normal((2, len(clean)))
    return clean.with_columns({n: clean.column(n) + e for n, e in zip(TORQUES, noise, strict=True)})


def read_as(log: MotionLog, reading: Callable[[Array], Array], *columns: str) -> MotionLog:
    return log.with_columns({name: reading(log.column(name)) for name in columns or TORQUES})


def band(torque: Array) -> float:
    """A tenth of the usual torque."""
    return 0.1 * float(np.std(torque))


@pytest.mark.parametrize(
    "reading",
    [
        lambda torque: np.where(np.abs(torque) < band(torque), 0.0, torque),
        lambda torque: np.sign(torque) * np.maximum(np.abs(torque) - band(torque), 0.0),
        lambda torque: np.where(np.arange(len(torque)) % 50 == 7, 0.0, torque),
    ],
    ids=["cut", "taken off", "values lost"],
)
def test_zeros_under_load_are_told_of_their_own_column(
    robot: RobotModel, log: MotionLog, reading: Callable[[Array], Array]
) -> None:
    for column in TORQUES:
        (finding,) = check_dead_bands(robot, read_as(log, reading, column))
        assert finding.code == DEAD_BAND
        assert not finding.fatal
        assert f"column '{column}':" in finding.text
    (force,) = check_dead_bands(robot, read_as(log, reading, "wrench.left.force.y"))
    assert "column 'wrench.left.force.y':" in force.text
    (both,) = check_dead_bands(robot, read_as(log, reading))
    assert "columns 'wrench.left.torque.x', 'wrench.left.torque.y':" in both.text


@pytest.mark.parametrize(
    "reading",
    [
        lambda torque: torque,
        lambda torque: band(torque) * np.round(torque / band(torque)),
        lambda torque: 10 * band(torque) * np.round(torque / band(torque) / 10),
        lambda torque: 0 * torque,
        lambda torque: np.repeat(torque[::10], 10)[: len(torque)],
        lambda torque: np.where(np.arange(len(torque)) % 50 == 7, np.nan, torque),
    ],
    ids=["as measured", "fine steps", "coarse steps", "dead", "held", "empty cells"],
)
def test_other_readings_are_no_dead_band(
    robot: RobotModel, log: MotionLog, reading: Callable[[Array], Array]
) -> None:
    assert list(check_dead_bands(robot, read_as(log, reading))) == []


def test_a_foot_in_the_air_may_read_nothing(robot: RobotModel, log: MotionLog) -> None:
    swing = np.arange(len(log)) % 200 < 80
    wrench = {name: np.where(swing, 0.0, log.column(name)) for name in log.columns if "wrench.left" in name}
    assert list(check_dead_bands(robot, log.with_columns(wrench))) == []

"""What a force sensor reads while the other foot carries the robot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import WEIGHT
from biped_robot import make_robot
from plantar.conventions import Array
from plantar.faults.air_readings import check_air_readings
from plantar.robot.model import RobotModel

LONG = 3.0

PERIOD = 0.01
SAMPLES = 1000


@pytest.fixture
def robot(tmp_path: Path) -> RobotModel:
    return make_robot(tmp_path)


def found(robot: RobotModel, wrench: Array, hanging: float = 1.0) -> list[str]:
    """Texts about a left foot that reads `wrench` (6,) for a share of the log, on both feet in the rest."""
    alone = np.arange(SAMPLES) < hanging * SAMPLES
    left = np.where(alone[:, None], wrench, [0, 0, WEIGHT / 2, 0, 0, 0])
    right = np.zeros((SAMPLES, 6))
    right[:, 2] = np.where(alone, WEIGHT, WEIGHT / 2)
    loads = {"left": left[:, 2], "right": right[:, 2]}
    return [one.text for one in check_air_readings(robot, PERIOD, loads, {"left": left, "right": right})]


@pytest.mark.parametrize(
    ("channel", "value", "name", "most"),
    [
        (2, 0.05 * WEIGHT, "force.z", 18),
        (0, -0.05 * WEIGHT, "force.x", 18),
        (4, 0.01 * WEIGHT, "torque.y", 3.5),
    ],
)
def test_a_zero_that_is_off_is_read_in_the_air(
    robot: RobotModel, channel: int, value: float, name: str, most: float
) -> None:
    (text,) = found(robot, value * np.eye(6)[channel])
    assert text == (
        f"column 'wrench.left.{name}', value {value:.4g}: reads this while left hangs in the air, so its zero is off "
        f"(valid: below {most}; zero the sensor in the air)"
    )
    assert found(robot, 0.4 * value * np.eye(6)[channel]) == []


def test_a_foot_that_stands_has_a_load(robot: RobotModel) -> None:
    wrench = 0.05 * WEIGHT * np.eye(6)[2]
    assert found(robot, wrench, hanging=0.0) == []
    assert found(robot, wrench, hanging=0.8 * LONG / (SAMPLES * PERIOD)) == []  # a step
    assert len(found(robot, wrench, hanging=1.2 * LONG / (SAMPLES * PERIOD))) == 1


def test_readings_that_are_missing_say_nothing_of_a_zero(robot: RobotModel) -> None:
    """A hole parts the time in the air: one side of it is long enough."""
    off, both = 0.05 * WEIGHT * np.eye(6)[2], np.zeros((SAMPLES, 6))
    both[:, 2] = WEIGHT
    left = np.tile(off, (SAMPLES, 1))
    left[SAMPLES // 4, 4] = np.nan
    loads = {"left": left[:, 2], "right": both[:, 2]}
    (told,) = check_air_readings(robot, PERIOD, loads, {"left": left, "right": both})
    assert "wrench.left.force.z" in told.text


def test_a_foot_zeroed_under_load_is_not_in_the_air(robot: RobotModel) -> None:
    left = replace(robot.feet["left"], contact="always")
    zeroed = replace(robot, feet={**robot.feet, "left": left})
    assert found(zeroed, 0.05 * WEIGHT * np.eye(6)[2]) == []


@pytest.mark.parametrize(("share", "told"), [(-0.14, True), (-0.16, False), (0.16, False), (0.14, True)])
def test_a_foot_that_reads_much_does_not_hang_whatever_its_sign(
    robot: RobotModel, share: float, told: bool
) -> None:
    """A load upside down is another fault, and no zero."""
    assert bool(found(robot, share * WEIGHT * np.eye(6)[2])) == told

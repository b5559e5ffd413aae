"""What a force sensor may get wrong, as matrices on what it reads: moved, turned, with gains and crosstalk."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.moments.sensor_errors import bush_directions, sensor_errors

WRENCH = np.array([10.0, -20.0, 300.0, 4.0, -5.0, 6.0])
FORCE, TORQUE = WRENCH[:3], WRENCH[3:]


@pytest.fixture
def unsure(robot: RobotModel) -> RobotModel:
    return replace(
        robot, uncertainty=Uncertainty(wrench_gain=0.03, bush_position=0.02, wrench_crosstalk=0.05)
    )


def test_a_sensor_that_is_moved_or_turned_reads_what_mechanics_says(unsure: RobotModel) -> None:
    """Moved, it reads an arm times the force as torque; turned, both as they look from there."""
    matrices, deviations = sensor_errors(unsure)
    np.testing.assert_array_equal(matrices[0], np.eye(6))
    for place, axis in enumerate(np.eye(3)):
        moved, turned = matrices[1 + place] @ WRENCH, matrices[4 + place] @ WRENCH
        np.testing.assert_allclose(moved, [*np.zeros(3), *np.cross(axis, FORCE)])
        np.testing.assert_allclose(turned, [*np.cross(axis, FORCE), *np.cross(axis, TORQUE)])
    assert deviations[:4].tolist() == [0.03, 0.02, 0.02, 0.02]


def test_channels_have_gains_and_read_each_other_but_no_torque_reaches_a_force(unsure: RobotModel) -> None:
    matrices, deviations = sensor_errors(unsure)
    singles = {tuple(np.argwhere(one)[0]): own for one, own in zip(matrices[7:], deviations[7:], strict=True)}
    assert len(singles) == len(matrices) - 7 == 27
    assert all(np.count_nonzero(one) == 1 for one in matrices[7:])
    assert not matrices[:, :3, 3:].any()
    for (read, real), own in singles.items():
        assert own == (0.03 if read == real else 0.05)


def test_the_bushs_axes_are_seen_from_the_sensor(robot: RobotModel) -> None:
    """Pitch about the bush's y, roll about its x: of a sensor that is turned by a quarter about z, its x and -y."""
    foot = robot.feet["left"]
    np.testing.assert_allclose(bush_directions(robot, foot), [[0, 1, 0], [1, 0, 0]], atol=1e-12)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    placement = foot.wrench.placement
    turned = replace(placement, rpy=np.array([0, 0, np.pi / 2]))
    np.testing.assert_allclose(turned.rotation, quarter, atol=1e-12)
    for link in (placement.link, "left_sole"):  # also of a link of its own
        placed = replace(foot.wrench, placement=replace(turned, link=link))
        found = bush_directions(robot, replace(foot, wrench=placed))
        np.testing.assert_allclose(found, [[1, 0, 0], [0, -1, 0]], atol=1e-12)

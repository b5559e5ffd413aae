"""What a turned IMU does to the angles, beside the angles of a robot file that has it turned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.contact.deflection import bush_states, foot_motions
from plantar.contact.imu_turn import imu_turn_effects
from plantar.conventions import Array
from plantar.exporters.poses import pose, rpy_of
from plantar.robot.model import Imu, RobotModel
from plantar.twin.robots import hrp2

SMALL = 2e-3  # rad
SAMPLES = 20


def angles(robot: RobotModel, positions: Array, orientation: Array) -> dict[str, Array]:
    still = np.zeros_like(positions), np.zeros((SAMPLES, 3))
    none = {foot: np.zeros((SAMPLES, 6)) for foot in robot.feet}
    states = bush_states(robot, positions, still[0], orientation, still[1], none)
    return {foot: state.deflection for foot, state in states.items()}


def effects_of(robot: RobotModel, positions: Array, orientation: Array) -> dict[str, Array]:
    still = np.zeros_like(positions), np.zeros((SAMPLES, 3))
    return imu_turn_effects(foot_motions(robot, positions, still[0], orientation, still[1]))


@pytest.mark.parametrize("axis", range(3))
def test_effects_are_those_of_another_mount(axis: int) -> None:
    robot, random = hrp2.robot(), np.random.default_rng(axis)
    positions = 0.3 * random.normal(size=(SAMPLES, len(robot.joint_names)))
    orientation = np.array([1.0, 0.1, -0.1, 0.3]) + 0.05 * random.normal(size=(SAMPLES, 4))
    assert robot.imu is not None
    mount = robot.imu.placement
    # The IMU's own axes are turned by -SMALL where its reading, taken for that of the file's axes, is turned by SMALL.
    c, s = np.cos(SMALL), np.sin(SMALL)
    turn = np.roll(np.roll([[1, 0, 0], [0, c, s], [0, -s, c]], axis, axis=0), axis, axis=1)
    rpy = rpy_of(pose(np.zeros(3), rotation=mount.rotation @ turn))
    other = replace(robot, imu=Imu(robot.imu.name, replace(mount, rpy=rpy)))
    before, after = (angles(one, positions, orientation) for one in (robot, other))
    effects = effects_of(robot, positions, orientation)
    for foot in robot.feet:
        change = (after[foot] - before[foot]) / SMALL
        assert np.abs(change).max() > 0.1
        np.testing.assert_allclose(effects[foot][:, :, axis], change, atol=0.01)


def test_a_hole_in_the_attitude_does_not_spread() -> None:
    """The filter that effects pass would lose what is beside it."""
    robot = hrp2.robot()
    still = np.zeros((SAMPLES, len(robot.joint_names)))
    orientation = np.array([1.0, 0.1, -0.1, 0.3]) + np.zeros((SAMPLES, 1))
    whole = effects_of(robot, still, orientation)
    holed = orientation.copy()
    holed[4] = np.nan
    for foot, effects in effects_of(robot, still, holed).items():
        np.testing.assert_allclose(effects, whole[foot], atol=1e-9)
    for effects in effects_of(robot, still, np.nan * orientation).values():
        assert not effects.any()

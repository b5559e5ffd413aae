"""The floor's friction over the load, in the axes of the world, whichever way the robot faces."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from biped import WEIGHT, record, sines, sway
from biped_robot import FEET
from plantar.contact.deflection import bush_states
from plantar.feet.exclusion.sole_velocity import friction
from plantar.robot.model import RobotModel


@pytest.mark.parametrize("heading", [0.0, 0.7, -2.0])
def test_friction_is_told_in_the_worlds_axes(robot: RobotModel, heading: float) -> None:
    motion = sway(duration=6.0)
    facing = sines((heading, 0.0, np.pi / 2))
    log = record(sway(duration=6.0, torso=(*motion.torso[:2], facing)))
    orientation = log.orientation("chest")
    assert orientation is not None
    positions, rates = log.positions(robot), log.angular_velocity("chest")
    wrenches = {foot: log.wrench(foot) for foot in FEET}
    bushes = bush_states(robot, positions, np.zeros_like(positions), orientation, rates, wrenches)
    stands = {foot: np.ones(len(log), dtype=bool) for foot in FEET}
    found = friction(SimpleNamespace(time=log.time, bushes=bushes), stands)  # type: ignore[arg-type]
    # Of each foot, as `biped.bush_force` has it.
    level = 2 * np.column_stack([4 * np.sin(1.3 * log.time), 3 * np.cos(0.9 * log.time)])
    np.testing.assert_allclose(found, level / WEIGHT, atol=1e-3)

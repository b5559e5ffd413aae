"""How much a robot's weight bears on its feet, by which imperfections grow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import GRAVITY
from plantar.robot.model import RobotModel
from plantar.twin.presets import SENSORS, Preset, gravitational_stiffness, sized_for
from plantar.twin.robots import hrp2


@pytest.mark.parametrize("pitch", [0.3, -0.3])
def test_the_height_is_along_the_soles_normals(robot: RobotModel, pitch: float) -> None:
    """Soles turned by `pitch` about places that are somewhere ahead of the centre of mass."""
    feet = {}
    for name, foot in robot.feet.items():
        place = replace(
            foot.sole.placement, xyz=foot.sole.placement.xyz + [0.03, 0, 0], rpy=np.array([0, pitch, 0])
        )
        feet[name] = replace(foot, sole=replace(foot.sole, placement=place))
    model, data = robot.model, robot.model.createData()
    centre = pin.centerOfMass(model, data, pin.neutral(model))
    soles = [(data.oMi[joint] * place).translation for joint, place in
             (robot.frame(foot.sole.placement) for foot in feet.values())]  # fmt: skip
    x, _, z = centre - np.mean(soles, axis=0)
    assert abs(x) > 0.02
    expected = robot.mass * GRAVITY * (np.cos(pitch) * z + np.sin(pitch) * x)
    assert gravitational_stiffness(replace(robot, feet=feet)) == pytest.approx(expected, rel=1e-9)


def test_a_robot_is_sized_by_its_share_of_hrp2(robot: RobotModel) -> None:
    assert sized_for(None) == sized_for(hrp2.robot()) == 1.0
    assert sized_for(robot) == round(
        gravitational_stiffness(robot) / gravitational_stiffness(hrp2.robot()), 3
    )


def test_recordings_of_one_robot_differ_by_one_share() -> None:
    """Drawn once for all motions of a seed, another for another seed; each motion's own draw is times that."""
    one, drawn = (Preset("a", SENSORS, between=between) for between in ((1.0, 1.0), (0.003, 0.01)))
    shares = {
        seed: [
            drawn.stiffening(seed, motion) / one.stiffening(seed, motion)
            for motion in ("Tilt1", "Squat", "walk")
        ]
        for seed in (0, 1, 2)
    }
    for own in shares.values():
        assert own == pytest.approx([own[0]] * 3)
        assert 0.003 <= own[0] <= 0.01
    assert len({round(own[0], 9) for own in shares.values()}) == 3
    assert one.stiffening(0, "Tilt1") != one.stiffening(0, "Squat") != one.stiffening(1, "Squat")

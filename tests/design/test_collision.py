"""Links that touch, on a robot of boxes whose places are known."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pinocchio as pin
import pytest

import design_samples
from plantar.design import collision
from plantar.design.collision import SelfCollision, self_collision
from plantar.twin.robots import hrp2

EVERY = 10

BOX = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
INERTIA = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'


def boxes() -> str:
    """Three boxes on a rail, each 0.2 m from the one before; the last slides back over the first."""
    links = "".join(f'<link name="{name}">{INERTIA}{BOX}</link>' for name in ("first", "second", "third"))
    slide = (
        '<joint name="{0}" type="prismatic"><parent link="{1}"/><child link="{2}"/><origin xyz="0.2 0 0"/>'
    )
    slide += '<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    joints = slide.format("near", "first", "second") + slide.format("far", "second", "third")
    return f'<robot name="boxes">{links}{joints}</robot>'


@pytest.mark.parametrize(("reach", "touches"), [(0.25, False), (0.35, True)])
def test_boxes_that_meet_are_named(reach: float, touches: bool) -> None:
    robot = replace(hrp2.robot(), urdf=boxes())
    model = robot.floating_model
    way = np.tile(pin.neutral(model), (20 * EVERY + 1, 1))
    way[:, -1] = -np.linspace(0.0, reach, len(way))
    found = self_collision(robot, way)
    assert found.pairs == 1  # neighbours are not watched
    if touches:
        assert found.touching is not None
        first, second, row = found.touching
        assert {first, second} == {"first_0", "third_0"}
        assert way[row, -1] == pytest.approx(-0.3, abs=2 * reach / 20)
    else:
        assert found.touching is None


def test_what_is_fixed_to_a_neighbour_is_one_too() -> None:
    """A lid above the first box, which the URDF tells last: the third box alone could touch it."""
    lid = f'<link name="lid">{INERTIA}{BOX}</link><joint name="over" type="fixed"><parent link="first"/>'
    lid += '<child link="lid"/><origin xyz="0 0 0.2"/></joint></robot>'
    robot = replace(hrp2.robot(), urdf=boxes().replace("</robot>", lid))
    assert self_collision(robot, pin.neutral(robot.floating_model)[None]).pairs == 2


def test_a_robot_without_geometry_is_not_watched() -> None:
    robot = hrp2.robot()
    assert self_collision(robot, pin.neutral(robot.floating_model)[None]).pairs == 0


@pytest.mark.parametrize(("touches", "share"), [(2.0, 1.0), (1.0, 0.75), (0.7, 0.5), (0.1, 0.0)])
def test_arms_swing_no_further_than_they_touch_nothing(touches: float, share: float) -> None:
    """With 1.3 times as far, as legs and trunk move as well, to both sides."""
    legs = design_samples.legs()
    rest, robot = legs.rest[0], hrp2.robot()

    def touching(_: object, configurations: np.ndarray) -> SelfCollision:
        turned = [pin.difference(robot.floating_model, rest, q) / legs.arms.max() for q in configurations]
        assert np.array_equal(configurations[0], rest), "pairs that touch at rest are not watched"
        assert np.min(turned) == pytest.approx(-np.max(turned)), "to both sides"
        return SelfCollision(1, ("hand", "leg", 3) if np.max(np.abs(turned)) > touches else None)

    with patch.object(collision, "self_collision", touching):
        assert collision.free_swing(robot, rest, legs.arms) == share

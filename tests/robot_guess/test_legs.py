"""Which chains are legs, which side they are on and where up is; which force sensor belongs to which foot."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.errors import RobotError
from plantar.robot_guess.biped import (
    SLENDER,
    USUAL_REACH,
    Biped,
    Limb,
    _alike,
    _exact,
    _pair,
    _side,
    _sides,
    _up,
)
from plantar.robot_guess.sensors import Sensors, look_at, sensor_of

TREE: Any = SimpleNamespace(path=Path("robot.urdf"))
JOINTS = tuple(f"j{number}" for number in range(6))


def limb(link: str, x: float, y: float, z: float, joints: tuple[str, ...] = JOINTS) -> Limb:
    return Limb(link, joints, np.array([x, y, z]), np.eye(3))


def test_legs_are_the_pair_that_is_called_so_and_then_the_one_that_reaches_farthest() -> None:
    arms = limb("wing_a", 0.0, 0.6, -0.9), limb("wing_b", 0.0, -0.6, -0.9)
    legs = limb("l_foot", 0.0, 0.1, -0.8), limb("r_foot", 0.0, -0.1, -0.8)
    assert _pair(TREE, [*arms, *legs]) == legs
    short = limb("e", 0.0, 0.1, -0.3, JOINTS[:5]), limb("f", 0.0, -0.1, -0.3, JOINTS[:5])
    assert _pair(TREE, [*short, *arms]) == arms
    hands = limb("l_hand", 0.0, 0.5, 0.0), limb("r_hand", 0.0, -0.5, 0.0)
    assert _pair(TREE, [*hands, *short]) == short, "hands are no feet"


@pytest.mark.parametrize(
    ("limbs", "said"),
    [
        ([limb(name, 0.0, 0.1, -0.5) for name in "abcd"],
         "robot.urdf: is no biped: 4 legs alike (a, b, c, d) (valid: two legs)"),
        ([limb(name, 0.0, 0.1, -0.1 * place) for place, name in enumerate("abcdefgh", 1)][::3],
         "robot.urdf: is no biped: no two of its chains' ends (a, d, g) are alike as two feet are "
         "(valid: two legs; hands and wheels do not count)"),
        ([limb("a", 0.0, 0.1, -0.5, JOINTS[:2]), limb("b", 0.0, -0.1, -0.5, JOINTS[:2])],
         "robot.urdf: has no flat feet: a (2) and b (2) joints from the root link, where an ankle needs more "
         "(valid: 4 joints a leg or more)"),
    ],
)  # fmt: skip
def test_what_is_no_biped_is_told_by_the_ends_of_its_chains(limbs: list[Limb], said: str) -> None:
    with pytest.raises(RobotError) as refused:
        _pair(TREE, limbs)
    assert str(refused.value) == said


def test_limbs_are_alike_by_their_joints_and_their_reach() -> None:
    one = limb("a", 0.0, 0.0, -1.0)
    assert _alike(one, limb("b", 0.0, 1.0, 0.0))
    assert not _alike(one, limb("b", 0.0, 1.0, 0.0, JOINTS[:5]))
    assert not _alike(one, limb("b", 0.0, 0.0, -0.5))


@pytest.mark.parametrize(
    ("place", "up"),
    [
        ((0, 0, -0.8), (0, 0, 1)),
        ((0.7, 0, 0.1), (-1, 0, 0)),
        ((0, 0.9, 0), (0, -1, 0)),
        ((0.6, 0, -0.6), (0, 0, 1)),
    ],
)
def test_up_is_the_roots_axis_that_points_from_the_feet_to_it(
    place: tuple[float, ...], up: tuple[float, ...]
) -> None:
    feet = limb("left_foot", *place), limb("right_foot", *place)
    np.testing.assert_array_equal(_up(feet), up)
    unnamed = limb("a", *place), limb("b", *place)
    np.testing.assert_array_equal(_up(unnamed), [0, 0, 1])


def test_sides_come_from_names_and_else_from_where_y_points() -> None:
    up = np.array([0.0, 0.0, 1.0])
    for first, second in (("l_foot", "r_foot"), ("r_foot", "l_foot")):
        (left, right), axes = _sides((limb(first, 0.0, 0.1, -0.8), limb(second, 0.0, -0.1, -0.8)), up)
        assert [(one.link, one.side) for one in (left, right)] == [("l_foot", "left"), ("r_foot", "right")]
        way = 1.0 if first == "l_foot" else -1.0
        np.testing.assert_array_equal(axes, np.column_stack([[way, 0, 0], [0, way, 0], [0, 0, 1]]))
    for places in ((0.1, -0.1), (-0.1, 0.1)):
        pair = limb("a", 0.0, places[0], -0.8), limb("b", 0.0, places[1], -0.8)
        (left, right), axes = _sides(pair, up)
        assert (left.place[1], left.side, right.place[1], right.side) == (0.1, "left", -0.1, "right")
        np.testing.assert_array_equal(axes, np.eye(3))
    along = np.array([1.0, 0.0, 0.0])
    (left, _), axes = _sides((limb("a", -0.8, -0.2, 0.0), limb("b", -0.8, 0.2, 0.0)), along)
    assert left.link == "b", "a root whose x points up has its left along y"
    np.testing.assert_array_equal(axes, np.column_stack([[0, 0, -1], [0, 1, 0], [1, 0, 0]]))


def test_a_side_is_named_by_the_link_and_else_by_the_nearest_joint() -> None:
    assert _side(limb("l_foot", 0, 0, 0, ("r_hip",))) == "left"
    assert _side(limb("foot", 0, 0, 0, ("l_hip", "r_ankle"))) == "right"
    assert _side(limb("foot", 0, 0, 0)) == ""
    assert _side(limb("left_of_right", 0, 0, 0, ("right_ankle",))) == "right", "both names are none"


def test_a_reach_is_that_of_the_legs_and_not_less_than_a_wide_stance_asks() -> None:
    legs = limb("a", 0.0, 0.3, -0.4), limb("b", 0.0, -0.3, -0.4)
    assert Biped(legs, np.eye(3), ()).reach == pytest.approx(max(0.5, 0.6 * SLENDER))
    assert Biped(legs[:1], np.eye(3), ()).reach == USUAL_REACH
    assert _exact(np.array([[1.0, 1e-12], [0.0, 0.7]])).tolist() == [[1.0, 1e-12], [0.0, 0.7]]
    assert _exact(np.array([[1.0 - 1e-12, -1e-12], [0.0, -1.0]])).tolist() == [[1.0, 0.0], [0.0, -1.0]]


def sensors(**frames: str) -> Sensors:
    return Sensors(wrenches=frames)


def test_a_foots_sensor_is_found_by_its_frame_and_then_by_its_name() -> None:
    both = sensors(a="r_sole", b="l_sole")
    assert (sensor_of("left", both, ["l_sole", "l_foot"]), sensor_of("right", both, ["r_sole"])) == ("b", "a")
    named = sensors(left_hand="", left_ankle="", left="", right_foot="", rfsensor="")
    assert (sensor_of("left", named, []), sensor_of("right", named, [])) == ("left_ankle", "right_foot")
    short = sensors(lfsensor="", rfsensor="")
    assert (sensor_of("left", short, []), sensor_of("right", short, [])) == ("lfsensor", "rfsensor")
    assert sensor_of("left", sensors(wrist_left=""), []) == "wrist_left", "better than none"
    assert sensor_of("left", sensors(plate=""), []) == "plate", "there is no other"
    assert sensor_of("left", sensors(plate="", board=""), []) is None
    assert sensor_of("left", sensors(right_foot=""), []) is None


def test_a_twins_truth_is_no_log(tmp_path: Path) -> None:
    truth = tmp_path / "sway.truth.parquet"
    found = look_at([truth])
    assert (found.left_out, found.logs, found.imus, found.wrenches) == ([truth], [], {}, {})

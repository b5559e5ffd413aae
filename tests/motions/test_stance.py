"""How a robot stands that has no posture of its own: knees bent the way they can, the pelvis level."""

from __future__ import annotations

import re

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.motions.body import CHEST, Body
from plantar.motions.stance import check_reached, stand
from plantar.twin.robots import hrp2

KNEES, ANKLES = (("LLEG_JOINT3", "RLEG_JOINT3"), ("LLEG_JOINT4", "RLEG_JOINT4"))


@pytest.fixture
def body() -> Body:
    return Body(hrp2.robot())


def joint(body: Body, q: Array, name: str) -> float:
    return float(q[body.model.joints[body.model.getJointId(name)].idx_q])


def limit(body: Body, names: tuple[str, ...], low: float, high: float) -> None:
    for name in names:
        place = body.model.joints[body.model.getJointId(name)].idx_q
        body.model.lowerPositionLimit[place], body.model.upperPositionLimit[place] = low, high


def level(body: Body, q: Array) -> None:
    """Pelvis and chest stand upright, the centre of mass over the soles' middle."""
    for rotation in (pin.Quaternion(q[3:7]).matrix(), body.pose(q, CHEST).rotation):
        np.testing.assert_allclose(rotation, np.eye(3), atol=1e-3)


def test_knees_bend_and_the_waist_does_not(body: Body) -> None:
    q = stand(body, None, {}).configuration
    level(body, q)
    assert all(joint(body, q, name) > 0.5 for name in KNEES)
    assert abs(joint(body, q, "CHEST_JOINT1")) < 0.06


def test_legs_that_bend_the_other_way_bend_the_other_way(body: Body) -> None:
    """From straight legs both ways look alike: ranges of hips, knees and ankles say which is right."""
    low, high = body.model.lowerPositionLimit, body.model.upperPositionLimit
    for name in (f"{side}LEG_JOINT{number}" for side in "LR" for number in (2, 3, 4)):
        place = body.model.joints[body.model.getJointId(name)].idx_q
        limit(body, (name,), -high[place], -low[place])
    limit(body, KNEES, -2.6, 0.4)
    q = stand(body, None, {}).configuration
    level(body, q)
    assert all(joint(body, q, name) < -0.5 for name in KNEES)


@pytest.mark.parametrize(("lowest", "bent"), [(-1.3, 0.75), (-0.75, 0.62), (-0.6, 0.44)])
def test_ankles_that_turn_little_leave_knees_straighter(body: Body, lowest: float, bent: float) -> None:
    """A foot that is lifted with its sole level turns its ankle further: at its limit the trunk would jump."""
    limit(body, ANKLES, lowest, 0.7)
    q = stand(body, None, {}).configuration
    assert all(joint(body, q, name) == pytest.approx(bent, abs=0.02) for name in KNEES)
    level(body, q)


@pytest.mark.parametrize(
    ("stopped", "said"),
    [
        ((), "misses by 20.0 mm (valid"),
        (ANKLES[:1], "misses by 20.0 mm, with LLEG_JOINT4 at its limit (valid"),
        (ANKLES, "misses by 20.0 mm, with LLEG_JOINT4, RLEG_JOINT4 at their limits (valid"),
    ],
)
def test_a_foot_that_cannot_reach_its_place_says_which_joints_stop_it(
    body: Body, stopped: tuple[str, ...], said: str
) -> None:
    start = stand(body, None, {})
    for name in stopped:
        limit(body, (name,), joint(body, start.configuration, name) - 0.005, 0.7)
    places = {
        foot: sole * pin.SE3(np.eye(3), np.array([0.02, 0.0, 0.0])) for foot, sole in start.soles.items()
    }
    with pytest.raises(MotionError, match=re.escape(f"foot cannot reach its place, it {said}")):
        check_reached(body, start.configuration, places, "Walk")


def test_the_centre_of_mass_stands_over_the_middle_of_feet_that_stand_askew(body: Body) -> None:
    """The left foot 40 mm ahead and 60 mm aside of where it stood."""
    usual, start = stand(body, None, {}), stand(body, None, {"left": (0.04, 0.06)})
    moved = start.soles["left"].translation - usual.soles["left"].translation
    np.testing.assert_allclose(moved, [0.04, 0.06, 0.0], atol=1e-6)
    np.testing.assert_allclose(start.soles["right"].translation, usual.soles["right"].translation, atol=1e-6)
    here, before = (body.centre_of_mass(one.configuration)[:2] for one in (start, usual))
    np.testing.assert_allclose(here - before, [0.02, 0.03], atol=1e-3)


def test_the_least_room_is_that_of_the_leg_joint_that_moved_farthest_to_its_limit(body: Body) -> None:
    """The left knee up towards 2.0, the right ankle down towards -1.0; others stay, and have no say."""
    limit(body, KNEES, 0.0, 2.0)
    limit(body, ANKLES, -1.0, 0.7)
    q, moved = body.neutral(), np.zeros(body.model.nq)
    assert body.room(q, moved) == np.inf, "nothing moved"
    for name, angle, way in ((KNEES[0], 1.2, 1.0), (ANKLES[1], -0.7, -0.5), (KNEES[1], 1.9, 0.05)):
        place = body.model.joints[body.model.getJointId(name)].idx_q
        q[place], moved[place] = angle, way
    assert body.room(q, moved) == pytest.approx(0.3)
    place = body.model.joints[body.model.getJointId(ANKLES[1])].idx_q
    moved[place] = 0.0
    assert body.room(q, moved) == pytest.approx(0.8)

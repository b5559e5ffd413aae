"""Walks: the plan is a walk, in balance, smooth and at rest at both ends."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from kept_texts import assert_as_kept, described
from plantar.contact.balance import planned_wrench, sole_outlines, zero_moment_point
from plantar.contact.polygon import convex_hull, inside_distance
from plantar.errors import MotionError
from plantar.motions import Plan, Walk, plan_motion, walk
from plantar.motions.body import Body
from plantar.motions.feasible import check, configurations
from plantar.motions.footsteps import CLEARANCE, footsteps
from plantar.motions.gait import Gait, gait_of, is_walk
from plantar.motions.preview import centre_over
from plantar.motions.stance import stand
from plantar.motions.walk import walk_plan
from plantar.twin.robots import hrp2

JUMPS = (
    r"^hrp2_like, t = 1\.\d+ s: Walk: the robot would leave the floor, since its legs jump from one posture to another "
    r"\(valid: a smaller or slower walk\)$"
)
BUILT = Gait(step=0.12, period=1.0, turn=0.1, steps=3, trial=0)


@cache
def built() -> tuple[Body, Plan]:
    """Three steps that turn a little."""
    body = Body(hrp2.robot())
    return body, walk_plan(body, "Walk", stand(body, hrp2.postures().standing, {}), BUILT)


def test_the_whole_bodys_zmp_stays_inside_the_feet_that_stand() -> None:
    body, plan = built()
    q, v, a, time = configurations(body, plan)
    zmp = zero_moment_point(planned_wrench(body.model, q, v, a), 10.0)
    rows = np.rint(time * 200).astype(int)
    assert np.abs(zmp - plan.walk.zmp[rows]).max() < 0.004  # the pendulum alone misses by centimetres
    for place, row in enumerate(rows[::4]):
        standing = plan.standing_at(int(row))
        outlines = sole_outlines(body.robot, {foot: plan.walk.soles[foot][row] for foot in standing})
        corners = convex_hull(np.vstack(list(outlines.values())))
        assert inside_distance(zmp[::4][place : place + 1], corners)[0] > 0.02
    assert {len(plan.standing_at(int(row))) for row in rows} == {1, 2}
    assert check(body, plan).worst()[1] > 0.02


def test_soles_go_where_the_steps_say() -> None:
    """By the URDF alone: swings as high as planned, standing feet still, and the last step brings them level."""
    body, plan = built()
    model, data = body.robot.floating_model, body.robot.floating_model.createData()
    q = configurations(body, plan)[0][::4]
    rows = np.arange(0, len(plan.time), 16)[: len(q)]
    for foot in ("left", "right"):
        joint, pose = body.robot.frame(body.robot.feet[foot].sole.placement)
        joint = model.getJointId(body.robot.model.names[joint])
        soles = []
        for row in q:
            pin.forwardKinematics(model, data, row)
            soles.append((data.oMi[joint] * pose).homogeneous)
        assert np.abs(np.array(soles) - plan.walk.soles[foot][rows]).max() < 1.5e-3
        height = plan.walk.soles[foot][:, 2, 3]
        assert height.max() == pytest.approx(CLEARANCE, abs=0.004)
        assert np.abs(height[plan.walk.stands[foot]]).max() < 0.06 * 0.069 + 1e-9
    ends = [plan.walk.soles[foot][-1] for foot in ("left", "right")]
    apart = ends[0][:3, :3].T @ (ends[0][:3, 3] - ends[1][:3, 3])
    assert apart == pytest.approx([0.0, 0.19, 0.0], abs=1e-9)
    assert np.arctan2(ends[0][1, 0], ends[0][0, 0]) == pytest.approx(
        0.2
    )  # turned by the first two of three steps


def test_joints_are_continuous_and_at_rest_at_both_ends() -> None:
    _, plan = built()
    speeds = np.diff(plan.positions, axis=0) * 200
    assert np.abs(speeds[[0, -1]]).max() < 1e-3
    assert np.abs(speeds).max() < 3.0
    assert np.abs(np.diff(speeds, axis=0)).max() * 200 < 60.0  # rad/s²
    assert np.abs(plan.positions[:200] - plan.positions[0]).max() < 2e-3  # a second of rest and more
    assert np.abs(plan.positions[-200:] - plan.positions[-1]).max() < 2e-3


def test_feet_alternate_and_equal_trials_are_equal() -> None:
    soles = {
        foot: pin.SE3(np.eye(3), np.array([0.0, y, 0.0])) for foot, y in (("left", 0.1), ("right", -0.1))
    }
    middles = dict.fromkeys(soles, np.array([0.0, 0.0, 0.1, 0.05]))
    first, again, other = (
        footsteps(gait_of(name, period=None), soles, middles) for name in ("Walk12_1", "Walk12_1", "Walk12_2")
    )
    assert [swing.foot for swing in first.swings] == ["left", "right"] * 12
    assert [swing.goal[0] for swing in first.swings[:3]] == pytest.approx([0.12, 0.24, 0.36])
    assert all(later.start >= swing.end for swing, later in zip(first.swings, first.swings[1:], strict=False))
    floors = [[swing.floor for swing in steps.swings] for steps in (first, again, other)]
    assert floors[0] == floors[1] != floors[2]
    assert 0 < np.abs(floors[0]).max() <= 0.06 * 0.05


@pytest.mark.parametrize("order", [("left", "right"), ("right", "left")])
def test_the_feet_on_the_floor_are_named_in_one_order(order: tuple[str, str]) -> None:
    """Of whatever order the robot file has them in."""
    stands = {foot: np.array([True, foot == "left", False]) for foot in order}
    plan = Plan("walk", np.arange(3.0), (), np.zeros((3, 0)), np.zeros((3, 4, 4)), frozenset(order), {})
    walking = replace(plan, walk=Walk({}, stands, np.zeros((3, 2)), np.zeros((3, 3))))
    assert [walking.standing_at(row) for row in range(3)] == [["left", "right"], ["left"], []]
    assert plan.standing_at(2) == ["left", "right"]


def test_the_pendulum_obeys_its_law() -> None:
    time = np.arange(0, 8, 0.01)
    zmp = np.column_stack([0.05 * np.tanh(5 * (time - 4)), np.zeros_like(time)])
    centre = centre_over(zmp, 0.8, 0.01)
    acceleration = np.diff(centre, 2, axis=0) / 0.01**2
    assert centre[1:-1] - acceleration * 0.8 / 9.80665 == pytest.approx(zmp[1:-1], abs=1e-9)
    assert centre[[0, -1]] == pytest.approx(zmp[[0, -1]])
    assert centre[370, 0] > zmp[370, 0] + 0.005  # it leads: the future is known


def test_names_say_the_gait() -> None:
    assert gait_of("Walk12", period=None) == Gait(0.12, 1.0, 0.0, 24, 0)
    assert gait_of("WalkSlow8_3", period=None) == Gait(0.08, 4.0, 0.0, 6, 3)
    assert gait_of("WalkQuick20", period=None).period == 0.8
    assert gait_of("WalkInPlace", period=2.0) == Gait(0.0, 2.0, 0.0, 12, 0)
    assert gait_of("WalkTurn", period=None).turn > 0
    assert not is_walk("Walk")
    assert not is_walk("Walk0")


def test_legs_that_jump_from_one_posture_to_another_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """By 5 cm within a fiftieth of a second: no weight holds the robot on the floor."""
    follow = walk._follow

    def jumping(*given: Any) -> np.ndarray:
        found = follow(*given)
        found[60, 2] += 0.05
        return found

    monkeypatch.setattr(walk, "_follow", jumping)
    body = Body(hrp2.robot())
    with pytest.raises(MotionError, match=JUMPS) as caught:
        walk_plan(body, "Walk", stand(body, hrp2.postures().standing, {}), replace(BUILT, steps=1))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("Walk99", {}, r"t = [\d.]+ s: Walk99: the (left|right) foot cannot reach its place"),
        ("Walk12", {"period": 0.1}, r"value 0.1: Walk12: no period of a step .valid: 0.6 to 6 s"),
        (
            "Walkabout",
            {},
            r"^unknown motion 'Walkabout' \(valid: Tilt1, Tilt2, Tilt3, Tilt4, Tilt5, Tilt6, "
            r"Manual_right_roll, Manual_right_pitch, Manual_left_roll, Manual_left_pitch, "
            r"Manual_both_pitch, Myrand4, Myrand5, Squat, Walk8, Walk12, Walk16, Walk20, WalkSlow8, "
            r"WalkSlow12, WalkQuick8, WalkQuick12, WalkTurn, WalkInPlace\)$",
        ),
    ],
)
def test_what_no_robot_walks_is_refused(name: str, options: dict[str, float], message: str) -> None:
    with pytest.raises(MotionError, match=message) as caught:
        plan_motion(name, hrp2.robot(), hrp2.postures(), **options)
    assert "\n" not in str(caught.value)


def test_a_walk_is_as_it_is_kept() -> None:
    plan = built()[1]
    ways = {name: plan.positions[:, place] for place, name in enumerate(plan.joints)}
    told = described({"plan": plan, "ways": ways})
    assert_as_kept(told, Path(__file__).parent / "kept" / "walk.txt", share=1e-4, least=1e-5)


def test_a_name_that_is_no_walks_is_told_with_those_that_are() -> None:
    with pytest.raises(
        MotionError, match=r"^unknown walk 'Walk' \(valid: Walk8, Walk12, Walk16, Walk20, WalkSlow8, "
    ):
        gait_of("Walk", period=None)

"""What a walking robot's feet are asked for: by the statics of the floor's force, on soles about a bush above them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from plantar.conventions import GRAVITY, Array
from plantar.motions.plan import Plan, Walk
from plantar.robot.model import RobotModel
from plantar.twin.walking.balance_state import State
from plantar.twin.walking.stabiliser import Asked, Stabiliser

HEIGHT, COUNT, PERIOD = 0.8, 600, 0.005
OMEGA = np.sqrt(GRAVITY / HEIGHT)
RISE = 0.03  # m: of the bush above the sole
HALF = np.array([0.13, 0.08])


def made(robot: RobotModel, standing: tuple[str, ...], yaw: float = 0.0, speed: float = 0.0) -> Stabiliser:
    soles = np.tile(np.eye(4), (COUNT, 1, 1))
    soles[:, :2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    time = PERIOD * np.arange(COUNT)
    centre = np.column_stack([speed * time, np.zeros(COUNT), np.full(COUNT, HEIGHT)])
    walk = Walk(dict.fromkeys(("left", "right"), soles), {f: np.full(COUNT, f in standing) for f in ("left", "right")},
                np.zeros((COUNT, 2)), centre)  # fmt: skip
    plan = Plan("walk", time, (), np.zeros((COUNT, 0)), soles, frozenset(standing), {}, walk=walk)
    return Stabiliser(robot, plan)


def state(centre: Any, rate: Any = (0, 0), places: dict[str, Any] | None = None) -> State:
    places = places or {"left": (0.0, 0.1), "right": (0.0, -0.1)}
    return State(np.zeros(3), np.array([*centre, HEIGHT]), np.array([*rate, 0.0]), {}, {},
                 {foot: np.array([*at, RISE]) for foot, at in places.items()})  # fmt: skip


def pressure(asked: Asked, place: Array, pull: Array, yaw: float = 0.0) -> Array:
    """Where in the world the floor's force acts whose moment about the bush is the torque that was asked for."""
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    side = turn.T @ pull
    arm = np.array([-(asked.torque[1] + RISE * side[0]), asked.torque[0] - RISE * side[1]]) / asked.load
    return np.asarray(place[:2] + turn @ arm)


@pytest.mark.parametrize("yaw", [0.0, 0.6])
@pytest.mark.parametrize("rate", [(0.0, 0.0), (0.02, -0.01)])
def test_the_pressure_leads_three_times_the_error_of_the_divergent_motion(
    robot: RobotModel, yaw: float, rate: tuple[float, float]
) -> None:
    weight, centre = robot.mass * GRAVITY, np.array([0.004, -0.006])
    now = state(centre, rate, {"left": (0.0, 0.0), "right": (0.0, -0.2)})
    asked = made(robot, ("left",), yaw).ask(0, now)
    error = centre + np.array(rate) / OMEGA
    wanted = 3.0 * error + error * PERIOD
    pull = weight * (centre - wanted) / HEIGHT
    assert asked["left"].load == pytest.approx(weight)
    np.testing.assert_allclose(pressure(asked["left"], now.place["left"], pull, yaw), wanted, atol=1e-12)
    assert (asked["right"].load, *asked["right"].torque) == (0.0, 0.0, 0.0)


def test_a_plan_that_moves_is_followed_as_it_moves(robot: RobotModel) -> None:
    """Where the robot does what was planned nothing is added."""
    one = made(robot, ("left",), speed=0.1)
    now = state((0.1 * 100 * PERIOD, 0.0), (0.1, 0.0), {"left": (0.0, 0.0), "right": (0.0, -0.2)})
    asked = one.ask(100, now)
    pull = robot.mass * GRAVITY * np.array([0.05, 0.0]) / HEIGHT
    np.testing.assert_allclose(pressure(asked["left"], now.place["left"], pull), [0.0, 0.0], atol=1e-12)


def test_an_error_that_lasts_is_learnt_in_a_second_and_no_further_than_two_centimetres(
    robot: RobotModel,
) -> None:
    one = made(robot, ("left",))
    for sample, (x, y) in ((200, (0.01, -0.01)), (500, (0.02, -0.02))):
        for _ in range(sample - (200 if sample > 200 else 0)):
            one.ask(0, state((0.01, -0.01), places={"left": (0.0, 0.0), "right": (0.0, -0.2)}))
        np.testing.assert_allclose(one.learnt, [x, y], rtol=1e-6)


def test_the_pressure_stays_on_the_sole(robot: RobotModel) -> None:
    now = state((0.2, -0.1), places={"left": (0.0, 0.0), "right": (0.0, -0.2)})
    asked = made(robot, ("left",)).ask(0, now)
    edge = 0.85 * HALF * [1, -1]
    pull = robot.mass * GRAVITY * (np.array([0.2, -0.1]) - edge) / HEIGHT
    np.testing.assert_allclose(pressure(asked["left"], now.place["left"], pull), edge, atol=1e-12)


@pytest.mark.parametrize("y", [-0.04, 0.0, 0.03])
def test_two_feet_share_the_weight_by_the_lever(robot: RobotModel, y: float) -> None:
    """What is wanted lies between the inner edges of both soles' middle parts; neither foot leaves its own."""
    weight, now = robot.mass * GRAVITY, state((0.0, y / (3 + PERIOD)))
    asked = made(robot, ("left", "right")).ask(0, now)
    inner = 0.1 - 0.35 * HALF[1]
    share = (inner + y) / (2 * inner)
    assert asked["left"].load == pytest.approx(share * weight)
    assert asked["right"].load == pytest.approx((1 - share) * weight)
    pull = weight * (now.centre[:2] - [0.0, y]) / HEIGHT
    for foot, own, side in (("left", share, 1), ("right", 1 - share, -1)):
        place = pressure(asked[foot], now.place[foot], own * pull)
        np.testing.assert_allclose(place, [0.0, side * inner], atol=1e-12)


def test_beyond_one_foot_s_middle_both_feet_move_their_pressures(robot: RobotModel) -> None:
    """All the weight on the left foot, whose pressure goes as far out as it must."""
    wanted = np.array([0.05, 0.14])
    now = state(wanted / (3 + PERIOD))
    asked = made(robot, ("left", "right")).ask(0, now)
    weight = robot.mass * GRAVITY
    share = asked["left"].load / weight
    assert share == pytest.approx(1.0)
    pull = weight * (now.centre[:2] - wanted) / HEIGHT
    np.testing.assert_allclose(pressure(asked["left"], now.place["left"], pull), wanted, atol=1e-9)

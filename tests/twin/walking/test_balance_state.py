"""What a walking robot's own sensors tell: lean without yaw, loads, and the mass's centre over the feet that carry."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import Array
from plantar.motions.plan import Plan, Walk
from plantar.robot.model import RobotModel
from plantar.twin.walking.balance_state import StateEstimator

SOLES = {"left": (0.1, 0.12, 0.0), "right": (-0.05, -0.1, 0.0)}
BUSH = {foot: np.array(at) + [0.0, 0.0, 0.03] for foot, at in SOLES.items()}  # as far above the sole
SENSORS = {("left", "force"): 0, ("left", "torque"): 3, ("right", "force"): 6, ("right", "torque"): 9}


def reader(robot: RobotModel) -> StateEstimator:
    joints = tuple(robot.floating_model.names[2:])
    soles = {
        foot: np.tile(pin.SE3(np.eye(3), np.array(at)).homogeneous, (3, 1, 1)) for foot, at in SOLES.items()
    }
    planned = np.tile(pin.SE3(pin.utils.rotate("y", 0.1), np.zeros(3)).homogeneous, (3, 1, 1))
    stands = {foot: np.ones(3, bool) for foot in SOLES}
    walk = Walk(soles, stands, np.zeros((3, 2)), np.zeros((3, 3)))
    plan = Plan(
        "walk",
        np.arange(3) / 200,
        joints,
        np.zeros((3, len(joints))),
        planned,
        frozenset(SOLES),
        {},
        walk=walk,
    )
    places = {name: SimpleNamespace(qposadr=[7 + i], dofadr=[6 + i]) for i, name in enumerate(joints)}
    model = SimpleNamespace(
        joint=places.get, sensor=lambda name: SimpleNamespace(adr=[SENSORS[tuple(name.split("."))]])
    )
    return StateEstimator(cast(Any, model), robot, plan, joints)


def told(turn: Array, positions: Array, rates: Array, loads: tuple[float, float]) -> Any:
    """The engine's data: somewhere in the world, the sensors as the parent acts on the child."""
    x, y, z, w = pin.Quaternion(turn).coeffs()
    sensed = [0.0, 0.0, -loads[0], 1.0, -2.0, 9.0, 0.0, 0.0, -loads[1], 3.0, 4.0, 9.0]
    return SimpleNamespace(qpos=np.array([5.0, -3.0, 7.0, w, x, y, z, *positions]), qvel=rates,
                           sensordata=np.array(sensed))  # fmt: skip


def moved(one: StateEstimator, turn: Array, positions: Array) -> tuple[Array, dict[str, Array]]:
    """The centre of mass and the bushes about the root."""
    q = np.r_[np.zeros(3), pin.Quaternion(turn).coeffs(), positions]
    model, data = one.model, one.model.createData()
    centre = np.array(pin.centerOfMass(model, data, q))
    pin.framesForwardKinematics(model, data, q)
    return centre, {foot: np.array(data.oMf[frame].translation) for foot, frame in one.frames.items()}


@pytest.mark.parametrize("loads", [(600.0, 0.0), (200.0, 400.0), (0.3, 0.2)])
def test_a_robot_is_where_its_feet_are(robot: RobotModel, loads: tuple[float, float]) -> None:
    one, random = reader(robot), np.random.default_rng(3)
    positions, rates = 0.05 * random.normal(size=11), 0.1 * random.normal(size=17)
    lean = np.array([0.02, -0.03, 0.0])
    turn = pin.exp3(lean) @ pin.utils.rotate("y", 0.1)
    state = one.read(1, told(pin.utils.rotate("z", 0.4) @ turn, positions, rates, loads))
    np.testing.assert_allclose(state.lean, lean, atol=1e-4)
    assert abs(state.lean[2]) < 1e-6
    assert (state.load["left"], state.load["right"]) == loads
    np.testing.assert_array_equal(state.torque["left"], [-1.0, 2.0])
    np.testing.assert_array_equal(state.torque["right"], [-3.0, -4.0])
    measured = pin.exp3(state.lean) @ pin.utils.rotate("y", 0.1)
    shares = np.array(loads) / max(sum(loads), 1.0)

    def over_its_feet(turn: Array, positions: Array) -> Array:
        centre, bushes = moved(one, turn, positions)
        held = [
            share * (BUSH[foot] - bushes[foot]) for foot, share in zip(("left", "right"), shares, strict=True)
        ]
        return np.asarray(centre + held[0] + held[1])

    np.testing.assert_allclose(state.centre, over_its_feet(measured, positions), atol=1e-9)
    step = 1e-6
    ahead, behind = (
        over_its_feet(measured @ pin.exp3(s * rates[3:6]), positions + s * rates[6:]) for s in (step, -step)
    )
    np.testing.assert_allclose(state.centre_rate, (ahead - behind) / (2 * step), atol=1e-7)
    for foot in SOLES:
        np.testing.assert_allclose(state.place[foot], BUSH[foot], atol=1e-12)


def test_a_foot_that_pulls_carries_nothing(robot: RobotModel) -> None:
    state = reader(robot).read(0, told(np.eye(3), np.zeros(11), np.zeros(17), (-50.0, 600.0)))
    assert (state.load["left"], state.load["right"]) == (0.0, 600.0)

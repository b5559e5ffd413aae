"""How a leg makes its foot carry what is asked: each correction by its own law."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import Array
from plantar.motions.plan import Plan, Walk
from plantar.robot.model import RobotModel
from plantar.twin.bush import Bush, Feet
from plantar.twin.walking.balance_state import State
from plantar.twin.walking.foot_control import FootControl
from plantar.twin.walking.stabiliser import Asked

PERIOD = 0.005  # s
FEET = {"left": Bush(480.0, 24.0, 350.0, 28.0, 4e4), "right": Bush(430.0, 16.0, 320.0, 17.0, 5e4)}
SERVO = 100.0 / 0.01  # N·m/rad: the ankle's full torque at a hundredth of a radian
PLACE = {"left": np.array([0.0, 0.1, 0.06]), "right": np.array([0.05, -0.1, 0.06])}
LEG = 1e6  # N/m


def compliance(foot: str) -> Array:
    """Roll and pitch [rad/(N·m)]: the bush's beside the servo's."""
    return np.array([1 / FEET[foot].roll_stiffness, 1 / FEET[foot].pitch_stiffness]) + 1 / SERVO


def vertical(foot: str) -> float:
    return 1 / LEG + 1 / FEET[foot].z_stiffness


class Leg:
    """One robot over a floor: what its legs do at each sample."""

    def __init__(
        self,
        robot: RobotModel,
        standing: tuple[str, ...] = ("left", "right"),
        yaw: float = 0.0,
        bushes: Feet | None = FEET,
    ) -> None:
        self.robot, count = robot, 400
        model = robot.floating_model.copy()
        joints = tuple(name for name in model.names[2:])
        frames = {}
        for name, foot in robot.feet.items():
            joint, place = robot.frame(foot.bush)
            carrier = int(model.getJointId(robot.model.names[joint]))
            frames[name] = int(
                model.addFrame(pin.Frame(name, carrier, 0, place, pin.FrameType.OP_FRAME), False)
            )
        still = np.tile(np.eye(4), (count, 1, 1))
        turned = still.copy()
        turned[:, :3, :3] = pin.utils.rotate("z", yaw)
        stands = {foot: np.full(count, foot in standing) for foot in FEET}
        walk = Walk(dict.fromkeys(FEET, turned), stands, np.zeros((count, 2)), np.zeros((count, 3)))
        plan = Plan("walk", PERIOD * np.arange(count), joints, np.zeros((count, len(joints))), still,
                    frozenset(FEET), {}, walk=walk)  # fmt: skip

        def configuration(positions: Array, base: pin.SE3) -> Array:
            return np.array(pin.integrate(model, pin.neutral(model), np.r_[np.zeros(6), positions]))

        estimator = SimpleNamespace(model=model, data=model.createData(), joints=joints, frames=frames,
                                    configuration=configuration)  # fmt: skip
        self.control = FootControl(cast(Any, estimator), robot, plan, bushes)
        self.estimator, self.q = estimator, configuration(np.zeros(len(joints)), pin.SE3.Identity())

    def step(self, sample: int, torque: Any = (0, 0), read: Any = (0, 0), load: float = 0.0, seen: Any = None,
             lean: Any = (0, 0, 0)) -> dict[str, Array]:  # fmt: skip
        """How far each foot turns and rises, about and along its bush's axes: z [m], roll and pitch [rad]."""
        seen = seen or dict.fromkeys(FEET, load)
        state = State(np.array(lean, float), np.zeros(3), np.zeros(3), seen, dict.fromkeys(FEET, np.array(read, float)),
                      PLACE)  # fmt: skip
        asked = dict.fromkeys(FEET, Asked(load, np.array(torque, float)))
        found = self.control.correction(sample, state, asked)
        moved = {}
        for foot, frame in self.estimator.frames.items():
            jacobian = pin.computeFrameJacobian(
                self.estimator.model, self.estimator.data, self.q, frame, pin.LOCAL
            )
            moved[foot] = (jacobian @ found)[[2, 3, 4]]
        return moved


def test_the_bush_is_deflected_by_what_the_torque_asks_for_as_late_as_it_is_damped(robot: RobotModel) -> None:
    leg, torque = Leg(robot), np.array([4.0, -6.0])
    first = leg.step(0, torque, torque)
    for foot, bush in FEET.items():
        lag = np.array([bush.roll_damping / bush.roll_stiffness, bush.pitch_damping / bush.pitch_stiffness])
        np.testing.assert_allclose(
            first[foot][1:], -torque * compliance(foot) * PERIOD / (lag + PERIOD), rtol=1e-6
        )
    for sample in range(1, 399):
        last = leg.step(sample, torque, torque)
    for foot in FEET:
        np.testing.assert_allclose(last[foot][1:], -torque * compliance(foot), rtol=1e-6)


def test_what_the_force_sensor_misses_is_brought_in_at_eight_a_second(robot: RobotModel) -> None:
    leg = Leg(robot)
    for sample in range(20):
        moved = leg.step(sample, (0, 0), (1.0, -2.0))
    for foot in FEET:
        turned = 8.0 * 20 * PERIOD * np.array([1.0, -2.0]) * compliance(foot)
        np.testing.assert_allclose(moved[foot][1:], turned, rtol=1e-6)


def test_a_load_shortens_its_leg_and_the_longer_leg_carries_more(robot: RobotModel) -> None:
    still = Leg(robot).step(0, load=300.0)
    for foot in FEET:
        assert still[foot][0] == pytest.approx(-300.0 * vertical(foot), rel=1e-6)
    leg = Leg(robot)
    for sample in range(10):
        moved = leg.step(sample, load=300.0, seen={"left": 320.0, "right": 290.0})
    for foot, miss in (("left", -15.0), ("right", 15.0)):  # five too much in all, which no leg can change
        lowered = 8.0 * 10 * PERIOD * miss * vertical(foot)
        assert moved[foot][0] == pytest.approx(-300.0 * vertical(foot) - lowered, rel=1e-6)
    alone = Leg(robot, ("left",))
    for sample in range(10):
        moved = alone.step(sample, load=300.0, seen={"left": 400.0, "right": 0.0})
    assert moved["left"][0] == pytest.approx(-300.0 * vertical("left"), rel=1e-6)


def test_a_foot_in_the_air_forgets_and_gives_way(robot: RobotModel) -> None:
    leg = Leg(robot, ("left",))
    leg.control.turned["right"], leg.control.lowered["right"] = np.array([0.01, -0.02]), 0.01
    for sample in range(30):
        moved = leg.step(sample)
    faded = (1 - PERIOD / 0.15) ** 30  # after 0.15 s
    np.testing.assert_allclose(moved["right"], faded * np.array([-0.01, 0.01, -0.02]), rtol=1e-6)
    touched = Leg(robot, ("left",)).step(0, seen={"left": 600.0, "right": 10.0})
    assert touched["right"][0] == pytest.approx(30.0 * PERIOD * 10.0 * vertical("right"), rel=1e-6)


@pytest.mark.parametrize("yaw", [0.0, 0.5])
def test_a_lean_is_taken_off_and_a_foot_in_the_air_kept_at_its_height(robot: RobotModel, yaw: float) -> None:
    """The robot turns about the foot that stands; a foot in the air would go down by the lean's arm."""
    leg, lean = Leg(robot, ("left",), yaw), np.array([0.02, -0.01, 0.0])
    for sample in range(10):
        moved = leg.step(sample, lean=lean)
    for foot in FEET:
        np.testing.assert_allclose(moved[foot][1:], -(pin.utils.rotate("z", yaw).T @ lean)[:2], atol=1e-9)
    arm = PLACE["right"] - PLACE["left"]
    sinks = lean[0] * arm[1] - lean[1] * arm[0]
    assert moved["right"][0] == pytest.approx(-sinks * (1 - (1 - PERIOD / 0.05) ** 10), rel=1e-6)
    assert moved["left"][0] == pytest.approx(0.0, abs=1e-9)
    for foot, both in Leg(robot, yaw=yaw).step(0, lean=lean).items():
        assert both[0] == pytest.approx(0.0, abs=1e-9), f"{foot} stands"


def test_no_leg_corrects_more_than_a_quarter_radian_and_three_centimetres(robot: RobotModel) -> None:
    moved = Leg(robot).step(0, load=1e7, lean=(0.4, -0.4, 0))
    for foot in FEET:
        np.testing.assert_allclose(moved[foot], [-0.03, -0.25, 0.25], rtol=1e-6)
    allowed = Leg(robot).step(0, load=0.025 / vertical("left"), lean=(0.24, -0.24, 0))
    np.testing.assert_allclose(allowed["left"], [-0.025, -0.24, 0.24], rtol=1e-6)


def test_without_rubber_servos_alone_give_way_and_at_once(robot: RobotModel) -> None:
    torque = np.array([4.0, -6.0])
    moved = Leg(robot, bushes=None).step(0, torque, torque, load=300.0)
    for foot in FEET:
        np.testing.assert_allclose(moved[foot], [-300.0 / LEG, *(-torque / SERVO)], rtol=1e-6)

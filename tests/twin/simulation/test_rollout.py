"""The twin's physics, against laws that know nothing of its code."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from example_robots import talos_file
from kept_texts import assert_as_kept, described
from plantar.conventions import rotation_from_quaternion
from plantar.errors import MotionError
from plantar.motions import plan_motion
from plantar.robot.model import RobotModel, load_robot
from plantar.twin import PAPER, Bush
from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import bush_forces, exact_columns, truth_columns
from plantar.twin.simulation import stepping
from plantar.twin.simulation.physics import Physics, Slip
from plantar.twin.simulation.rollout import Rollout, roll_out, scene_xml
from plantar.twin.simulation.stepping import Element
from twin_samples import flung, plan, roll, short, swayed, tilted

GRAVITY = 9.80665


def fit(deflection: np.ndarray, rate: np.ndarray, torque: np.ndarray) -> np.ndarray:
    rows = np.column_stack([deflection, rate, np.ones_like(rate)])
    return np.linalg.lstsq(rows, torque, rcond=None)[0]


def recorded(rollout: Rollout, robot: RobotModel) -> dict[str, np.ndarray]:
    return exact_columns(rollout, robot, cut_feet(describe(robot), robot))


@pytest.mark.parametrize(("axis", "column"), [("pitch", 1), ("roll", 2)])
def test_the_torque_obeys_the_bush(axis: str, column: int) -> None:
    rollout = swayed()
    deflection, rate = rollout.bush["right"][:, column], rollout.bush_rates["right"][:, column]
    stiffness, damping, offset = fit(deflection, rate, bush_forces(rollout, "right")[:, column])
    assert stiffness == pytest.approx(getattr(PAPER["right"], f"{axis}_stiffness"), rel=1e-5)
    assert damping == pytest.approx(getattr(PAPER["right"], f"{axis}_damping"), rel=1e-5)
    assert offset == pytest.approx(0.0, abs=1e-4)


def test_the_sole_stays_flat_so_that_the_imu_sees_the_bush() -> None:
    rollout = swayed()
    attitude = rotation_from_quaternion(rollout.sensors["right.sole"])
    tilt = np.arctan2(attitude[:, 2, 1], attitude[:, 2, 2])
    slope = np.polyfit(rollout.bush["right"][:, 2], tilt, 1)[0]
    assert abs(slope) < 2e-4  # the floor's softness goes straight into K


def test_log_alone_gives_stiffness_and_damping_back() -> None:
    """Angles and torques from the log's columns with Pinocchio, none of the package's kinematics."""
    robot, rollout = hrp2.robot(), swayed()
    columns = recorded(rollout, robot)
    model, data = robot.model, robot.model.createData()
    ankle, bush = robot.frame(robot.feet["right"].bush)
    chest, imu = robot.frame(robot.imu.placement)
    attitude = np.column_stack([columns[f"imu.chest.orientation.{axis}"] for axis in "wxyz"])
    up = np.empty((len(rollout.time), 3))
    for row, turn in enumerate(rotation_from_quaternion(attitude)):
        q = np.array([columns[f"joint.{name}.position"][row] for name in robot.joint_names])
        pin.forwardKinematics(model, data, q)
        between = (data.oMi[chest] * imu).inverse() * (data.oMi[ankle] * bush)
        up[row] = between.rotation.T @ turn.T[:, 2]
    roll_angle = -np.arcsin(up[:, 1])
    pitch = np.arctan2(up[:, 0], up[:, 2])
    force = np.column_stack([columns[f"wrench.right_foot.force.{axis}"] for axis in "xyz"])
    torque = np.column_stack([columns[f"wrench.right_foot.torque.{axis}"] for axis in "xyz"])
    lever = np.array([0.0, 0.0, -0.105 + 0.085]) - np.column_stack(
        [np.zeros_like(pitch), np.zeros_like(pitch), rollout.bush["right"][:, 0]]
    )
    torque = torque + np.cross(lever, force)
    generalised = torque[:, 0] * np.cos(pitch) - torque[:, 2] * np.sin(pitch)
    stiffness, damping, _ = fit(roll_angle, np.gradient(roll_angle, 0.005), generalised)
    assert stiffness == pytest.approx(323.0, rel=1e-3)
    assert damping == pytest.approx(17.53, rel=5e-3)


def test_signs_and_weight() -> None:
    robot, rollout = hrp2.robot(), tilted()
    columns = recorded(rollout, robot)
    both = sum(columns[f"wrench.{side}_foot.force.z"] for side in ("left", "right"))
    assert both == pytest.approx(np.full(len(both), robot.mass * GRAVITY), rel=0.02)
    assert (rollout.bush["left"][:, 0] > 0).all()  # compressed under load
    assert columns["imu.chest.linear_acceleration.z"].mean() == pytest.approx(GRAVITY, rel=5e-3)


def test_a_foot_in_the_air_reads_nothing() -> None:
    columns = recorded(swayed(), hrp2.robot())
    for axis in "xyz":
        assert np.abs(columns[f"wrench.left_foot.force.{axis}"]).max() < 1.0
    truth = truth_columns(swayed(), cut_feet(describe(hrp2.robot()), hrp2.robot()))
    assert np.isnan(truth["left.contact.cop.x"]).all()
    assert np.abs(truth["right.contact.cop.y"]).max() < 0.069


def test_newton_and_euler_close_over_the_whole_robot() -> None:
    """The base rows of inverse dynamics on the URDF equal the logged wrenches, sole's weight and all: of a robot that
    sways slowly, and of one whose light arms move fast."""
    for rollout, least in ((tilted(), (3e-5, 5e-4)), (flung(), (5e-5, 1e-4))):
        sides = [_both_sides(rollout, row) for row in range(100, len(rollout.time) - 100, 20)]
        needed, measured = (np.array(side) for side in zip(*sides, strict=True))
        for rows, most in zip((slice(0, 3), slice(3, 6)), least, strict=True):
            off, moves = needed[:, rows] - measured[:, rows], needed[:, rows] - needed[:, rows].mean(axis=0)
            assert np.linalg.norm(off) < most * np.linalg.norm(moves)


def _both_sides(rollout: Rollout, row: int) -> tuple[np.ndarray, np.ndarray]:
    robot = hrp2.robot()
    columns = recorded(rollout, robot)
    model, data = robot.floating_model, robot.floating_model.createData()
    before, q, after = (_configuration(model, rollout, columns, at) for at in (row - 1, row, row + 1))
    forth, back = pin.difference(model, q, after), pin.difference(model, before, q)
    tau = pin.rnea(model, data, q, (forth + back) / 2 / 0.005, (forth - back) / 0.005**2)
    tau[:6] -= pin.computeGeneralizedGravity(model, data, q)[:6] * (1 - GRAVITY / 9.81)
    pin.forwardKinematics(model, data, q)
    total = np.zeros(6)
    for side in ("left", "right"):
        joint, pose = robot.frame(robot.feet[side].wrench.placement)
        local = [columns[f"wrench.{side}_foot.{k}.{a}"][row] for k in ("force", "torque") for a in "xyz"]
        placement = data.oMi[model.getJointId(robot.model.names[joint])] * pose
        total += data.oMi[1].actInv(placement.act(pin.Force(np.array(local)))).vector
    return tau[:6], total


def _configuration(
    model: pin.Model, rollout: Rollout, columns: dict[str, np.ndarray], row: int
) -> np.ndarray:
    q = pin.neutral(model)
    w, x, y, z = rollout.base[row, 3:]
    q[:7] = [*rollout.base[row, :3], x, y, z, w]
    for name in hrp2.robot().joint_names:
        q[model.joints[model.getJointId(name)].idx_q] = columns[f"joint.{name}.position"][row]
    return q


@pytest.mark.parametrize("motion", [swayed, tilted, flung])
def test_a_rollout_is_as_it_is_kept(motion: Callable[[], Rollout]) -> None:
    """Engines of another version differ in small digits."""
    kept = Path(__file__).parent / "kept" / f"{motion.__name__}.txt"
    assert_as_kept(described(motion()), kept, share=1e-2, least=1e-3)


def test_the_same_plan_gives_the_same_numbers() -> None:
    played = short(plan("Tilt3"), 2.0, 2.5)
    first, second = roll(played, Physics(settle=0.2)), roll(played, Physics(settle=0.2))
    assert np.array_equal(first.efforts, second.efforts)
    assert np.array_equal(first.sensors["imu.angular_velocity"], second.sensors["imu.angular_velocity"])


def test_an_elastoplastic_element_pulls_beside_the_spring() -> None:
    bush = Bush(434.0, 15.89, 323.0, 17.53, roll_slip_torque=2.0, roll_slip_angle=0.01)
    rollout = roll(
        short(plan("Manual_right_roll"), 10.0, 13.0), Physics({"right": bush, "left": bush}, settle=1.0)
    )
    angle, rate = rollout.bush["right"][:, 2], rollout.bush_rates["right"][:, 2]
    left_over = bush_forces(rollout, "right")[:, 2] - 323.0 * angle - 17.53 * rate
    assert np.abs(left_over).max() == pytest.approx(2.0, abs=1e-3)  # never more than the slip torque
    state = np.empty_like(angle)  # the element by its definition, from where the log begins
    state[0] = left_over[0] / 200.0
    for row in range(1, len(angle)):
        state[row] = np.clip(state[row - 1] + angle[row] - angle[row - 1], -0.01, 0.01)
    assert left_over == pytest.approx(200.0 * state, abs=0.02)


def test_a_hardening_bush_pulls_with_the_cube() -> None:
    bush = Bush(434.0, 15.89, 323.0, 17.53, roll_hardening=5000.0)
    rollout = roll(
        short(plan("Manual_right_roll"), 10.0, 11.0), Physics({"right": bush, "left": bush}, settle=0.5)
    )
    angle, rate = rollout.bush["right"][:, 2], rollout.bush_rates["right"][:, 2]
    expected = 323.0 * angle + 17.53 * rate + 5000.0 * angle**3
    assert bush_forces(rollout, "right")[:, 2] == pytest.approx(expected, abs=2e-3)


def test_rigid_feet_have_no_bush_but_a_wrench() -> None:
    rollout = roll(short(plan("Tilt3"), 2.0, 2.5), Physics(bushes=None, settle=0.5))
    assert not rollout.bush["left"].any()
    columns = recorded(rollout, hrp2.robot())
    both = sum(columns[f"wrench.{side}_foot.force.z"] for side in ("left", "right"))
    assert both.mean() == pytest.approx(hrp2.robot().mass * GRAVITY, rel=0.02)


def test_a_sole_that_has_been_on_its_edge_stands_still_again() -> None:
    """A light sole rattled from edge to edge for good, and its damper's torque reached the log."""
    rollout = roll(short(plan("Manual_both_pitch"), 8.0, 14.0), Physics(settle=1.0))
    pressure = truth_columns(rollout, cut_feet(describe(hrp2.robot()), hrp2.robot()))["left.contact.cop.x"]
    assert np.nanmax(np.abs(pressure)) > 0.1  # tips over the toes or the heel at 0.1086
    for foot in ("left", "right"):
        rate = rollout.bush_rates[foot][:, 2]
        jumps = np.abs(np.diff(rate))[rollout.time[1:] > 5.0]
        assert np.median(jumps) < 0.01  # rad/s from sample to sample; it rattled by 0.1


def test_native_steps_are_the_steps_in_python(monkeypatch: pytest.MonkeyPatch) -> None:
    bush = Bush(434.0, 15.89, 323.0, 17.53, 239018.0, 1000.0, 5000.0, 4000.0, 5.0, 2.0, 0.01, 0.008)
    world = Physics({"right": bush, "left": bush}, settle=0.5)
    played = short(plan("Manual_right_roll"), 10.0, 11.0)
    assert stepping.engine_step() is not None
    fast = roll(played, world)
    monkeypatch.setattr(stepping, "engine_step", lambda: None)
    slow = roll(played, world)
    for foot in ("left", "right"):
        assert np.ptp(slow.rubber[foot], axis=0).max() > 0
        assert fast.rubber[foot] == pytest.approx(slow.rubber[foot], abs=1e-12)
    assert fast.bush["right"] == pytest.approx(slow.bush["right"], abs=1e-14)
    assert fast.sensors["imu.angular_velocity"] == pytest.approx(
        slow.sensors["imu.angular_velocity"], abs=1e-11
    )


def test_native_steps_refuse_what_does_not_fit() -> None:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><joint name='j' type='hinge'/><geom size='.1'/></body></worldbody>"
        "<actuator><motor joint='j'/></actuator></mujoco>"
    )
    data, step = mujoco.MjData(model), stepping.engine_step()
    assert step is not None
    with pytest.raises(ValueError, match="no such place"):
        stepping.native(model, data, [(1, 0, Element(1.0, 0.1, 0.0))], step)
    with pytest.raises(ValueError, match="every actuator"):
        stepping.native(model, data, [], step).run(np.zeros((3, 2)))
    with pytest.raises(ValueError, match="address of nothing"):
        stepping.native(model, data, [], 0)


def test_a_slippery_second_lets_the_foot_slide() -> None:
    played = short(plan("Manual_right_roll"), 10.0, 12.5)
    slips = (Slip(0.5, 2.0, 0.005),)
    dry, wet = roll(played, Physics(settle=1.0)), roll(played, Physics(slips=slips, settle=1.0))
    for rollout, slides in ((dry, False), (wet, True)):
        way = np.ptp(rollout.sensors["right.place"][:, :2], axis=0).max()
        assert (way > 1e-3) == slides


def test_a_robot_that_falls_is_reported_with_its_time() -> None:
    soft = Bush(60.0, 5.0, 60.0, 5.0)
    with pytest.raises(
        MotionError,
        match=r"^t = 0 s: Tilt3: the robot falls, it leans 156° away from its plan \(valid: a smaller "
        r"or slower motion\)$",
    ):
        roll(short(plan("Tilt3"), 2.0, 8.0), Physics({"right": soft, "left": soft}))


def test_any_biped_stands_on_given_bushes(tmp_path) -> None:
    robot = load_robot(talos_file(tmp_path))
    bushes = {foot: Bush(1000.0, 20.0, 800.0, 16.0, 4e5, 1000.0) for foot in ("left", "right")}
    played, physics = short(plan_motion("Tilt3", robot), 2.0, 4.5), Physics(bushes, settle=1.0)
    rollout = roll_out(robot, played, physics, scene_xml(robot, played, physics))
    stiffness, damping, _ = fit(
        rollout.bush["left"][:, 1], rollout.bush_rates["left"][:, 1], bush_forces(rollout, "left")[:, 1]
    )
    assert (stiffness, damping) == pytest.approx((1000.0, 20.0), rel=1e-4)
    columns = recorded(rollout, robot)
    both = sum(columns[f"wrench.{side}.force.z"] for side in ("left", "right"))
    assert both.mean() == pytest.approx(robot.mass * GRAVITY, rel=0.02)

"""The root's motion from an IMU anywhere on the robot, or from a sole at rest, against Pinocchio."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar import _core
from plantar.conventions import Array
from plantar.dynamics import Equation, Motion
from plantar.dynamics.base_motion import root_motion, root_motion_from_sole
from plantar.dynamics.inertial_motion import InertialSignals, inertial_motion, turned_motions
from plantar.robot.kinematics import packed_frame
from plantar.robot.model import RobotModel

PLACEMENT = pin.SE3(pin.rpy.rpyToMatrix(0.3, -0.4, 0.5), np.array([0.1, -0.2, 0.3]))
G = 9.80665
LINK = 3  # the last of the arm's, behind the root's own


def arm() -> pin.Model:
    """A free root, then a hinge, a slide and a hinge about axes of their own, each turned against the one before."""
    model = pin.Model()
    last = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")
    joints = (
        pin.JointModelRevoluteUnaligned(np.array([0.6, 0.0, 0.8])),
        pin.JointModelPrismaticUnaligned(np.array([0.0, 0.6, 0.8])),
        pin.JointModelRY(),
    )
    for place, joint in enumerate(joints):
        turn = pin.rpy.rpyToMatrix(0.2 + place, 0.5, -0.3 * place)
        last = model.addJoint(last, joint, pin.SE3(turn, np.array([0.1, 0.2 * place, 0.3])), f"joint_{place}")
        model.appendBodyToJoint(last, pin.Inertia.Random(), pin.SE3.Identity())
    return model


def moved(root: Array) -> tuple[pin.Model, Array, Array, Array, pin.Data]:
    """The arm in a random motion of its joints, its root's velocity and acceleration `root` (2, 6) in its own axes."""
    model, random = arm(), np.random.default_rng(7)
    q, v, a = random.normal(size=(3, 3))
    data = model.createData()
    whole = np.concatenate([pin.neutral(model)[:7], q])
    pin.forwardKinematics(model, data, whole, np.concatenate([root[0], v]), np.concatenate([root[1], a]))
    return model, q, v, a, data


def at(model: pin.Model, data: pin.Data) -> tuple[pin.SE3, pin.Motion, Array]:
    """The frame's pose, its velocity, and its acceleration as a point has it, in its own axes."""
    frame = pin.Frame("imu", model.njoints - 1, 0, PLACEMENT, pin.FrameType.OP_FRAME)
    pose = data.oMi[model.njoints - 1] * PLACEMENT
    velocity, acceleration = (PLACEMENT.actInv(one[frame.parentJoint]) for one in (data.v, data.a))
    classical = acceleration.linear + np.cross(velocity.angular, velocity.linear)
    return pose, velocity, np.concatenate([classical, acceleration.angular])


@pytest.mark.parametrize("isa", _core.instruction_sets())
def test_the_root_moves_as_an_imu_on_the_arm_tells(isa: str) -> None:
    """Through hinges and a slide, with Coriolis' and centripetal accelerations: the root's proper acceleration and
    turning come back."""
    root = np.random.default_rng(3).normal(size=(2, 6))
    model, q, v, a, data = moved(root)
    pose, velocity, acceleration = at(model, data)
    read = acceleration[:3] + pose.rotation.T @ [0.0, 0.0, G]
    seen = np.concatenate([read, velocity.angular, acceleration[3:]])
    rows = (each[None] for each in (seen, q, v, a))
    found = _core.root_motion(Equation(model).core, LINK, packed_frame(PLACEMENT), *rows, isa=isa)[0]
    proper = root[1, :3] + np.cross(root[0, 3:], root[0, :3]) + [0.0, 0.0, G]
    assert found == pytest.approx(np.concatenate([proper, root[0, 3:], root[1, 3:]]), abs=1e-12)


def test_a_sole_that_stands_is_an_imu_at_rest() -> None:
    model, q, v, a, _ = moved(np.zeros((2, 6)))
    still, joints = np.array([[0.0, 0.0, G, *np.zeros(6)]]), (q[None], v[None], a[None])
    rest = root_motion(Equation(model), LINK, PLACEMENT, still, *joints)
    assert root_motion_from_sole(Equation(model), LINK, PLACEMENT, *joints) == pytest.approx(rest)


def test_the_root_is_seen_from_itself_where_it_is() -> None:
    """An IMU on the root link, which does not turn: it reads what the root does, in its own axes."""
    still, turn = np.zeros(6), PLACEMENT.rotation
    seen = np.concatenate([turn.T @ [1.0, 2.0, 3.0], still])[None]
    found = root_motion(Equation(arm()), 0, PLACEMENT, seen, *np.ones((3, 1, 3)))
    assert found[0] == pytest.approx(np.concatenate([[1.0, 2.0, 3.0], still]))


def test_an_imu_that_is_turned_in_its_own_axes_reads_as_one_mounted_so(robot: RobotModel) -> None:
    """A mount of 0.5, -0.4 and 1.2 rad, from which the turn about x is none about the link's x."""
    equation, random = Equation(robot.floating_model), np.random.default_rng(2)
    positions = 0.1 * random.standard_normal((50, len(robot.joint_names)))
    signals = InertialSignals(positions, *random.standard_normal((2, 50, 3)), 0.01)

    def mounted(rotation: Array) -> RobotModel:
        placement = replace(robot.required_imu.placement, rpy=pin.rpy.matrixToRpy(rotation))
        return replace(robot, imu=replace(robot.required_imu, placement=placement))

    mount, turn = pin.rpy.rpyToMatrix(0.5, -0.4, 1.2), pin.exp3(np.array([0.3, 0.0, 0.0]))
    (found,) = turned_motions(mounted(mount), equation, signals, slice(10, 40), [turn])
    expected = inertial_motion(mounted(mount @ turn), equation, signals, slice(10, 40))
    np.testing.assert_allclose(found.base, expected.base, atol=1e-9)


def test_readings_that_are_late_are_taken_as_they_are_later(robot: RobotModel) -> None:
    """Joints and turning go on evenly; an acceleration by encoders changes with the moment of theirs."""
    equation, late, kept = Equation(robot.floating_model), 0.025, slice(10, 40)
    time = 0.01 * np.arange(60)[:, None]
    slopes = np.arange(1.0, 1.0 + len(robot.joint_names)) / 50

    def motion(encoders: float, gyroscope: float, now: float = 0.0, turning: float = 0.0) -> Motion:
        signals = InertialSignals(
            slopes * (time + now), (time + turning) * [0.1, 0.2, 0.3], np.tile([0.0, 0.0, G], (60, 1)), 0.01,
            by_encoders=np.tile([1.0, -2.0, 3.0], (60, 1)),
        )  # fmt: skip
        return inertial_motion(robot, equation, signals, kept, encoders, gyroscope)

    turned, wanted = motion(0.0, late), motion(0.0, 0.0, turning=late)
    np.testing.assert_allclose(turned.base, wanted.base, atol=1e-12)
    read, wanted = motion(late, 0.0), motion(0.0, 0.0, now=late)
    np.testing.assert_allclose(read.positions, wanted.positions, atol=1e-12)
    placement = robot.frame(robot.required_imu.placement)[1]
    moved = placement.rotation @ [late * 1.0, late * -2.0, late * 3.0]
    np.testing.assert_allclose(read.base[:, :3], wanted.base[:, :3] + moved, atol=1e-12)
    np.testing.assert_allclose(read.base[:, 3:], wanted.base[:, 3:], atol=1e-12)

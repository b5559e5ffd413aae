"""Equation 1 against Pinocchio: regressors, inverse dynamics and contact transfer."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pinocchio as pin
import pytest

import example_robots
from example_robots import random_motion
from plantar import _core
from plantar.conventions import Array
from plantar.dynamics import Contact, Equation, Motion, model_parameters, pinocchio_motion, regressor
from plantar.errors import DataError
from plantar.robot.kinematics import packed_frame

ROBOTS = [
    (example_robots.TALOS, True),
    (example_robots.G1, True),
    (example_robots.ICUB, True),
    (example_robots.HAND, False),
    (example_robots.PANDA, False),
    (example_robots.TIAGO, True),
    (example_robots.TIAGO, False),
]
NAMES = [f"{urdf.stem}-{'floating' if floating else 'fixed'}" for urdf, floating in ROBOTS]


def relative(found: Array, expected: Array) -> float:
    return float(np.abs(found - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize(("urdf", "floating"), ROBOTS, ids=NAMES)
def test_the_regressor_is_pinocchios_to_1e_10(urdf: object, floating: bool) -> None:
    model = example_robots.model(urdf, floating=floating)  # type: ignore[arg-type]
    data = model.createData()
    motion = random_motion(model, 21, 1)
    samples = zip(*motion, strict=True)
    expected = np.array([pin.computeJointTorqueRegressor(model, data, *s).copy() for s in samples])
    assert relative(regressor(model, *motion), expected) < 1e-10


@pytest.mark.parametrize(("urdf", "floating"), ROBOTS, ids=NAMES)
def test_regressor_times_parameters_and_inverse_dynamics_are_rnea(urdf: object, floating: bool) -> None:
    model = example_robots.model(urdf, floating=floating)  # type: ignore[arg-type]
    data = model.createData()
    motion = random_motion(model, 19, 2)
    expected = np.array([pin.rnea(model, data, *sample).copy() for sample in zip(*motion, strict=True)])
    parameters = model_parameters(model)
    assert relative(regressor(model, *motion) @ parameters, expected) < 1e-10
    equation = Equation(model)
    found = equation.inverse_dynamics(pinocchio_motion(model, equation.tree, *motion), parameters)
    assert relative(found.T, expected) < 1e-10


@pytest.mark.parametrize("urdf", [urdf for urdf, floating in ROBOTS if floating])
def test_base_wrenches_of_several_robots_at_once_are_rneas_first_rows(urdf: object) -> None:
    model = example_robots.model(urdf, floating=True)  # type: ignore[arg-type]
    motion, random = random_motion(model, 19, 3), np.random.default_rng(3)
    heavier, expected = model.copy(), []
    for body in list(heavier.inertias)[1:]:
        body.mass *= random.uniform(0.5, 2.0)
        body.lever = body.lever + random.normal(0.0, 0.02, 3)
    for each in (model, heavier):
        data = each.createData()
        expected.append([pin.rnea(each, data, *sample)[:6].copy() for sample in zip(*motion, strict=True)])
    equation = Equation(model)
    parameters = np.array([model_parameters(model), model_parameters(heavier)])
    given = pinocchio_motion(model, equation.tree, *motion)
    assert relative(equation.base_wrenches(given, parameters), np.array(expected)) < 1e-10
    for isa in _core.instruction_sets():
        found = _core.base_wrenches(equation.core, parameters, *vars(given).values(), threads=2, isa=isa)
        assert relative(found, np.array(expected)) < 1e-10


@pytest.mark.parametrize(("urdf", "floating"), ROBOTS[:1] + ROBOTS[4:], ids=NAMES[:1] + NAMES[4:])
def test_contact_transfer_is_the_transposed_jacobian(urdf: object, floating: bool) -> None:
    model = example_robots.model(urdf, floating=floating)  # type: ignore[arg-type]
    data = model.createData()
    q, _, _ = random_motion(model, 7, 3)
    equation = Equation(model)
    rng = np.random.default_rng(3)
    for joint in (2, model.njoints // 2, model.njoints - 1):
        placement = pin.SE3(pin.exp3(rng.normal(size=3)), rng.normal(size=3))
        frame = model.addFrame(
            pin.Frame(f"contact {joint}", joint, 0, placement, pin.FrameType.OP_FRAME), False
        )
        data = model.createData()
        found = equation.contact_transfer(equation.tree.joint_positions(q), Contact(joint - 1, placement))
        for i in range(len(q)):
            jacobian = pin.computeFrameJacobian(model, data, q[i], frame, pin.ReferenceFrame.LOCAL)
            np.testing.assert_allclose(found[i], jacobian.T, rtol=1e-10, atol=1e-10)
        if floating:
            base = equation.base_transfer(equation.tree.joint_positions(q), Contact(joint - 1, placement))
            np.testing.assert_allclose(base, found[:, :6], rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("isa", _core.instruction_sets())
def test_a_frame_anywhere_tells_the_roots_motion(isa: str) -> None:
    """Against Pinocchio's motion of the frame: arms that turn and slide, and more samples than lanes."""
    model = example_robots.model(example_robots.TIAGO, floating=True)
    equation = Equation(model)
    q, v, a = random_motion(model, 37, 6)
    given, data = pinocchio_motion(model, equation.tree, q, v, a), model.createData()
    place = pin.SE3(pin.exp3(np.array([0.3, -0.8, 0.5])), np.array([0.1, -0.2, 0.3]))
    joint = model.getJointId("arm_7_joint")
    measured = []
    for sample in zip(q, v, a, strict=True):
        pin.forwardKinematics(model, data, *sample)
        speed, slope = place.actInv(data.v[joint]), place.actInv(data.a[joint])
        up = -(data.oMi[joint] * place).rotation.T @ model.gravity.linear
        proper = slope.linear + np.cross(speed.angular, speed.linear) + up
        measured.append(np.concatenate([proper, speed.angular, slope.angular]))
    joints = (given.positions, given.velocities, given.accelerations)
    arguments = (equation.core, joint - 1, packed_frame(place), np.array(measured), *joints)
    np.testing.assert_allclose(_core.root_motion(*arguments, threads=2, isa=isa), given.base, atol=1e-9)
    base = _core.base_transfer(*arguments[:3], given.positions, threads=2, isa=isa)
    whole = equation.contact_transfer(given.positions, Contact(joint - 1, place))
    np.testing.assert_allclose(base, whole[:, :6], rtol=1e-10, atol=1e-10)


def test_contacts_carry_part_of_the_inverse_dynamics() -> None:
    """With two wrenches acting, what is left of Y phi is Y phi - K F, summed over both."""
    model = example_robots.model(example_robots.TALOS, floating=True)
    equation = Equation(model)
    q, v, a = random_motion(model, 9, 4)
    motion = pinocchio_motion(model, equation.tree, q, v, a)
    rng = np.random.default_rng(4)
    contacts = [Contact(link, pin.SE3(pin.exp3(rng.normal(size=3)), rng.normal(size=3))) for link in (6, 12)]
    wrenches = [rng.normal(size=(9, 6)) for _ in contacts]
    expected = equation.inverse_dynamics(motion, model_parameters(model)).T
    for contact, wrench in zip(contacts, wrenches, strict=True):
        transfer = equation.contact_transfer(motion.positions, contact)
        expected = expected - np.einsum("nri,ni->nr", transfer, wrench)
    found = equation.inverse_dynamics(motion, model_parameters(model), contacts, wrenches).T
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_base_rows_need_no_attitude_only_proper_acceleration() -> None:
    """The world turned about any axis, gravity with it: the same motion of the root frame, the same rows."""
    model = example_robots.model(example_robots.G1, floating=True)
    equation = Equation(model)
    q, v, a = random_motion(model, 5, 5)
    before = pinocchio_motion(model, equation.tree, q, v, a)
    turn = pin.exp3(np.array([0.3, -0.8, 0.5]))
    model.gravity.linear = turn @ model.gravity.linear
    turned = q.copy()
    for i in range(len(q)):
        rotation = pin.Quaternion(q[i, 3:7]).toRotationMatrix()
        turned[i, 3:7] = pin.Quaternion(turn @ rotation).coeffs()
    after = pinocchio_motion(model, equation.tree, turned, v, a)
    np.testing.assert_allclose(after.base, before.base, atol=1e-12)


def test_every_instruction_set_gives_the_same_rows() -> None:
    model = example_robots.model(example_robots.ICUB, floating=True)
    equation = Equation(model)
    motion = pinocchio_motion(model, equation.tree, *random_motion(model, 1030, 6))
    wanted = [True] * equation.n_rows
    arguments = ([1023] * len(equation.links), wanted, *vars(motion).values())
    expected = _core.regressor(equation.core, *arguments, threads=1, isa="baseline")
    for isa in _core.instruction_sets():
        found = _core.regressor(equation.core, *arguments, threads=2, isa=isa)
        assert relative(found, expected) < 1e-13


def test_wrong_shapes_and_values_that_are_not_finite_are_named() -> None:
    model = example_robots.model(example_robots.TALOS, floating=True)
    q, v, a = random_motion(model, 4, 7)
    with pytest.raises(DataError, match=r"^v: an array of shape \(4, 37\) \(valid: \(4, 38\)\)$"):
        regressor(model, q, v[:, :-1], a)
    a[2, 5] = np.nan
    with pytest.raises(DataError, match=r"^a: sample 2, column 5 is nan \(valid: finite numbers\)$"):
        regressor(model, q, v, a)


def test_a_motion_knows_its_finite_samples() -> None:
    zero = np.zeros((3, 2))
    motion = Motion(np.zeros((3, 9)), zero, zero.copy(), zero.copy())
    motion.velocities[1, 0] = np.inf
    assert motion.finite.tolist() == [True, False, True]
    assert len(motion.select(motion.finite)) == 2


def test_the_kept_equation_is_given_back_when_python_ends() -> None:
    """Else nanobind prints a list of leaks below what a command says. What is registered first is called last."""
    program = (
        "import atexit, sys\n"
        "atexit.register(lambda: print(sys.modules['plantar.dynamics.equation'].equation_of.cache_info().currsize))\n"
        "from plantar.dynamics.equation import equation_of\n"
        "from plantar.twin.robots import hrp2\n"
        "equation_of(hrp2.robot().floating_model)\n"
        "print(equation_of.cache_info().currsize)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["1", "0"]

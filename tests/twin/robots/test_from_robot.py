"""Robots from URDFs as they are published, rounded and with links of next to no inertia, stand in MuJoCo."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from biped_robot import URDF
from example_robots import G1, ICUB, ROMEO
from plantar.errors import RobotError
from plantar.robot.model import load_robot
from plantar.robot_guess import guess_robot_file
from plantar.twin import Bush
from plantar.twin.robots import from_robot
from plantar.twin.simulation.mjcf import Scene, mjcf_text

BUSH = Bush(300.0, 6.0, 220.0, 5.0, 200e3, 800.0)


@pytest.mark.parametrize("urdf", [ICUB, G1, ROMEO], ids=lambda path: path.stem)
def test_published_urdfs_stand_in_mujoco_with_their_weight(tmp_path: Path, urdf: Path) -> None:
    """iCub's URDF has inertias of 1e-20, which MuJoCo refuses in words that name no link."""
    file = tmp_path / "robot.yaml"
    file.write_text(guess_robot_file(urdf, [], file))
    robot = load_robot(file)
    model = mujoco.MjModel.from_xml_string(mjcf_text(robot, {"left": BUSH, "right": BUSH}, Scene()))
    assert float(np.sum(model.body_mass)) == pytest.approx(robot.mass, rel=2e-3)


@pytest.mark.parametrize("urdf", [G1, None], ids=["g1", "a neck that turns without end"])
def test_the_twin_of_a_urdf_has_its_limits_and_its_mass_matrix(tmp_path: Path, urdf: Path | None) -> None:
    """MuJoCo's, of the joints among each other, beside Pinocchio's, in a posture that turns every joint."""
    if urdf is None:
        urdf = tmp_path / "biped.urdf"
        urdf.write_text(URDF.replace('"neck" type="revolute"', '"neck" type="continuous"'))
    file = tmp_path / "robot.yaml"
    file.write_text(guess_robot_file(urdf, [], file))
    robot = load_robot(file)
    model = mujoco.MjModel.from_xml_string(mjcf_text(robot, {"left": BUSH, "right": BUSH}, Scene()))
    data = mujoco.MjData(model)
    q, asked = pin.neutral(robot.model), np.random.default_rng(0).uniform(-0.4, 0.4, robot.model.nv)
    q = pin.integrate(robot.model, q, asked)
    rows = []
    for name, angle in zip(list(robot.model.names)[1:], asked, strict=True):
        joint, own = model.joint(name), robot.model.joints[robot.model.getJointId(name)]
        data.qpos[joint.qposadr] = angle
        rows.append(int(joint.dofadr[0]))
        endless = own.nq == 2
        assert bool(joint.limited[0]) != endless
        if not endless:
            low, high = robot.model.lowerPositionLimit[own.idx_q], robot.model.upperPositionLimit[own.idx_q]
            assert joint.range == pytest.approx([low, high])
    assert any(joint.nq == 2 for joint in robot.model.joints) == (urdf != G1)
    mujoco.mj_forward(model, data)
    found, column = np.empty((len(rows), len(rows))), np.empty(model.nv)
    for place, row in enumerate(rows):
        mujoco.mj_mulM(model, data, column, np.eye(model.nv)[row])
        found[:, place] = column[rows]
    found -= np.diag(model.dof_armature[rows])
    wanted = np.array(pin.crba(robot.model, robot.model.createData(), q))
    wanted = np.triu(wanted) + np.triu(wanted, 1).T
    # The bushes' plates are the twin's own; no joint but those between IMU and feet moves them.
    assert np.abs(found - wanted).max() < 0.02 * wanted.max()
    free = [place for place, name in enumerate(robot.joint_names) if name not in robot.path_joints]
    assert found[np.ix_(free, free)] == pytest.approx(wanted[np.ix_(free, free)], abs=1e-9)


def chain() -> pin.Model:
    """A joint that turns about an askew axis, one that slides on it 0.3 m away, and one that may do anything."""
    model = pin.Model()
    placed = pin.SE3(np.eye(3), np.array([0.0, -0.2, 0.3]))
    turns = model.addJoint(0, pin.JointModelRevoluteUnaligned(np.array([0.0, 0.6, 0.8])), placed, "turns")
    slides = model.addJoint(
        turns, pin.JointModelPX(), pin.SE3(np.eye(3), np.array([0.3, 0.0, -0.4])), "slides"
    )
    model.addJoint(slides, pin.JointModelPY(), pin.SE3(np.eye(3), np.array([0.0, 0.0, 0.001])), "near")
    model.lowerPositionLimit = np.array([-1.0, 0.0, 2.0])
    model.upperPositionLimit = np.array([2.0, 0.0, 1.0])
    return model


def test_axes_limits_and_rods_of_joints() -> None:
    model, robot = chain(), SimpleNamespace(path=Path("robot.yaml"))
    axes = from_robot._axes(model, robot)  # type: ignore[arg-type]
    np.testing.assert_allclose(axes[1], [0, 0, 0, 0, 0.6, 0.8])
    np.testing.assert_allclose(axes[2], [1, 0, 0, 0, 0, 0])
    free = (-np.inf, np.inf)
    assert [from_robot._limits(model, place) for place in range(3)] == [(-1.0, 2.0), free, free]
    (rod,) = from_robot._rods(model, 1)
    np.testing.assert_allclose(rod.xyz, [0.15, 0.0, -0.2])
    np.testing.assert_allclose(rod.size, np.array([0.3, 0.0, 0.4]) + from_robot.ROD)
    assert from_robot._rods(model, 2) == (), "what is nearer than a rod is thick has none"
    told = [from_robot._positive(value, 7.0) for value in (3.0, 0.0, -1.0, 1e6, np.inf)]
    assert told == [3.0, 7.0, 7.0, 7.0, 7.0]
    model.addJoint(1, pin.JointModelSpherical(), pin.SE3.Identity(), "ball")
    with pytest.raises(
        RobotError,
        match=r"^robot\.yaml: joint 'ball' has 3 degrees of freedom \(valid: joints of one degree of freedom\)$",
    ):
        from_robot._axes(model, robot)  # type: ignore[arg-type]


def test_an_inertia_is_about_the_centre_of_mass() -> None:
    given = pin.Inertia(2.0, np.array([0.1, 0.2, 0.3]), np.diag([0.5, 0.6, 0.7]))
    mass, centre, inertia = from_robot._inertia(given)
    assert mass == 2.0
    np.testing.assert_array_equal(centre, [0.1, 0.2, 0.3])
    np.testing.assert_allclose(inertia, np.diag([0.5, 0.6, 0.7]))

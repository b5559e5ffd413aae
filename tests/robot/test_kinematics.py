"""The tree of joints that the native core is given."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import example_robots
from plantar.errors import RobotError
from plantar.robot.kinematics import KinematicTree, centre_of_mass


@pytest.mark.parametrize("urdf", [example_robots.TIAGO, example_robots.PANDA, example_robots.HAND])
def test_the_tree_rebuilds_pinocchios_poses(urdf: Path) -> None:
    """With prismatic, continuous and unaligned joints, of many samples at once."""
    model = example_robots.model(urdf)
    tree, data = KinematicTree.from_model(model), model.createData()
    pin.seed(3)
    q = np.array([pin.randomConfiguration(model, -np.ones(model.nq), np.ones(model.nq)) for _ in range(4)])
    rotations, places = tree.poses(tree.joint_positions(q))
    model.inertias[0] = pin.Inertia.Zero()  # Pinocchio leaves out of the centre of mass what does not move
    centre = centre_of_mass(model, rotations, places)
    for sample, configuration in enumerate(q):
        pin.forwardKinematics(model, data, configuration)
        np.testing.assert_allclose(centre[sample], pin.centerOfMass(model, data, configuration), atol=1e-12)
        for j, name in enumerate(model.names):
            assert pin.SE3(rotations[j, sample], places[j, sample]).isApprox(data.oMi[j], 1e-12), name


def test_continuous_joints_are_read_as_one_angle() -> None:
    model = example_robots.model(example_robots.TIAGO, floating=True)
    tree = KinematicTree.from_model(model)
    assert model.nq > model.nv + 1, "the robot should have a continuous joint"
    rng = np.random.default_rng(0)
    angles = rng.uniform(-3, 3, (5, len(tree)))
    q = np.zeros((5, model.nq))
    q[:, 6] = 1
    for j, name in enumerate(tree.names):
        joint = model.joints[model.getJointId(name)]
        turns = [np.cos(angles[:, j]), np.sin(angles[:, j])] if joint.nq == 2 else [angles[:, j]]
        q[:, joint.idx_q : joint.idx_q + joint.nq] = np.column_stack(turns)
    np.testing.assert_allclose(tree.joint_positions(q), angles, atol=1e-14)


def test_the_path_between_two_links_leaves_out_what_both_share() -> None:
    tree = KinematicTree.from_model(example_robots.model(example_robots.TALOS))
    chest, foot = tree.names.index("torso_2_joint"), tree.names.index("leg_left_6_joint")
    path = tree.path(chest, foot)
    assert [tree.names[j] for j, _ in path] == ["torso_2_joint", "torso_1_joint"] + [
        f"leg_left_{i}_joint" for i in range(1, 7)
    ]
    assert [sign for _, sign in path] == [-1, -1] + [1] * 6
    knee = tree.names.index("leg_left_4_joint")
    assert [tree.names[j] for j, _ in tree.path(knee, foot)] == ["leg_left_5_joint", "leg_left_6_joint"]
    assert tree.path(foot, foot) == []


@pytest.mark.parametrize("joint", [pin.JointModelSpherical(), pin.JointModelPlanar()])
def test_a_joint_of_several_axes_is_refused_by_name(joint: object) -> None:
    model = pin.Model()
    model.addJoint(0, joint, pin.SE3.Identity(), "shoulder")
    with pytest.raises(RobotError, match="'shoulder'"):
        KinematicTree.from_model(model)


def test_a_mimicking_joint_is_refused_by_name() -> None:
    urdf = """<robot name="gripper"><link name="palm"/><link name="a"/><link name="b"/>
      <joint name="one" type="revolute"><parent link="palm"/><child link="a"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
      <joint name="two" type="revolute"><parent link="palm"/><child link="b"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="one"/></joint></robot>"""
    with pytest.raises(
        RobotError,
        match=r"^joint 'two' is of type Mimic: it mimics another joint; write it as a joint of its own$",
    ):
        KinematicTree.from_model(pin.buildModelFromXML(urdf, mimic=True))

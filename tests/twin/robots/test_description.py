"""Where bodies are, and what they weigh together, beside Pinocchio."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from plantar.twin.robots.description import Body, Description, box_inertia

# Parents, and whether the joint slides: a chain that slides behind a turn, and a branch.
TREE = ((-1, False), (0, False), (1, True), (2, False), (1, True), (4, False))


def both() -> tuple[Description, pin.Model]:
    pin.seed(3)
    random, model, bodies = np.random.default_rng(3), pin.Model(), list[Body]()
    for place, (parent, slides) in enumerate(TREE):
        mass, com, size = random.uniform(1, 3), random.normal(size=3), random.uniform(0.1, 0.5, 3)
        own = pin.Inertia(mass, com, box_inertia(mass, size))
        if parent < 0:
            bodies.append(Body("root", -1, mass=mass, com=com, inertia=box_inertia(mass, size)))
            model.appendBodyToJoint(0, own, pin.SE3.Identity())
            continue
        pose, axis = pin.SE3.Random(), random.normal(size=3)
        axis /= np.linalg.norm(axis)
        joint = (pin.JointModelPrismaticUnaligned if slides else pin.JointModelRevoluteUnaligned)(axis)
        model.appendBodyToJoint(
            model.addJoint(parent, joint, pose, f"joint {place}"), own, pin.SE3.Identity()
        )
        bodies.append(
            Body(f"body {place}", parent, f"joint {place}", "prismatic" if slides else "revolute", axis,
                 pose.translation, pose.rotation, mass=mass, com=com, inertia=box_inertia(mass, size))
        )  # fmt: skip
    return Description("tree", tuple(bodies)), model


def test_bodies_are_placed_and_weighed_as_pinocchio_does() -> None:
    robot, model = both()
    q, data = np.random.default_rng(4).normal(size=model.nq), model.createData()
    pin.forwardKinematics(model, data, q)
    for (rotation, origin), pose in zip(robot.placements(q), data.oMi, strict=True):
        np.testing.assert_allclose(rotation, pose.rotation, atol=1e-12)
        np.testing.assert_allclose(origin, pose.translation, atol=1e-12)
    whole = pin.Inertia.Zero()
    for pose, inertia in zip(data.oMi, model.inertias, strict=True):
        whole += pose.act(inertia)
    mass, centre, inertia = robot.mass_properties(q)
    assert mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(centre, whole.lever, atol=1e-12)
    np.testing.assert_allclose(inertia, whole.inertia, atol=1e-9)


def test_a_box_is_as_textbooks_say() -> None:
    np.testing.assert_allclose(box_inertia(12.0, np.array([1.0, 2.0, 3.0])), np.diag([13.0, 10.0, 5.0]))

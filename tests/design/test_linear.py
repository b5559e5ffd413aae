"""How hard feet push against one another: beside the least energy of joints that give way, and friction's law."""

from __future__ import annotations

from copy import copy

import numpy as np
import pinocchio as pin
import pytest

import design_samples
from plantar.conventions import GRAVITY
from plantar.design.family import CHANNELS
from plantar.design.linear import internal_forces
from plantar.design.rubber import remembered
from plantar.twin.robots import hrp2
from plantar.twin.robots.from_robot import describe

FRICTION = 0.3
SLIP_ANGLE = 0.01
CORNER = 1 / np.cos(np.pi / 8)  # what an octagon's corners are outside its circle


def test_what_holds_a_foot_is_what_bends_the_joints_least() -> None:
    """Castigliano: of all forces and yaw moments with which the floor can hold a foot, those of least energy."""
    legs = design_samples.legs()
    model, data, rest = legs.model, legs.data, legs.rest[0]
    limits = {body.joint: body.effort for body in describe(hrp2.robot()).bodies[1:]}
    pin.computeJointJacobians(model, data, rest)
    pin.updateFramePlacements(model, data)
    for given in ([7.0, 0.0, 0.0], [0.0, -4.0, 0.0], [2.0, 3.0, 40.0]):  # pitch, roll [N·m], along z [N]
        found = []
        for frame in legs.bushes.values():
            rows = pin.getFrameJacobian(
                model, data, model.getFrameId(frame), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
            )
            joints = [joint for joint in model.joints[2:] if model.names[joint.id] in limits]
            weak = np.array([limits[model.names[joint.id]] for joint in joints]) ** -0.5
            effect = weak[:, None] * rows[:, [joint.idx_v for joint in joints]].T  # of a wrench on the foot
            wrench = np.array([0.0, 0.0, given[2], given[1], given[0], 0.0])
            found.append(np.linalg.lstsq(effect[:, [0, 1, 5]], -effect @ wrench, rcond=None)[0][:2])
        assert internal_forces(legs) @ given == pytest.approx(np.mean(found, axis=0), rel=1e-6)


def test_legs_are_columns_that_ankles_push_apart() -> None:
    """A foot that is turned toes up is pushed back by the floor it would slide on; about x the other way round."""
    pushed = internal_forces(design_samples.legs())
    height = design_samples.linear().pendulum.height
    assert 1.0 / height < pushed[0, 0] < 3.0 / height
    assert 1.0 / height < -pushed[1, 1] < 3.0 / height
    assert np.abs(pushed[[0, 1], [1, 0]]).max() < 0.05 / height


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_feet_are_beyond_their_limits_where_they_slip(sign: float) -> None:
    reach, shape = copy(design_samples.reach()), sign * design_samples.coefficients()
    sides = len(reach.feet) * len(reach.bushes) * 8
    for side in ("_low", "_high"):
        limits = np.full_like(getattr(reach, side), np.inf)
        limits[-sides:] = getattr(reach, side)[-sides:]
        setattr(reach, side, limits)
    bent, load = reach.of(reach.deflection, shape), reach.of(reach.load, shape)
    slips = remembered(bent.reshape(-1, bent.shape[-1]), [SLIP_ANGLE]).reshape(bent.shape)
    torque = reach.stiffness[:, None, None, None] * bent + reach.element[:, None] * slips
    torque += reach.damping[:, None, None, None] * reach.of(reach.rate, shape)
    odd = np.concatenate([torque, load[:, :, None]], axis=2)
    odd = (odd[:, 0] - odd[:, 1]) / 2
    internal, whole = internal_forces(design_samples.legs()) @ odd, reach.of(reach.forces, shape)[:2]
    beyond = []
    for place, other in enumerate((1.0, -1.0)):
        aside = np.linalg.norm(whole / 2 + other * internal, axis=1)
        beyond.append(((aside - FRICTION * load[:, place]) / (FRICTION * reach.weight)).max())
    assert max(beyond) / CORNER <= reach.used(shape) <= max(beyond) + 1e-9
    assert max(beyond) > 0.2, "or nothing was asked of the floor"


def test_the_pendulum_is_every_link_about_the_middle_of_the_bushes() -> None:
    legs, pendulum = design_samples.legs(), design_samples.linear().pendulum
    model, data, (rest, _, poses) = legs.model, legs.model.createData(), legs.rest
    pin.forwardKinematics(model, data, rest)
    middle = sum(pose.translation for pose in poses.values()) / len(poses)
    second, first = np.zeros((3, 3)), np.zeros(3)  # moments of mass: of squares, and of places
    for place, body in zip(data.oMi, model.inertias, strict=True):
        arm = place.act(body.lever) - middle
        turned = place.rotation @ body.inertia @ place.rotation.T
        second += turned.trace() / 2 * np.eye(3) - turned + body.mass * np.outer(arm, arm)
        first += body.mass * arm
    mass = sum(body.mass for body in model.inertias)
    assert pendulum.mass == pytest.approx(mass)
    assert pendulum.height == pytest.approx(first[2] / mass)
    assert pendulum.inertia == pytest.approx([second[1, 1] + second[2, 2], second[0, 0] + second[2, 2]])
    for foot, pose in poses.items():
        assert pendulum.places[foot] == pytest.approx(pose.translation[:2] - middle[:2], abs=1e-9)


def test_what_channels_ask_of_the_ground_is_newtons_law() -> None:
    """Only the three that move the centre of mass take force; what they hold is the weight, moved aside."""
    legs, robot = design_samples.legs(), design_samples.linear()
    mass = robot.pendulum.mass
    centre = np.zeros((len(CHANNELS), 3))
    centre[[CHANNELS.index(f"centre.{axis}") for axis in "xyz"]] = legs.directions.T
    np.testing.assert_allclose(robot.moved[:, :3], mass * centre, atol=2e-3 * mass)
    weight = mass * GRAVITY * np.array([0.0, 0.0, 1.0])
    held = np.hstack([np.zeros_like(centre), np.cross(centre, weight)])
    np.testing.assert_allclose(robot.held, held, atol=2e-3 * mass * GRAVITY)
    still, quick = np.zeros((len(CHANNELS), 2)), np.zeros((len(CHANNELS), 2))
    still[0, 1], quick[2, 0] = 0.5, 3.0
    asked = robot.wrench(still, quick)
    np.testing.assert_allclose(asked.T, [3.0 * robot.moved[2], 0.5 * robot.held[0]])

"""Inverse kinematics beside Pinocchio on the robot's own URDF."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

import design_samples
from plantar.contact.balance import planned_wrench
from plantar.conventions import GRAVITY
from plantar.design.family import CHANNELS
from plantar.design.legs import RISE, SPARE, Legs
from plantar.errors import MotionError
from plantar.motions.walk import SETTLED
from plantar.twin.robots import hrp2


def moved(**channels: float) -> np.ndarray:
    values = np.zeros(len(CHANNELS))
    for name, value in channels.items():
        values[CHANNELS.index(name.replace("_", ".", 1))] = value
    return values


def frames(q: np.ndarray) -> tuple[pin.Model, pin.Data]:
    model = hrp2.robot().floating_model
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    pin.centerOfMass(model, data, q)
    return model, data


def test_centre_and_ankles_go_where_they_are_told() -> None:
    legs = design_samples.legs()
    wanted = moved(centre_x=0.01, centre_y=-0.015, centre_z=-0.005, left_roll=0.03, left_pitch=-0.02)
    rest, q = legs.follow(np.column_stack([0 * wanted, wanted]))
    assert rest == pytest.approx(legs.rest[0], abs=1e-6)
    (model, before), (_, after) = frames(rest), frames(q)
    assert after.com[0] - before.com[0] == pytest.approx([0.01, -0.015, -0.005], abs=1e-5)
    left, right = (model.getFrameId(f"{side}LEG_LINK5") for side in "LR")
    turned = before.oMf[left].rotation.T @ after.oMf[left].rotation
    sole = (
        pin.rpy.rotate("y", 0.02) @ pin.rpy.rotate("x", -0.03)
    ).T  # what bends the rubber by pitch 0.02, roll -0.03
    assert turned == pytest.approx(sole, abs=1e-6)
    assert after.oMf[right].homogeneous == pytest.approx(before.oMf[right].homogeneous, abs=1e-6)
    centre = [0.0, 0.0, -0.085, 1.0]  # of the bush, in the ankle's link: it stays
    assert after.oMf[left].homogeneous @ centre == pytest.approx(
        before.oMf[left].homogeneous @ centre, abs=1e-6
    )


def test_standing_puts_the_centre_over_the_bushes_with_bent_knees() -> None:
    rest, centre, poses = design_samples.legs().rest
    middle = np.mean([pose.translation for pose in poses.values()], axis=0)
    assert centre[:2] == pytest.approx(middle[:2], abs=1e-9)
    model = hrp2.robot().floating_model
    for joint in ("LLEG_JOINT3", "RLEG_JOINT3"):
        assert rest[model.joints[model.getJointId(joint)].idx_q] > 0.2


def test_with_a_foot_ahead_the_centre_goes_across_the_line_of_the_feet_and_along_it() -> None:
    """The robot leans about that line: what goes along it only leads the load from foot to foot."""
    legs = Legs.of(hrp2.robot(), hrp2.postures().standing, 0.05)
    assert legs.ahead == pytest.approx(0.05, abs=1e-6)
    assert design_samples.legs().ahead == pytest.approx(0.0, abs=1e-6)
    (_, before), (_, after) = (
        frames(legs.follow(moved(**{way: 0.01})[:, None])[0]) for way in ("centre_x", "centre_y")
    )
    bushes = legs.rest[2]
    line = bushes["left"].translation - bushes["right"].translation
    assert line[:2] == pytest.approx([-0.05, 0.19], abs=1e-3)
    across, along = (data.com[0] - legs.rest[1] for data in (before, after))
    assert across @ line == pytest.approx(0.0, abs=1e-5)
    assert across[0] > 0.009
    assert along == pytest.approx(0.01 * line / np.linalg.norm(line), abs=1e-5)


def test_what_is_out_of_reach_is_refused() -> None:
    with pytest.raises(
        MotionError,
        match=r"^hrp2_like: the legs cannot reach their places, they miss by [\d.]+ mm or mrad "
        r"\(valid: a smaller motion\)$",
    ):
        design_samples.legs().follow(moved(centre_z=0.3)[:, None])


def test_the_linear_wrench_is_that_of_inverse_dynamics() -> None:
    """A sway of 1 cm is held by m g times it; its acceleration takes m times it at the centre's height."""
    linear = design_samples.linear()
    mass, height = linear.pendulum.mass, linear.pendulum.height
    row = CHANNELS.index("centre.x")
    assert mass == pytest.approx(hrp2.robot().mass)
    assert linear.held[row] == pytest.approx([0, 0, 0, 0, -mass * GRAVITY, 0], abs=0.02 * mass * GRAVITY)
    assert linear.moved[row, 0] == pytest.approx(mass, rel=1e-3)
    assert linear.moved[row, 4] == pytest.approx(
        mass * height, rel=0.2
    )  # the rest is what trunk and legs turn
    rest, centre, _ = design_samples.legs().rest
    still = np.zeros((1, design_samples.legs().model.nv))
    weight = planned_wrench(hrp2.robot().floating_model, rest[None], still, still)[0]
    assert weight[2] == pytest.approx(mass * GRAVITY, rel=1e-3)
    assert centre[2] - height == pytest.approx(0.02, abs=1e-3)  # of the bush above the floor


def test_from_standing_the_robot_can_rise_also_where_its_knees_were_straight() -> None:
    legs = Legs.of(hrp2.robot(), {})
    rest, centre, poses = legs.rest
    root = pin.XYZQUATToSE3(rest[:7]).rotation
    higher = legs.solve(rest, root, centre * [1.0, 1.0, 1.0 + RISE], poses, SETTLED)
    knees = [legs.model.joints[legs.model.getJointId(f"{side}LEG_JOINT3")].idx_q for side in "LR"]
    assert all(angle > SPARE for angle in higher[knees]), "still bent"
    assert pin.centerOfMass(legs.model, legs.data, higher)[2] == pytest.approx(
        (1 + RISE) * centre[2], abs=1e-5
    )


def test_the_centre_moves_across_and_along_the_line_through_the_bushes_on_the_level() -> None:
    """The right bush is 0.3 m ahead, 0.4 m to the right and lower: along is to the left and back."""
    bushes = {"left": np.array([0.1, 0.2, 0.5]), "right": np.array([0.4, -0.2, 0.3])}
    poses = {foot: pin.SE3(np.eye(3), place) for foot, place in bushes.items()}
    directions = Legs.directions.func(SimpleNamespace(rest=(None, None, poses)))  # type: ignore[attr-defined]
    assert pytest.approx(np.array([[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])) == directions.T

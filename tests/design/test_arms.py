"""Which joints swing, how far and which way, on a trunk with arms that are made by hand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from plantar.design.arms import SWING, arm_swing
from plantar.motions.body import CHEST
from plantar.motions.upper import ROOM

# Name, parent, axis, mass at 0.3 m below it [kg], limits [rad]; none where the lower one is not below the other.
JOINTS = (
    ("hip", 1, (0, 1, 0), 8.0, (-2.0, 2.0)),
    ("waist", 1, (0, 1, 0), 0.0, (-2.0, 2.0)),
    ("shoulder", 3, (0, 1, 0), 2.0, (-2.0, 2.0)),
    ("backwards", 3, (0, -1, 0), 2.0, (-0.2, 0.5)),
    ("outstretched", 3, (0, 1, 0), 2.0, (-0.25, 0.05)),
    ("unlimited", 3, (0, 1, 0), 2.0, (0.0, 0.0)),
    ("past its limit", 3, (0, 1, 0), 2.0, (0.1, 0.5)),
    ("finger", 3, (0, 1, 0), 0.3, (-2.0, 2.0)),
    ("aside", 3, (1, 0, 0), 2.0, (-2.0, 2.0)),
)


def body(*without: str) -> SimpleNamespace:
    model = pin.Model()
    model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root_joint")
    for name, parent, axis, mass, (low, high) in JOINTS:
        joint = model.addJoint(
            parent, pin.JointModelRevoluteUnaligned(*map(float, axis)), pin.SE3.Identity(), name,
            np.array([100.0]), np.array([100.0]), np.array([low]), np.array([high]),
        )  # fmt: skip
        mass = 0.0 if name in without else mass
        model.appendBodyToJoint(
            joint, pin.Inertia(mass, np.array([0.0, 0.0, -0.3]), np.zeros((3, 3))), pin.SE3.Identity()
        )
    model.appendBodyToJoint(3, pin.Inertia(500.0, np.zeros(3), np.eye(3)), pin.SE3.Identity())
    model.addFrame(pin.Frame(CHEST, 3, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    return SimpleNamespace(model=model, leg_joints=frozenset({1, 2}))


def test_arms_swing_together_as_far_as_their_nearer_limits_let_them() -> None:
    made = body()
    q = pin.neutral(made.model)
    swing = dict(zip(tuple(made.model.names)[2:], arm_swing(made, q)[6:], strict=True))  # type: ignore[arg-type]
    forward = np.sign(swing["shoulder"])
    assert {name: forward * value for name, value in swing.items() if value} == pytest.approx(
        {"shoulder": SWING, "backwards": -ROOM * 0.2, "outstretched": ROOM * 0.05, "unlimited": ROOM * SWING}
    )
    assert SWING > ROOM * 0.2


def test_a_robot_without_arms_swings_none() -> None:
    made = body(*(name for name, *_ in JOINTS[2:]))
    q = pin.neutral(made.model)
    assert not arm_swing(made, q).any()  # type: ignore[arg-type]


def test_the_swing_turns_the_body_forward() -> None:
    """Positive about y: the arm's own momentum, by its axis."""
    made = body()
    q, v = pin.neutral(made.model), arm_swing(made, pin.neutral(made.model))  # type: ignore[arg-type]
    assert pin.computeCentroidalMomentum(made.model, made.model.createData(), q, v).angular[1] > 0

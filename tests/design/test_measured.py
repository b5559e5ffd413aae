"""What a rehearsal measures, of made-up truth: margins of each foot, loads, friction, bend, efforts and soft floors."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.conventions import GRAVITY
from plantar.design.rehearsals import rehearsal
from plantar.design.soft_feet import SINKS, Softness
from plantar.robot.model import RobotModel
from plantar.twin.bush import Bush
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.physics import Physics

SWING = np.array([0.0, 1.0, 0.0, -1.0])
LEFT, RIGHT = Bush(500.0, 10.0, 300.0, 5.0), Bush(400.0, 10.0, 200.0, 5.0)


def truth(weight: float, **changes: Any) -> dict[str, np.ndarray]:
    """Soles reach 130 mm ahead and 80 mm aside; the left foot's pressure comes to 30 and 60 mm of its borders."""
    columns: dict[str, Any] = {
        "left.contact.cop.x": 0.02 + 0.08 * SWING, "left.contact.cop.y": 0.01 * SWING,
        "right.contact.cop.x": 0.0 * SWING, "right.contact.cop.y": -0.03 + 0.0 * SWING,
        "left.contact.force.z": weight * (0.9 + 0.2 * SWING), "right.contact.force.z": weight * (1.1 - 0.2 * SWING),
        "left.contact.force.x": 3.0 * SWING, "left.contact.force.y": 4.0 * SWING,
        "right.contact.force.x": 0.0 * SWING, "right.contact.force.y": 0.0 * SWING,
    }  # fmt: skip
    for place, (foot, axis) in enumerate(
        (foot, axis) for foot in ("left", "right") for axis in ("pitch", "roll")
    ):
        columns |= {
            f"{foot}.deflection.{axis}": 0.01 * (place + 1) * SWING, f"{foot}.torque.{axis}": 7.0 + 2.0 * SWING,
            f"{foot}.tilt.{axis}": 1e-3 * (place + 1) * SWING,
        }  # fmt: skip
    return {name: np.asarray(values) for name, values in (columns | changes).items()}


def measured(robot: RobotModel, monkeypatch: pytest.MonkeyPatch, **changes: Any) -> rehearsal.Rehearsal:
    weight = robot.mass * GRAVITY / 2
    recorded = SimpleNamespace(truth=SimpleNamespace(columns=truth(weight, **changes)))
    monkeypatch.setattr(rehearsal, "_recorded", lambda factor, *_: recorded)
    limits = {body.joint: body.effort for body in describe(robot).bodies[1:]}
    joints = list(limits)[:2]
    efforts = np.array([[0.1, -0.3], [0.2, 0.25]]) * [limits[joint] for joint in joints]
    bush = {"left": np.arange(12.0).reshape(4, 3)}
    rollout: Any = SimpleNamespace(joints=joints, efforts=efforts, bush=bush)
    return rehearsal._measured(0.5, robot, rollout, Physics(bushes={"left": LEFT, "right": RIGHT}))


def test_each_number_is_that_of_the_foot_that_comes_nearest_to_its_limit(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = measured(robot, monkeypatch)
    assert found.factor == 0.5
    assert found.sole_margins == pytest.approx((0.03, 0.05)), "the left one ahead, the right one aside"
    assert found.standing_margins == pytest.approx((0.11, 0.05))
    assert found.sole_margin == pytest.approx(0.03)
    assert found.least_load == pytest.approx(0.7)
    assert found.friction == pytest.approx(5.0 / (0.7 * robot.mass * GRAVITY / 2))
    assert found.bend == pytest.approx(0.04)
    assert found.effort == pytest.approx(0.3)
    assert found.yields == pytest.approx({
        ("left", "pitch"): 500 * 0.5e-3, ("left", "roll"): 300 * 1e-3, ("right", "pitch"): 400 * 1.5e-3,
        ("right", "roll"): 200 * 2e-3,
    })  # fmt: skip
    np.testing.assert_array_equal(found.bushes["left"], np.arange(12.0).reshape(4, 3)[:, 1:])
    assert found.fell is None


def test_a_foot_that_lifts_off_has_no_margin(robot: RobotModel, monkeypatch: pytest.MonkeyPatch) -> None:
    gone = np.array([0.0, np.nan, 0.0, 0.0])
    found = measured(
        robot,
        monkeypatch,
        **{"right.contact.cop.x": gone, "right.contact.force.z": np.array([9.0, 0.0, 9.0, 9.0])},
    )
    assert found.sole_margins == (-1.0, -1.0)
    assert found.standing_margins == (0.0, 0.0)
    assert found.least_load == 0.0


def test_bushes_of_a_softness_are_alike_about_both_axes_and_carry_the_weight(robot: RobotModel) -> None:
    told = Softness.told(robot, 500.0, None)
    assert told == Softness(500.0, 20.0, robot.mass * GRAVITY / SINKS, 0.005 * robot.mass * GRAVITY / SINKS)
    assert Softness.told(robot, 500.0, 3.0).damping == 3.0
    half = told.times(0.5)
    assert half == Softness(250.0, 10.0, told.vertical, told.vertical_damping)
    bush = rehearsal.bush_of(Softness(1.0, 2.0, 3.0, 4.0))
    assert bush == Bush(1.0, 2.0, 1.0, 2.0, 3.0, 4.0)

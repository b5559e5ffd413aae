"""Small parts of the faults' checks, each by a case that is solved by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped import record, sway
from plantar.faults.joints.closed_chain import _unexplained
from plantar.faults.joints.names import check_path_joints
from plantar.faults.joints.stepping_joints import _longest_step, _range
from plantar.faults.stance import StanceSides
from plantar.faults.stance_changes import SHIFTED, StanceChanges
from plantar.robot.model import RobotModel


def test_the_longest_of_both_soles_lengths_and_widths() -> None:
    polygons = [[0.1, 0.05], [-0.1, -0.05]], [[0.08, 0.13], [-0.08, -0.14]]
    feet = {
        name: SimpleNamespace(sole=SimpleNamespace(polygon=np.array(polygon)))
        for name, polygon in zip(("left", "right"), polygons, strict=True)
    }
    stance: Any = SimpleNamespace(robot=SimpleNamespace(feet=feet))
    changes = StanceChanges(stance)
    assert changes.longest == pytest.approx(0.27)
    assert changes.shifted == pytest.approx(SHIFTED * 0.27)


def test_a_joint_turns_by_its_known_positions_of_a_run_alone() -> None:
    position = np.array([9.0, 1.0, np.nan, 4.0, -9.0, np.nan, np.nan])
    assert _range(position, slice(1, 4)) == 3.0
    assert _range(position, slice(5, 7)) == 0.0
    assert _range(None, slice(1, 4)) == 0.0


@pytest.mark.parametrize(
    ("angle", "torque", "left"),
    [
        ([1.0, 2.0, 3.0], [5.0, 3.0, 1.0], 0.0),
        ([1.0, 2.0, 3.0], [1.0, 4.0, 1.0], 1.0),
        ([0.0, 1.0, 0.0, -1.0], [1.0, 1.0, -1.0, -1.0], 0.5),
        ([2.0, 2.0, 2.0], [1.0, 4.0, 1.0], 1.0),  # neither stands for the other where one stands still
        ([1.0, 4.0, 1.0], [2.0, 2.0, 2.0], 1.0),
    ],
)
def test_what_does_not_follow_the_deflection_is_a_share_of_the_torque(
    angle: list[float], torque: list[float], left: float
) -> None:
    """About its own axis: the other one follows, or not, as it likes."""
    other = np.arange(len(angle)) ** 2.0
    state: Any = SimpleNamespace(
        deflection=np.column_stack([other, angle]), torque=np.column_stack([-other, torque])
    )
    assert _unexplained(state, 1) == pytest.approx(left, abs=1e-12)


def test_the_longest_stretch_at_one_angle_is_a_step_where_the_foot_lands_and_leaves_as_usual() -> None:
    """Steps of 100 samples, and a bounce of 4 at a landing: half of a usual step is 50. The angle stands from 90 to
    206, through a step, longer in the air from 510 to 590, and for 20 samples about the bounce."""
    changes = np.array([100, 200, 300, 400, 404, 500, 600, 700])
    position = np.arange(800.0)
    for start, stop in ((90, 206), (395, 415), (510, 590)):
        position[start:stop] = position[start]
    assert _longest_step(position, changes) == slice(90, 206)
    position[90:206] = np.arange(90.0, 206.0)
    assert _longest_step(position, changes) is None, "of a bounce, or between two steps, nothing is told"
    moving = np.arange(800.0)
    assert _longest_step(moving, changes) is None


def test_joints_that_no_leg_has_are_not_missed(robot: RobotModel) -> None:
    log = record(sway(duration=5.0))
    gone = [f"joint.{name}.position" for name in ("neck", "left_ankle_roll")]
    assert list(check_path_joints(robot, log.without(gone[:1]))) == []
    (found,) = check_path_joints(robot, log.without(gone))
    assert (found.code, found.fatal) == ("joint_names", True)
    assert found.text.startswith(
        "columns 'joint.*.position': left_ankle_roll not recorded, and with them at 0 the feet"
    )


def components_of(left: float, right: float, other: float = 0.0) -> dict[str, float]:
    """What is left with each component reversed, of torques about x of both feet that add up with `other` to a moment
    arm about x which follows a motion."""
    motion = np.sin(np.arange(40.0))
    arms = np.zeros((40, 2, 6, 3))
    for foot, size in enumerate((left, right)):
        arms[:, foot, 3, 0] = size * motion
    arms[:, 0, 2, 0] = other * motion
    sides = StanceSides(arms, np.tile([0.0, 0.0, 1.0], (40, 1)), np.tile([0.0, 0.0, 1.0], (40, 1)))
    feet = {name: SimpleNamespace(wrench=SimpleNamespace(name=f"{name}_foot")) for name in ("left", "right")}
    stance: Any = SimpleNamespace(robot=SimpleNamespace(feet=feet), sides=lambda: sides)
    usual = float(np.median(np.abs(motion)))
    found = StanceChanges(stance)._reversed_components()
    return {name: round(misfit / usual, 3) for name, misfit in found.items()}


def test_a_component_of_both_wrenches_is_reversed_only_where_both_take_part() -> None:
    """Of torques of 1 and 1 beside 2 of a force each alone leaves half, and that moves by too much still. Of torques
    of 1 and 0.1 beside 1 the left one alone leaves as little as both."""
    every = "columns 'wrench.*.torque.*'"
    assert components_of(1.0, 1.0, 2.0) == {"columns 'wrench.*.torque.x'": 0.0, every: 0.0}
    assert components_of(1.0, 0.1, 1.0) == {"column 'wrench.left_foot.torque.x'": 0.1, every: 0.1}
    assert components_of(0.1, 1.0, 1.0) == {"column 'wrench.right_foot.torque.x'": 0.1, every: 0.1}

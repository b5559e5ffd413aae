"""Small parts of the faults' checks, each by a case that is solved by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.faults.joints.closed_chain import _unexplained
from plantar.faults.joints.stepping_joints import _range
from plantar.faults.stance_changes import SHIFTED, StanceChanges


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

"""What a result holds of the robot and of its feet beside the numbers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from biped_robot import make_robot
from plantar.feet.result import _feet_notes, _offsets, _robot_model
from plantar.results.feet import Offset
from plantar.robot.model import Placement, RobotModel, Sole


def test_an_export_finds_each_foot_as_the_robot_file_places_it(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    foot = replace(
        robot.feet["left"],
        ankle="ankle",
        bush=Placement("cup", np.array([0.1, 0.2, 0.3]), np.array([0.4, 0.5, 0.6])),
        sole=Sole(
            Placement("plate", np.arange(3.0), np.arange(3.0, 6.0)),
            np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]]),
        ),
    )
    robot = replace(robot, feet={"left": foot}, uncertainty=replace(robot.uncertainty, imu_mount=0.02))
    found = _robot_model(robot)
    assert found.keys() == {"urdf", "feet", "uncertainty"}
    assert found["urdf"] == str(robot.urdf_path)
    assert found["uncertainty"]["imu_mount"] == 0.02
    plate = {"link": "plate", "xyz": [0.0, 1.0, 2.0], "rpy": [3.0, 4.0, 5.0]}
    assert found["feet"] == {
        "left": {
            "ankle": "ankle",
            "bush": {"link": "cup", "xyz": [0.1, 0.2, 0.3], "rpy": [0.4, 0.5, 0.6]},
            "sole": plate | {"polygon": [[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]]},
        }
    }


@pytest.mark.parametrize(("axis", "unit"), [("pitch", "N.m"), ("roll", "N.m"), ("z", "N")])
def test_each_motion_has_its_offset_with_its_deviation(axis: str, unit: str) -> None:
    fit = SimpleNamespace(
        foot="left", axis=axis, offsets={"tilt": -0.4, "sway": 1.5}, offset_std={"sway": 0.2, "tilt": 0.1}
    )
    assert _offsets(fit) == [  # type: ignore[arg-type]
        Offset("left", axis, "tilt", unit, -0.4, 0.1), Offset("left", axis, "sway", unit, 1.5, 0.2)  # type: ignore[arg-type]
    ]  # fmt: skip


DOUBLE, ONE = 0, 1  # supports


@pytest.mark.parametrize(
    ("feet", "stands", "supports", "codes"),
    [
        (2, [[True, True], [True, True]], [ONE, DOUBLE], []),
        (2, [[True, True], [True, True]], [ONE, ONE], ["no_double_support"]),
        (2, [[True, False], [True, True]], [ONE, DOUBLE], []),
        (2, [[True, False], [True, False]], [ONE, ONE], ["foot_never_stands", "no_double_support"]),
        (1, [[True], [False]], [ONE, ONE], []),
        (1, [[False], [False]], [ONE, ONE], ["foot_never_stands"]),
    ],
)
def test_feet_that_never_stand_and_never_both_are_told(
    feet: int, stands: list[list[bool]], supports: list[int], codes: list[str], tmp_path: Path
) -> None:
    """Two logs: in each, which foot stands, and on what it stands in one of its samples."""
    robot: RobotModel = make_robot(tmp_path)
    names = list(robot.feet)[:feet]
    robot = replace(robot, feet={name: robot.feet[name] for name in names})

    def contact(stands: bool, support: int) -> SimpleNamespace:
        return SimpleNamespace(standing=np.array([False, stands]), support=np.array([3, support]))

    logs = [
        SimpleNamespace(contacts={name: contact(one, support) for name, one in zip(names, each, strict=True)})
        for each, support in zip(stands, supports, strict=True)
    ]
    notes = _feet_notes(robot, logs)  # type: ignore[arg-type]
    assert [note.code for note in notes] == codes
    if "foot_never_stands" in codes:
        assert notes[0].text.startswith(f"the {names[-1]} foot ")

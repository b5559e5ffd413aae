"""The wrenches' delay: known, it is taken off; unknown, it widens damping."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.robot.model import RobotModel


def test_a_known_delay_is_taken_off_and_an_unknown_one_widens_damping(tmp_path: object) -> None:
    robot: RobotModel = make_robot(tmp_path)  # type: ignore[arg-type]
    logs = [record(sway("one", seed=1)), record(sway("two", seed=2))]
    unknown = identify_feet(robot, logs)
    known = identify_feet(robot, logs, settings=FeetSettings(wrench_delay=0.0))
    assert any(note.code == "delay_unknown" for note in unknown.notes)
    wide, narrow = (one.parameter("left", "pitch", "damping") for one in (unknown, known))
    assert wide.std is not None
    assert narrow.std is not None
    assert wide.std == pytest.approx(0.0075 * TRUTH["left", "pitch"].stiffness, rel=0.1), (
        "K times the delay's deviation"
    )
    assert wide.std > 5 * narrow.std
    assert wide.advice is not None
    assert "arm sweeps" in wide.advice
    shifted = identify_feet(robot, logs, settings=FeetSettings(wrench_delay=0.005)).parameter(
        "left", "pitch", "damping"
    )
    assert shifted.value is not None
    assert narrow.value is not None
    gained = 0.005 * TRUTH["left", "pitch"].stiffness
    assert shifted.value - narrow.value == pytest.approx(gained, rel=0.1), (
        "C grows by K times the delay taken off"
    )


@pytest.mark.parametrize(("prior", "verdicts"), [(0.0075, {"weak"}), (0.002, {"weak"}), (0.0005, {"usable"})])
def test_damping_beside_an_unknown_delay_is_not_usable_unless_the_robot_file_knows_the_delay(
    tmp_path: Path, prior: float, verdicts: set[str]
) -> None:
    """Force sensors 30 ms early: C was 42 % too large, and as its interval's share is the smaller for it, usable."""
    robot = make_robot(tmp_path)
    robot = replace(robot, uncertainty=replace(robot.uncertainty, wrench_delay=prior))
    found = identify_feet(robot, [record(sway("one", seed=1)), record(sway("two", seed=2))])
    damping = [row for row in found.parameters if row.name == "damping" and row.axis != "z"]
    assert {row.verdict for row in damping} == verdicts
    if prior == 0.002:
        assert all("no log shows how late" in row.reason for row in damping)
    stiffness = [row for row in found.parameters if row.name == "stiffness" and row.axis != "z"]
    assert {row.verdict for row in stiffness} == {"usable"}

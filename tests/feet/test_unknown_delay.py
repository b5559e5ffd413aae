"""The wrenches' delay: known, it is taken off; unknown, it widens damping."""

from __future__ import annotations

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

"""Every second of a log is used or has a reason."""

from __future__ import annotations

import pytest

from biped import record, sway
from biped_robot import make_robot
from plantar.contact.phases import Phase
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.results.usage import used_shares
from plantar.robot.model import RobotModel


def test_every_second_is_accounted_for(tmp_path: object) -> None:
    robot: RobotModel = make_robot(tmp_path)  # type: ignore[arg-type]
    log = record(sway("hop", duration=20.0, lifts=(("left", 8.0, 11.0),)))
    result = identify_feet(robot, [log], settings=FeetSettings(model="kelvin_voigt"))
    left = next(row for row in used_shares(result.phases) if row.foot == "left")
    assert left.seconds == pytest.approx(20.0, abs=0.1)
    assert 12 < left.used < 17.5
    assert "in the air" in left.reasons
    assert result.diagnosis, "what limits each number is told"


def test_a_reason_of_no_time_is_not_told() -> None:
    phases = [
        Phase("a", "left", 0.0, 20.0, "double", True, None),
        Phase("a", "left", 20.0, 20.02, "double", False, "gap"),
    ]
    assert [row.reasons for row in used_shares(phases)] == [""]
    kinds = [
        Phase("a", "left", start, start + 1.0, "double", False, f"slip: {why}")
        for start, why in ((0.0, "the sole turns"), (1.0, "the soles move"))
    ]
    assert [row.reasons for row in used_shares(kinds)] == ["slip (2.0 s)"]
    assert "gap (0.1 s)" in used_shares([Phase("a", "left", 0.0, 0.06, "double", False, "gap")])[0].reasons

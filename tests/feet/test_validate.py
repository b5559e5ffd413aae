"""Scores by hand, results read back, and a saved result scored on logs that it has not seen."""

from __future__ import annotations

from pathlib import Path

import pytest

from biped import record, sway
from biped_robot import make_robot, robot_entry
from plantar.errors import DataError
from plantar.feet.identify import identify_feet
from plantar.feet.validate import validate_feet
from plantar.robot.model import RobotModel


def test_a_saved_result_scores_unseen_logs_as_the_fit_did(robot: RobotModel, tmp_path: Path) -> None:
    fit, unseen = record(sway("a", 1)), record(sway("b", 2, duration=10.0))
    found = identify_feet(robot, [fit], [unseen])
    saved = found.save(tmp_path)
    again = {(row.foot, row.axis): row for row in validate_feet(saved, robot, [unseen])}
    first = {(row.foot, row.axis): row for row in found.validation if row.kind == "cross"}
    assert set(again) == set(first)
    for key, row in again.items():
        assert row.kind == "cross"
        assert row.zero_mean_abs == pytest.approx(first[key].zero_mean_abs, rel=1e-6)
        assert row.mean_abs_error == pytest.approx(first[key].mean_abs_error, rel=1e-3)


def test_another_robots_result_is_refused(robot: RobotModel, tmp_path: Path) -> None:
    log = record(sway("a", 1, duration=8.0))
    found = identify_feet(robot, [log])
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    other = make_robot(tmp_path, feet={"right": feet["right"]})
    with pytest.raises(DataError, match=r"foot 'left' \(valid: right\)"):
        validate_feet(found, other, [log])


def test_a_log_too_short_to_score_is_refused(robot: RobotModel) -> None:
    found = identify_feet(robot, [record(sway("a", 1, duration=8.0))])
    with pytest.raises(DataError, match="no log has samples"):
        validate_feet(found, robot, [record(sway("b", 2, duration=1.2))])

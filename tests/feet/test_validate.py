"""Scores by hand, results read back, and a saved result scored on logs that it has not seen."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot, robot_entry
from plantar.errors import DataError, PlantarError
from plantar.feet.identify import identify_feet
from plantar.feet.validate import validate_feet
from plantar.results.feet import FEET_SCHEMA
from plantar.results.io import dump_json, finite, read_result
from plantar.results.scores import first_second, score
from plantar.robot.model import RobotModel


def test_a_row_by_hand() -> None:
    row = score("cross", "squat", "left", "roll", np.array([1.0, -4.0, 2.0]), np.array([0.0, -4.0, 4.0]), 1.0)
    assert asdict(row) == {
        "kind": "cross",
        "motion": "squat",
        "foot": "left",
        "axis": "roll",
        "mean_abs_error": pytest.approx((1 + 0 + 2) / 3),
        "rms_error": pytest.approx(np.sqrt((1 + 0 + 4) / 3)),
        "max_abs": 4.0,
        "percent_of_max": pytest.approx(25.0),
        "zero_mean_abs": pytest.approx((0 + 5 + 1) / 3),
        "samples": 3,
    }


def test_no_percentage_of_nothing() -> None:
    row = score("direct", "a", "left", "pitch", np.zeros(3), np.ones(3), 0.0)
    assert row.percent_of_max is None
    assert row.mean_abs_error == 1.0


def test_the_opening_is_one_second_of_samples_that_serve() -> None:
    time = np.arange(400) * 0.01
    used = time >= 1.0
    first = first_second(time, used)
    assert time[first].min() == pytest.approx(1.0)
    assert time[first].max() == pytest.approx(1.99)
    assert not first_second(time, np.zeros(400, dtype=bool)).any()


def test_numbers_that_are_not_finite_become_null() -> None:
    content = {"a": float("nan"), "b": (1.0, float("inf")), 3: [{"c": -0.5}], "d": True, "e": None}
    assert finite(content) == {"a": None, "b": [1.0, None], "3": [{"c": -0.5}], "d": True, "e": None}
    assert json.loads(dump_json(content))["b"] == [1.0, None]
    assert dump_json({}).endswith("}\n")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "not readable JSON"),
        ("{", "not readable JSON"),
        ("[" * 100_000, "not readable JSON"),
        ("[]", "not such a result"),
        ('{"schema": "other/1"}', "not such a result"),
        ('{"schema": 3}', "not such a result"),
    ],
)
def test_files_that_are_no_results(tmp_path: Path, text: str, expected: str) -> None:
    path = tmp_path / "result.json"
    path.write_text(text)
    with pytest.raises(PlantarError, match=expected) as caught:
        read_result(path)
    assert "\n" not in str(caught.value)
    assert "result.json" in str(caught.value)


def test_a_missing_result(tmp_path: Path) -> None:
    with pytest.raises(PlantarError, match="No such file"):
        read_result(tmp_path / "result.json")


def test_a_saved_result_scores_unseen_logs_as_the_fit_did(robot: RobotModel, tmp_path: Path) -> None:
    fit, unseen = record(sway("a", 1)), record(sway("b", 2, duration=10.0))
    found = identify_feet(robot, [fit], [unseen])
    content = read_result(found.save(tmp_path), FEET_SCHEMA)
    again = {(row.foot, row.axis): row for row in validate_feet(content, robot, [unseen])}
    first = {(row.foot, row.axis): row for row in found.validation if row.kind == "cross"}
    assert set(again) == set(first)
    for key, row in again.items():
        assert row.kind == "cross"
        assert row.zero_mean_abs == pytest.approx(first[key].zero_mean_abs, rel=1e-6)
        assert row.mean_abs_error == pytest.approx(first[key].mean_abs_error, rel=1e-3)


def test_another_robots_result_is_refused(robot: RobotModel, tmp_path: Path) -> None:
    log = record(sway("a", 1, duration=8.0))
    content = identify_feet(robot, [log]).to_dict()
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    other = make_robot(tmp_path, feet={"right": feet["right"]})
    with pytest.raises(DataError, match=r"foot 'left' \(valid: right\)"):
        validate_feet(content, other, [log])


def test_a_log_too_short_to_score_is_refused(robot: RobotModel) -> None:
    content = identify_feet(robot, [record(sway("a", 1, duration=8.0))]).to_dict()
    with pytest.raises(DataError, match="no log has samples"):
        validate_feet(content, robot, [record(sway("b", 2, duration=1.2))])

"""Scores by hand, results read back, and a saved result scored on logs that it has not seen."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot, robot_entry
from feet_trials import LINEAR
from plantar.errors import DataError
from plantar.feet.identify import identify_feet
from plantar.feet.result import delay_estimate
from plantar.feet.validate import scored_feet, validate_feet
from plantar.notes import Note
from plantar.results.feet import DelayEstimate
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import SensorDelay


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
    found = identify_feet(robot, [log], settings=LINEAR)
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    other = make_robot(tmp_path, feet={"right": feet["right"]})
    with pytest.raises(DataError, match=r"^the result is about a foot 'left' \(valid: right\)$"):
        validate_feet(found, other, [log])


def test_a_log_too_short_to_score_is_refused(robot: RobotModel) -> None:
    found = identify_feet(robot, [record(sway("a", 1, duration=8.0))], settings=LINEAR)
    with pytest.raises(
        DataError,
        match=r"^no log has samples of a standing foot that could be scored \(valid: more than 1\.3 s "
        r"of stance\)$",
    ):
        validate_feet(found, robot, [record(sway("b", 2, duration=1.2))])


def test_a_foot_that_cannot_be_scored_is_named_with_the_reasons(robot: RobotModel) -> None:
    found = identify_feet(robot, [record(sway("a", 1, duration=8.0))], settings=LINEAR)
    log = record(sway("b", 2, duration=10.0))
    lifted = {name: 0.0 * values for name, values in log.columns.items() if name.startswith("wrench.right")}
    held = {name: values + log.columns[name.replace("left", "right")] for name, values in log.columns.items()
            if name == "wrench.left.force.z"}  # fmt: skip
    rows, notes = scored_feet(
        found, robot, [log, replace(log.with_columns(lifted | held), name="c")], progress=lambda _: None
    )
    assert {(row.motion, row.foot) for row in rows} >= {("b", "left"), ("b", "right")}
    told = [note.text for note in notes if "the right foot is not scored" in note.text]
    assert len(told) == 1
    assert told[0].startswith("c: ")
    assert "in the air" in told[0]


def test_the_results_delays_are_taken_off_unseen_logs(robot: RobotModel) -> None:
    """Exact logs: whatever is taken off them makes them worse, each delay by itself."""
    log = record(sway("a", 1, duration=10.0))
    found = identify_feet(robot, [log], settings=LINEAR)
    assert found.sensor_delay == DelayEstimate(0.0, 0.0, False)
    right = {(row.foot, row.axis): row.mean_abs_error for row in validate_feet(found, robot, log)}
    for delay, hit in (
        (DelayEstimate(0.02, 0.001, True), ("left", "right")),
        (DelayEstimate(0.0, 0.001, True, feet={"left": 0.02, "right": 0.0}), ("left",)),
        (DelayEstimate(0.0, 0.001, True, encoder_delay=0.02), ("left", "right")),
    ):
        wrong = validate_feet(replace(found, sensor_delay=delay), robot, log)
        worse = {row.foot for row in wrong if row.mean_abs_error > 10 * right[row.foot, row.axis]}
        assert worse == set(hit)
        assert len(wrong) == len(right) == 4


def test_where_the_result_has_found_the_bush_is_predicted_with(robot: RobotModel) -> None:
    """A spring and damper alone predict exact logs; another place of the bush, or turned sensors, spoil their own axis
    only, and another compliance its own foot."""
    log = record(sway("a", 1, duration=10.0))
    yaw = 10.0 * np.sin(2 * np.pi * 0.5 * log.time)  # which no bush feels
    log = log.with_columns({f"wrench.{foot}.torque.z": yaw for foot in ("left", "right")})
    found = identify_feet(robot, [log], settings=LINEAR)
    right = {(row.foot, row.axis): row.mean_abs_error for row in validate_feet(found, robot, log)}

    def worse(**changed: object) -> list[tuple[str, str]]:
        rows = validate_feet(replace(found, **changed), robot, log)
        return [(row.foot, row.axis) for row in rows if row.mean_abs_error > 1.2 * right[row.foot, row.axis]]

    first = found.models[0]
    for place in (
        {"moment_arms": (0.02, 0.0)}, {"moment_arms": (0.0, 0.1)}, {"turned": 0.2}, {"leans": 0.2}, {"crosstalk": 0.2},
        {"imu_turned": (0.1, 0.1, 0.1)},
    ):  # fmt: skip
        moved = replace(first, **place)
        assert worse(models=(moved, *found.models[1:])) == [(first.foot, first.axis)], place
    assert {foot for foot, _ in worse(compliance={**found.compliance, "left": 1e-4})} == {"left"}


def test_every_delay_that_was_corrected_stands_in_the_result() -> None:
    note = Note("delays_apart", "warning", "late")
    found = SensorDelay(0.004, 0.0005, 30.0, True, note, {"left": 0.003, "right": 0.005}, 0.002)
    feet = {"left": 0.003, "right": 0.005}
    assert delay_estimate(found) == DelayEstimate(0.004, 0.0005, True, feet=feet, encoder_delay=0.002)


@pytest.mark.parametrize(("name", "told"), [("a", True), ("renamed", True), ("b", False)])
def test_a_log_that_was_fitted_is_no_unseen_one(robot: RobotModel, name: str, told: bool) -> None:
    log = replace(record(sway("a", 1, duration=8.0)), sha256="1" * 64)
    found = identify_feet(robot, [log], settings=LINEAR)
    given = replace(log, name=name, sha256="2" * 64 if name == "b" else log.sha256)
    _, notes = scored_feet(found, robot, [given], progress=lambda _: None)
    assert [note.text.split(":")[0] for note in notes if note.code == "seen"] == [name] * told


def test_a_result_of_another_robot_is_told(robot: RobotModel) -> None:
    """Its feet may have the same names, and its stiffness says nothing of these."""
    log = record(sway("a", duration=12.0))
    found = identify_feet(robot, [log], settings=LINEAR)
    for name, told in ((robot.name, False), ("another", True)):
        _, notes = scored_feet(replace(found, robot=name), robot, [log], progress=lambda _: None)
        texts = [note.text for note in notes if note.code == "other_robot"]
        assert bool(texts) == told
        assert all(f"the result is of 'another', the robot file of '{robot.name}'" in text for text in texts)

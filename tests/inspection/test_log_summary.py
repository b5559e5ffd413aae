"""Inspecting a log: what is in it, what is wrong with it, what it can identify."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import MASS, WEIGHT, record, sway, times
from biped_robot import FEET, make_robot
from made_recording import FOOT, PERIOD, made_recording
from plantar.contact.phases import SINGLE, SUPPORTS
from plantar.contact.reasons import Reason
from plantar.inspection import inspect_log, log_summary
from plantar.inspection.log_summary import _foot
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.notes import Note
from plantar.results.io import dump_json
from plantar.robot.model import RobotModel, load_robot


def test_a_healthy_log(robot: RobotModel, monkeypatch: pytest.MonkeyPatch) -> None:
    # A table of every sample, which nobody reads here: Arrow alone costs a tenth of a second.
    monkeypatch.delattr("plantar.feet.result.residual_table")
    log = record(sway("tilt"))
    summary = inspect_log(robot, log)
    assert (summary.name, summary.samples, summary.duration) == ("tilt", 2001, pytest.approx(20.0))
    assert summary.sampling.rate == pytest.approx(100.0)
    assert summary.sampling.gaps == ()
    assert summary.findings == ()
    assert summary.mass == pytest.approx(MASS)
    assert summary.carried == pytest.approx(MASS, rel=0.01)
    for foot in summary.feet:
        assert foot.double == pytest.approx(20.0, abs=0.1)
        assert foot.single == 0.0
        assert foot.load == pytest.approx(WEIGHT / 2, rel=0.05)
        assert 0.005 < foot.deflection_rms["pitch"] < 0.06
    stiffness = [row.verdict for row in summary.parameters if row.axis != "z" and row.name == "stiffness"]
    assert set(stiffness) == {"usable"}
    ranges = {column.name: column for column in summary.columns}
    assert set(ranges) == set(log.columns)
    force = ranges["wrench.left.force.z"]
    assert force.least == log.column("wrench.left.force.z").min()
    assert force.largest == log.column("wrench.left.force.z").max()


def test_single_support_and_seconds_that_serve(robot: RobotModel) -> None:
    summary = inspect_log(robot, record(sway(lifts=(("left", 5.0, 10.0),))))
    feet = {foot.foot: foot for foot in summary.feet}
    assert feet["right"].single == pytest.approx(5.0, abs=0.3)
    assert feet["left"].single == 0.0
    assert feet["left"].double == pytest.approx(15.0, abs=0.8)
    assert feet["left"].serving < feet["right"].serving


def test_gaps_and_holes(robot: RobotModel) -> None:
    motion = sway()
    time = times(motion)
    log = record(motion, at=time[(time < 5) | (time > 6)])
    neck = np.where(log.time < 1, np.nan, log.column("joint.neck.position"))
    summary = inspect_log(
        robot, log.with_columns({"joint.neck.position": neck, "joint.tail.effort": np.full(len(log), np.nan)})
    )
    ((start, end),) = summary.sampling.gaps
    assert (start, end) == (pytest.approx(4.99, abs=0.02), pytest.approx(6.01, abs=0.02))
    ranges = {column.name: column for column in summary.columns}
    assert ranges["joint.neck.position"].missing == 100
    assert ranges["joint.tail.effort"].least is None


@pytest.mark.parametrize("column", ["wrench.left.torque.y", "imu.chest.linear_acceleration.x"])
def test_a_log_that_cannot_serve_is_told_not_raised(robot: RobotModel, column: str) -> None:
    log = record(sway(duration=8.0))
    missing = {
        name: values for name, values in log.columns.items() if name != column and "orientation" not in name
    }
    summary = inspect_log(robot, type(log)(log.name, log.time, missing))
    assert any(finding.fatal for finding in summary.findings)
    assert any(column in finding.text for finding in summary.findings)


def test_impossible_readings_are_findings(robot: RobotModel) -> None:
    log = record(sway(duration=8.0))
    names = [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]
    summary = inspect_log(robot, log.with_columns({name: np.degrees(log.column(name)) for name in names}))
    assert [finding.code for finding in summary.findings] == ["degrees"]
    assert summary.parameters == ()


def test_everything_goes_into_json(robot: RobotModel) -> None:
    log = record(sway(duration=8.0, lifts=(("left", -1.0, 9.0), ("right", -1.0, 9.0))))
    content = json.loads(dump_json(inspect_log(robot, log).to_dict()))
    assert content["findings"][0]["code"] == "not_usable"
    assert "no foot carries load" in content["findings"][0]["text"]


def keys(content: object) -> object:
    """The keys of JSON at every depth; of a list, those of its first entry."""
    if isinstance(content, dict):
        return {key: keys(value) for key, value in content.items()}
    return [keys(content[0])] if isinstance(content, list) and content else None


def test_the_documents_say_what_the_json_holds(robot: RobotModel) -> None:
    text = (Path(__file__).resolve().parents[2] / "docs" / "log_columns.md").read_text()
    (documented,) = re.findall(r"```json\n(.*?)```", text, re.DOTALL)
    shown = json.loads(documented)["logs"][0]
    log = record(sway(duration=8.0))
    reversed_ = {name: -log.column(name) for name in log.columns if name.startswith("wrench.")}
    refused = json.loads(dump_json(inspect_log(robot, log.with_columns(reversed_)).to_dict()))
    healthy = json.loads(dump_json(inspect_log(robot, log).to_dict()))
    actual = {key: refused[key] or healthy[key] for key in healthy}
    assert list(shown) == list(actual)
    for key in ("sampling", "columns", "feet", "findings", "notes"):
        assert keys(shown[key]) == keys(actual[key]), key


def test_a_robot_without_feet(tmp_path: Path) -> None:
    summary = inspect_log(make_robot(tmp_path, feet={}), record(sway(duration=4.0)))
    assert summary.feet == ()
    assert summary.carried is None


def test_what_is_said_of_robot_and_log_stands_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also of a robot whose feet cannot be looked at: guesses, its weight, the log's own notes, its joints."""
    robot, log = make_robot(tmp_path, feet={}), record(sway(duration=4.0))
    monkeypatch.setattr(log_summary, "guess_notes", lambda name, guesses: [Note("guessed", "info", name)])
    monkeypatch.setattr(RobotModel, "weight_notes", [Note("weight", "warning", "5 kg less")])
    columns = {name: values for name, values in log.columns.items() if not name.startswith("joint.neck.")}
    summary = inspect_log(robot, replace(log, columns=columns, notes=(Note("log", "info", "cut"),)))
    assert [note.code for note in summary.notes][:3] == ["guessed", "weight", "log"]
    assert summary.notes[0].text == robot.path.name
    assert "neck" in summary.notes[3].text


def test_real_recordings(shared_data: Path) -> None:
    folder = shared_data / "icub_walking"
    robot = load_robot(folder / "robot.yaml")
    log = open_log(folder / "walking.csv.gz", robot)
    half = log.time < 45.0
    summary = inspect_log(
        robot, MotionLog(log.name, log.time[half], {name: log.column(name)[half] for name in log.columns})
    )
    assert not any(finding.fatal for finding in summary.findings)
    assert summary.carried == pytest.approx(33.9, abs=0.5)
    assert len(summary.feet) == len(FEET)
    for foot in summary.feet:
        assert foot.single > 1.0
        assert foot.double > 10.0
    for row in summary.parameters:
        assert row.value is None or row.value > 0 or row.verdict != "usable"


def test_a_foots_angles_are_those_of_its_used_samples() -> None:
    """A sine of 0.02 rad about a lean of 0.1 rad; what is left out swings far more, and stands alone."""
    time = PERIOD * np.arange(4000)
    wild = time > 20.0
    angle = 0.1 + np.where(wild, 0.5, 0.02) * np.sin(2 * np.pi * time)
    made = made_recording("sway", angle, 400.0 * angle)
    support = np.where(wild, SUPPORTS.index(SINGLE), made.contacts[FOOT].support).astype(np.int8)
    contact = replace(made.contacts[FOOT], support=support).without(time > 19.9, Reason.ON_THE_EDGE)
    found = _foot(replace(made, contacts={FOOT: contact}), FOOT)
    assert found.deflection_rms == pytest.approx(
        dict.fromkeys(("pitch", "roll"), 0.02 / np.sqrt(2)), rel=0.01
    )
    rate = 0.02 * 2 * np.pi / np.sqrt(2)
    assert found.rate_rms == pytest.approx(dict.fromkeys(("pitch", "roll"), rate), rel=0.05)
    assert (found.double, found.single, found.serving) == pytest.approx((20.0, 20.0, 19.9), abs=0.02)


@pytest.mark.parametrize(("missing", "load"), [(0.0, 345.0), (0.25, 340.0), (1.0, 0.0)])
def test_a_foots_load_is_that_of_the_samples_that_have_one(missing: float, load: float) -> None:
    made, count = made_recording("sway", np.zeros(400), np.zeros(400)), np.arange(400)
    force = np.where(count < 100, 360.0, 340.0)
    state = replace(made.bushes[FOOT], force_z=np.where(count < 400 * missing, np.nan, force))
    assert _foot(replace(made, bushes={FOOT: state}), FOOT).load == pytest.approx(load)

"""A fault of the data that nobody put right keeps numbers from being called usable, of the feet it concerns."""

from __future__ import annotations

from dataclasses import replace

import pytest

from biped import record, sway
from feet_trials import LINEAR, noisy
from plantar.feet import foot_assessment
from plantar.feet.assess.data_faults import OF_MOMENTS, UNMENDED, data_faults, doubted
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import fit_prepared
from plantar.feet.prepare import PreparedLogs, prepare_all
from plantar.notes import Note
from plantar.results.feet import FeetResult, Parameter
from plantar.robot.guesses import Guess
from plantar.robot.model import RobotModel
from plantar.sensors.bandwidth import FILTERED


@pytest.fixture(scope="module")
def ready(robot: RobotModel) -> PreparedLogs:
    log = noisy(record(sway("sway", 3, duration=30.0)), 3)
    return prepare_all(robot, [log], [], LINEAR, lambda _: None)


@pytest.fixture(scope="module")
def healthy(robot: RobotModel, ready: PreparedLogs) -> FeetResult:
    return fit_prepared(robot, ready)


def with_note(ready: PreparedLogs, note: Note) -> PreparedLogs:
    return replace(ready, fitted=tuple(replace(one, notes=(*one.notes, note)) for one in ready.fitted))


@pytest.mark.parametrize("code", sorted(UNMENDED - OF_MOMENTS))
def test_a_fault_takes_usable_away_and_is_the_reason(
    robot: RobotModel, ready: PreparedLogs, healthy: FeetResult, code: str
) -> None:
    spoiled = fit_prepared(robot, with_note(ready, Note(code, "warning", "sway: something is turned")))
    assert any(row.verdict == "usable" for row in healthy.parameters if row.axis != "z")
    for row, before in zip(spoiled.parameters, healthy.parameters, strict=True):
        assert row.value == before.value
        if row.axis != "z":
            assert row.verdict != "usable"
            assert before.verdict != "usable" or "something is turned" in row.reason


def test_a_fault_of_a_log_takes_usable_from_the_vertical_stiffness_too(
    robot: RobotModel, ready: PreparedLogs
) -> None:
    usable = Parameter("left", "z", "stiffness", "N/m", 2e5, 1e3, (1.9e5, 2.1e5), None, "usable", "")
    clear = replace(ready, vertical=replace(ready.vertical, parameters=(usable,)))
    for note, verdict in (
        (Note("spikes", "warning", "bridged"), "usable"),
        (Note("sign", "warning", "x"), "weak"),
    ):
        rows = fit_prepared(robot, with_note(clear, note)).parameters
        assert [row.verdict for row in rows if row.axis == "z"] == [verdict]


def test_what_was_put_right_or_is_only_said_takes_nothing_away(ready: PreparedLogs) -> None:
    fit = fit_axis(ready.fitted, "left", "pitch", LINEAR)
    assert fit is not None
    for note in (Note("spikes", "warning", "bridged"), Note("sign", "info", "looks odd")):
        assert data_faults(with_note(ready, note).fitted, fit) == []
    assert doubted([], [Note("sign", "warning", "reversed")]) == []


@pytest.mark.parametrize("code", sorted(OF_MOMENTS))
def test_sensors_that_read_at_other_moments_leave_the_stiffness(
    robot: RobotModel, ready: PreparedLogs, healthy: FeetResult, code: str
) -> None:
    note = Note(code, "warning", "torques fade")
    told = with_note(ready, note) if code in UNMENDED else replace(ready, notes=(*ready.notes, note))
    faded = fit_prepared(robot, told)
    before = {(row.foot, row.axis, row.name): row.verdict for row in healthy.parameters}
    usable = {key for key, verdict in before.items() if verdict == "usable" and key[1] != "z"}
    assert {name for _, _, name in usable} >= {"stiffness", "damping"}
    after = {(row.foot, row.axis, row.name): row for row in faded.parameters}
    assert all((after[key].verdict == "usable") == (key[2] == "stiffness") for key in usable)
    assert all("torques fade" in after[key].reason for key in usable if key[2] == "damping")


def test_a_force_that_leans_in_some_logs_is_somebodys_push(ready: PreparedLogs) -> None:
    fit = fit_axis(ready.fitted, "left", "pitch", LINEAR)
    assert fit is not None
    (stands,) = ready.fitted
    leans, far = (
        replace(stands, notes=(Note(code, "warning", "leans"),))
        for code in ("force_leans_little", "force_leans")
    )
    steps = replace(stands, stances=dict.fromkeys(stands.stances, object()))
    assert data_faults([leans, stands], fit) == []
    assert len(data_faults([leans, leans], fit)) == 2
    assert len(data_faults([leans, steps], fit)) == 1  # of a walk nobody can tell
    assert len(data_faults([far, stands], fit)) == 1


@pytest.mark.parametrize("guessed", [False, True])
def test_a_bush_too_far_from_its_place_takes_usable_away_where_the_place_is_known(
    robot: RobotModel,
    ready: PreparedLogs,
    healthy: FeetResult,
    monkeypatch: pytest.MonkeyPatch,
    guessed: bool,
) -> None:
    monkeypatch.setattr("plantar.cores.usable_cores", lambda: 1)
    monkeypatch.setattr(
        foot_assessment, "far_arms", lambda _: [Note("bush_arm_far", "warning", "50 mm off. Measure")]
    )
    if guessed:
        ready = replace(
            ready, robot=replace(robot, guesses=(Guess("feet.left.bush", ""), Guess("feet.right.bush", "")))
        )
    found = fit_prepared(robot, ready)
    numbers = [row for row in found.parameters if row.axis != "z"]
    assert any(row.verdict == "usable" for row in healthy.parameters if row.axis != "z")
    assert any(row.verdict == "usable" for row in numbers) == guessed
    assert any("50 mm off" in row.reason for row in numbers) != guessed


def test_a_slow_filter_spoils_the_stiffness_of_a_foot_that_steps() -> None:
    """On the twin's walks, wrenches behind 5 Hz made the stiffness 6 % too small within an interval of 5 %."""
    row = Parameter("left", "roll", "stiffness", "N.m/rad", 300.0, 8.0, (284.0, 316.0), 1.0, "usable", "")
    behind = Note(FILTERED, "warning", "as behind a low-pass of 6 Hz")
    assert [each.verdict for each in doubted([row], [behind])] == ["usable"]
    assert [each.verdict for each in doubted([row], [behind], steps=True)] == ["weak"]
    other = next(iter(OF_MOMENTS - {FILTERED}))
    assert [each.verdict for each in doubted([row], [Note(other, "warning", "")], steps=True)] == ["usable"]

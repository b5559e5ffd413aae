"""All logs of one identification together: roles, names, the delay given or found, what is common to them."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator
from dataclasses import replace
from time import monotonic, sleep

import numpy as np
import pytest

from biped import VERTICAL, record, sway
from feet_trials import PUNCTUAL
from plantar.errors import DataError, LogError
from plantar.feet import prepare
from plantar.feet.first_look import checked_in_turn
from plantar.feet.fit.vertical_stiffness import fit_vertical_stiffness
from plantar.feet.prepare import PreparedLogs, prepare_all, prepare_unseen
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.logs.inputs import logs_of
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    return [record(sway(name, seed)) for seed, name in enumerate(("first", "second", "unseen"))]


def prepared(robot: RobotModel, logs: list[MotionLog], settings: FeetSettings = PUNCTUAL) -> PreparedLogs:
    said: list[str] = []
    found = prepare_all(robot, logs[:2], logs[2:], settings, said.append)
    assert {"check the logs", "estimate the sensors' delays", "fit z"} <= set(said)
    return found


def test_each_log_has_its_role_and_the_cutoff_that_was_used(robot: RobotModel, logs: list[MotionLog]) -> None:
    found = prepared(robot, logs, replace(PUNCTUAL, cutoff=4.0))
    assert [(one.name, one.role) for one in found.recordings] == [
        ("first", "fit"), ("second", "fit"), ("unseen", "validate"),
    ]  # fmt: skip
    assert {one.cutoff for one in found.recordings} == {found.settings.cutoff} == {4.0}
    assert 0 < (prepared(robot, logs).settings.cutoff or 0) <= PUNCTUAL.highest_cutoff


def test_gains_of_legs_that_do_not_bend_are_told_without_any_bend(
    robot: RobotModel, logs: list[MotionLog], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Legs that may bend are asked first; beside them a gain is less sure."""
    asked: list[tuple[tuple[object, ...], object]] = []
    told: list[object] = []
    moments, gains = prepare.moments_of, prepare.torque_gains

    def of(robot: RobotModel, *given: object) -> object:
        asked.append((given, moments(robot, *given)))  # type: ignore[arg-type]
        return asked[-1][1]

    def of_gains(robot: RobotModel, fit: object) -> object:
        told.append(fit)
        return gains(robot, fit)  # type: ignore[arg-type]

    monkeypatch.setattr(prepare, "moments_of", of)
    monkeypatch.setattr(prepare, "torque_gains", of_gains)
    assert not prepared(robot, logs).bending.found
    (first, _), (second, stiff) = asked
    assert first == (*second, prepare.BENDING)
    assert told == [stiff]


def test_a_given_delay_is_taken_and_undone(robot: RobotModel, logs: list[MotionLog]) -> None:
    """The wrenches of a log that is 20 ms late, moved back, are those of the log that is not."""
    late = 0.02
    rows = round(late / logs[0].period)
    shifted = [
        log.with_columns({name: np.roll(v, rows) for name, v in log.columns.items() if "wrench" in name})
        for log in logs
    ]
    right, wrong, told = (
        prepared(robot, some, replace(PUNCTUAL, wrench_delay=delay)).fitted[0].bushes["left"].torque[200:-200]
        for some, delay in ((logs, 0.0), (shifted, 0.0), (shifted, late))
    )
    assert np.abs(told - right).max() < 0.02 * np.abs(wrong - right).max()


def test_torques_stand_about_the_centre_where_the_load_has_moved_it(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    found = prepared(robot, logs)
    assert found.vertical.compliance["left"] == pytest.approx(1 / VERTICAL, rel=0.05)
    (again,) = prepare_unseen(
        robot, logs[2:], found.settings, found.sensor_delay, found.vertical.compliance, lambda _: None
    )
    np.testing.assert_allclose(again.bushes["left"].torque, found.unseen[0].bushes["left"].torque, atol=1e-9)
    (rigid,) = prepare_unseen(
        robot, logs[2:], found.settings, found.sensor_delay, {"left": 0.0, "right": 0.0}, lambda _: None
    )
    assert np.abs(rigid.bushes["left"].torque - again.bushes["left"].torque).max() > 0.01


def test_two_logs_of_one_name_are_refused_fitted_or_not(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(
        DataError,
        match=r"^two logs are called 'first': first and first \(valid: file names that differ, since "
        r"results name motions by them\)$",
    ):
        prepared(robot, [logs[0], logs[1], logs[0]])


def test_a_gyroscope_behind_its_orientation_is_read_on_time(robot: RobotModel, logs: list[MotionLog]) -> None:
    assert robot.imu is not None
    columns = imu_columns(robot.imu.name, "angular_velocity")
    log, rates = logs[0], logs[0].angular_velocity(robot.imu.name)
    late = np.column_stack([np.interp(log.time - 0.004, log.time, column) for column in rates.T])
    delayed = log.with_columns(dict(zip(columns, late.T, strict=True)))
    exact, found = (
        prepare_all(robot, [one], [], PUNCTUAL, lambda _: None).recordings[0] for one in (log, delayed)
    )
    assert [note.code for note in found.notes if note.code == "gyroscope_delay"] == ["gyroscope_delay"]
    assert not [note for note in exact.notes if note.code == "gyroscope_delay"]
    inner = slice(100, -100)
    apart = np.abs(found.bushes["left"].rate - exact.bushes["left"].rate)[inner]
    assert np.nanmean(apart) < 0.05 * np.nanmean(np.abs(exact.bushes["left"].rate[inner]))


def test_a_log_is_let_go_once_it_is_checked(robot: RobotModel, logs: list[MotionLog]) -> None:
    """Also where the next one takes its time to be read."""
    seen: list[weakref.ref[MotionLog]] = []

    def gone() -> bool:
        if any(one() is not None for one in seen):
            gc.collect()
        return all(one() is None for one in seen)

    def read() -> Iterator[MotionLog]:
        for place in range(4):
            until = monotonic() + 60.0
            while not gone() and monotonic() < until:
                sleep(0.2)
            assert gone()
            log = replace(logs[0], name=f"log {place}")
            seen.append(weakref.ref(log))
            yield log
            del log

    found = checked_in_turn(robot, read(), meanwhile=None)
    assert [one.name for one in found] == [f"log {place}" for place in range(4)]


def test_the_first_log_with_an_error_is_named(robot: RobotModel, logs: list[MotionLog]) -> None:
    def degrees(name: str) -> MotionLog:
        moved = {
            column: np.degrees(values) for column, values in logs[0].columns.items() if "joint" in column
        }
        return replace(logs[0].with_columns(moved), name=name)

    with pytest.raises(
        DataError,
        match=r"^second: columns 'wrench\.\*': balance gravity only to 17\.9 m about the centre of mass "
        r"\(valid: below 0\.02 m\)$",
    ):
        checked_in_turn(robot, [logs[0], degrees("second"), degrees("third"), logs[1]], meanwhile=None)
    with pytest.raises(LogError, match=r"^nowhere\.csv: does not exist$"):
        checked_in_turn(robot, logs_of([logs[0], "nowhere.csv", degrees("third")], robot), meanwhile=None)
    with pytest.raises(
        DataError,
        match=r"^second: columns 'wrench\.\*': balance gravity only to 17\.9 m about the centre of mass "
        r"\(valid: below 0\.02 m\)$",
    ):
        checked_in_turn(robot, logs_of([logs[0], degrees("second"), "nowhere.csv"], robot), meanwhile=None)


def test_the_logs_to_fit_alone_choose_the_filter(
    robot: RobotModel, logs: list[MotionLog], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is only scored must not tell what it is scored by."""
    asked: list[str] = []

    def band(recordings: list[Recording]) -> float:
        asked.extend(recording.name for recording in recordings)
        return 3.0

    monkeypatch.setattr("plantar.feet.prepare.coherent_band", band)
    found = prepared(robot, logs, replace(PUNCTUAL, cutoff=None))
    assert asked == ["first", "second"]
    assert {one.cutoff for one in found.recordings} == {found.settings.cutoff} == {3.0}


def test_heights_are_told_by_the_logs_to_fit_without_their_slides(
    robot: RobotModel, logs: list[MotionLog], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[object] = []
    room, flat = "plantar.feet.prepare", Note("flat", "info", "without slides")
    monkeypatch.setattr(f"{room}.without_slip", lambda _, recording: replace(recording, notes=(flat,)))
    monkeypatch.setattr(f"{room}.heights_of", lambda _, recording: (recording.name, recording.notes))
    monkeypatch.setattr(
        f"{room}.fit_vertical_stiffness",
        lambda heights, *others: told.extend(heights) or fit_vertical_stiffness([], *others),
    )
    prepared(robot, logs)
    assert told == [("first", (flat,)), ("second", (flat,))]


def test_a_late_accelerometer_leaves_the_sensors_delay_as_unsure_as_its_own(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    """Newton's law tells delays against the accelerometer: what is unsure of that one is unsure of damping."""
    late = [
        log.with_columns(
            {
                name: np.interp(log.time - 0.004, log.time, log.column(name))
                for name in imu_columns("chest", "linear_acceleration")
            }
        )
        for log in logs
    ]
    settings = replace(PUNCTUAL, wrench_delay=None)
    found = prepared(robot, late, settings)
    (text,) = {
        note.text for one in found.recordings for note in one.notes if note.code == "accelerometer_delay"
    }
    own = float(text.split("± ")[1].split(" ")[0]) / 1960
    assert own > 0.0004
    added = found.sensor_delay.std**2 - prepared(robot, logs, settings).sensor_delay.std ** 2
    assert np.sqrt(added) == pytest.approx(own, rel=0.1)

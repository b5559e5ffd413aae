"""Logs of one identification made ready: what is refused, what each is for, what is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import small_biped
from plantar.errors import DataError, RobotError
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.whole_body.inertia import identify_inertia
from plantar.whole_body.settings import DynamicsSettings
from plantar.whole_body.whole_logs import WholeLogs, prepare_logs


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return small_biped.robot(tmp_path_factory.mktemp("biped"))


@pytest.fixture(scope="module")
def logs(robot: RobotModel) -> list[MotionLog]:
    real = small_biped.truth(robot.floating_model, 1)
    return [small_biped.record(robot, real, name, seed, 6.0) for seed, name in enumerate(("one", "two"))]


def prepared(robot: RobotModel, logs: list[MotionLog], validate: list[MotionLog]) -> WholeLogs:
    return prepare_logs(robot, logs, validate, DynamicsSettings(), lambda _: None)


def test_no_log_and_two_of_one_name_are_refused(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(DataError, match=r"^no logs to fit \(valid: at least one\)$"):
        prepared(robot, [], logs)
    with pytest.raises(
        DataError,
        match=r"^two logs are called 'one': one and one \(valid: file names that differ, since results "
        r"name motions by them\)$",
    ):
        prepared(robot, logs, logs[:1])


def test_each_log_has_its_role_and_its_notes(robot: RobotModel, logs: list[MotionLog]) -> None:
    sides = ("left", "right")
    flipped = {f"wrench.{side}.torque.x": -logs[0].column(f"wrench.{side}.torque.x") for side in sides}
    said = [Note(name, "info", f"of {name}") for name in ("fitted", "scored")]
    first, second = (replace(log, notes=(note,)) for log, note in zip(logs, said, strict=True))
    found = prepared(robot, [first.with_columns(flipped)], [second])
    assert [note for note in found.notes if note in said] == said
    assert [(row.path, row.role) for row in found.inputs] == [("one", "fit"), ("two", "validate")]
    assert (len(found.fitted), len(found.unseen)) == (1, 1)
    assert found.body.equation.floating
    assert "wrench_polarity" in {note.code for note in found.notes}
    assert "wrench_polarity" not in {note.code for note in prepared(robot, logs, []).notes}
    assert np.allclose(found.calibration.rotation, np.eye(3), atol=0.01)


def test_a_robot_that_is_bolted_down_has_nothing_to_calibrate(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    fixed = replace(robot, base="fixed", imu=None, feet={})
    found = prepared(fixed, logs[:1], [])
    assert not found.body.equation.floating
    np.testing.assert_array_equal(found.calibration.rotation, np.eye(3))


def test_what_no_inertia_can_be_found_from_is_refused(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(
        RobotError,
        match=r"biped\.yaml: a fixed base has no base rows to identify from \(valid: plantar identify "
        r"joints\)$",
    ):
        identify_inertia(replace(robot, base="fixed"), logs[:1])
    with pytest.raises(
        RobotError, match=r"biped\.yaml: names no feet \(valid: feet whose sensors carry the robot\)$"
    ):
        identify_inertia(replace(robot, feet={}), logs[:1])
    with pytest.raises(DataError, match=r"^one: has 14 samples that can be used \(valid: 50 or more\)$"):
        identify_inertia(robot, [logs[0].select(slice(0, 80))])
    columns = {
        name: values for name, values in logs[0].columns.items() if "linear_acceleration.z" not in name
    }
    lifted = {name: 0 * values if name.startswith("wrench.") else values for name, values in columns.items()}
    with pytest.raises(
        DataError,
        match=r"^one: does not tell how the root link moves \(valid: IMU columns angular_velocity and "
        r"linear_acceleration, or a foot that stands still\)$",
    ):
        identify_inertia(robot, [MotionLog("one", logs[0].time, lifted)])
    air = {name: 0 * values for name, values in logs[0].columns.items() if name.startswith("wrench.")}
    with pytest.raises(
        DataError,
        match=r"^the feet carry nothing: no ground wrench to explain \(valid: a robot that stands\)$",
    ):
        identify_inertia(robot, [logs[0].with_columns(air)])

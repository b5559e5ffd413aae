"""Advice that these logs and sensors can follow."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot
from page_folders import stepping
from plantar.feet.assess.diagnosis import REMEDY
from plantar.feet.assess.feasible_advice import (
    NO_BETTER_MODEL,
    hardly_standing,
    remedies,
    with_remedies,
)
from plantar.feet.prepare import prepare_all
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.results.feet import Diagnosis, Parameter
from plantar.robot.guesses import Guess
from plantar.sensors.delays.sensor_delay import SensorDelay

KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
UNKNOWN = SensorDelay(0.0, 0.0075, np.inf, False, Note("delay_unknown", "warning", "unknown"))


def z_row() -> Parameter:
    return Parameter(
        "left", "z", "stiffness", "N/m", None, None, None, None, "unidentifiable", "unclear", "shift"
    )


def without(log: MotionLog, kind: str) -> MotionLog:
    return replace(log, columns={name: values for name, values in log.columns.items() if kind not in name})


def test_a_delay_is_asked_of_sensors_that_can_show_it(tmp_path: Path) -> None:
    robot, log = make_robot(tmp_path), record(sway("one", seed=1, duration=12.0))
    blind = prepare_all(robot, [without(log, "linear_acceleration")], [], KNOWN, str).fitted
    without_it = (
        "of the IMU: without it no log shows the force sensors' delay; or give a delay that is known with "
    )
    assert remedies(KNOWN, UNKNOWN, robot, blind) == {
        "delay": f"record the accelerometer {without_it}--wrench-delay"
    }
    blinder = prepare_all(
        robot, [without(without(log, "linear_acceleration"), "angular_velocity")], [], KNOWN, str
    ).fitted
    assert remedies(KNOWN, UNKNOWN, robot, blinder) == {
        "delay": f"record the accelerometer and the gyroscope {without_it}--wrench-delay"
    }
    assert "delay" not in remedies(KNOWN, UNKNOWN, replace(robot, imu=None), blinder)
    seeing = prepare_all(
        robot, [without(record(sway("other", 2, duration=12.0)), "linear_acceleration"), log], [], KNOWN, str
    ).fitted
    assert "delay" not in remedies(KNOWN, UNKNOWN, robot, seeing), "arm sweeps, as ever"
    shown = SensorDelay(0.002, 0.001, np.inf, True, UNKNOWN.note)
    badly = "these logs show the force sensors' delay, but not well"
    assert remedies(KNOWN, shown, robot, seeing)["delay"] == (
        f"record arm sweeps at 0.3 to 1 Hz for longer: {badly}"
    )
    assert "delay" not in remedies(KNOWN, replace(shown, doubtful=True), robot, seeing)
    unsure = replace(robot, guesses=(Guess("imu", "its name"),))
    assert remedies(KNOWN, shown, unsure, seeing)["delay"] == (
        f"measure where the IMU sits, which is marked GUESS: {badly}"
    )
    parts = ("force.x", "force.y", "torque.z")
    none = {f"wrench.{foot}.{part}": np.zeros(len(log)) for foot in robot.feet for part in parts}
    on_cells = prepare_all(robot, [log.with_columns(none)], [], KNOWN, str).fitted
    assert remedies(KNOWN, shown, robot, on_cells) == {
        "delay": "measure how late the force cells are, and give it with --wrench-delay"
    }
    assert remedies(KNOWN, UNKNOWN, replace(robot, weighed=60.0), seeing) == {
        "force gain": "calibrate the force sensors, which the number follows: the robot was weighed"
    }


def test_what_was_tried_is_not_advised(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    assert "model" not in remedies(KNOWN, UNKNOWN, robot, [])
    assert remedies(FeetSettings(), UNKNOWN, robot, [])["model"] == NO_BETTER_MODEL
    row = Parameter("left", "pitch", "stiffness", "", 4.0, 1.0, (2.0, 6.0), 1.0, "weak", "", REMEDY["model"])
    said = f"left pitch. To tighten: {REMEDY['model']}"
    limit = Diagnosis("left", "pitch", "stiffness", "model", {"model": 1.0}, 50.0, said, REMEDY["model"])
    rows, limits = with_remedies([row], [limit], {"model": "other motions"})
    assert (rows[0].advice, limits[0].advice) == ("other motions", "other motions")
    assert limits[0].text == "left pitch. To tighten: other motions"
    assert with_remedies([row], [limit], {}) == ([row], [limit])


def test_a_vertical_stiffness_is_not_asked_of_the_same_motion_again(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    stands, steps = record(sway("sway", 1, duration=40.0)), stepping("walk", 2)
    ready = prepare_all(robot, [stands, steps], [], KNOWN, str).fitted
    assert hardly_standing([z_row()], ready) == [z_row()], "both feet stood: something else is the matter"
    (told,) = hardly_standing([z_row()], ready[1:])
    assert told.reason == "feet leave the floor in walk"
    assert told.advice == (
        "stand on both feet and shift the weight slowly from foot to foot for 30 s or more, lifting neither"
    )
    of_pitch, known = replace(z_row(), axis="pitch"), replace(z_row(), value=7e5)
    assert hardly_standing([of_pitch, known], ready[1:]) == [of_pitch, known]
    many = [replace(ready[1], log=replace(ready[1].log, name=f"walk_{k}")) for k in range(4)]
    assert hardly_standing([z_row()], many[:3])[0].reason == "feet leave the floor in walk_0, walk_1, walk_2"
    assert hardly_standing([z_row()], many)[0].reason == "feet leave the floor in all 4 logs"
    short = prepare_all(robot, [record(sway("sway", 1, duration=12.0))], [], KNOWN, str).fitted
    (told,) = hardly_standing([z_row()], short)
    begins, _, rest = told.reason.partition(" for only ")
    assert (begins, rest.partition(" s ")[2]) == ("both soles stand flat together", "of sway")
    seconds = float(rest.split(" s")[0])
    assert seconds == pytest.approx(12.0, abs=2.0)

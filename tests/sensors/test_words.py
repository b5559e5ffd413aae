"""What is said of sensors that are late, turned or off: every line, of made-up findings with known numbers."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.results.feet_rows import DelayEstimate
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import orientation_notes, with_imus_on_time
from plantar.sensors.attitude_lag import without_lag
from plantar.sensors.attitude_scale import attitude_scale_notes
from plantar.sensors.delays import sensor_delay
from plantar.sensors.delays.sensor_delay import _doubtful, _unseen, stored_delay
from plantar.sensors.moments.moment_fit import MomentFit, Part
from plantar.sensors.moments.sensor_errors import turn_columns
from plantar.sensors.moments.sensor_turns import sensor_turn_notes
from plantar.sensors.tilt_error import right_attitude

TIME = np.arange(400) / 200.0
UPRIGHT = dict(zip("wxyz", (1.0, 0.0, 0.0, 0.0), strict=True))


def log(*, gyroscope: bool = True, name: str = "sway") -> MotionLog:
    columns = {f"imu.chest.orientation.{axis}": np.full(400, value) for axis, value in UPRIGHT.items()}
    columns |= {
        f"imu.chest.linear_acceleration.{axis}": np.full(400, g)
        for axis, g in zip("xyz", (0, 0, 9.81), strict=True)
    }
    if gyroscope:
        columns |= {f"imu.chest.angular_velocity.{axis}": np.zeros(400) for axis in "xyz"}
    return MotionLog(name, TIME, columns)


def told(notes: Any) -> list[tuple[str, str, str]]:
    return [(note.code, note.severity, note.text) for note in notes]


@pytest.mark.parametrize("late", [0.042, -0.042])
def test_an_imu_whose_parts_are_read_at_two_times(late: float, robot: RobotModel) -> None:
    (read,) = with_imus_on_time(robot, [log()], (late, 0.005))
    by = "42.0 ± 9.8 ms behind"
    end = "(95 %) over soles that stand, read earlier by as much"
    said = {
        True: ("accelerometer_delay", "info", f"accelerometer {by} the IMU's orientation {end}"),
        False: (
            "orientation_delay",
            "info",
            f"the IMU's orientation and gyroscope {by} its accelerometer {end}",
        ),
    }
    assert told(read.notes) == [said[late > 0]]


def test_an_orientation_that_is_late_and_alone() -> None:
    found: Any = SimpleNamespace(late=lambda sensor: (0.25, 0.001))
    (note,) = orientation_notes(log(gyroscope=False), "chest", found)
    assert told([note]) == [(
        "orientation_late", "warning",
        "sway: columns 'imu.chest.orientation.*': 250 ms behind the accelerometer over soles that stand: late, "
        "behind a "
        "slow filter, or filtered towards the accelerometer; stiffness and damping follow it (valid: an attitude "
        "filter "
        "that keeps up, or the gyroscope in the log, beside which it is put right)",
    )]  # fmt: skip
    assert orientation_notes(log(), "chest", found) == [], "the gyroscope tells better"


def test_an_orientation_that_lags_is_not_used(robot: RobotModel) -> None:
    assert robot.imu is not None
    found: Any = SimpleNamespace(lag=0.084)
    read, kept = without_lag([log(), log(gyroscope=False, name="squat")], robot.imu, found)
    assert told(read.notes) == [(
        "attitude_late", "warning",
        "sway: the IMU's orientation is behind its gyroscope as behind a low-pass of 84 ms: not used; gravity's "
        "direction blended from gyroscope and accelerometer (valid: an attitude filter that keeps up)",
    )]  # fmt: skip
    assert kept.notes == ()


def test_an_orientation_of_another_scale_is_told_by_the_worse_axis() -> None:
    """It misses a fifth of one tilt, surely; the other axis shows more, by chance."""
    found: Any = SimpleNamespace(share=(np.array([0.25, 0.5]), np.array([0.001, 0.4])))
    assert told(attitude_scale_notes(found)) == [(
        "attitude_scale", "warning",
        "the IMU's orientation shows 0.8 times the tilts that its accelerometer and the standing soles do; "
        "stiffness and "
        "damping are off by the same share (valid: 1; check the scales of gyroscope and accelerometer, and the "
        "encoders "
        "between IMU and feet)",
    )]  # fmt: skip


def test_delays_of_a_result() -> None:
    stored = DelayEstimate(-0.0042, 0.001, True, feet={"left": 0.001}, encoder_delay=0.002)
    found = stored_delay(stored)
    assert told([found.note]) == [("delay_given", "info", "wrenches taken as -4.2 ms late, as in the result")]
    assert (found.delay, found.std, found.measured, found.feet, found.encoders) == (
        -0.0042,
        0.0,
        False,
        {"left": 0.001},
        0.002,
    )
    assert stored_delay(None).note.text == "wrenches taken as +0.0 ms late, as in the result"


def test_a_delay_that_no_log_shows(robot: RobotModel, monkeypatch: pytest.MonkeyPatch) -> None:
    unsure = replace(robot, uncertainty=replace(robot.uncertainty, wrench_delay=0.0075))
    start = "delay of the wrenches unknown: "
    end = "; taken as 0 ± 7.5 ms, which widens the interval of the damping by stiffness times that. "
    why = "no log in which the ground's wrench follows from IMU, encoders and URDF"
    cells = "vertical force cells read no horizontal force, by which it would show"
    for accelerated, on_cells, said in (
        (True, False, f"{start}{why}{end}Record arm sweeps of 0.3 to 1 Hz without an operator"),
        (False, False, f"{start}{why}{end}Record the accelerometer"),
        (False, True, f"{start}{cells}{end}Measure how late they are and give it with --wrench-delay"),
    ):
        monkeypatch.setattr(sensor_delay, "_accelerated", lambda *_, found=accelerated: found)
        monkeypatch.setattr(sensor_delay, "on_force_cells", lambda *_, found=on_cells: found)
        found = _unseen(unsure, [log()])
        assert told([found.note]) == [("delay_unknown", "warning", said)]
        assert (found.delay, found.std, found.measured) == (0.0, 0.0075, False)
    sure = replace(robot, uncertainty=replace(robot.uncertainty, wrench_delay=0.0001))
    assert (_unseen(sure, [log()]).note.code, _unseen(sure, [log()]).note.severity) == (
        "delay_assumed",
        "info",
    )


def test_delays_beyond_the_search(robot: RobotModel) -> None:
    lags: Any = SimpleNamespace(at_edge=False, std=np.array([0.003, 0.0]), values=np.array([0.004, 0.001]))
    exact = replace(robot, uncertainty=replace(robot.uncertainty, wrench_delay=0.012))
    found = _doubtful(exact, lags)
    assert found.std == pytest.approx(0.013)
    assert found.note.text == (
        "sensors may be late by 25 ms: no delays up to 250 ms were found with which the ground's wrench follows "
        "from IMU, "
        "encoders and URDF, though the robot moves; not corrected. Check first that the IMU sits on the link that the "
        "robot file says, and how it is turned there; then the clocks of IMU, encoders and force sensors, and "
        "the URDF, or "
        "record arm sweeps of 0.3 to 1 Hz that nobody disturbs; --wrench-delay gives a delay that is known"
    )


def test_a_force_sensor_that_sits_turned(robot: RobotModel) -> None:
    """The right one by -12 degrees about y and less about x; the left one by too little to say so."""
    columns = turn_columns(robot)
    values = np.zeros(columns["right"].stop + 5)
    values[columns["right"]] = np.radians([3.0, -12.0, 1.0])
    values[columns["left"]] = np.radians([2.0, 0.0, 1.0])
    noise = Part(np.diag(np.full(values.size, np.radians(0.5) ** 2)), 1e6)
    notes = sensor_turn_notes(robot, MomentFit(values, [noise]))
    assert list(notes) == ["right"]
    assert told(notes.values()) == [(
        "wrench_turned", "warning",
        "right: forces and torques give the moments of the robot's motion with the force sensor's frame turned "
        "by -12 ± 1 "
        "deg about its y axis (95 %). Check 'feet.right.wrench' in the robot file, and the zeros of this leg's "
        "encoders, "
        "which turn it alike",
    )]  # fmt: skip


def test_an_attitude_that_follows_its_accelerometer(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its own log tells by how much where it can, else all logs together; one that shows nothing stays."""
    assert robot.imu is not None
    sway = log()
    monkeypatch.setattr("plantar.sensors.tilt_error.put_right", lambda unit, *_: unit)
    own: Any = SimpleNamespace(believed=True, predicted=1.0, rate=0.25)
    others: Any = SimpleNamespace(believed=True, predicted=9.0, rate=0.5)
    quaternions = np.column_stack([sway.column(f"imu.chest.orientation.{axis}") for axis in "wxyz"])
    for first, rate in ((own, "0.25"), (SimpleNamespace(believed=False, predicted=1.0, rate=0.25), "0.5")):
        found = right_attitude(sway, robot.imu, quaternions, (first, others), {}, {})
        assert found is not None
        text = f"sway: the IMU's attitude follows its accelerometer (as at {rate} 1/s), so motion tilts it; "
        assert found[1] == Note("attitude_tilted", "info", f"{text}corrected from the soles that stand still")
    unseen: Any = SimpleNamespace(believed=True, predicted=0.0, rate=0.25)
    none: Any = SimpleNamespace(believed=False, predicted=1.0, rate=0.25)
    assert right_attitude(sway, robot.imu, quaternions, (unseen, others), {}, {}) is None
    assert right_attitude(sway, robot.imu, quaternions, (none, none), {}, {}) is None

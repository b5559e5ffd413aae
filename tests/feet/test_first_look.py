"""The first look at a log: how far its attitude follows the accelerometer, told of the log that is looked at."""

from __future__ import annotations

from biped import record, sway
from plantar.feet.first_look import look_again, look_at
from plantar.robot.model import RobotModel
from plantar.sensors.tilt_error import log_tilt_error
from plantar.twin.sensing.attitude_filter import filtered_attitude


def test_each_look_tells_the_tilt_error_of_its_log(robot: RobotModel) -> None:
    """Of an attitude that a filter made, and, looked at again, of one that was put right."""
    assert robot.imu is not None
    true = record(sway(duration=20.0))
    orientation = true.orientation("chest")
    assert orientation is not None
    believed = filtered_attitude(
        orientation[0], true.angular_velocity("chest"), true.linear_acceleration("chest"), true.period
    )
    made = true.with_columns(
        {f"imu.chest.orientation.{axis}": believed[:, place] for place, axis in enumerate("wxyz")}
    )
    first = look_at(robot, False, made)
    assert first.tilt == log_tilt_error(made, robot.imu)
    assert first.tilt.believed
    again = look_again(robot, False, first, true)
    assert again.tilt == log_tilt_error(true, robot.imu)
    assert not again.tilt.believed
    assert again.accelerometer == first.accelerometer

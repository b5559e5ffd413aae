"""Encoders that died: a position that stands still while the velocity beside it goes on."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from feet_trials import noisy
from plantar.errors import DataError
from plantar.faults.channels import check_channels
from plantar.faults.log_faults import check_log
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot.model import RobotModel
from plantar.signals.segments import longest_run

JOINT = "right_ankle_pitch"


def held(log: MotionLog, start: int, stop: int) -> MotionLog:
    """The log in which one encoder repeats its value between two samples."""
    name = f"joint.{JOINT}.position"
    values = log.column(name).copy()
    values[start:stop] = values[start]
    return log.with_columns({name: values})


@pytest.mark.parametrize(("start", "stop"), [(0, 2001), (700, 2001), (900, 1000)])
def test_a_position_that_stands_while_its_velocity_turns_is_refused(
    robot: RobotModel, start: int, stop: int
) -> None:
    log = held(record(sway()), start, stop)
    found = [finding for finding in check_log(robot, log) if "its velocity" in finding.text]
    assert len(found) == 1
    assert found[0].code == "dead_channel"
    assert found[0].fatal
    assert f"joint.{JOINT}.position" in found[0].text
    assert f"t = {log.time[start]:g}" in found[0].text
    with pytest.raises(DataError, match="the encoder is dead"):
        identify_feet(robot, [log])


def test_a_time_of_an_epoch_s_clock_is_told_to_the_sample(robot: RobotModel) -> None:
    log = held(record(sway(duration=10.0)), 400, 700)
    late = MotionLog("late", log.time + 1_700_000_000, log.columns)
    (text,) = (finding.text for finding in check_channels(robot, late) if "its velocity" in finding.text)
    assert "t = 1700000004 to 1700000006.99 s" in text


def test_dead_encoders_are_told_in_the_order_of_their_names(robot: RobotModel) -> None:
    log = record(sway())
    joints = [f"{foot}_ankle_{axis}" for foot in ("left", "right") for axis in ("pitch", "roll")]
    for joint in joints:
        values = log.column(f"joint.{joint}.position")
        log = log.with_columns({f"joint.{joint}.position": np.full(len(log), values[0])})
    told = [finding.text for finding in check_channels(robot, log) if finding.code == "dead_channel"]
    assert [text.split("'")[1] for text in told] == [f"joint.{joint}.position" for joint in joints]


def test_coarse_encoders_and_still_joints_are_not_dead(robot: RobotModel) -> None:
    log = record(sway())
    position, velocity = f"joint.{JOINT}.position", f"joint.{JOINT}.velocity"
    coarse = log.with_columns({position: np.round(log.column(position) / 5e-3) * 5e-3})
    still = log.with_columns({position: np.full(len(log), 0.1), velocity: np.full(len(log), 0.02)})
    for each in (coarse, still):
        assert not dead(each, robot)


def test_a_joint_that_stands_and_then_moves_far_is_not_dead(robot: RobotModel) -> None:
    """As of a robot that stands before it falls: the mean of its velocity is motion, not a bias."""
    log = record(sway())
    position, velocity = f"joint.{JOINT}.position", f"joint.{JOINT}.velocity"
    late = np.maximum(log.time - 8.0, 0.0)
    falls = log.with_columns({position: 0.05 * late**2, velocity: 0.1 * late})
    assert not dead(falls, robot)
    # The same with a bias, which the rest of the log shows, and with one that the joint's motion hides.
    assert not dead(falls.with_columns({velocity: 0.1 * late + 0.02}), robot)
    assert not dead(falls.with_columns({velocity: 0.08 * late}), robot)


def test_a_velocity_that_parts_from_the_moving_position_too_refuses_no_log(robot: RobotModel) -> None:
    log = held(record(sway()), 700, 1300)
    velocity = f"joint.{JOINT}.velocity"
    found = check_log(robot, log.with_columns({velocity: 3.0 * np.cos(log.time)}))
    told = [(each.code, each.fatal) for each in found if "its velocity" in each.text]
    assert told == [("stuck_channel", False)]


@pytest.mark.parametrize("seed", range(6))
def test_noise_of_a_velocity_turns_no_joint_that_rests(robot: RobotModel, seed: int) -> None:
    """Velocities without a filter add up to a path, too, the farther the longer a joint rests."""
    log, noise = record(sway(duration=30.0)), np.random.default_rng(seed)
    rests = {f"joint.{joint}.position": np.full(len(log), 0.1) for joint in robot.joint_names}
    rough = {f"joint.{joint}.velocity": noise.normal(0.0, 0.05, len(log)) for joint in robot.joint_names}
    assert [each.text for each in check_channels(robot, log.with_columns(rests | rough))] == []


def test_a_gap_of_the_log_turns_nothing(robot: RobotModel) -> None:
    log = record(sway())
    position, velocity = f"joint.{JOINT}.position", f"joint.{JOINT}.velocity"
    still = log.with_columns({position: np.full(len(log), 0.1), velocity: 0.01 * np.sin(log.time)})
    later = np.where(log.time > 3.0, log.time + 100.0, log.time)
    assert not dead(MotionLog(log.name, later, still.columns), robot)


def dead(log: MotionLog, robot: RobotModel) -> list[str]:
    """What is said about encoders whose velocity goes on."""
    return [finding.text for finding in check_log(robot, log) if "its velocity" in finding.text]


def test_a_force_that_stands_still_is_told_with_its_column(robot: RobotModel) -> None:
    log = noisy(record(sway()), 1)
    assert not [found for found in check_channels(robot, log) if found.code == "stuck_channel"]
    force = log.columns["wrench.left.force.x"].copy()
    force[400:900] = force[400]
    found = check_channels(robot, log.with_columns({"wrench.left.force.x": force}))
    assert any("wrench.left.force.x" in finding.text for finding in found)


def resting(start: int, seconds: float, missed: int) -> MotionLog:
    """A simulated sway, in which nothing changes for a while; `missed`: steps that the motion goes on by meanwhile."""
    log = record(sway())
    rows = np.concatenate(
        [
            np.arange(start),
            np.full(round(seconds / log.period), start),
            np.arange(start + 1 + missed, len(log)),
        ]
    )
    rests = np.arange(len(rows)) - start < round(seconds / log.period)
    columns = {
        name: np.where(rests & name.endswith(".velocity"), 0.0, values[rows])
        for name, values in log.columns.items()
    }
    return MotionLog(log.name, log.period * np.arange(len(rows)), columns)


def test_a_simulated_robot_at_rest_has_no_dead_channel(robot: RobotModel) -> None:
    (found,) = check_channels(robot, resting(0, 2.0, 0))
    assert (found.code, found.severity) == ("at_rest", "info")
    share = f"{100 * 200 / len(resting(0, 2.0, 0)):.0f} %"
    assert found.text == (
        f"t = 0 to 1.99 s: nothing changes, as of a simulated robot at rest; {share} of the log, left out"
    )
    log = resting(0, 2.0, 0)
    name = "wrench.left.force.x"
    both = log.with_columns(
        {name: np.where(np.arange(len(log)) < 800, log.column(name)[0], log.column(name))}
    )
    assert [one.code for one in check_channels(robot, both)] == ["at_rest", "stuck_channel"]


def test_a_logger_that_freezes_is_no_robot_at_rest(robot: RobotModel) -> None:
    """Behind it all channels jump, where a motion begins slowly."""
    codes = {one.code for one in check_channels(robot, resting(1000, 0.5, 100))}
    assert "stuck_channel" in codes
    assert "at_rest" not in codes


def test_force_cells_are_named_and_not_called_dead(robot: RobotModel) -> None:
    log = record(sway("cells", 1, duration=8.0))
    none = {f"wrench.left.{part}": np.zeros(len(log)) for part in ("force.x", "force.y", "torque.z")}
    cells = log.with_columns(none)
    found = [finding for finding in check_log(robot, cells) if "wrench.left" in finding.text]
    assert [(finding.code, finding.text) for finding in found] == [
        ("vertical_only", "columns 'wrench.left.*': vertical force cells, no horizontal force: the bush's torque is "
         "off by that force times the bush's height over the cells")
    ]  # fmt: skip
    broken = cells.with_columns({"wrench.left.torque.z": log.column("wrench.left.torque.z")})
    assert [f.code for f in check_log(robot, broken) if "wrench.left" in f.text] == ["dead_force"]


def losing(log: MotionLog, sensor: str, length: int, every: int) -> MotionLog:
    """The log in which a sensor repeats its last reading for `length` samples of each `every`."""
    number = np.arange(len(log))
    last = np.maximum.accumulate(np.where(number % every < every - length, number, 0))
    return log.with_columns(
        {name: values[last] for name, values in log.columns.items() if name.startswith(sensor)}
    )


@pytest.mark.parametrize(
    ("length", "every", "told"),
    [
        (3, 20, True),
        (5, 11, True),
        (2, 20, False),  # a sensor a little slower than its log
        (4, 5, False),  # a slow one
        (3, 400, False),  # hardly any
        (25, 200, False),  # stuck, which is told otherwise
    ],
)
@pytest.mark.parametrize("sensor", ["wrench.left.", "imu.chest."])
def test_frames_that_a_bus_loses_are_told_of_their_sensor(
    robot: RobotModel, sensor: str, length: int, every: int, told: bool
) -> None:
    log = losing(noisy(record(sway()), 1), sensor, length, every)
    found = [finding for finding in check_channels(robot, log) if finding.code == "lost_frames"]
    assert len(found) == told
    if told:
        assert found[0].text == (
            f"columns '{sensor}*': repeat their last values again and again, up to {10 * length} ms at a time, "
            f"{100 * length / every:.0f} % of the log; does a bus lose frames? Delays and damping are not sure "
            "(valid: leave such cells empty)"
        )
        assert not found[0].fatal
        assert found[0].severity == "warning"


def test_few_lost_frames_doubt_no_damping(robot: RobotModel) -> None:
    """A hundredth is lost, three frames at a time: readings are old by 0.24 ms in the mean."""
    log = losing(noisy(record(sway()), 1), "wrench.left.", 3, 250)
    found = [finding for finding in check_channels(robot, log) if finding.code == "lost_frames"]
    assert [finding.severity for finding in found] == ["info"]
    assert "damping" not in found[0].text


def test_zeros_that_a_driver_puts_in_are_no_repeated_frames(robot: RobotModel) -> None:
    log = noisy(record(sway()), 1)
    lost = np.arange(len(log)) % 20 > 15
    empty = {
        name: np.where(lost, 0.0, values)
        for name, values in log.columns.items()
        if name.startswith("wrench.left.")
    }
    codes = {finding.code for finding in check_channels(robot, log.with_columns(empty))}
    assert "lost_frames" not in codes


@pytest.mark.parametrize(("length", "told"), [(0, False), (6, True)])
def test_steps_of_a_converter_are_no_lost_frames(robot: RobotModel, length: int, told: bool) -> None:
    """Without noise all channels stand for some samples, and then one of them moves by a step."""
    log = record(sway(duration=12.0, shift=0.0))
    if length:
        log = losing(log, "wrench.left.", length, 60)
    names = wrench_columns("left")
    steps = dict(zip(names, 3 * [1.0] + 3 * [0.1], strict=True))
    read = log.with_columns({name: step * np.round(log.column(name) / step) for name, step in steps.items()})
    standing = (np.diff(read.stack(names), axis=0) == 0).all(axis=1)
    assert longest_run(standing).stop - longest_run(standing).start >= 3
    found = [one for one in check_channels(robot, read) if one.code == "lost_frames"]
    assert bool(found) == told

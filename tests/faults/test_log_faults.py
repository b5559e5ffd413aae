"""Impossible readings are found and named, and healthy logs raise no alarm."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import WEIGHT, Motion, record, sines, sway
from biped_robot import FEET, Frame, Mounting, make_robot
from plantar.errors import DataError
from plantar.faults.log_faults import _joints, check_log
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.notes import Finding
from plantar.robot.model import RobotModel, load_robot

QUATERNION = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
GYROSCOPE = [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]
ACCELEROMETER = [f"imu.chest.linear_acceleration.{axis}" for axis in "xyz"]
WRENCH = {
    foot: [f"wrench.{foot}.{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"] for foot in FEET
}

Fault = Callable[[MotionLog], MotionLog]


@pytest.fixture(scope="module")
def log() -> MotionLog:
    """A healthy log whose weight moves from foot to foot and whose torso leans by degrees."""
    return record(leaning())


def leaning(name: str = "lean") -> Motion:
    roll, pitch, still = sines((0.06, 0.2, 0.3)), sines((0.1, 0.15, 1.0)), sines((0.0, 0.0, 0.0))
    level = (
        lambda t: -pitch(t) + sines((0.015, 0.3, 0.1))(t),
        lambda t: -roll(t) + sines((0.01, 0.4, 0.2))(t),
    )
    return replace(
        sway(name, duration=15.0, shift=0.3), torso=(roll, pitch, still), ankles=dict.fromkeys(FEET, level)
    )


def scaled(names: list[str], factor: float) -> Fault:
    return lambda log: log.with_columns({name: log.column(name) * factor for name in names})


def constant(name: str, value: float = 0.0) -> Fault:
    return lambda log: log.with_columns({name: np.full(len(log), value)})


def reordered(order: list[str]) -> Fault:
    """The quaternion's columns filled in another order."""
    return lambda log: log.with_columns({f"imu.chest.orientation.{to}": log.column(f"imu.chest.orientation.{source}")
                                         for to, source in zip("wxyz", order, strict=True)})  # fmt: skip


def inverted(log: MotionLog) -> MotionLog:
    return log.with_columns({name: -log.column(name) for name in QUATERNION[1:]})


def swapped(log: MotionLog) -> MotionLog:
    pairs = [
        *zip(WRENCH["left"], WRENCH["right"], strict=True),
        *zip(WRENCH["right"], WRENCH["left"], strict=True),
    ]
    return log.with_columns({to: log.column(source) for to, source in pairs})


def milliseconds(log: MotionLog) -> MotionLog:
    return MotionLog(log.name, log.time * 1000, log.columns)


def joints_in_degrees(log: MotionLog) -> MotionLog:
    names = [name for name in log.columns if name.endswith("ankle_pitch.position")]
    return scaled(names, 180 / np.pi)(log)


def leaning_imu(log: MotionLog) -> MotionLog:
    """An IMU mounted a quarter turn about x from where the robot file has it, all of its readings alike."""
    turn = Rotation.from_euler("x", 90, degrees=True)
    quaternion = Rotation.from_quat(log.stack(QUATERNION), scalar_first=True) * turn
    columns = dict(zip(QUATERNION, quaternion.as_quat(scalar_first=True).T, strict=True))
    for names in (GYROSCOPE, ACCELEROMETER):
        columns |= dict(zip(names, turn.inv().apply(log.stack(names)).T, strict=True))
    return log.with_columns(columns)


def in_bursts(log: MotionLog) -> MotionLog:
    """Ten rows at once, each stamped as it comes."""
    row = np.arange(len(log))
    last = np.minimum(row // 10 * 10 + 9, len(log) - 1)
    return MotionLog(log.name, log.time[last] + 1e-4 * (row % 10), log.columns)


FAULTS: dict[str, tuple[Fault, str, str]] = {
    "joint in degrees": (constant("joint.neck.position", 45.0), "degrees", "joint.neck.position"),
    "gyroscope in degrees": (scaled(GYROSCOPE, 180 / np.pi), "degrees", "angular_velocity"),
    "accelerometer in g": (scaled(ACCELEROMETER, 1 / 9.80665), "accelerometer_unit", "looks like g"),
    "quaternion x y z w": (reordered(["x", "y", "z", "w"]), "quaternion_order", "x y z w"),
    "quaternion world to body": (inverted, "quaternion_order", "inverted"),
    "quaternion not of unit length": (scaled(QUATERNION, 0.01), "quaternion_norm", "norm"),
    "one foot's sign": (scaled(WRENCH["left"], -1.0), "sign", "feet.left.wrench"),
    "both feet's signs": (scaled(WRENCH["left"] + WRENCH["right"], -1.0), "sign", "wrench.left.force.z"),
    "force in kgf": (scaled(WRENCH["left"] + WRENCH["right"], 1 / 9.80665), "force_unit", "kgf"),
    "force in kN": (scaled(WRENCH["left"] + WRENCH["right"], 1e-3), "force_unit", "kN"),
    "feet swapped": (swapped, "swapped_feet", "swapped"),
    "gyroscope dead": (constant("imu.chest.angular_velocity.y"), "dead_channel", "angular_velocity.y"),
    "gyroscope's axis reversed": (scaled(GYROSCOPE[1:2], -1.0), "sign", "angular_velocity.y"),
    "IMU's orientation leans": (leaning_imu, "force_leans", "leans"),
    "torque dead": (constant("wrench.left.torque.y"), "dead_force", "wrench.left.torque.y"),
    "force dead": (constant("wrench.right.force.z"), "dead_force", "wrench.right.force.z"),
    "time in milliseconds": (milliseconds, "time_unit", "'time'"),
    "time in gigaseconds": (
        lambda log: MotionLog(log.name, log.time * 1e-9, log.columns),
        "time_unit",
        "'time'",
    ),
    "times of arrival": (in_bursts, "time_bursts", "rows come in bursts"),
    "a blink": (lambda log: log.select(slice(0, 20)), "too_short", "0.19 s"),
    "quaternion empty": (constant("imu.chest.orientation.w", np.nan), "dead_channel", "orientation"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_each_fault_is_named(robot: RobotModel, log: MotionLog, name: str) -> None:
    fault, code, part = FAULTS[name]
    findings = check_log(robot, fault(log))
    assert any(finding.code == code and part in finding.text for finding in findings), findings
    assert all("\n" not in finding.text for finding in findings)


@pytest.mark.parametrize(
    "name", [name for name in FAULTS if not name.endswith("dead") or "gyroscope" in name]
)
def test_nothing_is_fitted_to_what_is_impossible(robot: RobotModel, log: MotionLog, name: str) -> None:
    with pytest.raises(DataError, match="lean"):
        identify_feet(robot, [FAULTS[name][0](log)])


def test_pounds_are_told_but_a_rope_may_load_feet_as_little(robot: RobotModel, log: MotionLog) -> None:
    forces = [name for foot in WRENCH.values() for name in foot if ".force." in name]
    findings = check_log(robot, scaled(forces, 1 / 4.4482)(log))
    told = [finding for finding in findings if finding.code == "force_unit"]
    assert len(told) == 1
    assert "looks like lbf" in told[0].text
    assert not told[0].fatal


def test_a_joint_may_move_further_than_its_urdf_lets_it(robot: RobotModel, log: MotionLog) -> None:
    """Ranges of URDFs are often wrong: radians beyond them are no degrees."""
    name = "left_ankle_roll"
    most = float(robot.model.upperPositionLimit[robot.model.joints[robot.model.getJointId(name)].idx_q])
    swing = 1.7 * most * np.sin(2 * np.pi * 0.2 * log.time)
    found = check_log(robot, log.with_columns({f"joint.{name}.position": swing}))
    assert "joint_limit" in names_of(found)
    assert "degrees" not in names_of(found)


def names_of(findings: list[Finding]) -> list[str]:
    return [finding.code for finding in findings]


@pytest.mark.parametrize("seed", range(4))
def test_healthy_logs_raise_no_alarm(robot: RobotModel, seed: int) -> None:
    assert check_log(robot, record(sway(seed=seed, duration=10.0))) == []


def test_healthy_logs_of_many_kinds_raise_no_alarm(robot: RobotModel, log: MotionLog) -> None:
    assert check_log(robot, log) == []
    assert check_log(robot, record(sway(duration=12.0, lifts=(("left", 3.0, 6.0),)))) == []
    assert check_log(robot, record(sway(duration=12.0, lifts=(("left", 1.0, 11.0),)))) == []
    holes = log.with_columns({name: np.where(log.time < 3, np.nan, log.column(name)) for name in log.columns})
    assert check_log(robot, holes) == []
    noise = np.random.default_rng(0)
    noisy = log.with_columns(
        {
            name: values + noise.normal(0, 0.01, len(log))
            for name, values in log.columns.items()
            if "orientation" not in name
        }
    )
    assert check_log(robot, noisy) == []
    still = record(
        Motion(
            "still",
            10.0,
            (sines((0.0, 1.0, 0.0)),) * 3,
            {foot: (sines((0.0, 1.0, 0.0)),) * 2 for foot in FEET},
        )
    )
    shaken = still.with_columns(
        {name: values + noise.normal(0, 1e-4, len(still)) for name, values in still.columns.items()}
    )
    assert check_log(robot, shaken) == []


@pytest.mark.parametrize(
    "mounting",
    [
        Mounting(imu=Frame((0.0, 0.0, 0.2), (np.pi / 2, 0.0, np.pi))),
        Mounting(imu=Frame((0.0, 0.0, 0.2), (np.pi, 0.0, 0.0))),
        Mounting(wrench=Frame((0.0, 0.0, 0.0), (np.pi, 0.0, 0.4))),
        Mounting(sign=-1),
    ],
)
def test_sensors_mounted_in_other_ways_raise_no_alarm(tmp_path: Path, mounting: Mounting) -> None:
    assert check_log(make_robot(tmp_path, mounting), record(leaning(), mounting)) == []


def test_a_coarse_sensor_that_is_hardly_loaded_is_not_dead(robot: RobotModel, log: MotionLog) -> None:
    """All of its torques stay within a step or two; beside torques that move freely, one that never changes is dead."""
    quiet = {
        name: 0.3 + 0.2 * np.random.default_rng(place).standard_normal(len(log))
        for place, name in enumerate("yz")
    }
    coarse = {f"wrench.left.torque.{axis}": np.round(values) for axis, values in quiet.items()}
    assert check_log(robot, constant("wrench.left.torque.x")(log.with_columns(coarse))) == []
    found = check_log(robot, constant("wrench.left.torque.x")(log))
    assert "dead_force" in {finding.code for finding in found}


def test_a_joint_that_goes_from_limit_to_limit_in_degrees_is_told(robot: RobotModel, log: MotionLog) -> None:
    place = robot.model.idx_qs[robot.joint_names.index("neck") + 1]
    lower, upper = robot.model.lowerPositionLimit[place], robot.model.upperPositionLimit[place]
    travel = np.degrees(np.linspace(lower, upper, len(log)))
    (found,) = _joints(robot, log.with_columns({"joint.neck.position": travel}))
    assert (found.code, found.fatal) == ("degrees", True)


def test_a_joint_beyond_its_limit_is_a_warning_only(robot: RobotModel, log: MotionLog) -> None:
    found = check_log(robot, constant("joint.neck.position", 2.6)(log))
    assert [(finding.code, finding.fatal) for finding in found] == [("joint_limit", False)]


def test_a_gyroscope_of_the_wrong_scale_is_a_warning(robot: RobotModel, log: MotionLog) -> None:
    found = check_log(robot, scaled(GYROSCOPE, 5.0)(log))
    assert [(finding.code, finding.fatal) for finding in found] == [("gyroscope_scale", False)]


def test_the_sign_that_would_be_right_is_told(tmp_path: Path) -> None:
    robot = make_robot(tmp_path, Mounting(sign=-1))
    found = [finding for finding in check_log(robot, record(sway(shift=0.0))) if finding.code == "sign"]
    assert len(found) == 2
    for finding in found:
        assert "set 'sign: 1'" in finding.text
        assert float(finding.text.split("value ")[1].split(":")[0]) == pytest.approx(-WEIGHT / 2, rel=1e-3)


def test_a_log_without_an_imu_orientation_can_be_checked(robot: RobotModel, log: MotionLog) -> None:
    without = MotionLog(
        log.name, log.time, {name: v for name, v in log.columns.items() if name not in QUATERNION}
    )
    assert check_log(robot, without) == []
    dead = without.with_columns({name: np.zeros(len(log)) for name in ACCELEROMETER})
    assert [(finding.code, finding.fatal) for finding in check_log(robot, dead)] == [("dead_channel", True)]
    in_degrees = scaled(["joint.left_ankle_pitch.position"], 300.0)(without)
    assert "degrees" in names_of(check_log(robot, in_degrees))


def test_real_recordings_raise_no_fatal_alarm(shared_data: Path) -> None:
    for folder, file in (
        ("icub_walking", "walking.csv.gz"),
        ("icub_mats", "firm.csv"),
        ("kuka_lwr4", "recording_1.csv"),
    ):
        robot = load_robot(shared_data / folder / "robot.yaml")
        assert [f for f in check_log(robot, open_log(shared_data / folder / file)) if f.fatal] == []


def test_of_a_log_in_another_unit_of_time_only_that_is_said(robot: RobotModel, log: MotionLog) -> None:
    assert names_of(check_log(robot, milliseconds(swapped(log)))) == ["time_unit"]


@pytest.mark.parametrize(("unit", "count"), [("ms", 1e3), ("us", 1e6), ("ns", 1e9), (None, 1e12)])
@pytest.mark.parametrize("rate", [50.0, 100.0, 1000.0])
def test_the_unit_of_time_is_told_with_the_line_that_reads_it(
    robot: RobotModel, log: MotionLog, unit: str | None, count: float, rate: float
) -> None:
    time = 1.7e9 * (unit is not None) + np.arange(len(log)) / rate
    (found,) = check_log(robot, MotionLog(log.name, count * time, log.columns))
    lines = [f"`columns: {{time: {{from: time, unit: {unit}}}}}`"] if unit is not None else []
    assert re.findall(r"`.*?`", found.text) == lines
    assert found.fatal


@pytest.mark.parametrize("share", [0.3, 0.5])
def test_rows_that_got_lost_here_and_there_are_no_bursts(
    robot: RobotModel, log: MotionLog, share: float
) -> None:
    kept = np.random.default_rng(0).random(len(log)) > share
    thin = MotionLog(log.name, log.time[kept], {name: log.column(name)[kept] for name in log.columns})
    assert "time_bursts" not in names_of(check_log(robot, thin))


def test_a_load_that_cannot_be_known_is_told_once(robot: RobotModel, log: MotionLog) -> None:
    """The load is not the sensor's z alone where the sensor leans: a lost x loses it."""
    found = check_log(robot, constant("wrench.left.force.x", np.nan)(log))
    assert [(finding.code, finding.fatal) for finding in found] == [("dead_channel", False)]
    assert found[0].text == "columns 'wrench.left.force.*': never hold a value together: the load is unknown"


@pytest.mark.parametrize(
    ("contact", "carried", "told"),
    [("auto", 0.5, True), ("auto", 0.25, True), ("always", 0.5, False), ("auto", 1.0, False)],
)
def test_a_foot_that_the_robot_file_leaves_out_is_missed(
    robot: RobotModel, log: MotionLog, contact: Literal["auto", "always"], carried: float, told: bool
) -> None:
    """Two feet carry the robot, or as the last case has it the one that is named does."""
    alone = replace(robot, feet={"left": replace(robot.feet["left"], contact=contact)})
    column = "wrench.left.force.z"
    share = carried * WEIGHT / float(log.column(column).mean())
    findings = check_log(alone, log.with_columns({column: share * log.column(column)}))
    assert [one.code for one in findings if one.code == "foot_missing"] == ["foot_missing"] * told
    assert not any(one.fatal for one in findings)
    assert not told or findings[0].text == (
        f"feet: the robot file names 'left' alone, which carries {60 * carried:.3g} of 60 kg: another foot stands, "
        "too; name it as well, if it has a force sensor: together they show delays and gains"
    )


def test_a_joint_that_slides_has_no_limit_in_degrees(robot: RobotModel) -> None:
    """A leg's slide far beyond its limit, beside an ankle as far beyond its own."""
    log = record(sway(duration=2.0))
    far = np.full(len(log), 100.0)
    assert (
        robot.model.upperPositionLimit[robot.model.joints[robot.model.getJointId("left_leg_z")].idx_q] < 100.0
    )
    assert list(_joints(robot, log.with_columns({"joint.left_leg_z.position": far}))) == []
    (found,) = _joints(robot, log.with_columns({"joint.left_ankle_pitch.position": far}))
    assert "left_ankle_pitch" in found.text

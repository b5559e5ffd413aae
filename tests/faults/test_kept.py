"""What is said of logs with one fault each, as it is kept: every finding with columns, times, numbers and remedy."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import small_biped
from biped import record, sines, sway
from biped_robot import FEET, Frame, Mounting, make_robot
from feet_trials import noisy, shifted, stepping, without
from kept_texts import assert_as_kept
from plantar.errors import PlantarError
from plantar.faults.log_faults import check_log
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

KEPT = Path(__file__).parent / "kept"
QUATERNION = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
GYROSCOPE = [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]
ACCELEROMETER = [f"imu.chest.linear_acceleration.{axis}" for axis in "xyz"]
FORCE, TORQUE = ([f"wrench.left.{kind}.{axis}" for axis in "xyz"] for kind in ("force", "torque"))
ANKLE = "joint.left_ankle_pitch.position"

# The weight goes from foot to foot, the torso leans by degrees, and the soles tilt little.
LEVEL = sines((-0.1, 0.15, 1.0), (0.015, 0.3, 0.1)), sines((-0.06, 0.2, 0.3), (0.01, 0.4, 0.2))
TORSO = sines((0.06, 0.2, 0.3)), sines((0.1, 0.15, 1.0)), sines((0.0, 0.0, 0.0))
LEAN = {"shift": 0.3, "torso": TORSO, "ankles": dict.fromkeys(FEET, LEVEL)}

Fault = Callable[[MotionLog], MotionLog]


def scaled(names: list[str], factor: float) -> Fault:
    return lambda log: log.with_columns({name: factor * log.column(name) for name in names})


def moved(names: list[str], by: float) -> Fault:
    return lambda log: log.with_columns({name: log.column(name) + by for name in names})


def exchanged(names: list[str], others: list[str]) -> Fault:
    return lambda log: log.with_columns(
        {one: log.column(other) for one, other in zip(names, others, strict=True)}
    )


def late(names: list[str], seconds: float) -> Fault:
    return lambda log: log.with_columns(
        {name: np.interp(log.time - seconds, log.time, log.column(name)) for name in names}
    )


def held(name: str, start: float, end: float, value: float | None = None) -> Fault:
    def fault(log: MotionLog) -> MotionLog:
        values, here = log.column(name).copy(), (log.time > start) & (log.time < end)
        values[here] = values[here][0] if value is None else value
        return log.with_columns({name: values})

    return fault


def turned(*angles: float) -> Fault:
    """The IMU's readings in axes that are turned by x, y, z [rad]."""
    turn = Rotation.from_rotvec(angles)

    def fault(log: MotionLog) -> MotionLog:
        seen = Rotation.from_quat(log.stack(QUATERNION), scalar_first=True) * turn
        read = dict(zip(QUATERNION, seen.as_quat(scalar_first=True).T, strict=True))
        for names in (GYROSCOPE, ACCELEROMETER):
            read |= dict(zip(names, turn.inv().apply(log.stack(names)).T, strict=True))
        return log.with_columns(read)

    return fault


def timed(change: Callable[[np.ndarray], np.ndarray]) -> Fault:
    return lambda log: MotionLog(log.name, change(log.time), log.columns)


def rows(keep: Callable[[np.ndarray], np.ndarray]) -> Fault:
    return lambda log: log.select(keep(log.time))


def rounded(names: list[str], step: float) -> Fault:
    return lambda log: log.with_columns({name: step * np.round(log.column(name) / step) for name in names})


def dead_band(name: str, width: float) -> Fault:
    return lambda log: log.with_columns(
        {name: np.where(np.abs(log.column(name)) < width, 0.0, log.column(name))}
    )


BOTH = [f"wrench.{foot}.{kind}.{axis}" for foot in FEET for kind in ("force", "torque") for axis in "xyz"]
OTHER = [name.replace("left", "x").replace("right", "left").replace("x.", "right.") for name in BOTH]
FAULTS: dict[str, Fault] = {
    "none": lambda log: log,
    "noise": lambda log: noisy(log, 3),
    "kilogram-force": scaled(FORCE + [name.replace("left", "right") for name in FORCE], 1 / 9.80665),
    "kilonewton": scaled(BOTH, 1e-3),
    "newton millimetre": scaled([name for name in BOTH if "torque" in name], 1e3),
    "pulls": scaled(BOTH, -1.0),
    "one pulls": scaled(FORCE + TORQUE, -1.0),
    "torques' sign": scaled(TORQUE, -1.0),
    "one torque's sign": scaled(TORQUE[1:2], -1.0),
    "feet exchanged": exchanged(BOTH, OTHER),
    "axes exchanged": exchanged(TORQUE[:2], TORQUE[1::-1]),
    "forces in the air": moved(FORCE[2:], 60.0),
    "dead torque": held(TORQUE[0], -1.0, 99.0, 0.0),
    "stuck torque": held(TORQUE[1], 4.0, 7.0),
    "clipped force": lambda log: log.with_columns({FORCE[2]: np.minimum(log.column(FORCE[2]), 300.0)}),
    "no values": held(TORQUE[2], -1.0, 99.0, np.nan),
    "some without values": held(FORCE[2], 3.0, 4.5, np.nan),
    "dead band": dead_band(TORQUE[0], 0.8),
    "late forces": late(BOTH, 0.05),
    "gyroscope in degrees": scaled(GYROSCOPE, 180 / np.pi),
    "gyroscope scale": scaled(GYROSCOPE, 1.3),
    "gyroscope sign": scaled(GYROSCOPE, -1.0),
    "gyroscope axes": exchanged(GYROSCOPE, GYROSCOPE[1:] + GYROSCOPE[:1]),
    "late attitude": late(QUATERNION, 0.04),
    "late gyroscope": late(GYROSCOPE, 0.08),
    "accelerometer in g": scaled(ACCELEROMETER, 1 / 9.80665),
    "accelerometer without gravity": moved(ACCELEROMETER[2:], -9.81),
    "accelerometer sign": scaled(ACCELEROMETER, -1.0),
    "inverted attitude": scaled(QUATERNION[1:], -1.0),
    "attitude order": exchanged(QUATERNION, QUATERNION[1:] + QUATERNION[:1]),
    "attitude not unit": scaled(QUATERNION[:1], 0.7),
    "attitude stands": lambda log: log.with_columns({name: 0 * log.time + log.column(name)[0] for name in QUATERNION}),
    "imu turned a little": turned(0.0, 0.06, 0.0),
    "imu turned": turned(0.0, 0.0, np.pi / 2),
    "imu upside down": turned(np.pi, 0.0, 0.0),
    "no attitude": lambda log: without(log, "orientation"),
    "no gyroscope": lambda log: without(log, "angular_velocity"),
    "joints in degrees": scaled([ANKLE], 180 / np.pi * 40),
    "joint beyond": moved([ANKLE], 1.6),
    "joint sign": scaled([ANKLE, ANKLE.replace("position", "velocity")], -1.0),
    "joint zero": moved([ANKLE], 0.03),
    "joint slips": lambda log: log.with_columns({ANKLE: log.column(ANKLE) + 0.03 * (log.time > 8.0)}),
    "joint stands": held(ANKLE, 5.0, 9.0),
    "joints exchanged": exchanged([ANKLE], [ANKLE.replace("pitch", "roll")]),
    "coarse joint": rounded([ANKLE], 0.01),
    "no joint": lambda log: without(log, "left_ankle_pitch"),
    "other joint": lambda log: MotionLog(
        log.name, log.time, {name.replace("left_ankle_pitch", "LeftAnklePitch"): v for name, v in log.columns.items()}
    ),
    "milliseconds": timed(lambda time: 1e3 * time),
    "too short": rows(lambda time: time < 0.4),
    "gap": rows(lambda time: (time < 4.0) | (time > 5.5)),
    "lost frames": rows(lambda time: np.random.default_rng(0).random(time.size) > 0.1),
    "bursts": timed(lambda time: np.sort(np.floor(time / 0.08) * 0.08 + 1e-4 * (np.arange(time.size) % 8))),
    "frozen": lambda log: log.with_columns(
        {name: np.where(abs(log.time - 6) < 0.3, values[600], values) for name, values in log.columns.items()}
    ),
    "placed aside": lambda log: shifted(log, np.array([0.03, -0.02, 0.01])),
    "steps": stepping,
}  # fmt: skip


def said(robot: RobotModel, log: MotionLog, fault: Fault) -> str:
    try:
        found = check_log(robot, fault(log))
    except PlantarError as error:
        return f"  {error}\n"
    return "".join(f"  {one.code} {one.severity}{' fatal' * one.fatal}: {one.text}\n" for one in found)


@pytest.mark.parametrize("motion", ["leaning", "mounted otherwise"])
def test_findings_are_as_they_are_kept(motion: str, tmp_path: Path) -> None:
    mounting = Mounting(
        imu=Frame((0.1, 0.0, 0.2), (0.4, -0.3, 1.2)),
        wrench=Frame((0.0, 0.01, -0.02), (0.0, np.pi, 0.5)),
        sign=-1,
    )
    robot = make_robot(tmp_path, mounting) if motion == "mounted otherwise" else make_robot(tmp_path)
    moves = sway("lean", 3, 15.0, **LEAN)
    log = record(moves, mounting) if motion == "mounted otherwise" else record(moves)
    text = "".join(f"{name}\n{said(robot, log, fault)}" for name, fault in FAULTS.items())
    assert_as_kept(text, KEPT / f"{motion.replace(' ', '_')}.txt", share=1e-5)


def test_findings_of_a_robot_that_moves_are_as_they_are_kept(tmp_path: Path) -> None:
    robot = small_biped.robot(tmp_path)
    log = small_biped.record(robot, small_biped.truth(robot.floating_model, 1), "moves", 2, 12.0, 0.2)
    both = [name for name in log.columns if name.startswith("wrench.")]
    gyroscope, accelerometer = (
        [f"imu.trunk.{kind}.{axis}" for axis in "xyz"] for kind in ("angular_velocity", "linear_acceleration")
    )
    faults = {
        "none": lambda log: log, "weight": scaled(both, 1.3), "signs": scaled(both, -1.0),
        "gyroscope": scaled(gyroscope, -1.0), "gyroscope scale": scaled(gyroscope, 0.8),
        "accelerometer": exchanged(accelerometer, accelerometer[::-1]), "late": late(both, 0.04),
        "leg exchanged": exchanged(["joint.left_pitch.position"], ["joint.right_pitch.position"]),
    }  # fmt: skip
    text = "".join(f"{name}\n{said(robot, log, fault)}" for name, fault in faults.items())
    assert_as_kept(text, KEPT / "moving.txt", share=1e-5)

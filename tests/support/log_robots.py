"""One recording as the robots' own loggers write it: mc_rtc, hrpsys, YARP, robot logger."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from log_tables import FEET, IMU, Written, joints, moving, positions, vector, velocities
from plantar.logs.motion_log import MotionLog


def write_mc_rtc(log: MotionLog, folder: Path, version: int = 0) -> Written:
    """Entries as mc_rtc's Logger writes them; a key that comes and goes stands in the middle."""
    import msgpack

    # The body sensor's orientation turns world into body.
    attitude = vector(log, f"imu.{IMU}.orientation", "wxyz") * [1, -1, -1, -1]
    wrenches = {
        foot: np.hstack([vector(log, f"wrench.{foot}.torque"), vector(log, f"wrench.{foot}.force")])
        for foot in FEET
    }
    parts: list[tuple[str, int, np.ndarray]] = [
        ("t", 11, log.time), ("qIn", 21, positions(log)), ("alphaIn", 21, velocities(log)),
        ("rpyIn", 17, attitude), ("rateIn", 14, vector(log, f"imu.{IMU}.angular_velocity")),
        ("accIn", 14, vector(log, f"imu.{IMU}.linear_acceleration")),
        *((f"{foot.title()}FootForceSensor", 19, wrenches[foot]) for foot in FEET),
    ]  # fmt: skip
    with open(folder / "mc_rtc.bin", "wb") as handle:
        handle.write(bytes([0x41, 0x4E, 0x4E, 0x45 + version]))
        for row in range(len(log)):
            extra = [("perf", 10, np.float32(row))] if 50 <= row < 80 else []
            now = extra + [(key, kind, values[row]) for key, kind, values in parts]
            changed = row in (0, 50, 80)
            values = [value.tolist() for _, _, value in now]
            if version == 0:
                head = [key for key, _, _ in now] if changed else None
                body = [
                    part for (_, kind, _), value in zip(now, values, strict=True) for part in (kind, value)
                ]
            else:
                added = [[0, kind, key] for key, kind, _ in now]
                head = (
                    added
                    if row == 0
                    else [[0, 10, "perf"]]
                    if row == 50
                    else [[1, "perf"]]
                    if row == 80
                    else None
                )
                body = values if not extra else [*values[1:], values[0]]
            entry = msgpack.packb([head, body])
            handle.write(struct.pack("<Q", len(entry)) + entry)
    ports = {"alphaIn": {"role": "joints.velocity", "joints": moving(log)}}
    return folder / "mc_rtc.bin", {"joints": joints(log), "ports": ports}


def write_hrpsys(log: MotionLog, folder: Path) -> Written:
    """One file a port, at the logger's highest precision; the attitude as roll, pitch, yaw."""
    rpy = Rotation.from_quat(vector(log, f"imu.{IMU}.orientation", "xyzw")).as_euler("xyz")
    ports = {
        "RobotHardware0_q": positions(log), "RobotHardware0_dq": velocities(log), "kf_rpy": rpy,
        "RobotHardware0_gyrometer": vector(log, f"imu.{IMU}.angular_velocity"),
        "RobotHardware0_gsensor": vector(log, f"imu.{IMU}.linear_acceleration"),
        "RobotHardware0_lfsensor": np.hstack([vector(log, f"wrench.left.{k}") for k in ("force", "torque")]),
        "RobotHardware0_rfsensor": np.hstack([vector(log, f"wrench.right.{k}") for k in ("force", "torque")]),
    }  # fmt: skip
    for port, values in ports.items():
        with open(folder / f"walk.{port}", "w") as handle:
            for time, row in zip(log.time, values, strict=True):
                handle.write(f"{time:.6f} " + "".join(f"{value:.16e} " for value in row) + "\n")
    roles = {"RobotHardware0_dq": {"role": "joints.velocity", "joints": moving(log)}}
    return folder / "walk.RobotHardware0_q", {"joints": joints(log), "ports": roles}


def write_yarp(log: MotionLog, folder: Path) -> Written:
    """Dumps of ports in YARP's own units; the IMU's port holds roll, pitch, yaw, acceleration and rate."""
    rpy = Rotation.from_quat(vector(log, f"imu.{IMU}.orientation", "xyzw")).as_euler("xyz", degrees=True)
    inertial = np.hstack([rpy, vector(log, f"imu.{IMU}.linear_acceleration"),
                          np.degrees(vector(log, f"imu.{IMU}.angular_velocity"))])  # fmt: skip
    ports = {
        "body/state": np.degrees(positions(log)),
        "body/speed": np.degrees(velocities(log)),
        "inertial": inertial,
    }
    ports |= {
        f"{foot}_foot": np.hstack([vector(log, f"wrench.{foot}.{k}") for k in ("force", "torque")])
        for foot in FEET
    }
    for port, values in ports.items():
        (folder / "dump" / port).mkdir(parents=True)
        both = port == "inertial"
        (folder / "dump" / port / "info.log").write_text(
            f"Type: Bottle;\nStamp: {'tx;rx;' if both else 'rx;'}\n[1] /a [connected]\n"
        )
        with open(folder / "dump" / port / "data.log", "w") as handle:
            for row, (time, line) in enumerate(zip(log.time, values, strict=True)):
                stamps = f"{time:.9f} {time + 0.5:.9f}" if both else f"{time:.9f}"
                body = " ".join(f"{value:.17g}" for value in line)
                handle.write(f"{row} {stamps} " + (f"({body})" if port == "body/state" else body) + "\n")
    roles = {
        "body/state": {"role": "joints.position", "unit": "deg"},
        "body/speed": {"role": "joints.velocity", "unit": "deg/s", "joints": moving(log)},
        "inertial": [{"role": f"imu.{IMU}.orientation.rpy", "unit": "deg", "take": [0, 3]},
                     {"role": f"imu.{IMU}.linear_acceleration", "take": [3, 6]},
                     {"role": f"imu.{IMU}.angular_velocity", "unit": "deg/s", "take": [6, 9]}],
        **{f"{foot}_foot": f"wrench.{foot}" for foot in FEET},
    }  # fmt: skip
    return folder / "dump", {"joints": joints(log), "ports": roles}


def write_mat(log: MotionLog, folder: Path) -> Written:
    """A robot logger's file: MATLAB's (k, 1, n) stored as HDF5's (n, 1, k), names as references to char arrays."""
    import h5py

    rpy = Rotation.from_quat(vector(log, f"imu.{IMU}.orientation", "xyzw")).as_euler("xyz")
    signals = {
        "joints_state/positions": (positions(log), joints(log)),
        "joints_state/velocities": (velocities(log), moving(log)),
        f"orientations/{IMU}": (rpy, None), f"gyros/{IMU}": (vector(log, f"imu.{IMU}.angular_velocity"), None),
        f"accelerometers/{IMU}": (vector(log, f"imu.{IMU}.linear_acceleration"), None),
        **{
            f"FTs/{foot}": (np.hstack([vector(log, f"wrench.{foot}.{k}") for k in ("force", "torque")]), None)
            for foot in FEET
        },
    }  # fmt: skip
    with h5py.File(folder / "robot_logger_device.mat", "w", userblock_size=512) as file:
        for name, (values, names) in signals.items():
            group = file.create_group(f"robot_logger_device/{name}")
            group["data"] = values[:, None, :]
            group["timestamps"] = log.time[:, None]
            if names is not None:
                cells = []
                for number, text in enumerate(names):
                    codes = np.frombuffer(text.encode("utf-16-le"), np.uint16)[:, None]
                    cells.append(
                        file.create_dataset(f"#refs#/{name.replace('/', '_')}_{number}", data=codes).ref
                    )
                group.create_dataset("elements_names", data=np.array(cells, dtype=h5py.ref_dtype)[None, :])
    return folder / "robot_logger_device.mat", {}

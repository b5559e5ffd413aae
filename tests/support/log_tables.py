"""One recording as tables: plantar's own, foreign ones with a `columns:` map, and what other writers need of a log.

Each writer takes a log and a folder and returns what to open and the `columns:` that the robot file then needs.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet

from plantar.logs.motion_log import MotionLog

Written = tuple[Path, dict[str, Any]]
IMU, FEET = "chest", ("left", "right")


def joints(log: MotionLog) -> list[str]:
    return [
        name.split(".")[1] for name in log.columns if name.startswith("joint.") and name.endswith(".position")
    ]


def moving(log: MotionLog) -> list[str]:
    """Joints with a velocity; the neck has none."""
    return [joint for joint in joints(log) if log.has(f"joint.{joint}.velocity")]


def vector(log: MotionLog, stem: str, axes: str = "xyz") -> np.ndarray:
    return log.stack(f"{stem}.{axis}" for axis in axes)


def positions(log: MotionLog) -> np.ndarray:
    return log.stack(f"joint.{joint}.position" for joint in joints(log))


def velocities(log: MotionLog) -> np.ndarray:
    return log.stack(f"joint.{joint}.velocity" for joint in moving(log))


def table(log: MotionLog) -> pa.Table:
    return pa.table({"time": log.time, **log.columns})


def write_csv(log: MotionLog, folder: Path) -> Written:
    pa_csv.write_csv(table(log), folder / "log.csv")
    return folder / "log.csv", {}


def write_parquet(log: MotionLog, folder: Path) -> Written:
    pa_parquet.write_table(table(log), folder / "log.parquet")
    return folder / "log.parquet", {}


def write_npz(log: MotionLog, folder: Path) -> Written:
    np.savez_compressed(folder / "log.npz", time=log.time, **log.columns)
    return folder / "log.npz", {}


def foreign(log: MotionLog) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Other names and units: ms, degrees, g, N·mm, a sensor of the other sign, quaternion x y z w."""
    data = {"stamp": log.time * 1e3}
    columns: dict[str, Any] = {"time": {"from": "stamp", "unit": "ms"}}
    for joint in joints(log):
        data[f"q_{joint}"] = np.degrees(log.column(f"joint.{joint}.position"))
        columns[f"joint.{joint}.position"] = {"from": f"q_{joint}", "unit": "deg"}
    for joint in moving(log):
        data[f"dq_{joint}"] = np.degrees(log.column(f"joint.{joint}.velocity"))
        columns[f"joint.{joint}.velocity"] = {"from": f"dq_{joint}", "unit": "deg/s"}
    for word, stem, scale, unit, sign in (
        ("w", f"imu.{IMU}.angular_velocity", 180 / np.pi, "deg/s", 1),
        ("a", f"imu.{IMU}.linear_acceleration", 1 / 9.80665, "g", 1),
        *((f"f{foot}", f"wrench.{foot}.force", -1e-3, "kN", -1) for foot in FEET),
        *((f"m{foot}", f"wrench.{foot}.torque", -1e3, "N·mm", -1) for foot in FEET),
    ):
        data |= {f"{word}{axis}": scale * log.column(f"{stem}.{axis}") for axis in "xyz"}
        columns[stem] = {"from": [f"{word}{axis}" for axis in "xyz"], "unit": unit, "sign": sign}
    data |= {f"q{axis}": log.column(f"imu.{IMU}.orientation.{axis}") for axis in "xyzw"}
    columns[f"imu.{IMU}.orientation"] = {"from": ["qx", "qy", "qz", "qw"], "order": "xyzw"}
    return data, columns


def write_mapped_csv(log: MotionLog, folder: Path) -> Written:
    data, columns = foreign(log)
    pa_csv.write_csv(pa.table(data), folder / "foreign.csv")
    return folder / "foreign.csv", columns


def write_mapped_npz(log: MotionLog, folder: Path) -> Written:
    data, columns = foreign(log)
    np.savez(folder / "foreign.npz", **data)
    return folder / "foreign.npz", columns


def write_astate(log: MotionLog, folder: Path) -> Written:
    """OpenHRP's astate.log: numbers without a header, found by their place."""
    data, columns = foreign(log)
    places = {name: index for index, name in enumerate(data)}
    np.savetxt(folder / "astate.log", np.column_stack(list(data.values())), fmt="%.17g")
    for entry in columns.values():
        entry["from"] = (
            [places[name] for name in entry["from"]]
            if isinstance(entry["from"], list)
            else places[entry["from"]]
        )
    return folder / "astate.log", columns

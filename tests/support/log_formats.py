"""One recording written in every format that plantar reads, by other software or by the format's own words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from log_bags import write_mcap, write_ros1, write_ros2, write_sqlite
from log_robots import write_hrpsys, write_mat, write_mc_rtc, write_yarp
from log_tables import (
    Written,
    write_astate,
    write_csv,
    write_mapped_csv,
    write_mapped_npz,
    write_npz,
    write_parquet,
)
from plantar.logs.motion_log import MotionLog

WRITERS: dict[str, Callable[[MotionLog, Path], Written]] = {
    "csv": write_csv,
    "parquet": write_parquet,
    "npz": write_npz,
    "mapped_csv": write_mapped_csv,
    "mapped_npz": write_mapped_npz,
    "astate": write_astate,
    "mcap": write_mcap,
    "mcap_plain": lambda log, folder: write_ros2(log, folder, "MCAP"),
    "sqlite3": write_sqlite,
    "ros1": write_ros1,
    "ros1_bz2": lambda log, folder: write_ros1(log, folder, "BZ2"),
    "ros1_lz4": lambda log, folder: write_ros1(log, folder, "LZ4"),
    "mc_rtc": write_mc_rtc,
    "mc_rtc_1": lambda log, folder: write_mc_rtc(log, folder, 1),
    "hrpsys": write_hrpsys,
    "yarp": write_yarp,
    "robot_logger": write_mat,
}

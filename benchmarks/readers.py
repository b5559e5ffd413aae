"""Reading 60 s of a humanoid at 500 Hz from MCAP: 120,000 messages, against rosbags' own loop.

    python benchmarks/readers.py

Prints the seconds of both, their ratio, and the peak of memory over the size of the arrays.
"""

from __future__ import annotations

import json
import tempfile
import time
import tracemalloc
from pathlib import Path

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.save import save_log

RATE, SECONDS, JOINTS = 500, 60, 32


def recording() -> MotionLog:
    """Joints with position, velocity and effort, one IMU, two wrenches; smooth made-up numbers."""
    t = np.arange(RATE * SECONDS) / RATE
    rng = np.random.default_rng(0)
    wave = lambda: np.sin(rng.uniform(0.1, 5) * t + rng.uniform(0, 6)) + 1e-3 * rng.standard_normal(t.size)  # noqa: E731
    columns = {
        f"joint.leg_left_{i}_joint.{q}": wave()
        for i in range(JOINTS)
        for q in ("position", "velocity", "effort")
    }
    columns |= {f"imu.chest.orientation.{a}": wave() for a in "wxyz"}
    columns |= {
        f"imu.chest.{q}.{a}": wave() for q in ("angular_velocity", "linear_acceleration") for a in "xyz"
    }
    columns |= {
        f"wrench.{s}.{q}.{a}": wave() for s in ("left", "right") for q in ("force", "torque") for a in "xyz"
    }
    return MotionLog("benchmark", t, columns)


def rosbags_loop(path: Path) -> int:
    """What a user of rosbags writes today: one object a message, its numbers appended."""
    from rosbags.highlevel import AnyReader

    count, rows = 0, []
    with AnyReader([path]) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            stamp = message.header.stamp
            rows.append((stamp.sec + 1e-9 * stamp.nanosec, message))
            count += 1
    return count


def main() -> None:
    log = recording()
    arrays = 8 * len(log) * (len(log.columns) + 1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.mcap"
        save_log(log, path)
        ours, theirs = [], []
        for _ in range(3):
            start = time.perf_counter()
            again = open_log(path)
            ours.append(time.perf_counter() - start)
        start = time.perf_counter()
        count = rosbags_loop(path)
        theirs.append(time.perf_counter() - start)
        tracemalloc.start()
        open_log(path)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        same = all(np.array_equal(again.columns[name], log.columns[name]) for name in log.columns)
        print(json.dumps({
            "messages": count, "file_mb": round(path.stat().st_size / 1e6, 1), "plantar_s": round(min(ours), 3),
            "rosbags_s": round(min(theirs), 3), "ratio": round(min(theirs) / min(ours), 1),
            "arrays_mb": round(arrays / 1e6, 1), "peak_over_arrays": round(peak / arrays, 2), "identical": same,
        }))  # fmt: skip


if __name__ == "__main__":
    main()

"""The plain way from logs to feet: a loop over samples in Pinocchio, NumPy least squares, one offset a recording.

What a robotics engineer writes in an afternoon, to measure `plantar identify feet` by: no delay, no slip, no choice of
a model, no interval that holds. Prints K and C of each foot and axis.

    python benchmarks/plain_feet.py robot.yaml log.csv...
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import yaml
from scipy.signal import butter, filtfilt

from deflection import per_sample

CUTOFF = 5.0  # Hz, of both sides of the fit


def read(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV or Parquet log by name."""
    if path.suffix == ".parquet":
        import pyarrow.parquet

        table = pyarrow.parquet.read_table(path)
        return {name: table[name].to_numpy() for name in table.column_names}
    with path.open() as file:
        names = [name.strip('"') for name in file.readline().strip().split(",")]
        return dict(zip(names, np.loadtxt(file, delimiter=",").T, strict=True))


def main(robot_file: Path, logs: list[Path]) -> None:
    robot = yaml.safe_load(robot_file.read_text())
    model = pin.buildModelFromUrdf(str(robot_file.parent / robot["urdf"]))
    imu = model.frames[model.getFrameId(robot["imu"]["link"])]
    feet = [model.frames[model.getFrameId(foot["ankle"])] for foot in robot["feet"].values()]
    rows: dict[tuple[int, int], list[np.ndarray]] = {
        (k, axis): [] for k in range(len(feet)) for axis in (0, 1)
    }
    for log in logs:
        columns = read(log)
        period = float(np.median(np.diff(columns["time"])))
        numerator, denominator = butter(2, 2 * CUTOFF * period)
        q = np.column_stack([columns[f"joint.{name}.position"] for name in model.names[1:]])
        v = np.gradient(filtfilt(numerator, denominator, q, axis=0), period, axis=0)
        name = f"imu.{robot['imu']['name']}"
        orientation = np.column_stack([columns[f"{name}.orientation.{part}"] for part in "wxyz"])
        gyroscope = np.column_stack([columns[f"{name}.angular_velocity.{part}"] for part in "xyz"])
        motion = per_sample(model, imu, feet, q, v, orientation, gyroscope)
        motion = filtfilt(numerator, denominator, motion, axis=0)
        for k, foot in enumerate(robot["feet"].values()):
            wrench = {part: columns[f"wrench.{foot['wrench']['name']}.{part}"]
                      for part in ("force.x", "force.y", "force.z", "torque.x", "torque.y")}  # fmt: skip
            above = foot["bush"]["xyz"][2] - foot["wrench"]["xyz"][2]
            # From the sensor to the bush's centre, which is `above` it.
            torques = (
                wrench["torque.y"] - above * wrench["force.x"],
                wrench["torque.x"] + above * wrench["force.y"],
            )
            standing = wrench["force.z"] > 50.0
            for axis, torque in enumerate(torques if standing.any() else ()):
                smooth = filtfilt(numerator, denominator, torque)
                joint = np.column_stack([motion[:, k, axis], motion[:, k, 2 + axis], smooth])[standing]
                rows[k, axis].append(joint - joint.mean(axis=0))  # one offset a recording
    for (k, axis), parts in rows.items():
        joint = np.vstack(parts)
        stiffness, damping = np.linalg.lstsq(joint[:, :2], joint[:, 2], rcond=None)[0]
        print(f"{list(robot['feet'])[k]} {('pitch', 'roll')[axis]}: K {stiffness:.1f}, C {damping:.2f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), [Path(log) for log in sys.argv[2:]])

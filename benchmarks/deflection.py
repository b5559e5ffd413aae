"""Bush deflection of both feet of TALOS: the native batch against Pinocchio, sample by sample.

Prints times per foot-sample and their ratio; both compute pitch, roll and their rates, and must agree to 1e-10.

    python benchmarks/deflection.py [samples]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

from plantar import _core
from plantar.contact.deflection import foot_motion, foot_path
from plantar.conventions import Array
from plantar.robot.kinematics import KinematicTree

TALOS = Path(pin.__file__).parents[4] / "share/example-robot-data/robots/talos_data/robots/talos_reduced.urdf"
IMU, FEET = "torso_2_link", ("leg_left_6_link", "leg_right_6_link")


def per_sample(
    model: pin.Model,
    imu: pin.Frame,
    feet: Sequence[pin.Frame],
    q: Array,
    v: Array,
    orientation: Array,
    gyroscope: Array,
) -> Array:
    """(N, feet, 4): pitch, roll and rates by Pinocchio's kinematics and a few NumPy operations a foot."""
    data = model.createData()
    out = np.empty((len(q), len(feet), 4))
    for i in range(len(q)):
        pin.forwardKinematics(model, data, q[i], v[i])
        w, x, y, z = orientation[i]
        world_up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        imu_placement = data.oMi[imu.parentJoint] * imu.placement
        up_base = imu_placement.rotation @ world_up
        spin = imu_placement.rotation @ (gyroscope[i] - imu.placement.actInv(data.v[imu.parentJoint]).angular)
        for k, foot in enumerate(feet):
            rotation = (data.oMi[foot.parentJoint] * foot.placement).rotation
            up = rotation.T @ up_base
            omega = rotation.T @ spin + foot.placement.actInv(data.v[foot.parentJoint]).angular
            rate = pin.skew(up) @ omega
            level2 = up[0] ** 2 + up[2] ** 2
            out[i, k] = (
                np.arctan2(up[0], up[2]),
                -np.arcsin(up[1]),
                (up[2] * rate[0] - up[0] * rate[2]) / level2,
                -rate[1] / np.sqrt(level2),
            )
    return out


def main(samples: int = 20_000) -> None:
    model = pin.buildModelFromUrdf(str(TALOS))
    rng = np.random.default_rng(0)
    q, v = rng.uniform(-0.5, 0.5, (samples, model.nq)), rng.normal(size=(samples, model.nv))
    orientation = rng.normal(size=(samples, 4))
    orientation /= np.linalg.norm(orientation, axis=1, keepdims=True)
    gyroscope = rng.normal(size=(samples, 3))

    started = time.perf_counter()
    imu, *feet = (model.frames[model.getFrameId(name)] for name in (IMU, *FEET))
    slow = per_sample(model, imu, feet, q, v, orientation, gyroscope)
    loop = time.perf_counter() - started

    def batch() -> Array:
        tree = KinematicTree.from_model(model)

        def frame(name: str) -> tuple[int, pin.SE3]:
            found = model.frames[model.getFrameId(name)]
            return int(found.parentJoint), found.placement

        paths = [foot_path(tree, frame(IMU), frame(name), pin.SE3.Identity()) for name in FEET]
        motions = [foot_motion(path, q, v, orientation, gyroscope) for path in paths]
        return np.stack([np.hstack([m.deflection, m.rate]) for m in motions], axis=1)

    times = []
    for _ in range(10):
        started = time.perf_counter()
        fast = batch()
        times.append(time.perf_counter() - started)
    native = float(np.median(times))
    foot_samples = samples * len(FEET)
    print(f"TALOS, {samples} samples, {len(FEET)} feet, instruction set {_core.instruction_sets()[0]}")
    print(f"Pinocchio, sample by sample  {1e6 * loop / foot_samples:10.3f} us a foot-sample")
    print(f"plantar, one batch           {1e6 * native / foot_samples:10.3f} us a foot-sample")
    print(f"ratio                        {loop / native:10.1f}")
    print(f"largest difference           {np.abs(fast - slow).max():10.1e}")


if __name__ == "__main__":
    main(*(int(argument) for argument in sys.argv[1:]))

"""Logs of a humanoid that stands and sways on both feet, exact by statics: each foot's wrench carries its share of the
weight, and the centre of pressure lies under the centre of mass."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin

from plantar.logs.motion_log import MotionLog

RATE, DURATION = 50.0, 10.0  # Hz, s
G = 9.80665


def talos_sways(
    urdf: Path, imu_turn: np.ndarray | None = None, wrench_turn: np.ndarray | None = None, height: float = 0.0
) -> MotionLog:
    """TALOS tilts its trunk over flat feet, sideways little, as its legs do not give way.

    The IMU sits on imu_link, the sensors `height` over the ankles; `imu_turn`, `wrench_turn`: their axes in the link's,
    (3, 3).
    """
    imu_turn, wrench_turn = (np.eye(3) if turn is None else turn for turn in (imu_turn, wrench_turn))
    model = pin.buildModelFromXML(urdf.read_text())
    data = model.createData()
    weight = G * sum(inertia.mass for inertia in model.inertias)
    time = np.arange(0, DURATION, 1 / RATE)
    fore, side = 0.08 * np.sin(2 * np.pi * 0.3 * time), 0.02 * np.sin(2 * np.pi * 0.21 * time + 1)
    angles = {2: -side, 3: -0.4 - fore, 4: 0.8 + 0 * time, 5: -0.4 + 0 * time, 6: 0 * time}
    columns = {}
    q = np.tile(pin.neutral(model), (time.size, 1))
    for name in list(model.names)[1:]:
        number = int(name.split("_")[2]) if name.startswith("leg_") else 0
        values = angles.get(number, 0 * time)
        columns[f"joint.{name}.position"] = values
        q[:, model.joints[model.getJointId(name)].idx_q] = values
    felt, wrenches = np.empty((time.size, 4)), {foot: np.empty((time.size, 6)) for foot in ("left", "right")}
    root = model.inertias[0]
    total = weight / G
    for row in range(time.size):
        pin.centerOfMass(model, data, q[row])
        pin.framesForwardKinematics(model, data, q[row])
        ankles = {foot: data.oMf[model.getFrameId(f"leg_{foot}_6_link")] for foot in wrenches}
        centre = (root.mass * root.lever + (total - root.mass) * data.com[0]) / total
        world = ankles["left"].rotation.T  # the soles are flat: their axes are the world's
        imu = data.oMf[model.getFrameId("imu_link")].rotation
        felt[row] = np.roll(pin.Quaternion(world @ imu @ imu_turn).coeffs(), 1)
        across = {foot: (world @ (ankle.translation - centre))[:2] for foot, ankle in ankles.items()}
        roll = 0.02 * np.sin(2 * np.pi * 0.4 * time[row])  # of both centres of pressure, to the left
        share = (across["right"][1] + roll) / (across["right"][1] - across["left"][1])
        for foot, part in (("left", share), ("right", 1 - share)):
            ankle = ankles[foot]
            arm = world.T @ [-across[foot][0], roll, 0.0]  # from the ankle to the centre of pressure
            force = part * weight * world[2]
            torque = np.cross(arm - ankle.rotation @ [0, 0, height], force)
            axes = ankle.rotation @ wrench_turn
            wrenches[foot][row] = np.concatenate([axes.T @ force, axes.T @ torque])
    columns |= {f"imu.chest.orientation.{axis}": felt[:, k] for k, axis in enumerate("wxyz")}
    for foot, values in wrenches.items():
        for k, axis in enumerate("xyz"):
            columns[f"wrench.{foot}.force.{axis}"] = values[:, k]
            columns[f"wrench.{foot}.torque.{axis}"] = values[:, 3 + k]
    return MotionLog("sways", time, columns)

"""A small two-legged robot whose parameters are known, and logs of it: eq. 1 by Pinocchio, sample by sample."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel, load_robot

PERIOD = 0.01


def urdf() -> str:
    """A trunk with an arm and two legs of three joints each."""

    def link(name: str, mass: float, x: float, y: float, z: float, size: float) -> str:
        inertia = " ".join(f'i{axes}="{mass * size**2 * value}"' for axes, value in INERTIA.items())
        return (
            f'<link name="{name}"><inertial><origin xyz="{x} {y} {z}"/><mass value="{mass}"/>'
            f"<inertia {inertia}/></inertial></link>"
        )

    def joint(name: str, parent: str, child: str, xyz: str, axis: str) -> str:
        return (
            f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>'
            '<limit lower="-2" upper="2" effort="100" velocity="10"/></joint>'
        )

    parts = [link("trunk", 10.0, 0.01, 0.0, 0.2, 0.15), '<link name="imu"/>']
    parts.append('<joint name="imu_mount" type="fixed"><parent link="arm"/><child link="imu"/>')
    parts[-1] += '<origin xyz="0.05 0.02 -0.1" rpy="0.3 -0.2 0.5"/></joint>'
    parts += [
        link("arm", 2.0, 0.0, 0.02, -0.15, 0.1),
        joint("shoulder", "trunk", "arm", "0 0.1 0.35", "0 1 0"),
    ]
    for side, y in (("left", 0.1), ("right", -0.1)):
        parts += [
            link(f"{side}_hip", 1.0, 0.0, 0.01, -0.03, 0.05),
            link(f"{side}_leg", 3.0, 0.01, 0.0, -0.2, 0.12),
            link(f"{side}_foot", 1.0, 0.03, 0.0, -0.03, 0.06),
            joint(f"{side}_roll", "trunk", f"{side}_hip", f"0 {y} 0", "1 0 0"),
            joint(f"{side}_pitch", f"{side}_hip", f"{side}_leg", "0 0 -0.05", "0 1 0"),
            joint(f"{side}_ankle", f"{side}_leg", f"{side}_foot", "0 0 -0.4", "0 1 0"),
        ]
    return '<robot name="biped">' + "".join(parts) + "</robot>"


INERTIA = {"xx": 1.0, "xy": 0.05, "xz": -0.03, "yy": 0.9, "yz": 0.02, "zz": 0.8}

FOOT = """  {side}:
    ankle: {side}_foot
    bush: {{xyz: [0, 0, -0.05]}}
    wrench: {{name: {side}, link: {side}_foot, xyz: [0.01, 0, -0.04], rpy: [0.1, 0, 0.2], sign: {sign}}}
    sole: {{xyz: [0, 0, -0.08], polygon: [[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]]}}
"""


def robot(folder: Path, extra: str = "") -> RobotModel:
    (folder / "biped.urdf").write_text(urdf())
    text = "name: biped\nurdf: biped.urdf\nimu: {name: trunk, link: imu}\nfeet:\n"
    text += FOOT.format(side="left", sign=1) + FOOT.format(side="right", sign=-1)
    (folder / "biped.yaml").write_text(text + extra)
    return load_robot(folder / "biped.yaml")


def truth(model: pin.Model, seed: int) -> pin.Model:
    """The model with every body other than in the URDF: heavier or lighter, its mass elsewhere, still a body."""
    rng = np.random.default_rng(seed)
    real = model.copy()
    for joint in range(1, model.njoints):
        old = model.inertias[joint]
        scale = np.exp(rng.normal(0, 0.15))
        stretch = np.diag(np.exp(rng.normal(0, 0.1, 3)))
        spread = 0.5 * np.trace(old.inertia) * np.eye(3) - old.inertia
        spread = scale * stretch @ spread @ stretch
        inertia = np.trace(spread) * np.eye(3) - spread
        lever = old.lever + rng.normal(0, 0.01, 3)
        real.inertias[joint] = pin.Inertia(scale * old.mass, lever, inertia)
    return real


def smooth(rng: np.random.Generator, time: Array, size: float) -> tuple[Array, Array, Array]:
    """A sum of sines with its first two derivatives, (N,) each."""
    value, rate, second = np.zeros((3, len(time)))
    for frequency in rng.uniform(0.1, 0.9, 5):
        w, phase, amplitude = 2 * np.pi * frequency, rng.uniform(0, 2 * np.pi), size * rng.normal() / 2
        value += amplitude * np.sin(w * time + phase)
        rate += amplitude * w * np.cos(w * time + phase)
        second -= amplitude * w**2 * np.sin(w * time + phase)
    return value, rate, second


def record(
    robot: RobotModel, real: pin.Model, name: str, seed: int, seconds: float = 30.0, noise: float = 0.0
) -> MotionLog:
    """A log of the robot `real` in motion, the ground's wrench shared by both feet; `noise` [N, and N·m / 10]."""
    rng = np.random.default_rng(seed)
    model, data = real, real.createData()
    time = np.arange(0, seconds, PERIOD)
    joints = np.array([smooth(rng, time, 0.5) for _ in range(model.njoints - 2)])  # (n, 3, N)
    spin = np.array([smooth(rng, time, 0.3) for _ in range(3)])[:, 1:]  # rate and its derivative
    shift = np.array([smooth(rng, time, 0.1)[2] for _ in range(3)])
    columns = {f"joint.{joint}.position": joints[k, 0] for k, joint in enumerate(robot.joint_names)}
    columns |= {f"joint.{joint}.velocity": joints[k, 1] for k, joint in enumerate(robot.joint_names)}
    imu_joint, imu = robot.frame(robot.imu.placement)  # type: ignore[union-attr]
    gyro, moving, accelerometer = np.zeros((3, len(time), 3))
    torques = np.zeros((len(time), len(robot.joint_names)))
    wrenches = {side: np.zeros((len(time), 6)) for side in robot.feet}
    share = 0.5 + 0.4 * np.sin(2 * np.pi * 0.23 * time)
    frames = {side: robot.frame(foot.wrench.placement) for side, foot in robot.feet.items()}
    rotation = np.eye(3)
    for i in range(len(time)):
        q = np.concatenate([np.zeros(3), pin.Quaternion(rotation).coeffs(), joints[:, 0, i]])
        v = np.concatenate([np.zeros(3), spin[:, 0, i], joints[:, 1, i]])
        a = np.concatenate([rotation.T @ shift[:, i], spin[:, 1, i], joints[:, 2, i]])
        tau = pin.rnea(model, data, q, v, a)
        rotation = rotation @ pin.exp3(spin[:, 0, i] * PERIOD)
        pin.forwardKinematics(model, data, q, v, a)
        speed, slope = imu.actInv(data.v[imu_joint + 1]), imu.actInv(data.a[imu_joint + 1])
        gyro[i] = speed.angular
        up = (data.oMi[imu_joint + 1] * imu).rotation.T @ np.array([0, 0, 9.81])
        accelerometer[i] = slope.linear + up
        moving[i] = speed.linear
        torques[i] = tau[6:]
        for side, part in (("left", share[i]), ("right", 1 - share[i])):
            joint, placement = frames[side]
            sensor = data.oMi[1].inverse() * data.oMi[joint + 1] * placement
            wrench = sensor.actInv(pin.Force(part * tau[:6]))
            wrenches[side][i] = robot.feet[side].wrench.sign * wrench.vector
            jacobian = pin.computeJointJacobian(model, data, q, joint + 1)
            at_joint = placement.act(wrench)
            torques[i] -= (jacobian.T @ at_joint.vector)[6:]
    accelerometer += np.cross(gyro, moving)
    pieces = [noise] * 3 + [noise / 10] * 3
    for side, values in wrenches.items():
        values += rng.normal(size=values.shape) * pieces
        kinds = [f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]
        columns |= {f"wrench.{side}.{kind}": values[:, k] for k, kind in enumerate(kinds)}
    for quantity, values in (("angular_velocity", gyro), ("linear_acceleration", accelerometer)):
        columns |= {f"imu.trunk.{quantity}.{axis}": values[:, k] for k, axis in enumerate("xyz")}
    columns |= {
        f"joint.{joint}.effort": torques[:, k] + rng.normal(0, noise / 10, len(time))
        for k, joint in enumerate(robot.joint_names)
    }
    return MotionLog(name, time, columns)

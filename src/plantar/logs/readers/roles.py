"""What a vector of a log is (joint positions, an IMU's rate, a wrench), in which units and order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.errors import LogError

DEGREE = np.pi / 180

# Unit -> (what it measures, factor to SI).
UNITS: dict[str, tuple[str, float]] = {
    "s": ("time", 1.0), "ms": ("time", 1e-3), "us": ("time", 1e-6), "ns": ("time", 1e-9),
    "rad": ("position", 1.0), "deg": ("position", DEGREE), "m": ("position", 1.0), "mm": ("position", 1e-3),
    "rad/s": ("velocity", 1.0), "deg/s": ("velocity", DEGREE), "m/s": ("velocity", 1.0), "mm/s": ("velocity", 1e-3),
    "rad/s^2": ("joint acceleration", 1.0), "deg/s^2": ("joint acceleration", DEGREE),
    "m/s^2": ("acceleration", 1.0), "g": ("acceleration", GRAVITY),
    "N": ("force", 1.0), "kN": ("force", 1e3), "kgf": ("force", GRAVITY),
    "N.m": ("torque", 1.0), "N.mm": ("torque", 1e-3), "kN.m": ("torque", 1e3),
    "kgf.cm": ("torque", GRAVITY / 100),
    "1": ("ratio", 1.0),
}  # fmt: skip

# Last words of a column or role -> what it measures.
QUANTITIES = {
    "time": "time", "position": "position", "velocity": "velocity", "acceleration": "joint acceleration",
    "effort": "torque", "orientation": "ratio", "rpy": "position", "angular_velocity": "velocity",
    "linear_acceleration": "acceleration", "force": "force", "torque": "torque",
}  # fmt: skip
ORDERS = ("wxyz", "xyzw")


def factor(unit: object, quantity: str, where: str, path: Path) -> float:
    """What to multiply by to get SI. LogError: an unknown unit, or one of another quantity."""
    if unit is None:
        return 1.0
    plain = str(unit).replace("·", ".").replace("²", "^2").replace("Nm", "N.m").strip()
    kind, scale = UNITS.get(plain, (None, 1.0))
    if kind != quantity:
        fitting = [name for name, (of, _) in UNITS.items() if of == quantity]
        raise LogError(
            f"{where}: no such unit of {quantity}", path=path, value=str(unit)[:40], valid=", ".join(fitting)
        )
    return scale


def role_columns(
    role: str, values: Array, joints: Sequence[str], path: Path, *, unit: str | None, sign: float = 1.0
) -> dict[str, Array]:
    """A vector (n, k) that has a role, as columns by the contract's names.

    Roles: `joints.position|velocity|acceleration|effort` (k joints in order), `imu.<name>.orientation.wxyz`,
    `.xyzw`, `.rpy` (body to world), `imu.<name>.angular_velocity`, `imu.<name>.linear_acceleration`,
    `wrench.<name>` (force then torque), `wrench.<name>.torque_first`, `wrench.<name>.force`, `.torque`.
    Raises LogError: an unknown role, or a vector of another length.
    """
    kind, _, rest = role.partition(".")
    last = role.rpartition(".")[2]
    if kind == "joints" and last in ("position", "velocity", "acceleration", "effort"):
        _length(values, len(joints), role, path)
        scale = sign * factor(unit, QUANTITIES[last], role, path)
        return {f"joint.{name}.{last}": scale * values[:, i] for i, name in enumerate(joints)}
    if kind == "imu" and ".orientation." in role and last in (*ORDERS, "rpy"):
        stem = role.rpartition(".")[0]
        if last == "rpy":
            _length(values, 3, role, path)
            scale = sign * factor(unit, "position", role, path)
            values, last = quaternion_from_rpy(scale * values), "wxyz"
        _length(values, 4, role, path)
        return {f"{stem}.{axis}": values[:, i] for i, axis in enumerate(last)}
    if kind in ("imu", "wrench") and last in ("angular_velocity", "linear_acceleration", "force", "torque"):
        _length(values, 3, role, path)
        scale = sign * factor(unit, QUANTITIES[last], role, path)
        return {f"{role}.{axis}": scale * values[:, i] for i, axis in enumerate("xyz")}
    if kind == "wrench" and rest:
        _length(values, 6, role, path)
        if unit is not None:
            valid = "each half by itself: {role: wrench.<name>.force, unit: kN, take: [0, 3]}, and torque likewise"
            raise LogError(
                f"{role}: force and torque have no unit in common", path=path, value=unit, valid=valid
            )
        stem, halves = role.removesuffix(".torque_first"), (values[:, :3], values[:, 3:])
        force, torque = halves[::-1] if last == "torque_first" else halves
        columns = {f"{stem}.force.{axis}": sign * force[:, i] for i, axis in enumerate("xyz")}
        return columns | {f"{stem}.torque.{axis}": sign * torque[:, i] for i, axis in enumerate("xyz")}
    valid = "joints.position, imu.<name>.angular_velocity, imu.<name>.orientation.rpy, wrench.<name>, ..."
    raise LogError("is not a role", path=path, value=role, valid=valid)


def _length(values: Array, expected: int, role: str, path: Path) -> None:
    if values.ndim != 2 or values.shape[1] != expected:
        found = values.shape[1] if values.ndim == 2 else values.ndim
        hint = "columns.joints in the robot file, in the log's order" if role.startswith("joints") else None
        raise LogError(f"{role}: the log has {found} values a sample, not {expected}", path=path, valid=hint)


def quaternion_from_rpy(rpy: Array) -> Array:
    """Fixed-axis roll, pitch, yaw (n, 3) [rad] to quaternions w x y z (n, 4): Rz(yaw) Ry(pitch) Rx(roll)."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy / 2).T, np.cos(rpy / 2).T
    return np.column_stack([
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    ])  # fmt: skip

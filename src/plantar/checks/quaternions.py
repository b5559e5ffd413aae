"""The ways in which the four numbers of a quaternion can be meant."""

from __future__ import annotations

from scipy.spatial.transform import Rotation

from plantar.conventions import Array
from plantar.notes import Finding


def readings(orientation: Array) -> dict[str, Rotation]:
    """The orientation (n, 4) body to world as the columns say, and as other conventions would fill them."""
    as_is = Rotation.from_quat(orientation, scalar_first=True)
    return {
        "as it is": as_is,
        "read as x y z w": Rotation.from_quat(orientation),
        "inverted": as_is.inv(),
    }


def misread(name: str, text: str, reading: str) -> Finding:
    """What is said of an IMU whose quaternions agree only in another reading."""
    valid = "w x y z" if reading == "read as x y z w" else "body to world"
    return Finding(
        "quaternion_order",
        f"columns 'imu.{name}.orientation.*': {text}; {reading} it agrees (valid: {valid})",
        True,
    )

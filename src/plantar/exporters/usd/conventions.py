"""What UsdPhysics asks of names, axes and units."""

from __future__ import annotations

import math

import numpy as np

from plantar.conventions import Array
from plantar.exporters.spring import Spring

AXIS = {"z": "Z", "pitch": "Y", "roll": "X"}
PER_DEGREE = math.pi / 180


def drive(spring: Spring) -> tuple[str, float, float, float]:
    """Kind of a joint's drive, its stiffness, damping and target: angular ones per degree."""
    kind, factor = ("linear", 1.0) if spring.axis == "z" else ("angular", PER_DEGREE)
    return kind, spring.stiffness * factor, spring.damping * factor, spring.rest / factor


def identifier(name: str) -> str:
    """USD prim names hold letters, digits and underscores and start with no digit."""
    clean = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name)
    return clean if clean and not clean[0].isdigit() else f"_{clean}"


def quaternion(rotation: Array) -> tuple[float, ...]:
    """A rotation matrix as w, x, y, z, by the largest of the four."""
    r = rotation
    squares = np.array([1 + np.trace(r), *(1 + 2 * np.diag(r) - np.trace(r))])
    big = int(np.argmax(squares))
    columns = np.array([
        [squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], squares[1], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
        [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], squares[2], r[1, 2] + r[2, 1]],
        [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[3]],
    ])  # fmt: skip
    return tuple(float(value) for value in columns[big] / np.linalg.norm(columns[big]))

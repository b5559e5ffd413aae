"""A robot in memory: bodies joined by one-dof joints, from which URDF and MJCF are written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from plantar.conventions import Array


@dataclass(frozen=True)
class Shape:
    """Something to look at: a box of full sizes `size` [m], (3,), centred at `xyz` in the body's frame."""

    xyz: Array
    size: Array


@dataclass(frozen=True)
class Body:
    """A rigid body and the joint that carries it.

    The body's frame is its joint's frame; `xyz` and `rotation` place it in the parent at zero position. The
    inertia (3, 3) [kg·m²] is about the centre of mass `com` [m], in the body's axes. The root (parent -1) has
    no joint. Limits are position [rad or m], velocity and effort [N·m or N].
    """

    name: str
    parent: int
    joint: str = ""
    kind: Literal["revolute", "prismatic"] = "revolute"
    axis: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    xyz: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))
    lower: float = -np.inf
    upper: float = np.inf
    velocity: float = np.inf
    effort: float = np.inf
    mass: float = 0.0
    com: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True)
class Description:
    """Bodies in an order where parents come first; `bodies[0]` is the root link."""

    name: str
    bodies: tuple[Body, ...]

    @property
    def joint_names(self) -> tuple[str, ...]:
        return tuple(body.joint for body in self.bodies[1:])

    def placements(self, positions: Array) -> list[tuple[Array, Array]]:
        """Rotation and origin of every body in the root's frame, for joint positions in `joint_names` order."""
        found: list[tuple[Array, Array]] = [(np.eye(3), np.zeros(3))]
        for body, position in zip(self.bodies[1:], positions, strict=True):
            rotation, origin = found[body.parent]
            origin = origin + rotation @ body.xyz
            rotation = rotation @ body.rotation
            if body.kind == "revolute":
                rotation = rotation @ rotation_about(body.axis, float(position))
            else:
                origin = origin + rotation @ body.axis * position
            found.append((rotation, origin))
        return found

    def mass_properties(self, positions: Array) -> tuple[float, Array, Array]:
        """Mass [kg], centre of mass (3,) in the root's frame and inertia (3, 3) about it."""
        placements = self.placements(positions)
        masses = np.array([body.mass for body in self.bodies])
        centres = np.array([r @ b.com + p for (r, p), b in zip(placements, self.bodies, strict=True)])
        centre = masses @ centres / masses.sum()
        inertia = np.zeros((3, 3))
        for (rotation, _), body, mass, arm in zip(
            placements, self.bodies, masses, centres - centre, strict=True
        ):
            inertia += rotation @ body.inertia @ rotation.T
            inertia += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return float(masses.sum()), centre, inertia


def rotation_about(axis: Array, angle: float) -> Array:
    """Rotation by `angle` [rad] about the unit vector `axis`."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def box_inertia(mass: float, size: Array) -> Array:
    """Inertia of a homogeneous box about its centre, (3, 3) [kg·m²]."""
    squares = np.square(size)
    return np.diag(mass / 12 * (squares.sum() - squares))

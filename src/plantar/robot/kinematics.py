"""The robot's tree of joints as plain arrays, as the native core takes it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.errors import RobotError

_REVOLUTE = {"RX", "RY", "RZ", "RUBX", "RUBY", "RUBZ", "RevoluteUnaligned", "RevoluteUnboundedUnaligned"}
_PRISMATIC = {"PX", "PY", "PZ", "PrismaticUnaligned"}
_WHY_NOT = {
    "Mimic": "it mimics another joint; write it as a joint of its own",
    "Spherical": "write it as three revolute joints",
    "SphericalZYX": "write it as three revolute joints",
    "Planar": "write it as two prismatic joints and a revolute one",
    "Translation": "write it as three prismatic joints",
    "Composite": "write its parts as joints of their own",
    "FreeFlyer": "a free-flyer can only stand above the root link",
}


@dataclass(frozen=True)
class KinematicTree:
    """Joints in Pinocchio's order, each with one coordinate: an angle [rad] or a displacement [m].

    names: of the joints; parents: index of the joint that carries it, -1 for the root link, (n,);
    slides: prismatic, (n,) bool; axes: unit axis in the joint's frame, (n, 3);
    rotations, translations: the joint's frame before it moves, in its parent's, (n, 3, 3), (n, 3) [m];
    floating: the model has a free-flyer above its root link (itself not among the joints).
    """

    names: tuple[str, ...]
    parents: np.ndarray[tuple[int], np.dtype[np.int64]]
    slides: np.ndarray[tuple[int], np.dtype[np.bool_]]
    axes: Array
    rotations: Array
    translations: Array
    floating: bool
    _q_index: np.ndarray[tuple[int], np.dtype[np.int64]]
    _unbounded: np.ndarray[tuple[int], np.dtype[np.bool_]]
    nq: int
    nv: int

    @classmethod
    def from_model(cls, model: pin.Model) -> KinematicTree:
        """Flatten a Pinocchio model, with or without a free-flyer at its root.

        Raises RobotError naming the joint that is neither revolute, continuous nor prismatic.
        """
        kinds = [joint.shortname().removeprefix("JointModel") for joint in model.joints]
        floating = len(kinds) > 1 and kinds[1] == "FreeFlyer"
        first = 2 if floating else 1
        joints = range(first, model.njoints)
        for index in joints:
            if kinds[index] not in _REVOLUTE | _PRISMATIC:
                reason = _WHY_NOT.get(kinds[index], "valid: revolute, continuous, prismatic")
                raise RobotError(f"joint '{model.names[index]}' is of type {kinds[index]}: {reason}")
        if floating and any(model.parents[index] == 0 for index in joints):
            raise RobotError("a second tree stands beside the free-flyer (valid: one root link)")
        slides = np.array([kinds[index] in _PRISMATIC for index in joints], dtype=bool)
        subspaces = [_subspace(model, index) for index in joints]
        axes = [s[:3] if slide else s[3:] for s, slide in zip(subspaces, slides, strict=True)]
        placements = [model.jointPlacements[index] for index in joints]
        return cls(
            names=tuple(model.names[index] for index in joints),
            parents=np.array([model.parents[index] - first for index in joints], dtype=np.int64),
            slides=slides,
            axes=np.array(axes).reshape(-1, 3),
            rotations=np.array([placement.rotation for placement in placements]).reshape(-1, 3, 3),
            translations=np.array([placement.translation for placement in placements]).reshape(-1, 3),
            floating=floating,
            _q_index=np.array([model.joints[index].idx_q for index in joints], dtype=np.int64),
            _unbounded=np.array([model.joints[index].nq == 2 for index in joints], dtype=bool),
            nq=int(model.nq),
            nv=int(model.nv),
        )

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def ancestors(self) -> tuple[tuple[int, ...], ...]:
        """For each joint, itself and the joints above it, from itself to the root."""
        found: list[tuple[int, ...]] = []
        for index, parent in enumerate(self.parents):
            found.append((index, *(found[parent] if parent >= 0 else ())))
        return tuple(found)

    def joint_positions(self, q: Array) -> Array:
        """One coordinate a joint, (N, n), from Pinocchio's configurations, (N, nq).

        There a continuous joint is its cosine and sine, and a free-flyer stands in front.
        """
        if not self._unbounded.any():
            return q[:, 7:] if self.floating else q
        positions = q[:, self._q_index]
        turning = self._q_index[self._unbounded]
        positions[:, self._unbounded] = np.arctan2(q[:, turning + 1], q[:, turning])
        return positions

    def poses(self, positions: Array) -> tuple[Array, Array]:
        """Rotations (1 + n_joints, N, 3, 3) and places (1 + n_joints, N, 3) [m] in the root link, of that link itself
        and then of the joints' frames: a Pinocchio model's joint has its own index there.

        positions: of the joints, (N, n_joints).
        """
        rotations = np.tile(np.eye(3), (1 + len(self), len(positions), 1, 1))
        places = np.zeros((1 + len(self), len(positions), 3))
        for joint, parent in enumerate(self.parents):
            rotations[1 + joint], places[1 + joint] = self._frame(
                joint, rotations[1 + parent], places[1 + parent], positions
            )
        return rotations, places

    def _frame(self, joint: int, rotation: Array, place: Array, positions: Array) -> tuple[Array, Array]:
        """A joint's frame, given its parent's: rotation (N, 3, 3) and place (N, 3) in the root link."""
        place = place + rotation @ self.translations[joint]
        rotation = rotation @ self.rotations[joint]
        if self.slides[joint]:
            return rotation, place + rotation @ self.axes[joint] * positions[:, joint, None]
        return rotation @ rotations_about(self.axes[joint], positions[:, joint]), place

    def path(self, start: int, end: int) -> list[tuple[int, int]]:
        """Joints passed on the way from link `start` to link `end` (-1: the root link) as (joint, sign).

        Sign -1: passed from child to parent; +1: from parent to child.
        """
        up = self.ancestors[start] if start >= 0 else ()
        down = self.ancestors[end] if end >= 0 else ()
        shared = set(up) & set(down)
        return [(j, -1) for j in up if j not in shared] + [(j, +1) for j in reversed(down) if j not in shared]


def centre_of_mass(model: pin.Model, rotations: Array, places: Array) -> Array:
    """Of all bodies in the root link, (N, 3) [m], at the `KinematicTree.poses` of a model with its root fixed."""
    bodies = list(model.inertias)
    moments = sum(
        body.mass * (rotation @ body.lever + place)
        for body, rotation, place in zip(bodies, rotations, places, strict=True)
    )
    return np.asarray(moments / max(sum(body.mass for body in bodies), 1e-9))


def rotations_about(axis: Array, angle: Array) -> Array:
    """Rotations (N, 3, 3) by `angle` (N,) [rad] about one unit axis (3,) (Rodrigues)."""
    k = pin.skew(axis)
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.asarray(np.eye(3) + s * k + (1 - c) * (k @ k))


def packed_frame(placement: pin.SE3) -> Array:
    """A frame as the core takes it: rotation, row-major, then origin, (12,)."""
    return np.concatenate([placement.rotation.ravel(), placement.translation])


def _subspace(model: pin.Model, index: int) -> Array:
    """The joint's motion subspace in its own frame, linear then angular, (6,)."""
    joint = model.joints[index]
    data = joint.createData()
    joint.calc(data, pin.neutral(model))
    return np.asarray(data.S, dtype=float).reshape(6)

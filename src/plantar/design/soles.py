"""The edges of soles, which no centre of pressure may come near."""

from __future__ import annotations

from typing import Final

import numpy as np

from plantar.contact.polygon import convex_hull
from plantar.conventions import Array, Mask
from plantar.design.legs import Legs

EDGE: Final = 0.007  # m, of the centre of pressure from each sole's border; `identify feet` drops 5 mm
SMALLER_EDGE: Final = 0.2  # of a sole's half width at most: small feet need some room to be excited


def ends(normals: Array) -> Mask:
    """Which edges of a sole, by their normals (n, 2), are its ends, and not its sides."""
    return np.asarray(np.abs(normals[:, 0]) > np.abs(normals[:, 1]))


def margin_kept(polygon: Array) -> float:
    """Distance [m] from a sole's border that the centre of pressure keeps."""
    return float(min(EDGE, SMALLER_EDGE * np.ptp(polygon, axis=0).min() / 2))


def outward(normals: Array, torque: Array) -> Array:
    """Torques of a bush about pitch and roll (..., 2, N) towards each edge (..., n, N): the centre of pressure is
    (-torque pitch, torque roll)/load from below the bush."""
    return np.asarray(-np.einsum("ek,...kn->...en", normals, torque * [[-1.0], [1.0]]))


def edges(legs: Legs, foot: str) -> tuple[Array, Array]:
    """Inward normals (n, 2) of a sole's edges in the world's axes, and the room (n,) [m] of a centre of pressure
    below the bush to each, less the margin."""
    entry = legs.body.robot.feet[foot]
    sole = legs.start.soles[foot]
    bush = legs.rest[2][foot].translation
    corners = np.array([sole.act(np.array([*corner, 0.0]))[:2] for corner in entry.sole.polygon]) - bush[:2]
    corners = convex_hull(corners)
    along = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    return normals, -np.sum(normals * corners, axis=1) - margin_kept(corners)

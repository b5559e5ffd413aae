"""Points of collision shapes: corners of boxes, vertices of meshes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from plantar.conventions import Array

MESH_LIMIT = 256 * 2**20  # bytes of one mesh: millions of triangles


def box_corners(size: Array) -> Array:
    """Corners of a box of full edge lengths `size`, (8, 3), about its centre."""
    signs = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, -1).T
    corners: Array = signs * np.asarray(size)
    return corners


def solid_corners(kind: str, read: Callable[[str, int], Array]) -> Array | None:
    """Corners of the box around a shape, (8, 3), about its centre; None for what is no solid of URDF or SDFormat.

    kind: box, cylinder, capsule or sphere. read: the numbers of one of its sizes, by name and count.
    """
    if kind == "box":
        return box_corners(read("size", 3))
    if kind == "sphere":
        return box_corners(np.full(3, 2 * read("radius", 1)[0]))
    if kind in ("cylinder", "capsule"):
        radius, length = read("radius", 1)[0], read("length", 1)[0]
        return box_corners(np.array([2 * radius, 2 * radius, length + 2 * radius * (kind == "capsule")]))
    return None


def mesh_points(path: Path | None, scale: Array) -> Array | None:
    """A mesh's vertices (n, 3), or None where no such mesh can be read."""
    if path is None or not path.is_file() or path.stat().st_size > MESH_LIMIT:
        return None
    import coal  # type: ignore[import-untyped]

    try:
        mesh = coal.MeshLoader().load(str(path), np.asarray(scale, float))
        points = np.array(mesh.vertices(), dtype=np.float64)
    except (RuntimeError, ValueError):
        return None
    return points if points.size else None

"""Points of collision shapes: corners of boxes, vertices of meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from plantar.conventions import Array

MESH_LIMIT = 256 * 2**20  # bytes


def box_corners(size: Array) -> Array:
    """Corners of a box of full edge lengths `size`, (8, 3), about its centre."""
    signs = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, -1).T
    corners: Array = signs * np.asarray(size)
    return corners


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

"""Convex polygons in the plane: hull, and how far inside a point lies."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array


def convex_hull(points: Array) -> Array:
    """Corners of the convex hull of (n, 2) points, counter-clockwise; the points themselves when they span no area."""
    from scipy.spatial import ConvexHull, QhullError  # costs start-up

    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except (QhullError, ValueError):
        return np.asarray(points)


def inside_distance(points: Array, polygon: Array) -> Array:
    """Signed distance [m] of (N, 2) points to the border of a convex polygon (n, 2): positive inside.

    Outside near a corner it is the distance to the nearest edge's line, which is never more than the true distance.
    """
    corners = convex_hull(polygon)
    edges = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1, keepdims=True)
    depth = points @ normals.T - np.sum(corners * normals, axis=1)
    return np.asarray(depth.min(axis=1))

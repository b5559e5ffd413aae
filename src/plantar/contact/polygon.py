"""Convex polygons in the plane: hull, how far inside a point lies, how far two are apart."""

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


def edge_distances(points: Array, polygon: Array) -> Array:
    """Signed distances [m] of (N, 2) points to each edge's line of a convex polygon (n, 2): (N, n), positive inside.

    The edges are those of `convex_hull`, each from one corner to the next.
    """
    corners = convex_hull(polygon)
    edges = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1, keepdims=True)
    return np.asarray(points @ normals.T - np.sum(corners * normals, axis=1))


def inside_distance(points: Array, polygon: Array) -> Array:
    """Signed distance [m] of (N, 2) points to the border of a convex polygon (n, 2): positive inside.

    Outside near a corner it is the distance to the nearest edge's line, which is never more than the true distance.
    """
    return np.asarray(edge_distances(points, polygon).min(axis=1))


def separation(one: Array, other: Array) -> float:
    """Width [m] of the straight gap between two convex polygons (n, 2), (m, 2); negative: how far they overlap.

    Two convex polygons are apart where an edge of either has all of the other beyond it.
    """
    return max(float((-edge_distances(b, a)).min(axis=0).max()) for a, b in ((one, other), (other, one)))

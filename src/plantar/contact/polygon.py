"""Convex polygons in the plane: hull, how far inside a point lies, how far two are apart."""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROUNDING, Array


def convex_hull(points: Array) -> Array:
    """Corners of the convex hull of (n, 2) points, counter-clockwise; the points themselves when they span no area."""
    if len(points) < 3 or not np.isfinite(points).all():
        return points
    least = ROUNDING * float(np.ptp(points, axis=0).max()) ** 2
    ordered = points[np.lexsort(points.T[::-1])].tolist()
    corners: list[list[float]] = []
    for side in (
        ordered,
        ordered[::-1],
    ):  # the lower chain of corners, then the upper one (A. M. Andrew, 1979)
        first = len(corners)
        for x, y in side:
            while len(corners) >= first + 2:
                (ax, ay), (bx, by) = corners[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > least:
                    break
                corners.pop()
            corners.append([x, y])
        corners.pop()
    return np.array(corners) if len(corners) > 2 else points


def edge_distances(points: Array, polygon: Array) -> Array:
    """Signed distances [m] of (N, 2) points to each edge's line of a convex polygon (n, 2): (N, n), positive inside.

    The edges are those of `convex_hull`, each from one corner to the next.
    """
    normals = edge_normals(polygon)
    return np.asarray(points @ normals.T - np.sum(convex_hull(polygon) * normals, axis=1))


def edge_normals(polygon: Array) -> Array:
    """Unit normals of those edges, (n, 2), that point inwards."""
    corners = convex_hull(polygon)
    edges = np.roll(corners, -1, axis=0) - corners
    return np.asarray(
        np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1, keepdims=True)
    )


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

"""Hulls of points in the plane against a library's."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from plantar.contact.polygon import convex_hull


def test_corners_are_those_of_a_library_counter_clockwise() -> None:
    random = np.random.default_rng(0)
    for count in (3, 4, 10, 200):
        points = random.normal(size=(count, 2))
        corners = convex_hull(points)
        assert {tuple(corner) for corner in corners} == {
            tuple(p) for p in points[ConvexHull(points).vertices]
        }
        edges = np.roll(corners, -1, axis=0) - corners
        after = np.roll(edges, -1, axis=0)
        assert (edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0] > 0).all()


def test_points_on_an_edge_are_no_corners() -> None:
    square = np.array([[0, 0], [0.1, 0], [0.2, 0], [0.2, 0.2], [0, 0.2], [0, 0.1], [0.2, 0.2]])
    assert len(convex_hull(square)) == 4


def test_points_on_a_line_stay_as_they_are() -> None:
    line = np.linspace(0, 1, 9)[:, None] * [1.0, 0.3]
    assert convex_hull(line) is line

"""Hulls of points in the plane against a library's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from plantar.contact.polygon import convex_hull, edge_distances, inside_distance, separation


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


def test_distances_to_the_edges_of_a_rectangle_by_hand() -> None:
    """A rectangle of 0.2 m by 0.1 m, turned by 30 degrees, its corners in either order: positive is inside."""
    turn = np.array([[np.cos(np.pi / 6), -np.sin(np.pi / 6)], [np.sin(np.pi / 6), np.cos(np.pi / 6)]])
    corners = np.array([[0.0, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.1]])
    points = np.array([[0.05, 0.03], [0.19, 0.05], [0.23, 0.05], [0.1, -0.02], [0.24, 0.13]])
    for outline in (corners, corners[::-1]):
        distances = np.sort(edge_distances(points @ turn.T, outline @ turn.T), axis=1)
        for (x, y), found in zip(points, distances, strict=True):
            np.testing.assert_allclose(found, np.sort([x, 0.2 - x, y, 0.1 - y]), atol=1e-12)
        nearest = inside_distance(points @ turn.T, outline @ turn.T)
        np.testing.assert_allclose(nearest, [0.03, 0.01, -0.03, -0.02, -0.04], atol=1e-12)


def test_the_gap_between_two_squares_and_how_far_they_overlap() -> None:
    square = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]])
    for shift, width in ((0.13, 0.03), (0.1, 0.0), (0.08, -0.02)):
        for other in (square + [shift, 0.01], square - [0.01, shift]):
            assert separation(square, other) == pytest.approx(width, abs=1e-12)
            assert separation(other, square) == pytest.approx(width, abs=1e-12)
    tilted = np.array([[0.15, 0.05], [0.2, 0.0], [0.25, 0.05], [0.2, 0.1]])
    assert separation(square, tilted) == pytest.approx(0.05), "an edge of the square alone parts them"


def test_points_that_span_nothing_or_are_not_known_stay_as_they_are() -> None:
    for points in (
        np.zeros((0, 2)),
        np.array([[0.0, 0.0], [0.1, 0.2]]),
        np.array([[0, 0], [1, 0], [np.nan, 1], [0, 1.0]]),
    ):
        assert convex_hull(points) is points

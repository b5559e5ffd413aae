"""Small parts of estimation, each by a case that is solved by hand."""

from __future__ import annotations

import pytest

from plantar.estimation.delays.lag_search import _combinations


@pytest.mark.parametrize(
    ("feet", "count", "places"),
    [
        (1, 3, [[0], [1], [2]]),
        (2, 2, [[0, 0], [0, 1], [1, 0], [1, 1]]),
        (3, 2, [[0, 0, 0], [1, 1, 1]]),  # one lag for all: the grid would be too large
        (4, 5, [[k] * 4 for k in range(5)]),
    ],
)
def test_places_of_lags(feet: int, count: int, places: list[list[int]]) -> None:
    assert _combinations(feet, count).tolist() == places

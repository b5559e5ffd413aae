"""Small parts of estimation, each by a case that is solved by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from plantar.estimation.blocks import Block, LinearFit, StanceRows
from plantar.estimation.delays.lag_search import _combinations
from plantar.estimation.stance_problem import design


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


NUMBERS = np.array([3, 3, 0, 0, 3, 7])


def block_of(**changes: Any) -> Block:
    rows = np.arange(6.0)
    fields = {
        "regressor": np.column_stack([rows, rows**2]), "response": 10 * rows, "nuisance": np.eye(6)[:, :2],
        "stances": StanceRows(NUMBERS, np.array([1.0, 2.0, 0.5, 0.5, 1.0, 4.0])),
        "common_nuisance": -np.column_stack([rows, rows, rows**3]),
    }  # fmt: skip
    return Block("walk", period=0.02, **(fields | changes))


def test_a_block_has_as_many_rows_as_its_weights_say_and_lasts_as_all_of_them() -> None:
    assert (block_of().rows, block_of().duration) == (9.0, pytest.approx(0.12))
    assert block_of(stances=None).rows == 6.0


def test_rows_of_a_stance_stay_together_and_a_part_has_its_own() -> None:
    stances = block_of().stances
    assert stances is not None
    assert [rows.tolist() for rows in stances.split()] == [[2, 3], [0, 1, 4], [5]]
    part = block_of().part(np.array([0, 3, 5]))
    assert part.stances is not None
    assert (part.stances.number.tolist(), part.stances.weight.tolist()) == ([3, 0, 7], [1.0, 0.5, 4.0])
    assert part.response.tolist() == [0.0, 30.0, 50.0]
    assert part.regressor[:, 1].tolist() == [0.0, 9.0, 25.0]
    assert part.common_nuisance is not None
    assert part.common_nuisance[:, 2].tolist() == [0.0, -27.0, -125.0]
    assert part.nuisance is not None
    np.testing.assert_allclose(np.abs(part.nuisance), [[1.0], [0.0], [0.0]], atol=1e-12)
    bare = block_of(stances=None, common_nuisance=None, nuisance=None).part(np.array([1]))
    assert (bare.stances, bare.common_nuisance, bare.nuisance) == (None, None, None)
    assert StanceRows(NUMBERS[:0], np.zeros(0)).split() == []


def test_columns_to_forget_come_beside_those_there() -> None:
    columns = np.column_stack([np.eye(6)[:, 0] + np.eye(6)[:, 3]])
    both = block_of().with_nuisance(columns).nuisance
    assert both is not None
    np.testing.assert_array_equal(both[:, :2], np.eye(6)[:, :2])
    np.testing.assert_allclose(np.abs(both[:, 2]), np.eye(6)[:, 3], atol=1e-12)
    alone = block_of(nuisance=None).with_nuisance(columns).nuisance
    assert alone is not None
    np.testing.assert_allclose(
        np.abs(alone[:, 0]), (np.eye(6)[:, 0] + np.eye(6)[:, 3]) / np.sqrt(2), atol=1e-12
    )


@pytest.mark.parametrize("widest", [2, 3])
def test_the_design_holds_common_columns_its_own_up_to_the_widest_and_ones(widest: int) -> None:
    found = design(block_of(), widest)
    block = block_of()
    expected = [
        block.regressor,
        block.common_nuisance,
        np.eye(6)[:, :2],
        np.zeros((6, widest - 2)),
        np.ones((6, 1)),
    ]
    np.testing.assert_array_equal(found, np.hstack(expected))  # type: ignore[arg-type]
    without = design(block_of(nuisance=None, common_nuisance=None), widest)
    np.testing.assert_array_equal(
        without, np.hstack([block.regressor, np.zeros((6, widest)), np.ones((6, 1))])
    )


@pytest.mark.parametrize("shared", [False, True])
def test_a_fit_tells_each_offset_with_its_own_deviation(shared: bool) -> None:
    deviations = np.array([1.0, 2.0, 7.0]) if shared else np.array([1.0, 2.0, 3.0, 4.0])
    fit = LinearFit(
        values=np.array([5.0, 6.0]), offsets=dict.fromkeys(("a", "b"), 0.5), covariance=np.diag(deviations**2),
        white_covariance=np.diag(deviations**2) / 100, freedom=np.ones(4), rank=3, condition_number=1e6,
        residuals={"a": np.array([1.0, 2.0]), "b": np.array([3.0])}, shared_offset=shared,
    )  # fmt: skip
    assert [fit.offset_std(label) for label in "ab"] == ([7.0, 7.0] if shared else [3.0, 4.0])
    assert (fit.std.tolist(), fit.white_std.tolist()) == ([1.0, 2.0], [0.1, 0.2])
    assert fit.squares == 14.0
    assert not fit.singular
    assert replace(fit, condition_number=1.1e6).singular
    assert replace(fit, condition_number=np.nan).singular
    assert fit.predict(np.array([[1.0, 2.0], [0.0, 1.0]]), 0.25).tolist() == [17.25, 6.25]

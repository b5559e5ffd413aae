"""Initial states that a grid chooses: of each run the best, whichever offset suits its recording then."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bush_data_sets import Rubber, campaign
from plantar.model_selection.data_sets import prepare_data_sets
from plantar.model_selection.grid import Fits, Pieces, fit_pieces, held_out_squares
from plantar.models import Elastoplastic

RUNS, CANDIDATES, STATES, ROWS = 4, 8, 3, 40
VALUES = np.array([1.0, -2.0])


def problem(better: np.ndarray, shift: float) -> np.ndarray:
    """Rows (runs, candidates, states, rows, 4) of two columns, 1 and the response: in the `better` state (runs,)
    it follows the columns closely, in the others it does not; each state has another constant, `shift` apart."""
    random = np.random.default_rng(0)
    rows = random.normal(size=(RUNS, CANDIDATES, STATES, ROWS, 4))
    noise = np.where(np.arange(STATES) == better[:, None], 0.05, 0.6)[:, None, :, None]
    constants = shift * (np.arange(STATES) - 1)[:, None]
    rows[..., 3] = rows[..., :2] @ VALUES + noise * rows[..., 3] + constants + 5.0
    rows[..., 2] = 1.0
    return rows


def fitted(rows: np.ndarray, data_set: np.ndarray, begin: np.ndarray | None = None) -> Fits:
    grams = np.einsum("rgcni,rgcnj->rgcij", rows, rows)
    pieces: Any = SimpleNamespace(grams=grams, data_set=data_set, run=np.arange(RUNS), size=len(VALUES))
    return fit_pieces(pieces, np.ones(RUNS, dtype=bool), begin=begin, shared_offset=False)


@pytest.mark.parametrize("better", [[0, 2, 1, 0], [2, 2, 2, 2]])
def test_a_run_alone_takes_the_state_that_fits_whatever_its_constant_is(better: list[int]) -> None:
    """Its recording's offset follows; the state from which the search begins has no say."""
    found = fitted(problem(np.array(better), 3.0), np.arange(RUNS))
    assert np.array_equal(found.initial_states, np.tile(np.array(better)[:, None], CANDIDATES))
    assert found.offsets == pytest.approx(
        np.tile(5.0 + 3.0 * (np.array(better) - 1), (CANDIDATES, 1)), abs=0.05
    )


def test_each_candidate_is_fitted_as_if_it_were_alone() -> None:
    """Whether others come to rest before it, or after."""
    better, data_set = np.array([0, 2, 1, 0]), np.array([0, 0, 1, 1])
    rows, begin = problem(better, 0.0), np.repeat(better[:, None], CANDIDATES, axis=1)
    begin[:, 1::2] = 1  # half of them begin where they end, the others have to move
    found = fitted(rows, data_set, begin)
    for place in range(CANDIDATES):
        alone = fitted(rows[:, [place]], data_set, begin[:, [place]])
        assert np.array_equal(found.initial_states[:, place], alone.initial_states[:, 0])
        assert found.values[place] == pytest.approx(alone.values[0], rel=1e-12)
        assert found.squares[place] == pytest.approx(alone.squares[0], rel=1e-9)
    assert np.any(found.initial_states != begin, axis=0).tolist() == [False, True] * (CANDIDATES // 2)


def test_the_search_begins_where_it_is_told() -> None:
    """From the best states of all nothing is left to move: one candidate's begins are its ends."""
    rows, data_set = problem(np.array([2, 2, 0, 0]), 0.0), np.array([0, 0, 1, 1])
    ends = fitted(rows, data_set)
    again = fitted(rows, data_set, ends.initial_states)
    assert np.array_equal(again.initial_states, ends.initial_states)
    np.testing.assert_allclose(again.squares, ends.squares, rtol=1e-12)


def test_runs_of_one_recording_share_its_offset() -> None:
    """Where the better fits of both runs would need offsets that are far apart, one has to give way."""
    better = np.array([0, 2, 1, 1])
    found = fitted(problem(better, 3.0), np.array([0, 0, 1, 1]))
    first, second = found.initial_states[0], found.initial_states[1]
    assert (first == second).all()
    assert (found.initial_states[2:] == 1).all()


def test_values_offsets_and_squares_are_those_of_the_chosen_rows() -> None:
    rows, data_set = problem(np.array([1, 1, 0, 0]), 0.0), np.array([0, 0, 1, 1])
    found = fitted(rows, data_set)
    for candidate in range(CANDIDATES):
        chosen = np.vstack(
            [rows[run, candidate, found.initial_states[run, candidate]] for run in range(RUNS)]
        )
        offsets = np.repeat(np.eye(2)[data_set], ROWS, axis=0)
        design = np.hstack([chosen[:, :2], offsets])
        solution = np.linalg.lstsq(design, chosen[:, 3], rcond=None)[0]
        left = float(np.sum((chosen[:, 3] - design @ solution) ** 2))
        told = [*found.values[candidate], *found.offsets[candidate], found.squares[candidate]]
        assert told == pytest.approx([*solution, left], rel=1e-5)


def test_states_are_tried_over_all_their_range_or_closely_about_known_ones() -> None:
    model, prepared = Elastoplastic(), prepare_data_sets(campaign(0, Rubber())[:1], 5.0, drift=True)
    folds, shape = [np.zeros(int(each.used.sum()), dtype=np.intp) for each in prepared], np.array([[0.01]])
    runs = len(prepared[0].motion.runs)
    (everywhere,) = Pieces.of(model, prepared, folds, shape).initial_states
    (nearby,) = Pieces.of(model, prepared, folds, shape, [np.full(runs, 0.9)]).initial_states
    for run in range(runs):
        assert everywhere[:, run] == pytest.approx([-0.9, -0.45, 0.0, 0.45, 0.9])
        assert nearby[:, run] == pytest.approx([0.72, 0.81, 0.9, 0.99, 1.0])


@pytest.mark.parametrize("fades", [True, False])
def test_a_held_out_run_begins_in_its_best_state_where_the_first_one_fades(fades: bool) -> None:
    """Else it begins where the fit says: of a law without memory states are no choice."""
    grams = np.zeros((2, 1, STATES, 3, 3))
    grams[0, 0, :, 2, 2], grams[1, 0, :, 2, 2] = [5.0, 2.0, 3.0], [1.0, 8.0, 9.0]  # of the response alone
    model = SimpleNamespace(fading_memory=fades)
    pieces: Any = SimpleNamespace(grams=grams, data_set=np.array([0, 0]), model=model)
    fits = Fits(np.zeros((1, 1)), np.zeros((1, 1)), np.array([[0], [2]]), np.zeros(1))
    found = held_out_squares(pieces, fits, np.array([True, True]), 0, whole=False)
    assert found.tolist() == ([2.0, 1.0] if fades else [5.0, 9.0])

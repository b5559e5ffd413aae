"""The state in which an unseen recording begins, found from its torque and the zero of its first second."""

from __future__ import annotations

import numpy as np
import pytest

from bush_data_sets import PERIOD, sway
from plantar.model_selection.initial_state import TRIED, initial_states_of
from plantar.models import BushMotion, Elastoplastic
from plantar.signals.filters import low_pass

VALUES, SHAPE, CUTOFF = np.array([434.0, 15.89, 5.0]), np.array([0.01]), 8.0
FIRST = 200  # samples that show the offset


def filtered(
    path: np.ndarray, states: list[float], offset: float, cutoff: float = CUTOFF
) -> tuple[BushMotion, np.ndarray]:
    """A motion and the torque of a bush whose element starts in `states`, one a run, both filtered."""
    motion = BushMotion(path, np.gradient(path, PERIOD), PERIOD)
    torque = Elastoplastic().columns(motion, SHAPE, np.array(states)) @ VALUES + offset
    smooth = BushMotion(
        low_pass(motion.deflection, PERIOD, cutoff), low_pass(motion.rate, PERIOD, cutoff), PERIOD
    )
    return smooth, low_pass(torque, PERIOD, cutoff)


def found(motion: BushMotion, torque: np.ndarray, first: np.ndarray, cutoff: float = CUTOFF) -> np.ndarray:
    used = np.isfinite(torque)
    return initial_states_of(Elastoplastic(), VALUES, SHAPE, motion, torque, used, first, cutoff)


@pytest.mark.parametrize("state", [-0.7, 0.0, 0.9])
@pytest.mark.parametrize("offset", [0.0, 3.0])
def test_a_loaded_element_is_told_from_an_offset(state: float, offset: float) -> None:
    motion, torque = filtered(sway(np.random.default_rng(4), 0.08, 0.5), [state], offset)
    first = np.arange(len(torque)) < FIRST
    assert found(motion, torque, first) == pytest.approx([state], abs=1.01 * (TRIED[1] - TRIED[0]))


def test_each_run_has_a_state_of_its_own_and_all_one_offset() -> None:
    path = sway(np.random.default_rng(5), 0.08, 0.5, 48.0)
    path[len(path) // 2 : len(path) // 2 + 20] = np.nan
    motion, torque = filtered(path, [0.6, -0.8], 2.0)
    first = np.arange(len(torque)) < FIRST
    assert found(motion, torque, first) == pytest.approx([0.6, -0.8], abs=0.15)


def test_what_comes_after_the_state_has_faded_does_not_tell_of_it() -> None:
    motion, torque = filtered(sway(np.random.default_rng(4), 0.08, 0.5), [0.5], 1.0)
    drifting = torque + np.linspace(0.0, 4.0, len(torque)) * (np.arange(len(torque)) > len(torque) // 3)
    first = np.arange(len(torque)) < FIRST
    assert found(motion, drifting, first) == pytest.approx([0.5], abs=1.01 * (TRIED[1] - TRIED[0]))


def test_without_samples_that_show_it_the_offset_is_taken_as_zero() -> None:
    motion, torque = filtered(sway(np.random.default_rng(6), 0.08, 0.5), [0.5], 0.0)
    assert found(motion, torque, np.zeros(len(torque), dtype=bool)) == pytest.approx([0.5], abs=0.15)


def test_a_motion_without_a_used_sample_begins_in_the_middle() -> None:
    motion, torque = filtered(sway(np.random.default_rng(7), 0.08, 0.5), [0.5], 0.0)
    nothing = np.zeros(len(torque), dtype=bool)
    states = initial_states_of(Elastoplastic(), VALUES, SHAPE, motion, torque, nothing, nothing, CUTOFF)
    np.testing.assert_array_equal(states, [0.0])


def test_the_elements_memory_passes_the_filter_that_the_torque_has_passed() -> None:
    """At 1 Hz, near the sway's own frequencies: unfiltered, it would look like a smaller state."""
    motion, torque = filtered(sway(np.random.default_rng(4), 0.08, 0.5), [-0.7], 3.0, 1.0)
    first = np.arange(len(torque)) < FIRST
    assert found(motion, torque, first, 1.0) == pytest.approx([-0.7], abs=1.01 * (TRIED[1] - TRIED[0]))

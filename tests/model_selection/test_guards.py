"""Small parts of the choice of a model, each by a case that is solved by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.model_selection.grid import _best_states
from plantar.model_selection.model_fit import where_it_rested
from plantar.model_selection.selection import _adds, _refusal
from plantar.models import Elastoplastic, HardeningElastoplastic, KelvinVoigt


def fit_of(model: Any, values: list[float], doubts: tuple[str, ...] = (), variance: float = 1.0) -> Any:
    covariance = np.diag([1e-6, 1e-6, *[variance] * (len(values) - 2)])
    return SimpleNamespace(model=model, values=np.array(values), doubts=doubts, covariance=covariance)


@pytest.mark.parametrize(
    ("fit", "why"),
    [
        (fit_of(KelvinVoigt(), [-1.0, 1.0], ("doubt",)), None),  # nothing is left to take in its place
        (fit_of(Elastoplastic(), [400.0, 20.0, -1.0], ("doubt",)), "is not passive"),
        (fit_of(Elastoplastic(), [400.0, 20.0, 4.0], ("one", "other")), "one; other"),
        (fit_of(Elastoplastic(), [400.0, 20.0, 4.0]), None),
    ],
)
def test_why_a_model_is_refused(fit: Any, why: str | None) -> None:
    assert _refusal(fit) == why


@pytest.mark.parametrize(("hardening", "variance", "adds"), [
    (7000.0, 1e6, True), (-7000.0, 1e6, True), (700.0, 1e6, False), (-700.0, 1e6, False),
])  # fmt: skip
def test_what_is_added_is_told_from_zero_on_either_side(
    hardening: float, variance: float, adds: bool
) -> None:
    simpler = fit_of(Elastoplastic(), [400.0, 20.0, 4.0])
    assert (
        _adds(fit_of(HardeningElastoplastic(), [400.0, 20.0, 4.0, hardening], (), variance), simpler) == adds
    )


def test_an_earlier_fit_rests_at_its_shape_and_the_states_of_these_recordings_in_their_order() -> None:
    asked: list[Any] = []
    problem: Any = SimpleNamespace(
        prepared=[SimpleNamespace(label="b"), SimpleNamespace(label="a")],
        at=lambda shape, states: asked.append((shape, states.tolist())) or "point",
    )
    states = {"a": np.array([0.1, 0.2]), "other": np.array([0.9]), "b": np.array([0.3])}
    before: Any = SimpleNamespace(shape="shape", initial_states=states)
    assert where_it_rested(problem, before) == "point"
    assert asked == [("shape", [0.3, 0.1, 0.2])]


def test_the_state_of_each_run_is_the_one_that_leaves_least_beside_the_best_offset() -> None:
    """Of torque = offset + 2·(state): columns state, one, torque, of two samples a run; the rest has state zero."""

    def gram(columns: np.ndarray) -> np.ndarray:
        return np.asarray(columns.T @ columns)

    def run(state: float, torque: list[float]) -> np.ndarray:
        return gram(np.column_stack([[state, state], [1.0, 1.0], torque]))

    rest = gram(np.column_stack([[0.0] * 3, [1.0] * 3, [5.0] * 3]))  # the offset is 5
    states = (-1.0, 0.0, 1.0)
    torques = ([7.0, 7.1], [2.9, 3.0], [5.0, 5.1])
    own = np.array([[[run(state, torque) for state in states]] for torque in torques])
    found = _best_states(own, np.array([[rest]] * 3), np.array([[2.0]]))
    assert found.ravel().tolist() == [2, 0, 1]

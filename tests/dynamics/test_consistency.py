"""The nearest body to parameters that no body has, against a search over bodies that are written as P = L Lᵀ."""

from __future__ import annotations

import clarabel
import numpy as np
import pinocchio as pin
import pytest
from scipy import optimize, sparse

from plantar.dynamics.consistency import Normal, Prior, consistent_fit, is_consistent, pseudo_inertia
from plantar.errors import DataError

LOWER = np.tril_indices(4)


def parameters_of(matrix: np.ndarray) -> np.ndarray:
    """The ten parameters of a pseudo-inertia [[S, h], [hᵀ, m]]: inertia = tr(S) 1 - S."""
    inertia = np.trace(matrix[:3, :3]) * np.eye(3) - matrix[:3, :3]
    entries = [inertia[i, j] for i, j in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))]
    return np.array([matrix[3, 3], *matrix[:3, 3], *entries])


def nearest(target: np.ndarray, weights: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Weighted least distance from `target` over all positive semidefinite pseudo-inertias."""

    def missed(entries: np.ndarray) -> np.ndarray:
        lower = np.zeros((4, 4))
        lower[LOWER] = entries
        return weights * (parameters_of(lower @ lower.T) - target)

    first = np.linalg.cholesky(pseudo_inertia(start))[LOWER]
    return parameters_of_lower(optimize.least_squares(missed, first, xtol=1e-14, ftol=1e-14, gtol=1e-14).x)


def parameters_of_lower(entries: np.ndarray) -> np.ndarray:
    lower = np.zeros((4, 4))
    lower[LOWER] = entries
    return parameters_of(lower @ lower.T)


@pytest.mark.parametrize("seed", range(4))
def test_the_fit_is_the_nearest_body(seed: int) -> None:
    """A centre of mass and products of inertia that the mass cannot have: off the diagonal of P."""
    random = np.random.default_rng(seed)
    body = pin.Inertia.FromEllipsoid(2.0, 0.3, 0.2, 0.25)
    body.lever = np.array([0.05, -0.03, 0.08])
    cad = body.toDynamicParameters()
    prior = Prior.around(cad)
    scale = np.array([1.0, *[0.3] * 3, *[0.05] * 6])
    target = cad + scale * random.normal(0, 1.5, 10)
    assert not is_consistent(target)
    weights = 1 / scale
    regressor = np.diag(weights)
    found = consistent_fit(Normal.of(regressor, weights * target, prior), prior, 1e-9, positive=())
    expected = nearest(target, weights, cad)
    assert np.linalg.eigvalsh(pseudo_inertia(found))[0] > -1e-7
    distance = [np.linalg.norm(weights * (one - target)) for one in (found, expected)]
    assert distance[0] == pytest.approx(distance[1], rel=5e-3)
    np.testing.assert_allclose(weights * found, weights * expected, atol=0.05)


def test_the_solver_is_given_directions_of_one_size(monkeypatch: pytest.MonkeyPatch) -> None:
    """Logs without noise decide some directions a million times as well as others: unscaled, it gets no further."""
    given = []
    solver = clarabel.DefaultSolver

    def kept(square: sparse.csc_matrix, *rest: object) -> object:
        given.append(square.diagonal())
        return solver(square, *rest)

    cad = pin.Inertia.FromEllipsoid(2.0, 0.3, 0.2, 0.25).toDynamicParameters()
    prior = Prior.around(cad)
    regressor = np.diag(np.geomspace(1e-2, 1e4, 10)) @ np.linalg.inv(prior.spread)
    target = regressor @ np.array([-1.0, *cad[1:]])
    monkeypatch.setattr(clarabel, "DefaultSolver", kept)
    found = consistent_fit(Normal.of(regressor, target, prior), prior, 1e-9, positive=())
    np.testing.assert_allclose(given, [np.ones(10)], rtol=1e-9)
    assert np.linalg.eigvalsh(pseudo_inertia(found))[0] > -1e-7


def test_a_solver_that_stalls_is_asked_again_with_shorter_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a made log one of a hundred fits stalled in long steps: the command ended with the solver's word for it."""
    solver, steps = clarabel.DefaultSolver, list[float]()

    def stalls(*problem: object) -> object:
        settings = problem[-1]
        steps.append(settings.max_step_fraction)
        settings.max_iter = 200 if steps[-1] < least else 2
        return solver(*problem)

    cad = pin.Inertia.FromEllipsoid(2.0, 0.3, 0.2, 0.25).toDynamicParameters()
    prior = Prior.around(cad)
    regressor = np.linalg.inv(prior.spread)
    normal = Normal.of(regressor, regressor @ np.array([-1.0, *cad[1:]]), prior)
    expected = consistent_fit(normal, prior, 1e-9, positive=())
    monkeypatch.setattr(clarabel, "DefaultSolver", stalls)
    least = 0.95
    np.testing.assert_allclose(consistent_fit(normal, prior, 1e-9, positive=()), expected, atol=1e-5)
    assert steps == sorted(set(steps), reverse=True)
    assert len(steps) == 2
    least = 0.0
    with pytest.raises(
        DataError, match=r"^the physically consistent fit did not converge \(MaxIterations\)$"
    ):
        consistent_fit(normal, prior, 1e-9, positive=())

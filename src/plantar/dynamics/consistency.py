"""Inertial parameters that a real body can have, near the CAD's, by a semidefinite fit.

A link's ten parameters belong to a body of positive density exactly when its pseudo-inertia

    P = [[S, h], [hᵀ, m]],   S = 1/2 tr(I) 1 - I,   h = m c

is positive definite (P. Wensing, S. Kim, J.-J. Slotine, IEEE RA-L 3(1), 2018). The distance from the CAD is taken
relative to the link's own mass and size, d² = tr(Q⁻¹ dP Q⁻¹ dP): a kilogram counts for a finger, not for a trunk.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from plantar.conventions import Array
from plantar.dynamics.base_parameters import INERTIA_ENTRIES
from plantar.dynamics.equation import PER_LINK
from plantar.errors import DataError, needs

ROUNDNESS = 4.0  # of the reference body: its radius of gyration squared over the link's own
SMALLEST_RADIUS = 0.01  # m: of gyration; thinner links count as this thick
SMALLEST_MASS = 1e-4  # kg: lighter links count as this heavy
STEPS = (0.99, 0.9, 0.7)  # shares of the way to a cone's border: shorter ones where the solver stalls
FLOOR = 1e-5  # of the reference body: what every identified link keeps, so that simulators take it


def pseudo_inertia(parameters: Array) -> Array:
    """P of one link's ten parameters, (4, 4)."""
    return np.asarray(np.einsum("k,kij->ij", parameters, _BASIS))


@dataclass(frozen=True)
class Prior:
    """The CAD's parameters (10 n_links,) and how far each link may be from them.

    widths: for each link (10, 10), so that `parameters = cad + widths @ u` with |u|² the distance; reference: Q of
    each link, (n_links, 4, 4).
    """

    cad: Array
    widths: Array
    reference: Array

    @classmethod
    def around(cls, cad: Array) -> Prior:
        """A prior around given parameters, 10 a link."""
        links = cad.reshape(-1, PER_LINK)
        reference = np.array([_reference(pseudo_inertia(link)) for link in links])
        widths = []
        for q in reference:
            inverse = np.linalg.inv(q)
            metric = np.einsum("ij,ajk,kl,bli->ab", inverse, _BASIS, inverse, _BASIS)
            widths.append(np.linalg.inv(np.linalg.cholesky(metric).T))
        return cls(cad, np.array(widths), reference)

    @property
    def spread(self) -> Array:
        """All widths as one block-diagonal matrix, (10 n_links, 10 n_links)."""
        size = len(self.cad)
        matrix = np.zeros((size, size))
        for link, width in enumerate(self.widths):
            part = slice(PER_LINK * link, PER_LINK * (link + 1))
            matrix[part, part] = width
        return matrix


@dataclass(frozen=True)
class Normal:
    """A least-squares problem min |regressor x - target|² in the prior's own units.

    square, linear: of the problem in [u, extras / scale]; scale: of the extras (they have no prior).
    """

    square: Array
    linear: Array
    scale: Array

    @classmethod
    def of(cls, regressor: Array, target: Array, prior: Prior) -> Normal:
        """regressor: (rows, 10 n_links + n_extras), inertial parameters first; target: (rows,)."""
        size = len(prior.cad)
        inertial = regressor[:, :size] @ prior.spread
        extras = regressor[:, size:]
        norm = np.linalg.norm(extras, axis=0)
        scale = 1 / np.where(norm > 0, norm, 1.0)
        whole = np.hstack([inertial, extras * scale])
        return cls(whole.T @ whole, whole.T @ (target - regressor[:, :size] @ prior.cad), scale)


def consistent_fit(normal: Normal, prior: Prior, regularisation: float, positive: Sequence[int]) -> Array:
    """Least squares plus `regularisation` times the distance from the CAD; pseudo-inertias stay positive definite.

    positive: which extras may not be negative (friction cannot drive a joint). Returns [inertial parameters, extras].
    Raises MissingExtra without clarabel, DataError when the solver fails.
    """
    size, count = len(prior.cad), len(normal.linear)
    ridge = np.concatenate([np.full(size, regularisation), np.full(count - size, 1e-12)])
    square = normal.square + np.diag(ridge)
    free = np.asarray(np.linalg.solve(square, normal.linear), dtype=np.float64)
    if np.all(free[[size + extra for extra in positive]] >= 0) and _keeps_floor(prior, free[:size]):
        x = free
    else:
        x = _constrained(square, normal.linear, prior, [size + extra for extra in positive])
    return np.concatenate([prior.cad + prior.spread @ x[:size], x[size:] * normal.scale])


def _keeps_floor(prior: Prior, u: Array) -> bool:
    """Whether parameters `cad + widths @ u` leave every link above the floor."""
    links = prior.cad.reshape(-1, PER_LINK) + np.einsum("nij,nj->ni", prior.widths, u.reshape(-1, PER_LINK))
    bodies = np.einsum("nk,kij->nij", links, _BASIS) - FLOOR * prior.reference
    return bool(np.linalg.eigvalsh(bodies)[:, 0].min(initial=0.0) >= 0)


def _constrained(square: Array, linear: Array, prior: Prior, places: Sequence[int]) -> Array:
    """min xᵀ square x / 2 - linearᵀ x over bodies that keep the floor, x[places] not negative."""
    with needs("clarabel", "inertia", "physically consistent parameters"):
        import clarabel
    size, count = len(prior.cad), len(linear)
    unit = max(float(np.abs(linear).max(initial=0.0)), 1e-12)
    # Logs without noise decide some directions 1e12 times as well as others.
    sizes = 1 / np.sqrt(np.maximum(np.diag(square) / unit, 1e-12))
    cones, offsets = np.zeros((size + len(places), count)), np.zeros(size + len(places))
    for link, width in enumerate(prior.widths):
        part = slice(PER_LINK * link, PER_LINK * (link + 1))
        cones[part, part] = -_PACKED @ width
        offsets[part] = _PACKED @ prior.cad[part] - FLOOR * _pack(prior.reference[link])
    cones[range(size, len(cones)), places] = -1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    for settings.max_step_fraction in STEPS:
        solution = clarabel.DefaultSolver(
            sparse.csc_matrix(np.triu(square) / unit * np.outer(sizes, sizes)),
            -linear / unit * sizes,
            sparse.csc_matrix(cones * sizes),
            offsets,
            [clarabel.PSDTriangleConeT(4)] * len(prior.widths) + [clarabel.NonnegativeConeT(len(places))],
            settings,
        ).solve()
        if str(solution.status) in ("Solved", "AlmostSolved"):
            return np.asarray(sizes * np.array(solution.x))
    raise DataError(f"the physically consistent fit did not converge ({solution.status})")


def is_consistent(parameters: Array) -> bool:
    """Whether every link's pseudo-inertia is positive definite; parameters: 10 a link."""
    links = parameters.reshape(-1, PER_LINK)
    return all(np.linalg.eigvalsh(pseudo_inertia(link))[0] > 0 for link in links)


def _basis() -> Array:
    basis = np.zeros((PER_LINK, 4, 4))
    basis[0, 3, 3] = 1.0
    for k in range(3):
        basis[1 + k, k, 3] = basis[1 + k, 3, k] = 1.0
    for k, (i, j) in enumerate(INERTIA_ENTRIES):
        inertia = np.zeros((3, 3))
        inertia[i, j] = inertia[j, i] = 1.0
        basis[4 + k, :3, :3] = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    return basis


def _pack(matrix: Array) -> Array:
    """The upper triangle column by column, off-diagonals times sqrt 2, as the solver's cone has it."""
    return np.array([matrix[i, j] * (1.0 if i == j else np.sqrt(2)) for j in range(4) for i in range(j + 1)])


def _reference(p: Array) -> Array:
    """Q of one link: its mass and centre, its spread made round."""
    mass = max(float(p[3, 3]), SMALLEST_MASS)
    centre = p[:3, 3] / mass
    spread = np.trace(p[:3, :3]) / 3 / mass - centre @ centre / 3
    radius2 = max(ROUNDNESS * float(spread), SMALLEST_RADIUS**2)
    q = np.empty((4, 4))
    q[:3, :3] = mass * (radius2 * np.eye(3) + np.outer(centre, centre))
    q[:3, 3] = q[3, :3] = mass * centre
    q[3, 3] = mass
    return q


_BASIS = _basis()
_PACKED = np.column_stack([_pack(element) for element in _BASIS])

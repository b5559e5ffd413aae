"""Least squares for the base parameters (eq. 2), from arrays or from a stream of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, get_args

import numpy as np
import pinocchio as pin

from plantar import _core
from plantar.choices import one_of
from plantar.conventions import ROUNDING, Array
from plantar.dynamics.base_parameters import BaseParameters, base_parameters
from plantar.dynamics.equation import BASE_ROWS, Equation
from plantar.dynamics.motion import pinocchio_motion
from plantar.dynamics.stream import EquationStream, stacked
from plantar.errors import DataError
from plantar.notes import Note

SAFE_CONDITION = 1e10  # below this estimate every parameter is excited and no singular values are needed
RANK_TOLERANCE = 1e-10  # of the largest singular value, columns scaled to one
UNEXCITED_SHARE = 0.05  # of a unit parameter that must lie in the unexcited directions to be named

Rows = Literal["base", "all"]
Samples = tuple[Array, Array, Array, Array]


@dataclass(frozen=True)
class BaseParameterFit:
    """Least-squares base parameters.

    values: (n_base,), where some are not excited the smallest that fit; std: (n_base,), for white residuals of one size
    in all rows, infinite for a parameter that is not excited; rank: excited directions; names, expressions: of the
    parameters; samples; residual_rms: over all rows [N and N·m]; notes: what is not excited.
    """

    equation: Equation = field(repr=False)
    base: BaseParameters = field(repr=False)
    rows: tuple[int, ...] = field(repr=False)
    triangle: Array = field(repr=False)
    values: Array
    std: Array
    rank: int
    samples: int
    residual_rms: float
    notes: tuple[Note, ...]
    _model: pin.Model = field(repr=False)

    @property
    def names(self) -> tuple[str, ...]:
        return self.base.names

    @property
    def expressions(self) -> tuple[str, ...]:
        return self.base.expressions

    @cached_property
    def condition_number(self) -> float:
        """Largest over smallest singular value of the stacked regressor; infinite where the rank lacks."""
        if self.rank < len(self.values):
            return float("inf")
        singular = np.linalg.svd(self.triangle[:-1, :-1], compute_uv=False)
        return float(singular[0] / singular[-1])

    def predict(self, q: Array, v: Array, a: Array) -> Array:
        """The fitted rows in another motion, (N, len(rows)) [N, N·m]."""
        motion = pinocchio_motion(self._model, self.equation.tree, q, v, a)
        return self.equation.inverse_dynamics(motion, self.base.embed(self.values))[list(self.rows)].T


def fit_base_parameters(
    model: pin.Model, q: Array, v: Array, a: Array, tau: Array, rows: Rows = "base", threads: int = 0
) -> BaseParameterFit:
    """Base parameters of a Pinocchio model by least squares.

    Args:
        model: the robot, with or without a free-flyer at its root.
        q: (N, nq) positions in Pinocchio's conventions [m, rad].
        v: (N, nv) velocities.
        a: (N, nv) accelerations.
        tau: (N, nv) generalised forces [N, N·m].
        rows: "base" uses the six rows of the free-flyer (eq. 2, no joint torque is read), "all" every row.
        threads: 0 for as many as are worth starting.

    Returns:
        `.values`, `.std`, `.rank`, `.condition_number`, `.expressions` of the parameters, and `.predict(q, v, a)`.

    Raises:
        RobotError: a joint type that is not supported. SettingsError: `rows` is neither. DataError: wrong shapes,
        values that are not finite, or base rows asked of a model without free-flyer.

    Example:
        >>> import numpy as np, pinocchio as pin
        >>> from plantar import dynamics
        >>> model, random = pin.buildSampleModelManipulator(), np.random.default_rng(0)
        >>> q, v, a = random.normal(size=(3, 100, model.nv))
        >>> data = model.createData()
        >>> tau = np.array([pin.rnea(model, data, *sample) for sample in zip(q, v, a)])
        >>> fit = dynamics.fit_base_parameters(model, q, v, a, tau, rows="all")
        >>> fit.rank == len(fit.values), bool(np.allclose(fit.predict(q, v, a), tau))
        (True, True)
    """
    return fit_base_parameters_chunked(model, [(q, v, a, tau)], rows, threads)


def fit_base_parameters_chunked(
    model: pin.Model, chunks: Iterable[Samples], rows: Rows = "base", threads: int = 0
) -> BaseParameterFit:
    """As `fit_base_parameters`, from any number of batches, in constant memory.

    Args:
        model: the robot, with or without a free-flyer at its root.
        chunks: q (N, nq), v, a, tau (N, nv) of each batch, which may come from a generator.
        rows: "base" or "all", as of `fit_base_parameters`.
        threads: 0 for as many as are worth starting.

    Returns:
        What `fit_base_parameters` returns for all samples in one.

    Raises:
        RobotError, DataError: as `fit_base_parameters`; DataError also where there is no sample.

    Example:
        >>> import numpy as np, pinocchio as pin
        >>> from plantar import dynamics
        >>> model, random = pin.buildSampleModelManipulator(), np.random.default_rng(0)
        >>> chunks = (random.normal(size=(4, 50, model.nv)) for _ in range(3))
        >>> dynamics.fit_base_parameters_chunked(model, chunks, rows="all").samples
        150
    """
    one_of("rows", rows, get_args(Rows))
    equation = Equation(model)
    if rows == "base" and not equation.floating:
        raise DataError("base rows need a free-flyer at the root (valid: rows='all' for a fixed base)")
    base = base_parameters(equation)
    chosen = tuple(range(BASE_ROWS if rows == "base" else equation.n_rows))
    together = ((0, 1, 2), (3, 4, 5)) if equation.floating else ()
    stream = EquationStream(equation, base, chosen, together=together)
    samples = 0
    for q, v, a, tau in chunks:
        motion = pinocchio_motion(model, equation.tree, q, v, a)
        tau = np.asarray(tau, dtype=np.float64)
        if tau.shape != (len(motion), model.nv):
            raise DataError(f"tau: an array of shape {tau.shape} (valid: {(len(motion), model.nv)})")
        if not np.isfinite(tau[:, : len(chosen)]).all():
            sample, column = np.argwhere(~np.isfinite(tau[:, : len(chosen)]))[0]
            raise DataError(f"tau: sample {sample}, column {column} is {tau[sample, column]} (valid: finite)")
        stream.add(motion, {row: tau[:, row] for row in chosen}, threads=threads)
        samples += len(motion)
    if samples == 0:
        raise DataError("no samples to fit (valid: at least one)")
    factors = sorted(stream.factors().values(), key=lambda factor: -len(factor.columns))
    triangle = stacked(factors, len(base))
    return _solved(model, equation, base, chosen, triangle, samples)


def _solved(
    model: pin.Model,
    equation: Equation,
    base: BaseParameters,
    rows: tuple[int, ...],
    triangle: Array,
    samples: int,
) -> BaseParameterFit:
    solution = solve_triangle(triangle)
    equations = samples * len(rows)
    freedom = equations - solution.rank
    residual = abs(float(triangle[-1, -1])) if solution.full else solution.residual
    variance = residual**2 / freedom if freedom > 0 else np.nan
    notes = []
    if not solution.full:
        named = [base.expressions[k] for k in np.flatnonzero(~solution.excited)]
        text = f"{len(base) - solution.rank} of {len(base)} directions are not excited; not determined: "
        notes.append(Note("unexcited", "warning", text + "; ".join(named)))
    if freedom <= 0:
        text = f"{equations} equations for {solution.rank} excited directions: no deviations can be given"
        notes.append(Note("too_few_samples", "warning", text))
    std = np.where(solution.excited, np.sqrt(variance) * solution.spread, np.inf)
    return BaseParameterFit(
        equation=equation,
        base=base,
        rows=rows,
        triangle=triangle,
        values=solution.values,
        std=std,
        rank=solution.rank,
        samples=samples,
        residual_rms=residual / np.sqrt(equations),
        notes=tuple(notes),
        _model=model,
    )


@dataclass(frozen=True)
class TriangleSolution:
    """Least squares from a triangle [R z; 0 r].

    values: (n,); spread: (n,), standard deviations for residuals of size one; excited: (n,) bool; rank;
    residual: norm of what is left; full: every direction is excited.
    """

    values: Array
    spread: Array
    excited: np.ndarray[tuple[int], np.dtype[np.bool_]]
    rank: int
    residual: float
    full: bool


def solve_triangle(triangle: Array) -> TriangleSolution:
    """Solve a triangle whose last column is the measured side; the smallest of the values that fit."""
    r, z = triangle[:-1, :-1], triangle[:-1, -1]
    scale = np.linalg.norm(r, axis=0)
    scale[scale <= ROUNDING * scale.max(initial=0.0)] = 1.0
    unit = r / scale
    n = len(z)
    if np.all(np.abs(np.diag(unit)) > 1 / SAFE_CONDITION):
        inverse = _core.inverse_upper(unit)
        rows = np.sqrt(np.einsum("ij,ij->i", inverse, inverse))
        if np.sqrt(n) * np.linalg.norm(rows) < SAFE_CONDITION:  # Frobenius norms of R, of its inverse
            values = np.einsum("ij,j->i", inverse, z) / scale
            spread = rows / scale
            return TriangleSolution(
                values, spread, np.ones(n, dtype=bool), n, abs(float(triangle[-1, -1])), True
            )
    u, singular, vt = np.linalg.svd(unit)
    rank = int(np.sum(singular > RANK_TOLERANCE * singular[0])) if singular[0] > 0 else 0
    seen = vt[:rank].T / singular[:rank]
    values = seen @ (u[:, :rank].T @ z) / scale
    excited = np.linalg.norm(vt[rank:], axis=0) < UNEXCITED_SHARE
    rest = np.append(u[:, rank:].T @ z, triangle[-1, -1])
    spread = np.linalg.norm(seen, axis=1) / scale
    return TriangleSolution(values, spread, excited, rank, float(np.linalg.norm(rest)), rank == n)

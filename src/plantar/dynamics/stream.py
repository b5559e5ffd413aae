"""Eq. 1 over any number of samples in constant memory: an R factor for each of its rows.

The rows of many samples are never stacked. Each component of the base wrench and each joint has its own upper triangle
R, with RᵀR the sum of its rows' squares, over the columns it depends on and the measured side. Afterwards any choice of
rows and of weights for them is a small problem: stack the weighted triangles and triangularise again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.dynamics.base_parameters import BaseParameters
from plantar.dynamics.equation import PER_LINK, Equation
from plantar.dynamics.motion import Motion


@dataclass(frozen=True)
class RowFactor:
    """R of one row of eq. 1, or of several that share their columns, over the samples seen.

    upper: (k, k), upper triangle of [columns, extras, measured]; columns: base parameters of its leading columns,
    increasing, (k - extras - 1,); extras: further columns given by the caller; samples: how many rows went in.
    """

    upper: Array
    columns: np.ndarray[tuple[int], np.dtype[np.int64]]
    extras: int
    samples: int


class EquationStream:
    """Accumulates eq. 1's rows over the base parameters, sample batch by sample batch.

    rows: which rows of the equation take part; extras: how many further columns a row has (joint terms), none
    by default; together: rows that depend on the same columns and are never weighted apart (the forces, the torques):
    one factor is enough for all of such a set.
    """

    def __init__(
        self,
        equation: Equation,
        base: BaseParameters,
        rows: Sequence[int],
        extras: Mapping[int, int] | None = None,
        together: Sequence[Sequence[int]] = (),
    ) -> None:
        self.equation = equation
        self.rows = tuple(rows)
        self.extras = {row: (extras or {}).get(row, 0) for row in self.rows}
        self._samples = 0
        given = [self.extras[row] + 1 if row in self.extras else 0 for row in range(equation.n_rows)]
        first = {
            row: min(set(rows) & set(self.rows)) for rows in together for row in rows if row in self.rows
        }
        self._groups: dict[int, list[int]] = {}
        for row in sorted(self.rows):
            self._groups.setdefault(first.get(row, row), []).append(row)
        group = [0] * equation.n_rows
        for number, members in enumerate(self._groups.values()):
            for row in members:
                group[row] = number
        self._core = _core.Stream(equation.core, base.masks, given, group)
        self._position = np.full(PER_LINK * len(equation.links), -1)
        self._position[base.kept] = np.arange(len(base))

    def add(
        self,
        motion: Motion,
        measured: Mapping[int, Array],
        extras: Mapping[int, Sequence[Array]] | None = None,
        threads: int = 0,
    ) -> None:
        """Take in a batch of finite samples.

        measured: the right side of eq. 1, (N,) for each of the rows; extras: a row's further columns, (N,) each.
        """
        given: list[list[Array]] = [[] for _ in range(self.equation.n_rows)]
        for row in self.rows:
            given[row] = [*(extras or {}).get(row, ()), measured[row]]
        m = motion
        self._core.add(m.base, m.positions, m.velocities, m.accelerations, given, threads)
        self._samples += len(motion)

    def factors(self) -> dict[int, RowFactor]:
        """The R factor of each row, or of each set of rows by its first, so far."""
        found = {
            members[0]: RowFactor(
                self._core.factor(group),
                self._position[self._core.parameters(group)],
                self.extras[members[0]],
                self._samples * len(members),
            )
            for group, members in enumerate(self._groups.values())
        }
        return {row: found[row] for row in self.rows if row in found}


def stacked(factors: Sequence[RowFactor], n_base: int, weights: Sequence[float] | None = None) -> Array:
    """One triangle for several rows' factors, each row times its weight: (n + 1, n + 1), the measured side last.

    Columns: the base parameters, then each factor's own extras in the order given.
    """
    extras = sum(factor.extras for factor in factors)
    size = n_base + extras + 1
    onto, start = [], n_base
    for factor in factors:
        own = range(start, start + factor.extras)
        onto.append([*factor.columns.tolist(), *own, size - 1])
        start += factor.extras
    chosen = [1.0] * len(factors) if weights is None else list(weights)
    return _core.stacked([np.ascontiguousarray(factor.upper) for factor in factors], onto, chosen, size)

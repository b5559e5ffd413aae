"""What every bush model offers: torque from the history of deflection and rate.

    torque = stiffness·deflection + damping·rate + Σ parameter·column(history; shape) + offset

The torque is linear in all parameters but the nonlinear ones, `shape`. The offset belongs to the recording, not to the
bush. Every model has `stiffness` and `damping`, a spring and a damper in parallel with whatever else it has.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final

import numpy as np

from plantar.conventions import DAMPING_UNIT, STIFFNESS_UNIT, Array, Axis
from plantar.signals.segments import runs

BESIDE: Final = ("stiffness", "damping")  # the spring and damper of every model, first among its terms


@dataclass(frozen=True, eq=False)
class BushMotion:
    """One axis of one foot over one recording, at an even period [s]; NaN where nothing is known (a gap, the air).

    A motion equals itself alone, so that what is worked out of it once can be kept.

    `deflection` [rad] and `rate` [rad/s] are (N,), wide-band: a model that does not commute with a filter needs the
    path itself. `across` and `across_rate` are (N, m): the same foot's other axes, for models that couple them.
    """

    deflection: Array
    rate: Array
    period: float
    across: Array | None = None
    across_rate: Array | None = None

    @cached_property
    def runs(self) -> tuple[slice, ...]:
        """Segments without a gap: the model's memory lasts over each of them and starts anew in the next."""
        return tuple(runs(np.isfinite(self.deflection) & np.isfinite(self.rate)))

    @cached_property
    def swing(self) -> float:
        """Half of the widest swing of a run [rad], 1 % cut off."""
        ends = [np.percentile(self.deflection[run], [0.5, 99.5]) for run in self.runs]
        return max((0.5 * float(high - low) for low, high in ends), default=0.0)

    def __len__(self) -> int:
        return len(self.deflection)


class BushModel(ABC):
    """A bush model. Linear `terms` first stiffness and damping; `shape_terms` are its nonlinear parameters.

    A model that `remembers` has an inner state whose value at the beginning of a run is unknown: its initial state, in
    [-1, 1].
    """

    name: ClassVar[str]
    terms: ClassVar[tuple[str, ...]] = BESIDE
    shape_terms: ClassVar[tuple[str, ...]] = ()
    remembers: ClassVar[bool] = False
    fading_memory: ClassVar[bool] = True  # whether the effect of the initial state fades as the bush moves
    tried_states: ClassVar[tuple[float, ...]] = (0.0,)  # by the rough search, before they are refined
    elaborates: ClassVar[str | None] = (
        None  # a simpler model, without whose gain this one is not worth trying
    )
    # (shape term, "low" or "high"): see `candidates`
    blind_ends: ClassVar[frozenset[tuple[str, str]]] = frozenset()
    # An error of the deflection's zero is more than an offset and an initial state.
    zero_matters: ClassVar[bool] = False
    dissipative_terms: ClassVar[tuple[str, ...]] = ()  # below zero the bush is not passive
    units: ClassVar[dict[str, tuple[str, str]]] = {}  # of extra and shape terms: rotational, vertical

    @property
    def size(self) -> int:
        """How many parameters the bush has under this model."""
        return len(self.terms) + len(self.shape_terms)

    def unit(self, term: str, axis: Axis) -> str:
        """Unit of a linear or shape parameter on an axis."""
        if term == "stiffness":
            return STIFFNESS_UNIT[axis]
        if term == "damping":
            return DAMPING_UNIT[axis]
        return self.units[term][axis == "z"]

    def applies(self, motions: Sequence[BushMotion]) -> bool:
        """Whether these motions hold what the model needs."""
        return True

    def candidates(self, motions: Sequence[BushMotion]) -> Array:
        """Nonlinear parameters (g, s) to try for these motions; one empty row where the model has none.

        They span what the motions can show. At a blind end of that range the model becomes a spring or a damper
        more, and cannot be told from the spring and the damper beside it.
        """
        return np.zeros((1, 0))

    @abstractmethod
    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """The columns beside deflection and rate, (N, e, b); NaN outside the motion's runs.

        `shapes` (b, s), nonlinear parameters, and `initial_states` (b, runs) are b variants.
        """

    def columns(
        self, motion: BushMotion, shape: Sequence[float] | Array = (), initial_states: Array | None = None
    ) -> Array:
        """Regressor (N, k) of one motion, NaN outside its runs; `initial_states` (runs,), zero where not given."""
        initial_states = (
            np.zeros(len(motion.runs)) if initial_states is None else np.asarray(initial_states, dtype=float)
        )
        extra = self.basis_columns(
            motion, np.reshape(np.asarray(shape, dtype=float), (1, -1)), initial_states[None, :]
        )
        columns = np.column_stack([motion.deflection, motion.rate, extra[:, :, 0]])
        columns[~np.isfinite(columns).all(axis=1)] = np.nan
        return columns

    def initial_states(self, motion: BushMotion, shape: Array) -> Array:
        """Initial state (runs,) of each run, if the bush was loaded to it from rest without turning back."""
        return np.zeros(len(motion.runs))

    def hardly_shown(self, shape: Array, limits: Array) -> str | None:
        """Why motions whose range of the nonlinear parameters is `limits` (2, s) hardly show `shape` (s,); None where
        they do."""
        return None

    def possible(self, values: Array) -> bool:
        """Whether a bush with these linear parameters (k,) is passive, and a spring."""
        return bool(values[0] > 0) and all(
            values[self.terms.index(term)] >= 0 for term in self.dissipative_terms
        )


def reach(motions: Sequence[BushMotion]) -> float:
    """Largest deflection from the middle, over the motions' runs [rad]."""
    return max((motion.swing for motion in motions), default=0.0)

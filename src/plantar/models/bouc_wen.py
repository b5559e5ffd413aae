"""Kelvin-Voigt beside a Bouc-Wen element: hysteresis that bends into slip smoothly."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.models.bush_model import BushMotion
from plantar.models.hysteresis import Hysteretic, Path

TABLE = 2001  # of the element's torque from 0 to 1, between which it is interpolated
STEPS = 8000  # of the integrals behind it
DEEPEST = 30.0  # -log(1 - z) at which z counts as 1
SHARPNESS = (1.0, 2.0, 4.0)  # tried by the search; 1 is Dahl's friction, large ones are a Jenkins element


class BoucWen(Hysteretic):
    """slip_torque·z with dz = (dq / slip_angle)·(1 - sign(dq)·z·|z|^(sharpness - 1)).

    Bouc-Wen's equation with β = 1 / slip_angle, γ = 0, scaled so that z ends at ±1: passive for every sharpness ≥ 1.
    """

    name: ClassVar[str] = "bouc_wen"
    elaborates: ClassVar[str | None] = "elastoplastic"
    shape_terms: ClassVar[tuple[str, ...]] = ("slip_angle", "sharpness")
    units: ClassVar[dict[str, tuple[str, str]]] = {**Hysteretic.units, "sharpness": ("1", "1")}

    def candidates(self, motions: Sequence[BushMotion]) -> Array:
        """Slip angles as for a Jenkins element, each with every sharpness."""
        angles = super().candidates(motions)[:, 0]
        return np.array([(angle, sharpness) for sharpness in SHARPNESS for angle in angles[::2]])

    def states(self, path: Path, shapes: Array, initial_states: Array) -> Array:
        """z (N, b)."""
        result = np.empty((len(path.deflection), len(shapes)))
        for sharpness in np.unique(shapes[:, 1]):
            chosen = np.flatnonzero(shapes[:, 1] == sharpness)
            curve, pace = branch_curve(round(float(sharpness), 9)), sharpness / shapes[chosen, 0]
            result[:, chosen] = curve.states(path, pace, initial_states[:, chosen])
        return result


class BranchCurve:
    """The one curve that z follows from -1 to 1, over the place p = 1 - exp(-sharpness·way / slip_angle).

    In p the curve and the turn (z -> -z) have finite slopes at both ends, so a table interpolated linearly is enough.
    """

    def __init__(self, sharpness: float) -> None:
        fall = np.linspace(0.0, DEEPEST, STEPS + 1)  # -log(1 - |z|)
        z = -np.expm1(-fall)
        power = sharpness * np.log1p(-np.exp(-np.maximum(fall, 1e-15)))  # log |z|^n
        # Way / slip angle: ∫ dz / (1 + |z|^n) from -1 to 0, then ∫ dz / (1 - z^n), both over `fall`.
        below, above = np.exp(-fall) / (1.0 + np.exp(power)), np.exp(-fall) / -np.expm1(power)
        z = np.unique(np.concatenate([np.linspace(0.0, 1.0, TABLE)[:-1], z[fall > 4.0][::8]]))
        fall = -np.log1p(-z)
        zero, under, over = (
            _integral(*each) for each in ((below, np.array([DEEPEST])), (below, fall[:0:-1]), (above, fall))
        )
        way = np.concatenate([[0.0], zero - under, zero + over, [np.inf]])
        self._state = np.concatenate([[-1.0], -z[:0:-1], z, [1.0]])
        self._place = -np.expm1(-sharpness * way)

    def states(self, path: Path, pace: Array, initial_states: Array) -> Array:
        """z (N, b) of b variants whose 1 - p falls by exp(-pace·way), `pace` (b,); NaN outside the runs."""
        starts = np.ascontiguousarray(initial_states)
        return _core.branch_curve(path.deflection, path.runs, pace, starts, self._place, self._state)


def _integral(values: Array, ends: Array) -> Array:
    """Integral from 0 to each of `ends` (n,) of a smooth function's `values` (STEPS + 1,), evenly spaced to DEEPEST.

    Cubic: over each step from four values (Gregory), and within a step by Hermite's polynomial.
    """
    step = DEEPEST / STEPS
    beside = np.pad(values, 1, mode="reflect", reflect_type="odd")
    parts = step / 24 * (13 * (values[1:] + values[:-1]) - beside[:-3] - beside[3:])
    until = np.concatenate([[0.0], np.cumsum(parts)])
    place = np.minimum((ends / step).astype(np.intp), STEPS - 1)
    t = ends / step - place
    rise = until[place + 1] - until[place]
    bend = t * (1 - t) * step * ((1 - t) * values[place] - t * values[place + 1])
    return np.asarray(until[place] + t * t * (3 - 2 * t) * rise + bend)


@lru_cache(maxsize=64)
def branch_curve(sharpness: float) -> BranchCurve:
    """The curve of one sharpness, kept."""
    return BranchCurve(sharpness)

"""The state in which a bush with hysteresis lands: what the air left of it.

A lifted foot carries nothing: its bush returns to where spring and element balance, and the next landing deflects it
from there. So the state at a landing follows from the end of the stance before, but for what the foot does while it
is not flat.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.models import BushModel, BushMotion

ROUNDS = 2  # through all stances: the state at the end of one hardly depends on how it began
SAMPLES = 100  # of the way back in the air, and of the way to the next landing
STATE = "slip_torque"  # the term whose column is the state itself


@dataclass(frozen=True)
class Hysteresis:
    """A model's linear parameters (k,) and nonlinear ones (s,), and the sensors' `offset` [N.m]."""

    model: BushModel
    values: Array
    shape: Array
    offset: float

    def states(self, paths: Sequence[Array], initial_states: Array) -> list[Array]:
        """State along each path (n_i,) [rad], begun in (paths,)."""
        column = self.model.terms.index(STATE)
        gap = np.array([np.nan])
        whole = np.concatenate([part for path in paths for part in (path, gap)])
        motion = BushMotion(whole, np.where(np.isfinite(whole), 0.0, np.nan), 1.0)
        found = self.model.columns(motion, self.shape, initial_states)[:, column]
        return [found[run] for run in motion.runs]

    def torque(self, path: Array, state: Array) -> Array:
        """What the sensors read along a slow path (n,)."""
        column = self.model.terms.index(STATE)
        return np.asarray(self.values[0] * path + self.values[column] * state + self.offset)


def landing_states(bush: Hysteresis, stances: Sequence[Array], initial_states: Array) -> Array:
    """State (stances,) at the start of each stance; the first one's is the guess that is given.

    stances: the deflection along each, (n_i,) [rad].
    """
    states = initial_states.copy()
    for _ in range(ROUNDS if len(stances) > 1 and bush.values[0] > 0 else 0):
        last = np.array([state[-1] for state in bush.states(stances, states)])[:-1]
        lifted = np.array([path[-1] for path in stances[:-1]])
        landed = [path[0] for path in stances[1:]]
        # The spring alone would take it back to zero torque in this way; with the element it stops sooner.
        farthest = lifted - bush.torque(lifted, last) / bush.values[0]
        back = [np.linspace(*ends, SAMPLES) for ends in zip(lifted, farthest, strict=True)]
        ways: list[Array] = []
        for path, state in zip(back, bush.states(back, last), strict=True):
            stop = int(np.argmin(np.abs(bush.torque(path, state))))
            ways.append(
                np.concatenate([path[: stop + 1], np.linspace(path[stop], landed[len(ways)], SAMPLES)])
            )
        states[1:] = [state[-1] for state in bush.states(ways, last)]
    return states

"""Delays that differ from log to log, as where clocks are set anew for each recording.

One delay for all logs is then right for none of them: the damping of each is off by stiffness times the rest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import SURE
from plantar.estimation.delays.delay import Pair, estimate_delay
from plantar.notes import Note

LEAST = 0.003  # s, and by so much: half of it moves the damping of K/C = 30 1/s by less than a twentieth


class DelaysByLog(NamedTuple):
    """`by_log` [s], > 0: the force sensors are late; of logs in which Newton's law closes."""

    by_log: Mapping[str, float]

    @property
    def std(self) -> float:
        """Deviation of one log's delay [s] about their mean."""
        return float(np.std(list(self.by_log.values()), ddof=1))

    @property
    def note(self) -> Note:
        each = ", ".join(f"{label} {1e3 * delay:+.1f} ms" for label, delay in self.by_log.items())
        text = (
            f"the force sensors are late by another time in each log: {each}; not corrected, and damping is unsure "
            "(valid: one clock for all columns, or the same delay in all logs; identify each log by itself)"
        )
        return Note("delays_by_log", "warning", text)


def delays_by_log(pairs: Sequence[Pair], common: float) -> DelaysByLog | None:
    """The delay that each log shows by itself; None where no two of them clearly differ.

    pairs: of both sides of Newton's law, the sensors read `common` [s] later; one or more of each log.
    """
    labels = dict.fromkeys(pair.label for pair in pairs)
    own = {label: estimate_delay([pair for pair in pairs if pair.label == label]) for label in labels}
    found = {label: one for label, one in own.items() if one is not None}
    if len(found) < 2:
        return None
    values = np.array([one.value for one in found.values()])
    stds = np.array([one.wide_std for one in found.values()])
    apart = np.abs(values[:, None] - values)
    if not (apart > np.maximum(SURE * np.hypot(stds[:, None], stds), LEAST)).any():
        return None
    return DelaysByLog({label: common + one.value for label, one in found.items()})

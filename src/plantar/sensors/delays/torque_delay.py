"""Torque channels that are read at other moments than the forces beside them: damping follows the torques alone."""

from __future__ import annotations

import numpy as np

from plantar.conventions import NORMAL95
from plantar.estimation.quantiles import MOST_FREEDOM
from plantar.notes import Note
from plantar.sensors.moment_fit import MomentFit, Part, is_wrong

TORQUES_LATE = "torques_late"
LEAST = 0.005  # s: damping is off by some percent of what feet have; simulated robots without this fault show 0.0005
USUAL = 0.001  # s, by which channels of one sensor are read apart


def torque_delay_notes(fit: MomentFit | None) -> list[Note]:
    """A warning where the moments of the robot's motion ask for torques that are read earlier or later than forces."""
    if fit is None:
        return []
    late, place = float(fit.values[-1]), len(fit.values) - 1
    std = float(np.sqrt(np.sum([part.covariance[-1, -1] for part in fit.parts])))
    parts = [*fit.parts, Part(USUAL**2 * np.eye(len(fit.values)), MOST_FREEDOM)]
    if abs(late) < LEAST or not is_wrong(fit.values, parts, [place]):
        return []
    text = (
        f"the force sensors' torques are {1e3 * abs(late):.0f} ± {1e3 * NORMAL95 * std:.0f} ms (95 %) "
        f"{'behind' if late > 0 else 'ahead of'} their forces, and damping follows them (valid: all channels of a "
        "sensor read at one moment, behind the same filter)"
    )
    return [Note(TORQUES_LATE, "warning", text)]

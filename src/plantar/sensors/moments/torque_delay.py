"""Torque channels that are read at other moments than the forces beside them: damping follows the torques alone."""

from __future__ import annotations

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES
from plantar.estimation.quantiles import MOST_FREEDOM
from plantar.notes import Note
from plantar.sensors.moments.moment_fit import MomentFit, Part, is_wrong

TORQUES_LATE = "torques_late"
LEAST = 0.005  # s: damping is off by some percent of what feet have; simulated robots without this fault show 0.0005
USUAL = 0.001  # s, by which channels of one sensor are read apart


def torque_delay_notes(fit: MomentFit | None) -> list[Note]:
    """A warning where the moments of the robot's motion ask for torques about an axis that are read earlier or later
    than forces."""
    if fit is None:
        return []
    places = {axis: place - len(ROTATIONAL_AXES) for place, axis in enumerate(ROTATIONAL_AXES)}
    variance = np.sum([np.diag(part.covariance) for part in fit.parts], axis=0)
    parts = [*fit.parts, Part(USUAL**2 * np.eye(len(fit.values)), MOST_FREEDOM)]
    late = {axis: float(fit.values[place]) for axis, place in places.items()}
    apart = {axis: by for axis, by in late.items() if abs(by) >= LEAST}
    if not apart or not is_wrong(fit.values, parts, [*places.values()]):
        return []
    each = ", ".join(
        f"{axis} {1e3 * abs(by):.0f} ± {1e3 * NORMAL95 * np.sqrt(variance[places[axis]]):.0f} ms "
        f"{'behind' if by > 0 else 'ahead'}"
        for axis, by in apart.items()
    )
    text = (
        f"the force sensors' torques are read at other moments than their forces: {each} (95 %), and damping follows "
        "them (valid: all channels of a sensor read at one moment, behind the same filter)"
    )
    return [Note(TORQUES_LATE, "warning", text)]

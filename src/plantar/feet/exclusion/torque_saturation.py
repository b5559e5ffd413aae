"""A sole that tips over its edge where no centre of pressure tells: the torque stops growing with the angle."""

from __future__ import annotations

import numpy as np

from plantar.contact.reasons import Reason
from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.robot.model import RobotModel

SHELLS = 60  # into which the angles from the resting pose are sorted
BENT = 0.5  # of the first slope: below it for good, the torque has stopped growing
LEAST_SHELL = np.radians(0.02)  # rad: narrower shells hold noise
BIN = np.radians(0.25)  # rad: as closely the resting pose is known


def without_torque_saturation(robot: RobotModel, recording: Recording, settings: FeetSettings) -> Recording:
    """The recording without samples beyond the bend of torque over angle, or beyond `settings.window`."""
    for foot, bush in recording.bushes.items():
        for column, axis in enumerate(ROTATIONAL_AXES):
            used = recording.used(foot)
            if used.sum() < 100:
                continue
            angle = bush.deflection[:, column] - _resting(bush.deflection[used, column])
            if settings.window is not None:
                beyond = np.abs(angle) > settings.window
                recording = recording.without(
                    foot, beyond, Reason.WINDOW, f"{np.degrees(settings.window):.3g} deg"
                )
            if robot.feet[foot].contact != "always":
                continue
            for side, name in ((1.0, "positive"), (-1.0, "negative")):
                bend = _bend(side * angle[used], side * bush.torque[used, column])
                if bend is not None:
                    where = f"{axis} more than {np.degrees(bend):.2f} deg {name} of the resting pose"
                    recording = recording.without(foot, side * angle > bend, Reason.TORQUE_SATURATION, where)
    return recording


def _resting(angles: Array) -> float:
    """The pose in which the foot spends most of its time: the fullest of narrow bins."""
    spread = float(np.ptp(angles))
    if spread < LEAST_SHELL:  # it does not turn: bins of rounding errors do not exist
        return float(np.median(angles))
    counts, edges = np.histogram(angles, bins=max(20, round(spread / BIN)))
    fullest = int(np.argmax(counts))
    return float((edges[fullest] + edges[fullest + 1]) / 2)


def _bend(angle: Array, torque: Array) -> float | None:
    """The angle beyond which torque grows at less than BENT of its first slope for good; None where there is none."""
    outward = angle > 0
    if outward.sum() < 30:
        return None
    reach = float(angle.max())
    width = max(reach / SHELLS, LEAST_SHELL)
    if reach < 8 * width:
        return None
    shell = np.floor(angle[outward] / width).astype(int)
    filled = np.unique(shell)
    centre = (filled + 0.5) * width
    usual = np.array([np.median(torque[outward][shell == k]) for k in filled])
    highest = np.maximum.accumulate(usual)
    half = highest[0] + (highest[-1] - highest[0]) / 2
    first = centre <= centre[np.argmax(highest >= half)]
    if first.sum() < 2 or highest[-1] <= highest[0]:
        return None
    slope = np.polyfit(centre[first], usual[first], 1)[0]
    local = np.gradient(usual, centre)
    bent = local < BENT * slope
    growing = np.flatnonzero(~bent)
    last = int(growing[-1]) + 1 if growing.size else 0
    return float(centre[last]) if last < len(centre) - 2 else None

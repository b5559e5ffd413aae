"""A channel of a force sensor that reads exactly nothing wherever it is small: a driver's dead band."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plantar.contact.phases import LANDING_SHARE
from plantar.conventions import GRAVITY, Array
from plantar.faults.channels import named
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.notes import Finding
from plantar.robot.model import RobotModel

LEAST_SHARE = 0.01  # of the loaded samples that read exactly 0
OFTEN = 5.0  # times as often as the next value: of one that reads in steps, 0 is one of many
FINE = 200  # other values: fewer are a channel that reads in steps as large as its torque
DEAD_BAND, DEAD_FORCE = "dead_band", "dead_force"


def check_dead_bands(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """Forces of a loaded foot, and torques about its horizontal axes, that are exactly 0 far more often than any other
    value: forces go into the bush's torque by its height over the sensor."""
    for foot in robot.feet.values():
        names = wrench_columns(foot.wrench.name)
        squares = np.zeros(len(log))
        for name in names[:3]:
            squares += log.column(name) ** 2
        loaded = squares > (LANDING_SHARE * robot.mass * GRAVITY) ** 2
        dead = [name for name in names[:5] if _share_at_zero(log.column(name)[loaded]) > LEAST_SHARE]
        if dead:
            text = (
                f"{named(dead)}: exactly 0 far more often than any other value while the foot carries load: a "
                "dead band of the driver, or lost values"
            )
            yield Finding(
                DEAD_BAND, f"{text} (valid: forces and torques as measured; empty cells for lost values)"
            )


def _share_at_zero(values: Array) -> float:
    """The share of exact zeros; 0 where another value comes about as often, or there are few others."""
    values = values[np.isfinite(values)]
    others, counts = np.unique(values[values != 0], return_counts=True)
    zeros = len(values) - int(counts.sum())
    return zeros / len(values) if len(others) >= FINE and zeros > OFTEN * counts.max() else 0.0

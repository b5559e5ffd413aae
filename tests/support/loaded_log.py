"""A small log of two feet that carry the robot, with columns of a test's own."""

from __future__ import annotations

import numpy as np

from biped import WEIGHT
from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog

PERIOD = 0.01
PARTS = [f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]


def made(
    seconds: float, columns: dict[str, Array], load: float | Array = WEIGHT / 2, period: float = PERIOD
) -> MotionLog:
    """A log of both feet loaded alike [N], and of `columns`; its sensors have noise, unlike a simulation's."""
    time = period * np.arange(round(seconds / period))
    noise = 1e-3 * np.sin(np.arange(time.size))
    wrenches = {f"wrench.{foot}.{part}": noise for foot in ("left", "right") for part in PARTS}
    wrenches |= {f"wrench.{foot}.force.z": load + noise for foot in ("left", "right")}
    return MotionLog("log", time, wrenches | columns)

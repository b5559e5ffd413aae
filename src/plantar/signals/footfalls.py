"""When a foot lands or leaves the ground, by the size of what its force sensor reads."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import FORCE
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.signals.medians import running_median

LOADED = 0.1  # of a foot's largest force: where it passes this, the foot lands or leaves
LONE = 5  # samples over which a median is taken: no lone sample lands a foot


def footfalls(log: MotionLog, sensor: str) -> NDArray[np.intp]:
    """Samples after which the foot on this force sensor lands or leaves; none without its three forces."""
    columns = wrench_columns(sensor)[FORCE]
    if len(log) < LONE or not log.has(*columns):
        return np.zeros(0, dtype=np.intp)
    squares = sum((log.column(name) ** 2 for name in columns), np.zeros(len(log)))
    steady = running_median(np.nan_to_num(np.sqrt(squares)), LONE)
    return LONE // 2 + np.flatnonzero(np.diff(steady > LOADED * steady.max()))

"""What an attitude drifts by over a recording, in columns: a line, and cosines slower than usual motions."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array

DRIFT_PERIOD = 20.0  # s: attitudes wander more slowly, motions that were asked for are twice as quick or more
QUICK = 0.5  # of a motion's squares about its line: where cosines leave less, the motion itself is slow


def drift_columns(time: Array) -> Array:
    """A line and cosines down to `DRIFT_PERIOD` over the times (n,) [s] of samples: (n, m), each of mean zero."""
    if not time.size:
        return np.zeros((0, 1))
    length = float(np.ptp(time))
    share = (time - time[0]) / max(length, 1e-9)
    orders = np.arange(1, int(2 * length / DRIFT_PERIOD) + 1)
    columns = np.column_stack([time, np.cos(np.pi * np.outer(share, orders))])
    return np.asarray(columns - columns.mean(axis=0))


def drift_beside(motion: Array, time: Array) -> Array:
    """The columns of drift that `motion` (n,) at the times (n,) [s] can be told from: of a slow motion, the line alone.

    A drift that is left in the angle draws the stiffness to zero, as noise does; but a foot that leans once in half a
    minute shows its stiffness in nothing but slow angles.
    """
    columns = drift_columns(time)
    about = motion - np.sum(motion) / max(len(motion), 1)
    taken = (
        np.linalg.qr(columns)[0].T @ about
    ) ** 2  # the line's squares, then what each cosine takes beside it
    beside_line = float(about @ about) - float(taken[:1].sum())
    return columns if taken[1:].sum() < (1 - QUICK) * beside_line else columns[:, :1]

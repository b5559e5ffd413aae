"""What an attitude drifts by over a recording, in columns: a line, and cosines slower than usual motions."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from plantar.conventions import Array
from plantar.estimation.orthonormal import orthonormal

DRIFT_PERIOD = 20.0  # s: attitudes wander more slowly, motions that were asked for are twice as quick or more
MOST_COSINES = 60  # of ten minutes: a longer recording's drift is followed less closely, at bounded cost
KEPT = 4  # bases of the samples that were last asked about
QUICK = 0.5  # of a motion's squares about its line: where cosines leave less, the motion itself is slow


def drift_basis(time: Array) -> Array:
    """Orthonormal columns (n, m) of mean zero over the times (n,) [s] of samples: of a line, which is first, and of
    cosines down to `DRIFT_PERIOD`."""
    return _basis(np.asarray(time - time[:1], dtype=np.float64).tobytes())


@lru_cache(maxsize=KEPT)
def _basis(since: bytes) -> Array:
    """The columns over times since the first sample: both axes of a foot, and often both feet, ask for the same."""
    time = np.frombuffer(since)
    if not time.size:
        return np.zeros((0, 1))
    length = float(time[-1])
    share = time / max(length, 1e-9)
    columns = np.empty((1 + min(int(2 * length / DRIFT_PERIOD), MOST_COSINES), len(time)))
    columns[0] = time
    # Each cosine from those before it: cos(k + 1)x = 2 cos x · cos kx - cos(k - 1)x.
    twice, before, last = 2 * np.cos(np.pi * share), np.cos(np.pi * share), np.ones(len(time))
    for cosine in columns[1:]:
        cosine[:] = twice * last - before
        before, last = last, cosine
    columns -= columns.mean(axis=1, keepdims=True)
    basis = orthonormal(columns.T)
    basis.setflags(write=False)
    return basis


def drift_beside(motion: Array, basis: Array) -> Array:
    """Those columns (n, k) of a `drift_basis` that `motion` (n,) can be told from: of a slow motion, the line alone.

    A drift that is left in the angle draws the stiffness to zero, as noise does; but a foot that leans once in half a
    minute shows its stiffness in nothing but slow angles.
    """
    about = motion - np.sum(motion) / max(len(motion), 1)
    taken = (basis.T @ about) ** 2
    beside_line = float(about @ about) - float(taken[:1].sum())
    return basis if taken[1:].sum() < (1 - QUICK) * beside_line else basis[:, :1]

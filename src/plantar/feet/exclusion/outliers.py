"""Short stretches in which the torque leaves its law as it does nowhere around them: left out, with their reason."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from plantar.contact.deflection import BushState
from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.regression_data import FEWEST_SAMPLES, model_columns
from plantar.feet.recording import Recording
from plantar.models import BushModel
from plantar.signals.segments import runs

BIN = 0.1  # s
AROUND = 6.0  # s whose usual misfit a bin is compared with
FAR_MISFITS = 6.0  # usual misfits
WORTH = 0.03  # of the recording's spread of torque: a smaller misfit does no harm
LONGEST = 1.0  # s: what lasts longer is not a bad sample but another law
MOST = 0.1  # share of a recording that may be outliers
MOVING = 0.1  # share of the squares of both angle and torque: a stretch with so much is what the motion consists of
ROUNDS = 3  # a large outlier hides smaller ones


def fit_without_outliers(
    recordings: Sequence[Recording], foot: str, axis: Axis, fit: Callable[[BushModel | None], AxisFit | None]
) -> AxisFit | None:
    """What `fit` makes of the recordings; where short stretches leave its law by far, again without them.

    They are left out of the recordings' contacts with a reason. Clean recordings are fitted once and stay as they are.
    `fit` chooses a law where it is given none: of all recordings, and of what serves in the end.
    """
    found, several = fit(None), False
    for _ in range(ROUNDS):
        if found is None or not _left_out(recordings, foot, axis, found):
            break
        found, several = fit(found.model), True
    return fit(None) if several else found


def _left_out(recordings: Sequence[Recording], foot: str, axis: Axis, fit: AxisFit) -> bool:
    """Leave outliers out; whether there were any."""
    column, several = ROTATIONAL_AXES.index(axis), False
    for recording in recordings:
        used = recording.used(foot)
        if recording.name not in fit.offsets or used.sum() < FEWEST_SAMPLES:
            continue
        torque = recording.bushes[foot].torque[:, column]
        missed = torque - model_columns(recording, foot, axis, fit) @ fit.values
        reach = 1 / recording.cutoff
        off = outliers(np.where(used, missed, np.nan), float(np.std(torque[used])), recording.period, reach)
        moved = _motion_until(recording.bushes[foot], used) if off.any() else np.zeros((0, 2, 2))
        for run in runs(off):
            # The motion of either axis, of its angle and its torque, may lie in one stretch for a large part.
            off[run] = (moved[run.stop] - moved[run.start]).min(axis=0).max() <= MOVING
        if off.any():
            recording.contacts[foot].leave_out(off, f"outlier: the {axis} torque leaves its law for a moment")
            several = True
    return several


def _motion_until(bush: BushState, used: Mask) -> Array:
    """Share of the squares of angle and torque, of pitch and roll, before each sample that serves, (N + 1, 2, 2)."""
    both = np.stack([bush.deflection, bush.torque], axis=1)
    squares = np.where(used[:, None, None], both - both[used].mean(axis=0), 0.0) ** 2
    until = np.concatenate([np.zeros((1, 2, 2)), np.cumsum(squares, axis=0)])
    return np.asarray(until / np.maximum(until[-1], 1e-300))


def outliers(missed: Array, spread: float, period: float, reach: float) -> Mask:
    """Samples of short stretches in which `missed` (N,), NaN where nothing serves, is far larger than around them.

    `spread` is that of the torque [N·m]; `reach` [s] the filter's, by which stretches are widened.
    """
    width = max(1, round(BIN / period))
    bins = -(-len(missed) // width)
    padded = np.append(missed, np.full(bins * width - len(missed), np.nan)).reshape(bins, width)
    used = np.isfinite(padded).sum(axis=1) > width // 2
    none = np.zeros(len(missed), dtype=bool)
    if used.sum() < AROUND / BIN:
        return none
    level = np.nanmean(padded[used], axis=1)
    # Over the bins that serve, the usual level around each, and the usual distance from it.
    usual = _median_around(level)
    size = np.sqrt(np.nanmean((padded[used] - usual[:, None]) ** 2, axis=1))
    scale = _median_around(size)
    far = np.zeros(bins, dtype=bool)
    far[used] = size > np.maximum(FAR_MISFITS * scale, WORTH * spread)
    found = none.copy()
    margin = round(reach / period)
    for run in runs(far):
        if (run.stop - run.start) * BIN <= LONGEST:
            found[max(0, run.start * width - margin) : run.stop * width + margin] = True
    found &= np.isfinite(missed)
    return found if found.sum() <= MOST * np.isfinite(missed).sum() else none


def _median_around(values: Array) -> Array:
    """Median of the bins (n,) around each, mirrored at the ends."""
    half = round(AROUND / 2 / BIN)
    wide = np.pad(values, half, mode="reflect")
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(wide, 2 * half + 1), axis=1))

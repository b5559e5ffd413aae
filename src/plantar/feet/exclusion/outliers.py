"""Short stretches in which the torque leaves its model as it does nowhere around them: left out, with their reason."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.contact.deflection import BushState
from plantar.conventions import ROTATIONAL_AXES, Array, Mask
from plantar.estimation.errors_in_variables import FEWEST
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.prediction import predict
from plantar.signals.medians import running_median
from plantar.signals.segments import runs

BIN = 0.1  # s of samples that are judged together: shorter than any motion
AROUND = 6.0  # s whose usual misfit a bin is compared with
FAR_MISFITS = 6.0  # usual misfits
WORTH = 0.03  # of the recording's spread of torque: a smaller misfit, or a jump of the zero, does no harm
LONGEST = 1.0  # s: what lasts longer is not a bad sample but another behaviour
MOST = 0.1  # share of a recording that may be outliers
MOVING = 0.1  # share of the squares of both angle and torque: a stretch with so much is what the motion consists of


def outlier_masks(recordings: Sequence[Recording], fitted: FittedModel) -> dict[str, Mask]:
    """By recording, the samples (N,) in which one axis leaves its fitted model; none where there are none."""
    foot, column, found = fitted.foot, ROTATIONAL_AXES.index(fitted.axis), {}
    for recording in recordings:
        used = recording.used(foot)
        if recording.name not in fitted.offsets or used.sum() < FEWEST:
            continue
        torque = recording.bushes[foot].torque[:, column]
        prediction = predict(recording, fitted)
        assert prediction is not None, "a fitted recording"
        missed = np.where(used, torque - prediction.torque, np.nan)
        off = outliers(missed, float(np.std(torque[used])), recording.period, 1 / recording.cutoff)
        moved = _motion_until(recording.bushes[foot], used) if off.any() else np.zeros((0, 2, 2))
        for run in runs(off):
            # The motion of either axis, of its angle and its torque, may lie in one stretch for a large part.
            off[run] = (moved[run.stop] - moved[run.start]).min(axis=0).max() <= MOVING
        if off.any():
            found[recording.name] = off
    return found


def _motion_until(bush: BushState, used: Mask) -> Array:
    """Share of the squares of angle and torque, of pitch and roll, before each used sample, (N + 1, 2, 2)."""
    both = np.stack([bush.deflection, bush.torque], axis=1)
    squares = np.where(used[:, None, None], both - both[used].mean(axis=0), 0.0) ** 2
    until = np.concatenate([np.zeros((1, 2, 2)), np.cumsum(squares, axis=0)])
    return np.asarray(until / np.maximum(until[-1], 1e-300))


def outliers(missed: Array, spread: float, period: float, reach: float) -> Mask:
    """Samples of short stretches in which `missed` (N,), NaN where nothing is used, is far larger than around them.

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
    # Over the bins with used samples, the usual level around each, and the usual distance from it.
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
    return running_median(wide, 2 * half + 1)

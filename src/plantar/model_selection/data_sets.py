"""One recording of one axis, ready for any law: thinned out to what the filter leaves, both sides filtered alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from plantar.conventions import Array, Mask
from plantar.models import BushModel, BushMotion
from plantar.signals.filters import low_pass

SAMPLES_PER_CYCLE = 7  # of the filter's cutoff, that thinning keeps
THIN_BAND = 4.0  # cutoffs, that survive thinning


@dataclass(frozen=True)
class DataSet:
    """One axis of one foot over one recording: wide-band `motion` and `torque` (N,), and the samples that serve.

    Both sides unfiltered, or filtered alike well above the fit's cutoff.
    """

    label: str
    motion: BushMotion
    torque: Array
    used: Mask

    def thinned(self, cutoff: float) -> DataSet:
        """Every nth sample, after a filter well above `cutoff` [Hz]; itself where it is slow already."""
        period = self.motion.period
        stride = int(1 / (period * SAMPLES_PER_CYCLE * cutoff) + 1e-6)
        if stride < 2:
            return self
        band = THIN_BAND * cutoff
        motion = self.motion
        pairs = np.column_stack([motion.deflection, motion.rate])
        path = low_pass(pairs, period, band)
        across = None if motion.across is None else low_pass(motion.across, period, band)[::stride]
        across_rate = (
            None if motion.across_rate is None else low_pass(motion.across_rate, period, band)[::stride]
        )
        torque = np.where(np.isfinite(path[:, 0]), self.torque, np.nan)
        thin = BushMotion(path[::stride, 0], path[::stride, 1], period * stride, across, across_rate)
        return DataSet(self.label, thin, low_pass(torque, period, band)[::stride], self.used[::stride])


@dataclass(frozen=True)
class FilteredDataSet:
    """A trial through the fit's filter: `motion` (N,), the samples that serve, and the `response` (n,) at these.

    A law with memory does not commute with a filter: its state follows the path, and its columns then go through the
    filter that the torque went through. The path itself is filtered too: jitter of the measured angle would wear the
    state down at every turn (a Bouc-Wen element forgets under dither), which the rubber, not shaken, does not do.

    With `drift`, response and columns come without their line in time: the IMU's attitude drifts slowly, differently in
    each recording, which is the same as fitting such a line beside the offset.
    """

    label: str
    motion: BushMotion
    response: Array
    used: Mask
    cutoff: float
    drift: bool

    @classmethod
    def of(cls, data_set: DataSet, cutoff: float, *, drift: bool = True) -> FilteredDataSet:
        """Filter both sides at `cutoff` [Hz]; samples without a value on either side do not serve."""
        motion = data_set.motion
        whole = np.isfinite(motion.deflection) & np.isfinite(motion.rate) & np.isfinite(data_set.torque)
        values = np.column_stack([motion.deflection, motion.rate, data_set.torque])
        values[~whole] = np.nan
        smooth = low_pass(values, motion.period, cutoff)
        across = None if motion.across is None else low_pass(motion.across, motion.period, cutoff)
        across_rate = (
            None if motion.across_rate is None else low_pass(motion.across_rate, motion.period, cutoff)
        )
        path = BushMotion(smooth[:, 0], smooth[:, 1], motion.period, across, across_rate)
        used = data_set.used & np.isfinite(smooth).all(axis=1)
        raw = cls(data_set.label, path, smooth[used, 2], used, cutoff, drift)
        return replace(raw, response=raw.without_drift(raw.response))

    def without_drift(self, rows: Array) -> Array:
        """Samples that serve, (n, ...), without their line in time; their means stay."""
        time = np.flatnonzero(self.used).astype(np.float64)
        time -= time.mean() if time.size else 0.0
        power = float(time @ time)
        if not self.drift or power == 0:
            return rows
        flat = rows.reshape(len(rows), -1)
        return np.asarray(flat - np.outer(time, time @ flat / power)).reshape(rows.shape)

    @cached_property
    def base(self) -> Array:
        """The linear columns, deflection and rate, at the samples that serve, (n, 2)."""
        return self.without_drift(np.column_stack([self.motion.deflection, self.motion.rate])[self.used])

    @cached_property
    def run_of(self) -> Array:
        """The run's number at every sample that serves, (n,)."""
        number = np.full(len(self.motion), -1)
        for place, run in enumerate(self.motion.runs):
            number[run] = place
        return number[self.used]

    def filtered(self, extra: Array) -> Array:
        """Columns (N, e, b) of a law through the filter, at the samples that serve: (n, e, b)."""
        if extra.shape[1] == 0:
            return extra[self.used]
        smooth = low_pass(extra.reshape(len(extra), -1), self.motion.period, self.cutoff)
        return self.without_drift(smooth[self.used].reshape(-1, *extra.shape[1:]))


def prepare_data_sets(
    data_sets: Sequence[DataSet], cutoff: float, *, drift: bool = True
) -> list[FilteredDataSet]:
    """Thinned and filtered trials that have samples to serve."""
    prepared = [FilteredDataSet.of(data_set.thinned(cutoff), cutoff, drift=drift) for data_set in data_sets]
    return [each for each in prepared if each.used.any()]


def filtered_columns(
    model: BushModel, prepared: Sequence[FilteredDataSet], shapes: Array, initial_states: Sequence[Array]
) -> list[Array]:
    """A law's columns beside the linear two at the samples that serve, (n, e, b) for each trial."""
    extras = model.extra([each.motion for each in prepared], shapes, initial_states)
    return [each.filtered(extra) for each, extra in zip(prepared, extras, strict=True)]

"""One recording of one axis, ready for any model: thinned out to what the filter leaves, both sides filtered alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array, Mask
from plantar.estimation.orthonormal import SlowSpan, orthonormal, without
from plantar.estimation.slow_drift import DRIFT_PERIOD, drift_basis, drift_beside
from plantar.models import BESIDE, BushModel, BushMotion
from plantar.signals.filters import SHORTEST_FITTED_RUN, low_pass

SAMPLES_PER_CYCLE = 7  # of the filter's cutoff, that thinning keeps
# Likewise, of those that a fit takes: at their Nyquist frequency the filter leaves less than a two hundredth.
ROWS_PER_CYCLE = 4
THIN_BAND = 4.0  # cutoffs, that survive thinning
# Likewise, of the path that a memory follows through short stances: of four, slip angles lack half a per cent.
PATH_BAND = 6.0
# So that a turn between two samples is seen: half as many take another half a per cent off slip angles.
SAMPLES_PER_CYCLE_IN_STANCES = 32


@dataclass(frozen=True)
class StepColumns:
    """Of a foot that steps, for each sample: its `stance` (N,), and columns whose own torque is a `nuisance` (N, m).

    `share` (0 to 1) of a stance's mean is taken off its samples: 1 where the offsets of stances are free, 0 where they
    are all alike (random effects as a partial centring; W. A. Fuller, G. E. Battese, J. Econometrics 2, 1974).
    """

    stance: NDArray[np.intp]
    nuisance: Array
    share: float

    def thinned(self, stride: int) -> StepColumns:
        """Every nth sample."""
        return StepColumns(self.stance[::stride], self.nuisance[::stride], self.share)

    def centred(self, rows: Array, place: NDArray[np.intp]) -> Array:
        """Rows (n, m) of the used samples less that share of their stances' means; the mean of all stays.

        place: (n,), the number of each row's stance, in order.
        """
        count = np.bincount(place)
        sums = np.add.reduceat(rows, np.cumsum(count) - count)
        apart = sums / count[:, None] - sums.sum(axis=0) / len(rows)
        return np.asarray(rows - np.repeat(self.share * apart, count, axis=0))


@dataclass(frozen=True)
class DataSet:
    """One axis of one foot over one recording: wide-band `motion` and `torque` (N,), and the used samples.

    Both sides unfiltered, or filtered alike well above the fit's cutoff. `drift` (N,) is taken off the path that a
    memory follows, and off nothing else.
    """

    label: str
    motion: BushMotion
    torque: Array
    used: Mask
    steps: StepColumns | None = None
    drift: Array | None = None

    def thinned(self, cutoff: float) -> DataSet:
        """Every nth sample, after a filter well above `cutoff` [Hz]; itself where it is slow already."""
        period = self.motion.period
        samples, cutoffs = SAMPLES_PER_CYCLE, THIN_BAND
        if self.steps is not None:
            samples, cutoffs = SAMPLES_PER_CYCLE_IN_STANCES, PATH_BAND
        stride = int(1 / (period * samples * cutoff) + 1e-6)
        if stride < 2:
            return self
        band = cutoffs * cutoff
        motion = self.motion
        pairs = np.column_stack([motion.deflection, motion.rate])
        path = low_pass(pairs, period, band, SHORTEST_FITTED_RUN)
        across = None if motion.across is None else low_pass(motion.across, period, band, every=stride)
        across_rate = (
            None if motion.across_rate is None else low_pass(motion.across_rate, period, band, every=stride)
        )
        torque = np.where(np.isfinite(path[:, 0]), self.torque, np.nan)
        thin = BushMotion(path[::stride, 0], path[::stride, 1], period * stride, across, across_rate)
        smooth = low_pass(torque, period, band, SHORTEST_FITTED_RUN, stride)
        steps = None if self.steps is None else self.steps.thinned(stride)
        drift = None if self.drift is None else self.drift[::stride]
        return DataSet(self.label, thin, smooth, self.used[::stride], steps, drift)


@dataclass(frozen=True)
class FilteredDataSet:
    """A data set through the fit's filter: `motion` (N,), of `every` nth sample those that are `used`, and the
    `response` (n,) at these. The filter leaves no more to a fit; a state's turns take all samples.

    A model with memory does not commute with a filter: its state follows the path, and its columns then go through the
    filter that the torque went through. The path itself is filtered too: jitter of the measured angle would wear the
    state down at every turn (dither makes a Bouc-Wen element's memory fade), which the rubber itself does not feel.
    Where the foot steps, turns are too quick for that: the state follows the wide-band `path`.

    Response and columns come without what drifts slowly, as the IMU's attitude does, differently in each recording: the
    span of the columns `slow`, which is the same as fitting these beside the offset. Where the foot steps, it is
    what `steps` holds that is taken off instead.
    """

    label: str
    motion: BushMotion
    path: BushMotion
    response: Array
    used: Mask
    cutoff: float
    slow: SlowSpan | None
    steps: StepColumns | None = None
    every: int = 1

    @classmethod
    def of(cls, data_set: DataSet, cutoff: float, *, drift: bool = True) -> FilteredDataSet:
        """Filter both sides at `cutoff` [Hz]; samples without a value on either side are not used."""
        motion = data_set.motion
        whole = np.isfinite(motion.deflection) & np.isfinite(motion.rate) & np.isfinite(data_set.torque)
        values = np.column_stack([motion.deflection, motion.rate, data_set.torque])
        values[~whole] = np.nan
        smooth = low_pass(values, motion.period, cutoff, SHORTEST_FITTED_RUN)
        across = None if motion.across is None else low_pass(motion.across, motion.period, cutoff)
        across_rate = (
            None if motion.across_rate is None else low_pass(motion.across_rate, motion.period, cutoff)
        )
        slow = BushMotion(smooth[:, 0], smooth[:, 1], motion.period, across, across_rate)
        known = np.isfinite(smooth).all(axis=1)
        away = np.where(known, 0.0, np.nan)
        quick = replace(motion, deflection=motion.deflection + away, rate=motion.rate + away)
        path = slow if data_set.steps is None else quick
        if data_set.drift is not None:
            path = replace(path, deflection=path.deflection - data_set.drift)
        every = max(1, int(1 / (motion.period * ROWS_PER_CYCLE * cutoff) + 1e-6))
        kept, used = smooth[::every], (data_set.used & known)[::every]
        own, steps = None, None if data_set.steps is None else data_set.steps.thinned(every)
        if drift and steps is None:
            time = np.flatnonzero(used).astype(np.float64) * every * motion.period
            own = SlowSpan(drift_beside(kept[used, 0], drift_basis(time)), time, DRIFT_PERIOD)
        raw = cls(data_set.label, slow, path, kept[used, 2], used, cutoff, own, steps, every)
        return replace(raw, response=raw.without_nuisance(raw.response))

    def without_nuisance(self, rows: Array) -> Array:
        """Samples that are used, (n, ...), without what is their recording's own; their means stay."""
        if not len(rows):
            return rows
        flat = rows.reshape(len(rows), -1)
        if self.steps is not None:
            flat = without(self._nuisance, self.steps.centred(flat, self._stance))
        elif self.slow is not None:
            flat = self.slow.off(flat)
        return flat.reshape(rows.shape)

    @property
    def drift(self) -> Array:
        """Orthonormal columns (n, m) of what drifts slowly; none where the foot steps or nothing is taken to drift."""
        return np.zeros((len(self.response), 0)) if self.slow is None else self.slow.basis

    @cached_property
    def _nuisance(self) -> Array:
        """Orthonormal columns (n, m) of what is the recording's own, about their means; of a foot that steps."""
        assert self.steps is not None, "asked only where the foot steps"
        nuisance = self.steps.centred(self.steps.nuisance[self.used], self._stance)
        return orthonormal(nuisance - nuisance.mean(axis=0))

    @cached_property
    def _stance(self) -> NDArray[np.intp]:
        """The number of each used sample's stance among those used, (n,); of a foot that steps."""
        assert self.steps is not None, "asked only where the foot steps"
        return np.asarray(np.unique(self.steps.stance[self.used], return_inverse=True)[1])

    @cached_property
    def base(self) -> Array:
        """The linear columns, deflection and rate, at the used samples, (n, 2)."""
        columns = np.column_stack([self.motion.deflection, self.motion.rate])
        return self.without_nuisance(columns[:: self.every][self.used])

    @property
    def duration(self) -> float:
        """Of the used samples [s]."""
        return len(self.response) * self.every * self.motion.period

    @cached_property
    def run_of(self) -> Array:
        """The run's number at every used sample, (n,)."""
        number = np.full(len(self.motion), -1)
        for place, run in enumerate(self.motion.runs):
            number[run] = place
        return number[:: self.every][self.used]


def prepare_data_sets(data_sets: Sequence[DataSet], cutoff: float, *, drift: bool) -> list[FilteredDataSet]:
    """Thinned and filtered data sets that have samples to use."""
    prepared = [FilteredDataSet.of(data_set.thinned(cutoff), cutoff, drift=drift) for data_set in data_sets]
    return [each for each in prepared if each.used.any()]


def filtered_columns(
    model: BushModel, prepared: Sequence[FilteredDataSet], shapes: Array, initial_states: Sequence[Array]
) -> Array:
    """A model's columns beside the linear two through the filter, at the used samples: (n, e, b), those of all data
    sets one below the other."""
    rows, count = [len(each.response) for each in prepared], len(model.terms) - len(BESIDE)
    found = np.empty((sum(rows), count, len(shapes)))
    if not count:
        return found
    for each, start, last in zip(prepared, initial_states, np.cumsum(rows), strict=True):
        extra = model.basis_columns(each.path, shapes, start)
        smooth = low_pass(extra, each.motion.period, each.cutoff, SHORTEST_FITTED_RUN, each.every)
        found[last - len(each.response) : last] = each.without_nuisance(smooth[each.used])
    return found

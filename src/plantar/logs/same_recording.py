"""Whether two logs hold one recording, or a part of one: told twice, it would narrow every interval.

Copies, cuts and thinned logs have samples in common. One that was resampled, rounded or filtered has none, but still
the noise of its sensors: no two recordings share that, not even of one motion played twice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.fft import irfft, rfft
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog

Spectrum = NDArray[np.complexfloating]

PROBES = 40  # samples of a log that another one may hold as well
OVERLAP = 0.1  # share of a log that another may hold too: it narrows intervals by a twentieth at most
BEGUN_ALIKE = 0.5  # the same of logs that begin alike, as simulations without noise do before they part
CHANNELS = 6  # columns whose noise is compared
SLOWEST, FASTEST = 5.0, 50.0  # Hz: noise above the motion, and below most sensors' own filters
RATE = 2 * FASTEST
OF_RATE = 0.4  # of a log's rate: what resampling leaves as it was
EDGE = 0.2  # of a log at each end, over which it fades in: cut edges would look alike
FINER = 4  # times: lags are looked for in parts of a sample
# Deviations by which the phases of one recording agree more than chance: 20 and more if it holds half of the other
# one. Other recordings of noisy sensors reach 6; where impacts agree far more, the next limit tells them apart.
AGREE = 10.0
WINDOW = 25  # samples at RATE
SHORTEST = 2.0  # s
# Correlation of the noise in nine of ten windows: it is alike wherever both logs last. 0.38 and more of one recording,
# 0 at most of one motion played twice, whose impacts are alike, but not the noise between them.
QUIET, ALIKE = 10, 0.2  # percentile, correlation
# Correlation of the motion, where both logs last: a simulator's noise may be the same in all motions.
SAME_MOTION = 0.7
# Share of a column's deviation in those windows: 2e-4 and more of noise, filtered and thinned; 4e-5 at most of
# simulations without any, which are alike even on other rubber.
NOISY = 1e-4


def same_samples(log: MotionLog, other: MotionLog) -> bool:
    """Whether many of the shorter log's samples are samples of the longer one: as they are, cut, thinned, on another
    clock, or with other columns beside the same force sensors: joints alone may do the same twice."""
    short, long = sorted((log, other), key=len)
    shared = sorted(short.columns.keys() & long.columns.keys())
    forces = any(name.startswith("wrench.") for name in shared)
    measured = forces or short.columns.keys() == long.columns.keys()
    if not shared or not len(short) or not measured:
        return False
    probes = np.linspace(0, len(short) - 1, PROBES).astype(int)
    # What has been left out of both tells nothing twice.
    whole = np.isfinite(np.sum([short.columns[name][probes] for name in shared], axis=0))
    probes = probes[whole] if whole.any() else probes
    told = {name: short.columns[name][probes] for name in shared}
    finest = max(told, key=lambda name: len(np.unique(told[name])))
    alike = np.isin(long.columns[finest], np.unique(told[finest]))
    asked, there = (
        {row.tobytes() for row in np.column_stack(columns)}
        for columns in (list(told.values()), [long.columns[name][alike] for name in told])
    )
    alike_at_first = all(short.columns[name][0] == long.columns[name][0] for name in shared)
    share = BEGUN_ALIKE if alike_at_first else OVERLAP
    # Noise-free logs may rest alike: that is one sample of all.
    return len(asked & there) > max(1, share * len(asked))


def same_noise(logs: Sequence[MotionLog]) -> Iterator[tuple[MotionLog, MotionLog]]:
    """Pairs of logs whose force sensors have the same noise, whatever their rates, clocks and digits."""
    if len(logs) < 2:
        return
    shared = sorted(set.intersection(*(set(log.columns) for log in logs)))
    sensors = [name for name in shared if name.startswith("wrench.")]
    names = sensors[:: max(1, len(sensors) // CHANNELS)]
    heard = [(log, noise) for log in logs if names and (noise := _noise(log, names)) is not None]
    if len(heard) < 2:
        return
    count = _fast(2 * max(noise.values.shape[1] for _, noise in heard))
    spectra = [rfft(noise.values, count) for _, noise in heard]
    for first, second in combinations(range(len(heard)), 2):
        if _alike(heard[first][1], heard[second][1], spectra[first], spectra[second], count):
            yield heard[first][0], heard[second][0]


def _fast(count: int) -> int:
    """The least length from `count` on that is two or three times a power of two: Fourier transforms of it are fast."""
    power: int = 2 ** (max(count, 2) - 1).bit_length()
    return power if count > 3 * power // 4 else 3 * power // 4


class _Noise(NamedTuple):
    """values (c, n) at RATE, each column's deviation being 1, of which `length` are the log's; what is faster than
    `top` [Hz] is not to be trusted. motion (c, n): what is slower than the noise."""

    values: Array
    motion: Array
    length: int
    top: float


def _noise(log: MotionLog, names: Sequence[str]) -> _Noise | None:
    """The columns between SLOWEST and FASTEST; None of a log that is too short or too slow for them."""
    time = log.time - log.time[:1]
    step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    if not step > 0 or OF_RATE / step < 2 * SLOWEST or time[-1] < SHORTEST:
        return None
    kept = _fast(int(np.ceil(FASTEST * time[-1])))
    lasts = kept / FASTEST
    count = _fast(int(np.ceil(lasts / step)))
    even = lasts / count * np.arange(count)
    fade = np.clip(np.minimum(even, time[-1] - even) / (EDGE * time[-1]), 0.0, 1.0)
    values, motion = np.zeros((2, len(names), 2 * kept))
    for row, slow, column in zip(values, motion, (log.columns[name] for name in names), strict=True):
        if (there := np.isfinite(column)).any():
            alone = column[there] - column[there].mean()
            alone /= max(float(alone.std()), np.finfo(float).tiny)
            spectrum = rfft(fade * np.interp(even, time[there], alone))[: kept + 1]
            slowest = round(SLOWEST * lasts)
            slow[:] = irfft(spectrum[:slowest], 2 * kept)
            spectrum[:slowest] = 0.0
            row[:] = irfft(spectrum, 2 * kept)
    return _Noise(values, motion, int(RATE * time[-1]), min(FASTEST, OF_RATE / step))


def _alike(one: _Noise, other: _Noise, first: Spectrum, second: Spectrum, count: int) -> bool:
    """Whether two logs' noise is the same at some lag, throughout the time in which both last; `first`, `second` (c,
    count // 2 + 1): its Fourier transforms of `count` samples."""
    least, most = (int(edge * count / RATE) for edge in (SLOWEST, min(one.top, other.top)))
    first, second = first[:, least:most], second[:, least:most]
    across = first * second.conj()
    sizes = np.abs(across)
    phases = np.divide(across, sizes, out=np.zeros_like(across), where=sizes > 0).sum(axis=0)
    enough = AGREE * np.sqrt(across.size)
    # Whole samples first: between two of them at least half is left of an agreement.
    if _agreement(phases, least, count, 1).max() < enough / 2:
        return False
    agreement = _agreement(phases, least, count, FINER)
    lag = int(np.argmax(agreement))
    if agreement[lag] < enough:
        return False
    second = second * np.exp(-2j * np.pi * np.arange(least, most) * lag / (FINER * count))
    later = lag / FINER - (
        count if lag > FINER * one.length else 0
    )  # samples by which the other log begins later
    start, stop = round(max(0.0, later)), round(min(one.length, later + other.length))
    windows = (stop - start) // WINDOW
    if windows < 1 or not _moved_alike(one.motion, other.motion, start, stop, round(later)):
        return False
    # Motion shakes the faster half the least; what it does shake, as where a foot lands, stays in its own window.
    faster = slice((least + most) // 2, most)
    smooth = np.hanning(most - faster.start)
    both = np.zeros((2, len(first), count // 2 + 1), complex)
    both[:, :, faster] = smooth * first[:, faster.start - least :], smooth * second[:, faster.start - least :]
    x, y = irfft(both, count)[:, :, start : start + windows * WINDOW].reshape(2, len(first), windows, WINDOW)
    quiet = [np.median(np.percentile(each.std(axis=2), QUIET, axis=1)) for each in (x, y)]
    if min(quiet) < NOISY:
        return False
    spread = np.sqrt((x**2).sum(axis=2) * (y**2).sum(axis=2))
    correlation = np.divide((x * y).sum(axis=2), spread, out=np.zeros_like(spread), where=spread > 0)
    return bool(np.percentile(np.median(correlation, axis=0), QUIET) > ALIKE)


def _agreement(phases: Spectrum, least: int, count: int, finer: int) -> Array:
    """Sum of cosines of phases from the frequency `least` on, (count * finer,), at lags of parts of a sample."""
    every = np.zeros(finer * count // 2 + 1, complex)
    every[least : least + len(phases)] = phases
    return np.asarray(irfft(every, finer * count) * (finer * count / 2))


def _moved_alike(first: Array, second: Array, start: int, stop: int, later: int) -> bool:
    """Whether columns (c, n) move alike from `start` to `stop` of the first, which the second begins `later` than."""
    there = np.arange(start, min(stop, first.shape[1], second.shape[1] + later))
    x, y = first[:, there], second[:, there - later]
    x, y = (each - each.mean(axis=1, keepdims=True) for each in (x, y))
    spread = np.sqrt((x**2).sum(axis=1) * (y**2).sum(axis=1))
    return bool(np.median((x * y).sum(axis=1)[spread > 0] / spread[spread > 0]) > SAME_MOTION)

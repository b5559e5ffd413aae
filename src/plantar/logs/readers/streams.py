"""Streams on clocks of their own, brought to one time base; what was not recorded stays a gap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plantar.conventions import Array, Mask
from plantar.errors import LogError
from plantar.logs.readers.read_limit import ReadLimit
from plantar.notes import Note

STRAY_STAMPS = 0.01  # share of a stream's stamps that may step back before the file is refused
GAP_PERIODS = 2.5  # a hole longer than this many usual periods is a gap, not a late sample
SAME_STAMP = 1e-7  # s: stamps this close are the same sample and are not interpolated
COMMON_SHARE = 0.5  # share of the base's span that all streams must cover for its ends to be cut to it


@dataclass(frozen=True)
class Stream:
    """Columns that share a clock: `time` (n,) [s] and arrays (n,) by the contract's column names."""

    name: str
    time: Array
    columns: dict[str, Array]

    @property
    def period(self) -> float:
        """The usual time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    def take(self, rows: Mask) -> Stream:
        columns = {name: values[rows] for name, values in self.columns.items()}
        return Stream(self.name, self.time[rows], columns)


def in_order(time: Array, latest: float = np.inf) -> Mask:
    """Which stamps (n,) come behind all those before them; none that is not finite or not below `latest`."""
    known = np.abs(time) < latest
    before = np.maximum.accumulate(np.where(known, time, -np.inf))
    known[1:] &= time[1:] > before[:-1]
    return np.asarray(known)


def increasing(stream: Stream, path: Path, notes: list[Note]) -> Stream:
    """The stream without samples whose stamp is NaN, repeats or steps back. LogError: more than a few do."""
    keep = in_order(stream.time)
    strays = np.flatnonzero(~keep)
    if strays.size == 0:
        return stream
    at = float(stream.time[strays[0] - 1]) if strays[0] else None
    if strays.size > max(1, STRAY_STAMPS * keep.size):
        message = f"{stream.name}: time does not increase in {strays.size} of {keep.size} samples, first here"
        valid = f"stamps that increase, but for {STRAY_STAMPS:.0%} of them"
        raise LogError(message, path=path, time=at, value=float(stream.time[strays[0]]), valid=valid)
    text = f"{path.name}: {stream.name}: {strays.size} samples whose time does not increase are left out"
    notes.append(Note("time_order", "warning", text))
    return stream.take(keep)


def merge(streams: Sequence[Stream], limit: ReadLimit, notes: list[Note]) -> tuple[Array, dict[str, Array]]:
    """One time base, (N,), for all streams: the clock of the one that ticks fastest, cut to what all cover.

    Between samples values are linear (quaternions along the shorter arc); in a hole of more than
    `GAP_PERIODS` periods, and outside a stream's span, they are NaN. Raises LogError when nothing is left,
    or when all columns at the fastest clock are more than `limit` allows.
    """
    path = limit.path
    kept = [increasing(stream, path, notes) for stream in streams]
    kept = [stream for stream in kept if stream.time.size >= 2]
    if not kept:
        raise LogError("holds fewer than two samples of joints, IMU or force sensors", path=path)
    base = _base(kept)
    time = base.time
    first, last = max(s.time[0] for s in kept), min(s.time[-1] for s in kept)
    span = time[-1] - time[0]
    if last - first >= COMMON_SHARE * span:
        cut = time[(time >= first - SAME_STAMP) & (time <= last + SAME_STAMP)]
        if span - (cut[-1] - cut[0]) > 0.1:
            text = f"cut to {cut[0]:.3f} ... {cut[-1]:.3f} s, which every stream covers"
            notes.append(Note("log_cut_to_overlap", "info", f"{path.name}: {text}"))
        time = cut
    else:
        text = "the streams hardly overlap in time; what a stream does not cover is missing"
        notes.append(Note("streams_apart", "warning", f"{path.name}: {text}"))
    if time.size < 2:
        raise LogError("the streams have no two samples in common", path=path)
    count = sum(len(stream.columns) for stream in kept)
    limit.columns(count)
    limit.numbers(time.size, count)
    columns: dict[str, Array] = {}
    resampled = []
    for stream in kept:
        values, exact = resample(stream, time)
        columns |= {name: column for name, column in values.items() if name not in columns}
        if not exact:
            resampled.append(stream.name)
    if resampled:
        text = f"resampled to the clock of {base.name} ({1 / base.period:.4g} Hz): {', '.join(resampled)}"
        notes.append(Note("streams_resampled", "info", f"{path.name}: {text}"))
    return time, columns


def _base(streams: Sequence[Stream]) -> Stream:
    """The fastest clock; among clocks equally fast to 1 %, joints before IMU before force sensors."""
    fastest = min(stream.period for stream in streams)
    near = [stream for stream in streams if stream.period <= 1.01 * fastest]
    for kind in ("joint.", "imu.", "wrench."):
        for stream in near:
            if any(name.startswith(kind) for name in stream.columns):
                return stream
    return near[0]


def resample(stream: Stream, time: Array) -> tuple[dict[str, Array], bool]:
    """A stream's columns at `time` (N,), and whether every value is a recorded one."""
    if stream.time.size == time.size and np.allclose(stream.time, time, rtol=0, atol=SAME_STAMP):
        return dict(stream.columns), True
    after = np.clip(np.searchsorted(stream.time, time), 1, stream.time.size - 1)
    before = after - 1
    step = stream.time[after] - stream.time[before]
    share = (time - stream.time[before]) / step
    near = np.where(share < 0.5, before, after)
    on_sample = np.abs(stream.time[near] - time) <= SAME_STAMP
    inside = (share >= 0) & (share <= 1) & (step <= GAP_PERIODS * stream.period)
    columns: dict[str, Array] = {}
    for names in _grouped(stream.columns):
        values = np.column_stack([stream.columns[name] for name in names])
        low, high = values[before], values[after]
        if len(names) == 4:  # a quaternion: q and -q are the same attitude
            high = np.where(np.sum(low * high, axis=1, keepdims=True) < 0, -high, high)
        between = low + share[:, None] * (high - low)
        if len(names) == 4:
            norm = np.linalg.norm(between, axis=1, keepdims=True)
            between = between / np.where(norm > 0, norm, np.nan)
        between[~inside] = np.nan
        between[on_sample] = values[near[on_sample]]
        columns |= {name: between[:, i].copy() for i, name in enumerate(names)}
    return columns, bool(on_sample.all())


def _grouped(columns: dict[str, Array]) -> list[list[str]]:
    """Column names one by one, but the four of a quaternion together."""
    groups: dict[str, list[str]] = {}
    for name in columns:
        stem, _, axis = name.rpartition(".")
        groups.setdefault(stem if stem.endswith(".orientation") and axis in "wxyz" else name, []).append(name)
    return [
        names for group in groups.values() for names in ([group] if len(group) == 4 else [[n] for n in group])
    ]


def origin(first: float) -> float:
    """What to take off stamps so that seconds keep their digits: whole seconds of an epoch, else nothing."""
    return float(np.floor(first)) if first > 1e6 else 0.0

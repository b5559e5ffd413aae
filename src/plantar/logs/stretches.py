"""Of a long recording the stretches in which most moves: robots mostly stand still, and what a log costs is bounded.

A stretch tells of stiffness as much as its torques vary, of damping and of delays as much as they change. Each torque's
best stretches are taken in turn by both, so that no foot, axis or parameter is left with what suits another.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array, Mask
from plantar.logs.motion_log import MotionLog, device_of
from plantar.notes import Note

LONGEST = 600.0  # s of one recording that are worked on: of a longer one those stretches that move most
STRETCH = 60.0  # s: it holds motions, and delays, which are told beside drifts of 20 s, are told in each
CELL = 0.1  # s over which torques are averaged: what is faster is noise, or a sole that knocks
BLANK = 0.1  # s at the end of a stretch that are emptied, so that nothing is filtered, bridged or read late beyond it
# s: samples that follow each other otherwise are no log in seconds, which is told elsewhere
PERIODS = (1e-5, 1.0)


@dataclass(frozen=True)
class Stretches:
    """Which rows (N,) of a recording that `lasts` so long [s] are in its chosen stretches, and which of those (n,) end
    one and are emptied."""

    rows: Mask
    blank: Mask
    lasts: float

    def without(self, lost: Mask) -> Stretches:
        """The same of rows of which some, `lost` (n,), are not kept: then the one before ends its stretch."""
        ends = np.flatnonzero(self.blank & ~np.append(self.blank[1:], False))
        blank = self.blank.copy()
        for end in ends[lost[ends]]:
            blank[: end + 1][np.flatnonzero(~lost[: end + 1])[-1:]] = True
        return replace(self, blank=blank[~lost])

    def log(self, log: MotionLog) -> MotionLog:
        """A recording that holds these rows alone, the last of each stretch empty already, with what is left out."""
        last = np.flatnonzero(self.blank & ~np.append(self.blank[1:], False))
        out = tuple(zip(log.time[last].tolist(), log.time[last + 1].tolist(), strict=True))
        share, used = 100 * len(self.blank) / len(self.rows), len(self.blank) * log.period
        text = (
            f"{log.name}: lasts {self.lasts:.0f} s; the {used:.0f} s in which most moves are used, {share:.0f} % of it,"
            f" in stretches of {STRETCH:g} s (valid: parts of it as logs of their own, to use more)"
        )
        notes = (*log.notes, Note("long_recording", "info", text))
        return MotionLog(log.name, log.time, log.columns, log.path, log.sha256, notes, out)


def most_moving(log: MotionLog, sensors: Collection[str] = ()) -> MotionLog:
    """The stretches of a log of more than LONGEST that move most; itself where it is shorter, or they are chosen.

    sensors: as in `stretches_of`.
    """
    chosen = any(note.code == "long_recording" for note in log.notes)
    found = None if chosen else stretches_of(log.time, log.columns, log.columns.__getitem__, sensors)
    if found is None:
        return log
    columns = {name: values[found.rows] for name, values in log.columns.items()}
    for values in columns.values():
        values[found.blank] = np.nan
        values.setflags(write=False)  # handed over, not copied
    return found.log(MotionLog(log.name, log.time[found.rows], columns, log.path, log.sha256, log.notes))


def stretches_of(
    time: Array,
    names: Iterable[str],
    read: Callable[[str], Array],
    sensors: Collection[str],
    longest: float = LONGEST,
) -> Stretches | None:
    """The stretches that move most of a recording of these times (N,) [s]; None where it is no longer than `longest`.

    names: of its columns, of which torques about x and y are read, one at a time: of these force `sensors`, of all
    where it has none of them.
    """
    steps = np.diff(time)
    period = float(np.median(steps[steps > 0])) if (steps > 0).any() else np.nan
    if not PERIODS[0] < period < PERIODS[1] or len(time) * period <= longest * (1 + 1e-6):
        return None
    width, count = round(STRETCH / period), max(1, int(longest / STRETCH))
    starts = np.arange(0, len(time) - width + 1, width)  # what is left behind the last one is shorter
    wrenches = (name for name in names if name.startswith("wrench."))
    bending = [name for name in wrenches if name.endswith((".torque.x", ".torque.y"))]
    torques = [name for name in bending if device_of(name).removeprefix("wrench.") in sensors] or bending
    told = np.array([_told(read(name), width, len(starts), max(1, round(CELL / period))) for name in torques])
    # The best of each column, then the second of each, and so on, each once.
    in_turn = np.argsort(-told.reshape(-1, len(starts)), axis=1, kind="stable").T.ravel()
    chosen = list(dict.fromkeys((*in_turn.tolist(), *range(len(starts)))))[:count]
    rows = np.zeros(len(time), dtype=bool)
    for start in starts[chosen]:
        rows[start : start + width] = True
    places = np.flatnonzero(rows)
    blank = np.zeros(len(places), dtype=bool)
    for last in np.flatnonzero(np.diff(places) > 1):
        blank[max(0, last + 1 - max(1, round(BLANK / period))) : last + 1] = True
    return Stretches(rows, blank, float(np.nanmax(time) - np.nanmin(time)))


def _told(torque: Array, width: int, count: int, cell: int) -> Array:
    """Variance of a torque (N,) and of its changes in each of `count` stretches of `width` rows, (2, count)."""
    cells = width // cell
    rows = torque[: width * count].reshape(count, width)[:, : cells * cell].reshape(count, cells, cell)
    # The median of each: of a stretch in which nothing moves one spike would make the most moving of all.
    known, ordered = np.isfinite(rows).sum(axis=2), np.sort(rows, axis=2)  # what is not known comes last
    middles = np.take_along_axis(ordered, (np.maximum(known - 1, 0) // 2)[:, :, None], axis=2)[:, :, 0]
    return np.array([_variance(middles), _variance(np.diff(middles, axis=1))])


def _variance(values: Array) -> Array:
    """Of each row of (n, k), of what is known in it; 0 where that is nothing."""
    known = np.isfinite(values)
    count = np.maximum(known.sum(axis=1, keepdims=True), 1)
    mean = np.where(known, values, 0.0).sum(axis=1, keepdims=True) / count
    return np.asarray((np.where(known, values - mean, 0.0) ** 2).sum(axis=1) / count[:, 0])

"""What a bag's topics hold, gathered batch by batch."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.logs.readers.ros import layouts
from plantar.logs.readers.ros.layouts import JOINT_STATE, BrokenMessage, Bytes, Encoding, Layout

LAYOUT_LIMIT = 200  # layouts of one topic: frames and joint lists change rarely
Stamps = NDArray[np.int64]


@dataclass
class Series:
    """One kind of message of one topic with the same joint names: chunks of stamps and numbers."""

    names: tuple[str, ...]
    header: list[Stamps] = field(default_factory=list)
    received: list[Stamps] = field(default_factory=list)
    values: dict[str, list[Array]] = field(default_factory=dict)

    def clock(self, received: bool) -> Stamps:
        """Stamps of the messages (n,) [ns]: of their headers, or of their receipt."""
        return np.concatenate(self.received if received else self.header)

    def column(self, name: str, index: int) -> Array:
        """One number over time, (n,); NaN where a message did not hold it."""
        if name not in self.values:
            return np.full(sum(map(len, self.header)), np.nan)
        parts = [chunk[:, index] for chunk in self.values[name]]
        return np.concatenate(parts)


@dataclass
class Topic:
    """One topic of a bag: its type, encoding, frame, and what was decoded so far."""

    name: str
    kind: str
    encoding: Encoding
    frames: list[str] = field(default_factory=list)
    layouts: list[Layout] = field(default_factory=list)
    series: dict[tuple[str, ...], Series] = field(default_factory=dict)
    count: int = 0
    broken: int = 0

    def add(self, buffer: Bytes, starts: list[int], ends: list[int], received: list[int]) -> None:
        """Decode the messages that lie in `buffer` from `starts` to `ends`."""
        self.count += len(starts)
        first, sizes = np.array(starts, np.int64), np.array(ends, np.int64) - np.array(starts, np.int64)
        clock = np.array(received, np.uint64).astype(np.int64)
        for size in np.unique(sizes):
            rows = np.flatnonzero(sizes == size)
            if size < 8:
                self.broken += rows.size
                continue
            self._decode(layouts.rows_of(buffer, first[rows], int(size)), clock[rows])

    def _decode(self, rows: Bytes, clock: Stamps) -> None:
        left = np.arange(len(rows))
        for layout in [known for known in self.layouts if known.size == rows.shape[1]]:
            left = self._take(layout, rows, clock, left)
        while left.size:
            try:
                layout = layouts.layout_of(self.kind, self.encoding, rows[left[0]].tobytes())
            except BrokenMessage:
                self.broken += 1
                left = left[1:]
                continue
            if len(self.layouts) >= LAYOUT_LIMIT:
                self.broken += left.size
                return
            self.layouts.append(layout)
            if layout.frame not in self.frames:
                self.frames.append(layout.frame)
            left = self._take(layout, rows, clock, left)

    def _take(self, layout: Layout, rows: Bytes, clock: Stamps, left: NDArray[np.intp]) -> NDArray[np.intp]:
        if left.size == 0:
            return left
        candidates = rows if left.size == len(rows) else rows[left]
        mine = layout.matches(candidates)
        if not mine.any():
            return left
        taken = candidates if mine.all() else candidates[mine]
        series = self.series.setdefault(layout.names, Series(layout.names))
        series.header.append(layout.stamps(taken))
        series.received.append(clock[left[mine]])
        expected = len(layout.names)
        present = {
            entry[0]: entry for entry in layout.fields if self.kind != JOINT_STATE or entry[2] == expected
        }
        done = sum(len(chunk) for chunk in series.header) - len(taken)
        for name, entry in present.items():
            if name not in series.values:
                series.values[name] = [np.full((done, entry[2]), np.nan)] if done else []
            series.values[name].append(layout.values(taken, entry))
        for name, chunks in series.values.items():
            if name not in present:
                chunks.append(np.full((len(taken), chunks[0].shape[1]), np.nan))
        return left[~mine]

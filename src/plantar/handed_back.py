"""What a copy of this process found, handed back to it: arrays through shared memory, and only those that are new.

What both have since before the copy was made, arrays of a log above all, is named by its address, which is the same in
both, and is found again as the very same object.
"""

from __future__ import annotations

import io
import mmap
import os
import pickle
import struct
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

SIZE = struct.Struct("<q")
ALIGNED = 64  # bytes: where an array may begin, as in memory of its own
PLAIN = (str, bytes, int, float, bool, type(None))


def held_by(values: Iterable[Any]) -> dict[int, Any]:
    """Every object that `values` hold, in containers and attributes, by its address; these keep it valid."""
    held: dict[int, Any] = {}
    waiting = list(values)
    while waiting:
        value = waiting.pop()
        if isinstance(value, PLAIN) or id(value) in held:
            continue
        held[id(value)] = value
        if isinstance(value, Mapping):
            waiting.extend(value.values())
        elif isinstance(value, tuple | list):
            waiting.extend(value)
        else:
            waiting.extend(getattr(value, "__dict__", {}).values())
    return held


class _Span(NamedTuple):
    """Where in the file an array's numbers stand [bytes]."""

    first: int
    size: int


def hand_back(found: Any, held: Mapping[int, Any], file: int) -> None:
    """Write what was found to an open, empty file."""
    text, buffers = io.BytesIO(), list[pickle.PickleBuffer]()
    _Writer(text, held, buffers).dump(found)
    spans, first = list[_Span](), 0
    with os.fdopen(file, "wb", closefd=False) as out:
        for buffer in buffers:
            with buffer.raw() as raw:
                first += out.write(bytes(-first % ALIGNED))
                spans.append(_Span(first, raw.nbytes))
                first += out.write(raw)
        table = pickle.dumps((spans, text.getvalue()))
        out.write(table + SIZE.pack(len(table)))


def taken(file: int, held: Mapping[int, Any]) -> Any:
    """What `hand_back` wrote. No number is copied: arrays lie in the file, whose memory goes with the last of them."""
    whole = memoryview(mmap.mmap(file, 0, access=mmap.ACCESS_COPY))
    end = len(whole) - SIZE.size
    size = SIZE.unpack(whole[end:])[0]
    spans, text = pickle.loads(whole[end - size : end])
    return _Reader(
        io.BytesIO(text), held, (whole[span.first : span.first + span.size] for span in spans)
    ).load()


class _Writer(pickle.Pickler):
    """Names what both processes have, and leaves the numbers of arrays to `buffers`."""

    def __init__(self, out: io.BytesIO, held: Mapping[int, Any], buffers: list[pickle.PickleBuffer]) -> None:
        super().__init__(out, protocol=5, buffer_callback=buffers.append)
        self.dispatch_table = {MappingProxyType: lambda mapping: (_read_only, (dict(mapping),))}
        self._held = held

    def persistent_id(self, value: Any) -> int | None:
        return id(value) if id(value) in self._held else None


class _Reader(pickle.Unpickler):
    """Finds again what `_Writer` named."""

    def __init__(self, text: io.BytesIO, held: Mapping[int, Any], buffers: Iterable[memoryview]) -> None:
        super().__init__(text, buffers=buffers)
        self._held = held

    def persistent_load(self, name: int) -> Any:
        return self._held[name]


def _read_only(mapping: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    """`MappingProxyType` under a name that a reader finds."""
    return MappingProxyType(mapping)

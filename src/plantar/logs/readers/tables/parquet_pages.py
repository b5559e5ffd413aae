"""What the pages of a Parquet file unpack to, from their own headers: the file's footer may say less.

A page header is a struct in Thrift's compact protocol (thrift.apache.org, thrift-compact-protocol.md) with the fields
1: type, 2: uncompressed size, 3: compressed size (parquet-format, parquet.thrift); the others are stepped over.
"""

from __future__ import annotations

from typing import IO

from plantar.logs.readers.read_limit import ReadLimit

HEADER_LIMIT = 2**16  # bytes of a page's header, statistics in it
DEPTH = 8  # structs inside each other

TRUE, FALSE, BYTE, I16, I32, I64, DOUBLE, BINARY, LIST, SET, MAP, STRUCT = range(1, 13)
"""Types of the compact protocol."""


class BrokenPage(ValueError):
    """Bytes that are no page header."""


def check_pages(handle: IO[bytes], start: int, size: int, limit: ReadLimit) -> None:
    """Count what the pages from `start` on, `size` bytes in all, unpack to. BrokenPage: they hold something else.

    Raises LogError when it is more than `limit` allows.
    """
    at, end = start, start + size
    while at < end:
        handle.seek(at)
        header = _Header(handle.read(min(HEADER_LIMIT, end - at)))
        sizes = header.struct({2, 3})
        unpacked, packed = sizes.get(2, -1), sizes.get(3, -1)
        if unpacked < 0 or packed < 0:
            raise BrokenPage("a page has no size")
        limit.unpack(unpacked)
        at += header.at + packed


class _Header:
    def __init__(self, data: bytes) -> None:
        self._data, self.at = data, 0

    def struct(self, wanted: set[int], depth: int = 0) -> dict[int, int]:
        """The integers of a struct's wanted fields."""
        if depth > DEPTH:
            raise BrokenPage("a header without end")
        found: dict[int, int] = {}
        field = 0
        while (head := self._byte()) != 0:
            step, kind = head >> 4, head & 15
            field = field + step if step else self._integer()
            if kind in (I16, I32, I64):
                value = self._integer()
                if field in wanted:
                    found[field] = value
            elif kind not in (TRUE, FALSE):
                self._skip(kind, depth)
        return found

    def _skip(self, kind: int, depth: int) -> None:
        if kind in (I16, I32, I64):
            self._integer()
        elif kind == BINARY:
            self._forward(self._number())
        elif kind == STRUCT:
            self.struct(set(), depth + 1)
        elif kind in (LIST, SET):
            head = self._byte()
            for _ in range(head >> 4 if head >> 4 < 15 else self._number()):
                self._skip(head & 15, depth + 1)
        elif kind in (TRUE, FALSE, BYTE):  # in a list a truth value is a byte
            self._forward(1)
        elif kind == DOUBLE:
            self._forward(8)
        else:
            raise BrokenPage(f"a header with a field of type {kind}")

    def _byte(self) -> int:
        self._forward(1)
        return self._data[self.at - 1]

    def _forward(self, count: int) -> None:
        self.at += count
        if self.at > len(self._data):
            raise BrokenPage("a header ends in its middle")

    def _number(self) -> int:
        """An unsigned number, seven bits a byte."""
        value = shift = 0
        while True:
            byte = self._byte()
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value
            if shift > 63:
                raise BrokenPage("a number without end")

    def _integer(self) -> int:
        """A signed number in zigzag order: 0, -1, 1, -2, ..."""
        number = self._number()
        return (number >> 1) ^ -(number & 1)

"""ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0): records in order, chunks plain, bz2 or lz4.

The index is not needed, so a bag that was never closed (`.bag.active`) or was cut reads like any other.
"""

from __future__ import annotations

import struct
from pathlib import Path

from plantar.errors import LogError
from plantar.logs.readers.read_limit import BLOCK, ReadLimit
from plantar.logs.readers.ros.compressed import BrokenChunk, unpack_chunk
from plantar.logs.readers.ros.scan import MESSAGES, Found, Scan
from plantar.logs.readers.ros.topics import Topic
from plantar.notes import Note

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, CHUNK, CONNECTION = 0x02, 0x05, 0x07

_SIZE = struct.Struct("<I")


def read_ros1(path: Path, topics: dict[str, Topic], limit: ReadLimit, notes: list[Note]) -> None:
    """Add the file's messages to `topics`. LogError when it is no bag; a note when it is cut or damaged."""
    scan = _Scan(path, topics, limit, notes)
    size = path.stat().st_size
    with open(path, "rb") as handle:
        if handle.read(len(MAGIC)) != MAGIC:
            raise LogError("is not a ROS 1 bag of format 2.0", path=path)
        rest = b""
        while True:
            block = handle.read(max(BLOCK, scan.needed - len(rest)))
            data = rest + block if rest else block
            rest = data[scan.records(data) :]
            ended = not block or scan.needed > size
            if ended and rest and not scan.lost:
                scan.cut(rest)
                scan.note_cut()
            if ended or scan.lost:
                return


class _Scan(Scan):
    lost = False

    def records(self, data: bytes, *, inside_chunk: bool = False) -> int:
        """Read whole records; returns the bytes used."""
        at, total = 0, len(data)
        found: Found = {}
        self.needed = 8
        while at + 8 <= total:
            (header_size,) = _SIZE.unpack_from(data, at)
            start = at + 4 + header_size
            if start + 4 > total:
                self.needed = start + 4 - at
                break
            (body_size,) = _SIZE.unpack_from(data, start)
            end = start + 4 + body_size
            if end > total:
                self.needed = end - at
                break
            header = _fields(data[at + 4 : start])
            if b"op" not in header:  # no record: what follows is not in step either
                self.lost = self._lost()
                break
            at = end
            code = header.get(b"op", b"\0")[:1]
            if code == bytes([MESSAGE]):
                self._message(header, start + 4, end, found)
                if any(len(starts) >= MESSAGES for starts, _, _ in found.values()):
                    self._flush(data, found)
            elif code == bytes([CONNECTION]):
                self._flush(data, found)
                self._connection(header, _fields(data[start + 4 : end]))
            elif code == bytes([CHUNK]) and not inside_chunk:
                self._flush(data, found)
                self._chunk(header, data[start + 4 : end])
        self._flush(data, found)
        return at

    def _message(self, header: dict[bytes, bytes], start: int, end: int, found: Found) -> None:
        try:
            (channel,) = _SIZE.unpack(header[b"conn"])
            seconds, nanoseconds = struct.unpack("<II", header[b"time"])
        except (KeyError, struct.error):
            return
        if self._channels.get(channel) is not None:
            starts, ends, received = found.setdefault(channel, ([], [], []))
            starts.append(start)
            ends.append(end)
            received.append(seconds * 1_000_000_000 + nanoseconds)

    def _connection(self, header: dict[bytes, bytes], body: dict[bytes, bytes]) -> None:
        try:
            (channel,) = _SIZE.unpack(header[b"conn"])
            name, kind = header[b"topic"].decode(), body[b"type"].decode()
        except (KeyError, struct.error, UnicodeDecodeError):
            return
        self._open(channel, name, kind, "ros1")

    def cut(self, rest: bytes) -> None:
        """What is whole in a chunk that the file's end cuts."""
        if len(rest) >= 4:
            (header_size,) = _SIZE.unpack_from(rest)
            header = _fields(rest[4 : 4 + header_size])
            if header.get(b"op") == bytes([CHUNK]) and b"size" in header:
                self._chunk(header, rest[8 + header_size :], whole=False)

    def _chunk(self, header: dict[bytes, bytes], body: bytes, *, whole: bool = True) -> None:
        try:
            (size,) = _SIZE.unpack(header[b"size"])
            content = unpack_chunk(header[b"compression"].decode(), body, size, self.limit)
            if whole and len(content) != size:
                raise BrokenChunk("its length does not agree")
        except (KeyError, struct.error, UnicodeDecodeError, BrokenChunk) as error:
            self._broken(error)
            return
        self.records(content, inside_chunk=True)


def _fields(data: bytes) -> dict[bytes, bytes]:
    """Header fields `name=value`, as many as are whole."""
    fields: dict[bytes, bytes] = {}
    at = 0
    while at + 4 <= len(data):
        (size,) = _SIZE.unpack_from(data, at)
        name, equals, value = data[at + 4 : at + 4 + size].partition(b"=")
        if not equals:
            break
        fields[name] = value
        at += 4 + size
    return fields

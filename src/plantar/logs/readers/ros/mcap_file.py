"""MCAP (mcap.dev/spec): records read in order, so that a file cut at any byte gives its whole records.

The index at the end is not needed and not trusted. Files are read in blocks; messages are decoded where they lie.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

from plantar.errors import LogError
from plantar.logs.readers.read_limit import BLOCK, ReadLimit
from plantar.logs.readers.ros.compressed import BrokenChunk, unpack_chunk
from plantar.logs.readers.ros.layouts import Encoding
from plantar.logs.readers.ros.scan import MESSAGES, Found, Scan
from plantar.logs.readers.ros.topics import Topic
from plantar.notes import Note

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 0x02, 0x03, 0x04, 0x05, 0x06, 0x0F

_RECORD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")
_CHUNK = struct.Struct("<QQQI")


def read_mcap(path: Path, topics: dict[str, Topic], limit: ReadLimit, notes: list[Note]) -> None:
    """Add the file's messages to `topics`. LogError when it is not MCAP; a note when it is cut or damaged."""
    scan = _Scan(path, topics, limit, notes)
    size = path.stat().st_size
    with open(path, "rb") as handle:
        if handle.read(len(MAGIC)) != MAGIC:
            raise LogError("is not an MCAP file", path=path, valid="a file that starts with the MCAP magic")
        rest, done = b"", False
        while not done:
            block = handle.read(max(BLOCK, scan.needed - len(rest)))
            data = rest + block if rest else block
            used, done = scan.records(data)
            rest = data[used:]
            if not done and (not block or scan.needed > size):
                scan.cut(rest)
                scan.note_cut()
                return


class _Scan(Scan):
    def __init__(self, path: Path, topics: dict[str, Topic], limit: ReadLimit, notes: list[Note]) -> None:
        super().__init__(path, topics, limit, notes)
        self._schemas: dict[int, str] = {}

    def records(self, data: bytes, *, inside_chunk: bool = False) -> tuple[int, bool]:
        """Read whole records; returns the bytes used and whether the data section has ended."""
        at, total, done = 0, len(data), False
        found: Found = {}
        record, message, channels = _RECORD.unpack_from, _MESSAGE.unpack_from, self._channels
        self.needed = _RECORD.size
        while at + _RECORD.size <= total:
            code, length = record(data, at)
            start = at + _RECORD.size
            end = start + length
            if end > total:
                self.needed = end - at
                break
            at = end
            if code == MESSAGE:
                if length < _MESSAGE.size:
                    done = self._lost()
                    break
                channel, _, received, _ = message(data, start)
                if channels.get(channel) is not None:
                    lists = found.get(channel)
                    if lists is None:
                        lists = found[channel] = ([], [], [])
                    lists[0].append(start + _MESSAGE.size)
                    lists[1].append(end)
                    lists[2].append(received)
                    if len(lists[0]) >= MESSAGES:
                        self._flush(data, found)
            elif code == CHUNK and not inside_chunk:
                self._flush(data, found)
                self._chunk(data[start:end])
            elif code == SCHEMA:
                self._schema(data[start:end])
            elif code == CHANNEL:
                self._flush(data, found)
                self._channel(data[start:end])
            elif code in (DATA_END, FOOTER):
                done = True
                break
            elif code == 0 or inside_chunk:
                done = self._lost()
                break
        self._flush(data, found)
        return at, done

    def cut(self, rest: bytes) -> None:
        """What is whole in a chunk that the file's end cuts."""
        if rest[:1] == bytes([CHUNK]):
            self._chunk(rest[_RECORD.size :], whole=False)

    def _chunk(self, body: bytes, *, whole: bool = True) -> None:
        try:
            _, _, size, checksum = _CHUNK.unpack_from(body)
            kind, at = _string(body, _CHUNK.size)
            (length,) = struct.unpack_from("<Q", body, at)
            packed = body[at + 8 : at + 8 + min(length, len(body))]
            content = unpack_chunk(kind, packed, size, self.limit)
            if whole and (len(content) != size or (checksum and zlib.crc32(content) != checksum)):
                raise BrokenChunk("its checksum or length does not agree")
        except (BrokenChunk, struct.error, UnicodeDecodeError) as error:
            self._broken(error)
            return
        self.records(content, inside_chunk=True)

    def _schema(self, body: bytes) -> None:
        try:
            (identity,) = struct.unpack_from("<H", body)
            name, _ = _string(body, 2)
        except (struct.error, UnicodeDecodeError):
            return
        self._schemas[identity] = name.replace("/msg/", "/")

    def _channel(self, body: bytes) -> None:
        try:
            identity, schema = struct.unpack_from("<HH", body)
            name, at = _string(body, 4)
            encoding, _ = _string(body, at)
        except (struct.error, UnicodeDecodeError):
            return
        kind = self._schemas.get(schema, "")
        known: dict[str, Encoding] = {"cdr": "cdr", "ros1": "ros1"}
        self._open(identity, name, kind if encoding in known else "", known.get(encoding, "cdr"))


def _string(body: bytes, at: int) -> tuple[str, int]:
    """A length-prefixed text and where it ends."""
    (size,) = struct.unpack_from("<I", body, at)
    end = at + 4 + size
    if end > len(body):
        raise struct.error("a text is longer than its record")
    return body[at + 4 : end].decode(), end

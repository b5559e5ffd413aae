"""Decompression with a bound on what comes out, whatever the data says about itself."""

from __future__ import annotations

import bz2

from plantar.errors import LogError, needs
from plantar.logs.readers.read_limit import ReadLimit, shown

CHUNK_LIMIT = 2**27  # bytes that one compressed chunk of a bag may hold: recorders write a few million


class BrokenChunk(ValueError):
    """A compressed chunk that does not hold what it says."""


class TooLong(BrokenChunk):
    """More comes out of a chunk than was asked for."""


def unpack_chunk(kind: str, data: bytes | memoryview, claimed: int, limit: ReadLimit) -> bytes:
    """The content of a chunk that says it holds `claimed` bytes.

    Raises BrokenChunk: damaged, or longer than it says. LogError: more than `limit` allows, whatever it says.
    """
    if kind in ("", "none"):
        return bytes(data)
    most = min(CHUNK_LIMIT, limit.left)
    try:
        content = decompress(kind, data, min(claimed, most))
    except TooLong:
        if claimed <= most:
            raise
        if most < CHUNK_LIMIT:
            raise limit.too_much(f"unpacks to more than {shown(limit.unpacks_to)}") from None
        valid = f"at most {shown(CHUNK_LIMIT)} a chunk"
        message = f"a chunk unpacks to more than {shown(CHUNK_LIMIT)}"
        raise LogError(message, path=limit.path, valid=valid) from None
    limit.unpack(len(content))
    return content


def decompress(kind: str, data: bytes | memoryview, limit: int) -> bytes:
    """The content of a chunk compressed by zstd, lz4 or bz2.

    Raises BrokenChunk: unknown kind, damaged, or more than `limit` bytes. MissingExtra: no decompressor.
    """
    try:
        if kind == "bz2":
            content = bz2.BZ2Decompressor().decompress(data, limit + 1)
        elif kind == "zstd":
            content = _zstd(data, limit)
        elif kind == "lz4":
            content = _lz4(data, limit)
        else:
            raise BrokenChunk(f"unknown compression '{kind[:20]}'")
    except (OSError, ValueError, EOFError, RuntimeError) as error:
        raise BrokenChunk(str(error) or "damaged") from error
    if len(content) > limit:
        raise TooLong(f"holds more than {limit} bytes")
    return content


def _zstd(data: bytes | memoryview, limit: int) -> bytes:
    with needs("zstandard", "logs", "reading this bag"):
        import zstandard
    try:
        with zstandard.ZstdDecompressor(max_window_size=2**27).stream_reader(bytes(data)) as stream:
            return bytes(stream.read(limit + 1))
    except (zstandard.ZstdError, MemoryError) as error:
        raise BrokenChunk(str(error)) from error


def _lz4(data: bytes | memoryview, limit: int) -> bytes:
    with needs("lz4", "logs", "reading this bag"):
        import lz4.frame  # type: ignore[import-untyped]
    return bytes(lz4.frame.LZ4FrameDecompressor().decompress(bytes(data), max_length=limit + 1))

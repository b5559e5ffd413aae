"""Decompression with a bound on what comes out, whatever the data says about itself."""

from __future__ import annotations

import bz2
import zlib

from plantar.errors import MissingExtra

CHUNK_LIMIT = 2**28  # bytes that one chunk of a bag may hold
SMALL = 2**28  # bytes that any bag may unpack to
RATIO = 100  # bytes that a bag may unpack to for each of its own: recordings shrink to a tenth at best


class BrokenChunk(ValueError):
    """A compressed chunk that does not hold what it says."""


class Budget:
    """How much a whole bag may unpack to, from its own size."""

    def __init__(self, file_size: int) -> None:
        self._left = SMALL + RATIO * file_size

    def spend(self, size: int) -> None:
        """BrokenChunk when the bag unpacks to more than any recording does."""
        self._left -= size
        if self._left < 0:
            raise BrokenChunk("the bag unpacks to a size that no recording has")


def decompress(kind: str, data: bytes | memoryview, limit: int = CHUNK_LIMIT) -> bytes:
    """The content of a chunk compressed by '' (not at all), zstd, lz4 or bz2.

    Raises BrokenChunk: unknown kind, damaged, or more than `limit` bytes. MissingExtra: no decompressor.
    """
    try:
        if kind in ("", "none"):
            content = bytes(data)
        elif kind == "bz2":
            content = bz2.BZ2Decompressor().decompress(data, limit + 1)
        elif kind == "zlib":
            content = zlib.decompressobj().decompress(data, limit + 1)
        elif kind == "zstd":
            content = _zstd(data, limit)
        elif kind == "lz4":
            content = _lz4(data, limit)
        else:
            raise BrokenChunk(f"unknown compression '{kind[:20]}'")
    except (OSError, ValueError, EOFError, zlib.error, RuntimeError) as error:
        raise BrokenChunk(str(error) or "damaged") from error
    if len(content) > limit:
        raise BrokenChunk(f"holds more than {limit} bytes")
    return content


def _zstd(data: bytes | memoryview, limit: int) -> bytes:
    try:
        import zstandard
    except ImportError as error:
        raise MissingExtra("zstandard", "logs", "reading this bag") from error
    try:
        with zstandard.ZstdDecompressor(max_window_size=2**27).stream_reader(bytes(data)) as stream:
            return bytes(stream.read(limit + 1))
    except (zstandard.ZstdError, MemoryError) as error:
        raise BrokenChunk(str(error)) from error


def _lz4(data: bytes | memoryview, limit: int) -> bytes:
    try:
        import lz4.frame  # type: ignore[import-untyped]
    except ImportError as error:
        raise MissingExtra("lz4", "logs", "reading this bag") from error
    return bytes(lz4.frame.LZ4FrameDecompressor().decompress(bytes(data), max_length=limit + 1))

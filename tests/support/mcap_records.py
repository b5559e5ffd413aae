"""Records of an MCAP file as its bytes, for files that no writer would write."""

from __future__ import annotations

import struct

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x0F


def mcap_texts(*values: str) -> bytes:
    return b"".join(struct.pack("<I", len(value)) + value.encode() for value in values)


def mcap_record(code: int, body: bytes) -> bytes:
    return struct.pack("<BQ", code, len(body)) + body


def mcap_of_chunk(packed: bytes, claimed: int) -> bytes:
    """A file of one zstd chunk that says it unpacks to `claimed` bytes."""
    body = (
        struct.pack("<QQQI", 0, 0, claimed, 0) + mcap_texts("zstd") + struct.pack("<Q", len(packed)) + packed
    )
    return MAGIC + mcap_record(CHUNK, body)

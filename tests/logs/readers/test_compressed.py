"""Chunks of bags: what comes out, and at most how much."""

from __future__ import annotations

import bz2
from collections.abc import Callable
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]
import pytest
import zstandard

from plantar.errors import LogError
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.ros import compressed
from plantar.logs.readers.ros.compressed import BrokenChunk, TooLong, unpack_chunk

CONTENT = bytes(range(250)) * 4
PACKED: dict[str, Callable[[bytes], bytes]] = {
    "bz2": bz2.compress, "lz4": lz4.frame.compress, "zstd": zstandard.compress, "none": bytes,
}  # fmt: skip


@pytest.fixture
def limit(tmp_path: Path) -> ReadLimit:
    (tmp_path / "a.bag").write_bytes(bytes(10))
    return ReadLimit(tmp_path / "a.bag")


@pytest.mark.parametrize("kind", PACKED)
def test_a_chunk_is_what_was_packed_and_counts(kind: str, limit: ReadLimit) -> None:
    before = limit.left
    assert unpack_chunk(kind, PACKED[kind](CONTENT), len(CONTENT), limit) == CONTENT
    assert before - limit.left == (0 if kind == "none" else len(CONTENT)), (
        "what the file itself holds is no more"
    )


@pytest.mark.parametrize("kind", ["bz2", "lz4", "zstd"])
def test_a_chunk_longer_than_it_says_is_broken(kind: str, limit: ReadLimit) -> None:
    with pytest.raises(TooLong):
        unpack_chunk(kind, PACKED[kind](CONTENT), len(CONTENT) - 1, limit)


@pytest.mark.parametrize("kind", ["bz2", "lz4", "zstd", "zlib"])
def test_what_is_damaged_or_packed_otherwise_is_broken(kind: str, limit: ReadLimit) -> None:
    with pytest.raises(BrokenChunk):
        unpack_chunk(kind, b"no archive", 100, limit)


@pytest.mark.parametrize(
    ("left", "refused"),
    [
        (1000, r"a\.bag: a chunk unpacks to more than 900 bytes \(valid: at most 900 bytes a chunk\)$"),
        (
            800,
            r"a\.bag: unpacks to more than 268 MB \(valid: at most 268 MB from a file of 10 bytes: "
            r"268 MB and 100 times its size\)$",
        ),
    ],
)
def test_no_chunk_is_longer_than_recorders_write_nor_than_its_file_may_hold(
    left: int, refused: str, limit: ReadLimit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compressed, "CHUNK_LIMIT", 900)
    limit.unpack(limit.left - left)
    with pytest.raises(LogError, match=refused):
        unpack_chunk("bz2", bz2.compress(CONTENT), 2000, limit)

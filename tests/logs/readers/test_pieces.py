"""Files that are read piece by piece: what is kept of each, and what a channel is that is told anew on the way."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pa_parquet
import pytest

from mcap_records import CHANNEL, MESSAGE, SCHEMA, mcap_record, mcap_texts
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.ros.mcap_file import _Scan
from plantar.logs.readers.ros.topics import Topic
from plantar.logs.readers.tables import parquet_file
from plantar.notes import Note


def test_rows_that_are_kept_are_those_of_all_pieces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of ten rows in pieces of three."""
    monkeypatch.setattr(parquet_file, "BATCH", 3)
    path = tmp_path / "log.parquet"
    numbers = {"time": np.arange(10.0), "b": 10.0 * np.arange(10)}
    pa_parquet.write_table(pa.table(numbers), path)
    kept = np.array([0, 1, 1, 0, 0, 1, 1, 0, 0, 1], dtype=bool)
    for rows in (kept, None):
        found = parquet_file.read_parquet(path, ReadLimit(path), list, rows, strict=True)
        for name, values in numbers.items():
            np.testing.assert_array_equal(found[name], values if rows is None else values[rows])


def wrench(force: float) -> bytes:
    return (
        b"\0\1\0\0"
        + struct.pack("<iII", 1, 0, 2)
        + b"f\0"
        + b"\0\0"
        + struct.pack("<6d", 0, 0, force, 0, 0, 0)
    )


def test_messages_belong_to_what_their_channel_was_when_they_came() -> None:
    """One number of a channel is told anew between two messages, as by a recorder that was started again."""
    topics: dict[str, Topic] = {}
    notes: list[Note] = []
    path = Path("walk.mcap")

    def channel(name: str) -> bytes:
        return mcap_record(CHANNEL, struct.pack("<HH", 7, 1) + mcap_texts(name, "cdr") + struct.pack("<I", 0))

    def message(force: float) -> bytes:
        return mcap_record(MESSAGE, struct.pack("<HIQQ", 7, 0, 10, 10) + wrench(force))

    schema = struct.pack("<H", 1) + mcap_texts("geometry_msgs/msg/WrenchStamped", "ros2msg", "")
    parts = [
        mcap_record(SCHEMA, schema),
        channel("/left"),
        message(1.0),
        message(2.0),
        channel("/right"),
        message(3.0),
    ]
    data = b"".join(parts)
    assert _Scan(path, topics, ReadLimit(path), notes).records(data) == (len(data), False)
    assert {name: topic.count for name, topic in topics.items()} == {"/left": 2, "/right": 1}
    assert notes == []

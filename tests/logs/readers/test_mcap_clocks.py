"""MCAP messages carry two times, the recorder's and the publisher's: without header stamps, the recorder's is meant."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from plantar.logs.readers import open_log

MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, DATA_END, FOOTER, HEADER = 0x03, 0x04, 0x05, 0x0F, 0x02, 0x01


def text(value: str) -> bytes:
    return struct.pack("<I", len(value)) + value.encode()


def record(code: int, body: bytes) -> bytes:
    return struct.pack("<BQ", code, len(body)) + body


def unstamped_wrench(values: list[float]) -> bytes:
    """A geometry_msgs/WrenchStamped in CDR whose header's stamp was never set."""
    header = struct.pack("<iII", 0, 0, 2) + b"f\0"
    return b"\0\1\0\0" + header + b"\0\0" + struct.pack("<6d", *values)


def test_the_recorders_clock_counts_where_headers_have_none(tmp_path: Path) -> None:
    """The publisher's clock runs ahead by 3 to 9 ms, another amount each time."""
    random = np.random.default_rng(0)
    logged = 1_700_000_000_000_000_000 + 10_000_000 * np.arange(200)
    published = logged - random.integers(3_000_000, 9_000_000, 200)
    parts = [MAGIC, record(HEADER, text("") + text("test"))]
    parts.append(
        record(
            SCHEMA,
            struct.pack("<H", 1) + text("geometry_msgs/msg/WrenchStamped") + text("ros2msg") + text(""),
        )
    )
    parts.append(
        record(CHANNEL, struct.pack("<HH", 7, 1) + text("/ft/left") + text("cdr") + struct.pack("<I", 0))
    )
    for place, (log_time, publish_time) in enumerate(zip(logged.tolist(), published.tolist(), strict=True)):
        head = struct.pack("<HIQQ", 7, place, log_time, publish_time)
        parts.append(record(MESSAGE, head + unstamped_wrench([0.0, 0.0, float(place), 0.0, 0.0, 0.0])))
    parts += [record(DATA_END, struct.pack("<I", 0)), record(FOOTER, struct.pack("<QQI", 0, 0, 0)), MAGIC]
    path = tmp_path / "wrench.mcap"
    path.write_bytes(b"".join(parts))
    log = open_log(path)
    np.testing.assert_allclose(np.diff(log.time), 0.01, atol=1e-6)
    force = next(values for name, values in log.columns.items() if name.endswith("force.z"))
    assert force[50] - force[49] == pytest.approx(1.0)

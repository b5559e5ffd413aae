"""Times of a bag's messages: of headers, of the recorder's and the publisher's clocks, and which of them is meant."""

from __future__ import annotations

import sqlite3
import struct
from pathlib import Path

import numpy as np
import pytest

import log_bags
from biped import record, sway
from log_formats import write_ros1
from mcap_records import (
    CHANNEL,
    DATA_END,
    FOOTER,
    HEADER,
    MAGIC,
    MESSAGE,
    SCHEMA,
    mcap_record,
    mcap_texts,
)
from plantar.errors import LogError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.readers.ros.bag import _unusable
from plantar.logs.save import save_log


@pytest.fixture(scope="module")
def original() -> MotionLog:
    return record(sway("log", duration=2.0))


def unstamped_wrench(values: list[float]) -> bytes:
    """A geometry_msgs/WrenchStamped in CDR whose header's stamp was never set."""
    header = struct.pack("<iII", 0, 0, 2) + b"f\0"
    return b"\0\1\0\0" + header + b"\0\0" + struct.pack("<6d", *values)


def test_the_recorders_clock_counts_where_headers_have_none(tmp_path: Path) -> None:
    """The publisher's clock runs ahead by 3 to 9 ms, another amount each time."""
    random = np.random.default_rng(0)
    logged = 1_700_000_000_000_000_000 + 10_000_000 * np.arange(200)
    published = logged - random.integers(3_000_000, 9_000_000, 200)
    schema = struct.pack("<H", 1) + mcap_texts("geometry_msgs/msg/WrenchStamped", "ros2msg", "")
    channel = struct.pack("<HH", 7, 1) + mcap_texts("/ft/left", "cdr") + struct.pack("<I", 0)
    parts = [MAGIC, mcap_record(HEADER, mcap_texts("", "test"))]
    parts += [mcap_record(SCHEMA, schema), mcap_record(CHANNEL, channel)]
    for place, (log_time, publish_time) in enumerate(zip(logged.tolist(), published.tolist(), strict=True)):
        head = struct.pack("<HIQQ", 7, place, log_time, publish_time)
        parts.append(mcap_record(MESSAGE, head + unstamped_wrench([0.0, 0.0, float(place), 0.0, 0.0, 0.0])))
    parts += [
        mcap_record(DATA_END, struct.pack("<I", 0)),
        mcap_record(FOOTER, struct.pack("<QQI", 0, 0, 0)),
        MAGIC,
    ]
    path = tmp_path / "wrench.mcap"
    path.write_bytes(b"".join(parts))
    log = open_log(path)
    np.testing.assert_allclose(np.diff(log.time), 0.01, atol=1e-6)
    force = next(values for name, values in log.columns.items() if name.endswith("force.z"))
    assert force[50] - force[49] == pytest.approx(1.0)


def test_stamps_that_are_not_set_fall_back_to_times_of_receipt(original: MotionLog, tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    real = log_bags.ros_messages

    def without_stamps(log, store, ros1):  # type: ignore[no-untyped-def]
        for topic, kind, stamp, message in real(log, store, ros1):
            message.header.stamp.sec = message.header.stamp.nanosec = 0
            yield topic, kind, stamp, message

    log_bags.ros_messages = without_stamps
    try:
        path, _ = write_ros1(original, tmp_path)
    finally:
        log_bags.ros_messages = real
    log = open_log(path)
    assert "receive_time" in {note.code for note in log.notes}
    np.testing.assert_allclose(log.time, original.time, atol=1e-8)


@pytest.mark.parametrize(("behind", "told"), [(0.02, False), (1.5, True)])
def test_a_sensor_on_a_clock_of_its_own_is_told(
    behind: float, told: bool, original: MotionLog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its header says another time than all others' when they are received together."""
    real = log_bags.ros_messages

    def of_another_computer(log, store, ros1):  # type: ignore[no-untyped-def]
        for topic, kind, stamp, message in real(log, store, ros1):
            if topic == "/sensors/torso/imu":
                earlier = stamp + 10**10 - round(1e9 * behind)
                message.header.stamp.sec, message.header.stamp.nanosec = divmod(earlier, 10**9)
            else:
                message.header.stamp.sec += 10
            yield topic, kind, stamp + 10**10, message

    monkeypatch.setattr(log_bags, "ros_messages", of_another_computer)
    path, _ = write_ros1(original, tmp_path)
    notes = [note.text for note in open_log(path).notes if note.code == "clocks_apart"]
    assert bool(notes) == told
    assert all("stamps of /sensors/torso/imu are 1.5 s older" in text for text in notes)


def test_epoch_stamps_keep_their_digits(original: MotionLog, tmp_path: Path) -> None:
    late = MotionLog("late", original.time + 1_700_000_000, original.columns)
    save_log(late, tmp_path / "late.mcap")
    log = open_log(tmp_path / "late.mcap")
    np.testing.assert_allclose(np.diff(log.time), np.diff(late.time), atol=1e-6)
    assert 0 <= log.time[0] < 1
    assert any("1700000000" in note.text for note in log.notes)


@pytest.mark.parametrize(
    ("time", "outside"), [([-0.5, 0.0, 0.5], -0.5), ([2.0**31 - 1, 2.0**31, 2.0**31 + 1], 2.0**31)]
)
def test_a_time_that_no_stamp_holds_is_named(time: list[float], outside: float, tmp_path: Path) -> None:
    """Seconds of a stamp are counted from 0 to 2^31, and what is written is whole or not there."""
    with pytest.raises(LogError, match="ROS stamp") as refused:
        save_log(MotionLog("log", np.array(time), {}), tmp_path / "log.mcap")
    assert f"t = {outside:.10g} s" in str(refused.value)
    assert not any(tmp_path.iterdir())


def test_header_clocks_that_never_meet_are_no_clocks() -> None:
    """Stamps of one sensor that begin where another's have ended."""
    clocks = [np.arange(0, 100), np.arange(50, 150), np.arange(101, 200)]
    said = _unusable(clocks, ["/imu", "/joint_states", "/ft"])
    assert said == "the header stamps of /ft do not overlap the others'"
    assert _unusable([*clocks[:2], np.arange(99, 200)], ["/imu", "/joint_states", "/ft"]) is None


def test_rows_without_a_message_are_counted_with_the_broken_ones(tmp_path: Path) -> None:
    """Two of five rows hold nothing."""
    path = tmp_path / "log.db3"
    with sqlite3.connect(path) as file:
        file.execute("CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT)")
        file.execute("CREATE TABLE messages(id INTEGER, topic_id INTEGER, timestamp INTEGER, data BLOB)")
        file.execute("INSERT INTO topics VALUES (1, '/ft/left', 'geometry_msgs/msg/WrenchStamped', 'cdr')")
        for place in range(5):
            data = None if place in (1, 3) else unstamped_wrench([0.0, 0.0, float(place), 0.0, 0.0, 0.0])
            file.execute("INSERT INTO messages VALUES (?, 1, ?, ?)", (place, 10_000_000 * place, data))
    log = open_log(path)
    assert len(log) == 3
    (told,) = [note.text for note in log.notes if note.code == "messages_broken"]
    assert told == "log.db3: /ft/left: 2 of 5 messages cannot be decoded and are left out"

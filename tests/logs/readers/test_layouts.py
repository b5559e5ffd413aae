"""ROS messages read by their layout: byte orders, alignments, lengths that lie."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from plantar.logs.readers.ros.layouts import IMU, JOINT_STATE, WRENCH, BrokenMessage, layout_of
from plantar.logs.readers.ros.topics import Topic


def cdr_joint_state(
    names: list[str], position: list[float], order: str = "<", frame: str = "b", wide: int = 8
) -> bytes:
    """A JointState serialised by hand, in either byte order; `wide` is the largest alignment."""
    kind = {"<8": b"\0\1", ">8": b"\0\0", "<4": b"\0\7", ">4": b"\0\6"}[f"{order}{wide}"]
    body = struct.pack(f"{order}iI", 12, 345)

    def aligned(size: int) -> bytes:
        return body + bytes(-len(body) % min(size, wide))

    def text(word: str) -> bytes:
        return struct.pack(f"{order}I", len(word) + 1) + word.encode() + b"\0"

    body = aligned(4) + text(frame)
    body = aligned(4) + struct.pack(f"{order}I", len(names))
    for name in names:
        body = aligned(4) + text(name)
    for values in (position, [], []):
        body = aligned(4) + struct.pack(f"{order}I", len(values))
        if values:
            body = aligned(8) + struct.pack(f"{order}{len(values)}d", *values)
    return kind + b"\0\0" + body


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("wide", [8, 4])
@pytest.mark.parametrize("frame", ["", "b", "base", "a_longer_frame"])
def test_layouts_of_both_byte_orders_and_alignments(order: str, wide: int, frame: str) -> None:
    data = cdr_joint_state(["hip", "knee", "ankle_roll"], [1.5, -2.5, 3.5], order, frame, wide)
    layout = layout_of(JOINT_STATE, "cdr", data)
    rows = np.frombuffer(data * 3, np.uint8).reshape(3, -1)
    assert layout.names == ("hip", "knee", "ankle_roll")
    assert layout.frame == frame
    assert layout.matches(rows).all()
    assert layout.stamps(rows).tolist() == [12_000_000_345] * 3
    assert layout.values(rows, layout.fields[0]).tolist() == [[1.5, -2.5, 3.5]] * 3


def test_a_message_of_the_same_size_with_other_names_is_another_layout() -> None:
    one, two = (cdr_joint_state([name, "b"], [1.0, 2.0]) for name in ("left", "lift"))
    assert len(one) == len(two)
    rows = np.stack([np.frombuffer(one, np.uint8), np.frombuffer(two, np.uint8)])
    assert layout_of(JOINT_STATE, "cdr", one).matches(rows).tolist() == [True, False]
    rows[1] = rows[0]
    rows[1, 1] = 5  # an encapsulation that nobody knows
    assert layout_of(JOINT_STATE, "cdr", one).matches(rows).tolist() == [True, False]


@pytest.mark.parametrize(("frames", "broken"), [(200, 0), (201, 1), (230, 30)])
def test_a_topic_has_two_hundred_layouts_at_most(frames: int, broken: int) -> None:
    """A file that changes the frame with every message would take an hour: what is beyond counts as broken."""
    sent = [cdr_joint_state(["hip"], [1.0], frame=f"{number:04d}") for number in range(frames)]
    buffer, size = np.frombuffer(b"".join(sent), np.uint8), len(sent[0])
    topic = Topic("/joint_states", JOINT_STATE, "cdr")
    starts = [size * place for place in range(frames)]
    topic.add(buffer, starts, [start + size for start in starts], list(range(frames)))
    assert (topic.broken, len(topic.layouts)) == (broken, min(frames, 200))


@pytest.mark.parametrize("kind", [JOINT_STATE, IMU, WRENCH])
@pytest.mark.parametrize("encoding", ["cdr", "ros1"])
def test_lengths_that_lie_are_broken_messages(kind: str, encoding: str) -> None:
    for data in (b"", b"\0\1\0\0", b"\0\1\0\0" + b"\xff" * 60, b"\0\1\0\0" + bytes(11)):
        with pytest.raises(BrokenMessage):
            layout_of(kind, encoding, data)  # type: ignore[arg-type]


@pytest.mark.parametrize("frame", ["b", "a_frame_whose_name_is_longer_than_two_numbers"])
def test_what_some_messages_lack_is_no_number_there(frame: str) -> None:
    """Of five messages of two joints every second has no positions; longer ones are read behind shorter ones."""
    sent = [
        cdr_joint_state(["hip", "knee"], [float(k), -float(k)])
        if k % 2 == 0
        else cdr_joint_state(["hip", "knee"], [], frame=frame)
        for k in range(5)
    ]
    ends = np.cumsum([len(data) for data in sent]).tolist()
    topic = Topic("/joint_states", JOINT_STATE, "cdr")
    topic.add(np.frombuffer(b"".join(sent), np.uint8), [0, *ends[:-1]], ends, [10 * k for k in range(5)])
    (series,) = topic.series.values()
    order = np.argsort(series.clock(received=True))
    position = np.concatenate(series.values["position"])[order]
    np.testing.assert_array_equal(position[::2], [[0.0, -0.0], [2.0, -2.0], [4.0, -4.0]])
    assert np.isnan(position[1::2]).all()
    np.testing.assert_array_equal(series.column("position", 1)[order], position[:, 1])
    assert np.isnan(series.column("effort", 0)).tolist() == 5 * [True]


def test_a_message_has_the_fields_that_are_filled_and_named() -> None:
    found = layout_of(JOINT_STATE, "cdr", cdr_joint_state(["hip"], [1.5]))
    assert [(name, size) for name, _, size in found.fields] == [("position", 1)]
    head = b"\0\1\0\0" + struct.pack("<iI", 12, 345) + struct.pack("<I", 2) + b"b\0" + bytes(2)
    imu = layout_of(IMU, "cdr", head + struct.pack("<37d", *range(37)))
    named = ["orientation", "orientation_covariance", "angular_velocity", "linear_acceleration"]
    assert [name for name, *_ in imu.fields] == named


def test_messages_that_come_later_are_read_by_the_layout_that_is_known() -> None:
    """Beside some of another size in between: each has its layout once."""
    short, long = (
        cdr_joint_state(names, [1.0] * len(names)) for names in (["hip"], ["hip", "knee_of_the_leg"])
    )
    topic = Topic("/joint_states", JOINT_STATE, "cdr")
    for message, size in ((short, 3), (long, 2), (short, 4)):
        buffer = np.frombuffer(message * size, np.uint8)
        starts = [len(message) * place for place in range(size)]
        topic.add(buffer, starts, [start + len(message) for start in starts], list(range(size)))
    assert [layout.names for layout in topic.layouts] == [("hip",), ("hip", "knee_of_the_leg")]
    assert (topic.count, topic.broken) == (9, 0)
    assert [sum(map(len, part.header)) for part in topic.series.values()] == [7, 2]

"""Topics of a bag as streams, of made-up messages: whose joints are taken, on which clock, and what is said of them."""

from __future__ import annotations

import bz2
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar.errors import LogError
from plantar.logs.readers.ros.bag import _check, _clocks_apart, _streams, _unusable, bag_files
from plantar.logs.readers.ros.compressed import BrokenChunk, TooLong, decompress
from plantar.logs.readers.ros.joint_topics import Messages, joint_columns
from plantar.logs.readers.ros.layouts import IMU, JOINT_STATE, WRENCH
from plantar.logs.readers.ros.sensor_topics import _frame_elsewhere, assign
from plantar.logs.readers.ros.topics import Series, Topic
from plantar.notes import Note
from plantar.robot.model import Placement, RobotModel

PATH = Path("walk.bag")
SECOND = 1_000_000_000
EPOCH = 1_700_000_000 * SECOND


def series(stamps: Any, names: tuple[str, ...] = (), later: int = 2_000_000, **values: Any) -> Series:
    """Messages that are received `later` [ns] than their headers' stamps say."""
    header = np.asarray(stamps, np.int64)
    numbers = {name: [np.asarray(rows, float)] for name, rows in values.items()}
    return Series(names, [header], [header + later], numbers)


def topic(name: str, kind: str, *parts: Series) -> Topic:
    made = Topic(name, kind, "cdr")  # type: ignore[arg-type]
    made.series = {(str(place),): one for place, one in enumerate(parts)}
    return made


def said(notes: list[Note]) -> list[tuple[str, str, str]]:
    return [(note.code, note.severity, note.text) for note in notes]


def test_a_joint_belongs_to_the_first_topic_that_names_it_and_to_its_first_place_there() -> None:
    """Lists of names change on the way: the knee is in both, the hip in the first, the toe in the second."""
    ticks = SECOND * np.arange(4)
    first = series(
        ticks[::2], ("hip", "knee", "hip"), position=[[1, 2, 9], [3, 4, 9]], effort=[[5, 6, 9], [7, 8, 9]]
    )
    second = series(ticks[1::2], ("knee", "toe"), position=[[10, 20], [30, 40]])
    notes: list[Note] = []
    owners = {"toe": "/feet"}
    found = list(joint_columns(topic("/joint_states", JOINT_STATE, first, second), owners, notes, PATH))
    columns = {name: values.tolist() for _, part in found for name, values in part.items()}
    np.testing.assert_equal(columns, {
        "joint.hip.position": [1, 3], "joint.hip.effort": [5, 7], "joint.knee.position": [2, 10, 4, 30],
        "joint.knee.effort": [6, np.nan, 8, np.nan],
    })  # fmt: skip
    assert owners == {"toe": "/feet", "hip": "/joint_states", "knee": "/joint_states"}
    assert [messages.clock(received=False).tolist() for messages, _ in found] == [
        [0, 2 * SECOND],
        ticks.tolist(),
    ]
    assert said(notes) == [
        ("joint_twice", "warning", "walk.bag: /joint_states names 'hip' twice; the first is used"),
        ("joint_topics", "warning",
         "walk.bag: /joint_states names joints that /feet holds; they are taken from /feet"),
    ]  # fmt: skip
    wanted: list[Note] = []
    assert not list(joint_columns(topic("/joint_commands", JOINT_STATE, first), owners, wanted, PATH))
    assert [note.severity for note in wanted] == ["warning", "info"], (
        "a command is expected to name them again"
    )


def test_messages_of_several_lists_stand_in_the_order_in_which_they_came() -> None:
    late = series([10, 30], ("a",), later=100, position=[[1], [2]])
    early = series([50, 20], ("a",), later=0, position=[[3], [4]])
    both = Messages((late, early))
    assert both.clock(received=True).tolist() == [20, 50, 110, 130]
    assert both.clock(received=False).tolist() == [20, 50, 10, 30]
    assert both.column("position", "a").tolist() == [4, 3, 1, 2]
    assert np.isnan(both.column("velocity", "a")).all()


def test_streams_count_from_a_whole_second_on_the_clock_of_the_headers() -> None:
    force = series(EPOCH + SECOND * np.array([0.7, 1.2]), force=[[1, 2, 3], [4, 5, 6]])
    turn = series(
        EPOCH + SECOND * np.array([0.5, 1.5]), orientation=[[0, 0, 0, 1]] * 2, orientation_covariance=np.zeros((2, 9)),
        angular_velocity=[[7, 8, 9]] * 2,
    )  # fmt: skip
    notes: list[Note] = []
    chosen = {"wrench.left": [topic("/ft", "x", force)], "imu.chest": [topic("/imu", "x", turn)]}
    left, chest = _streams(chosen, PATH, notes)
    np.testing.assert_allclose(left.time, [0.7, 1.2])
    np.testing.assert_allclose(chest.time, [0.5, 1.5])
    assert {name: values.tolist() for name, values in left.columns.items()} == {
        "wrench.left.force.x": [1, 4], "wrench.left.force.y": [2, 5], "wrench.left.force.z": [3, 6],
    }  # fmt: skip
    axes = {**dict.fromkeys("xyz", 0.0), "w": 1.0}
    assert {name: values[0] for name, values in chest.columns.items()} == {
        **{f"imu.chest.orientation.{axis}": value for axis, value in axes.items()},
        **{f"imu.chest.angular_velocity.{axis}": 7.0 + place for place, axis in enumerate("xyz")},
    }  # fmt: skip
    assert said(notes) == [
        ("time_origin", "info", "walk.bag: time counts from 1700000000 s of the bag's clock")
    ]


def test_of_two_topics_of_a_sensor_the_second_fills_in_what_the_first_lacks() -> None:
    ticks = SECOND * np.arange(2)
    unknown = np.zeros((2, 9))
    unknown[:, 0] = -1.0
    first = series(
        ticks,
        orientation=[[0, 0, 0, 1]] * 2,
        orientation_covariance=unknown,
        angular_velocity=[[1, 2, 3]] * 2,
    )
    second = series(ticks, angular_velocity=[[7, 8, 9]] * 2, linear_acceleration=[[4, 5, 6]] * 2)
    streams = _streams({"imu.chest": [topic("/gyro", "x", first), topic("/acc", "x", second)]}, PATH, [])
    assert [(one.name, sorted(one.columns)) for one in streams] == [
        ("/gyro", [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]),
        ("/acc", [f"imu.chest.linear_acceleration.{axis}" for axis in "xyz"]),
    ]


def test_clocks_that_cannot_be_used_or_that_are_apart() -> None:
    """Messages of the force sensor are 0.25 s old when they come, those of the IMU 0.05 s."""
    ticks = SECOND * np.arange(4)
    sources = [
        (topic("/ft", "x"), series(ticks, later=SECOND // 4)), (topic("/imu", "x"), series(ticks, later=SECOND // 20)),
    ]  # fmt: skip
    assert _clocks_apart(sources) == (
        "the header stamps of /ft are 0.2 s older at their receipt than those of /imu: "
        "clocks that differ make the sensors late by as much (valid: all computers on one clock)"
    )
    assert _clocks_apart(sources[1:]) is None
    assert _unusable([ticks, np.array([0, 0, 0, SECOND])], ["/ft", "/imu"]) == "/imu has no header stamps"
    assert _unusable([ticks, np.array([0, 0, 1, SECOND])], ["/ft", "/imu"]) is None, "half of them are set"
    apart = _unusable([ticks, 9 * SECOND + ticks], ["/ft", "/imu"])
    assert apart == "the header stamps of /imu do not overlap the others'"
    assert _unusable([ticks, 3 * SECOND + ticks], ["/ft", "/imu"]) is None, "they meet at one stamp"
    never, notes = series([0, 0, 0], force=[[1, 2, 3]] * 3), list[Note]()
    (stream,) = _streams({"wrench.left": [topic("/ft", "x", never)]}, PATH, notes)
    np.testing.assert_allclose(stream.time, [0.002] * 3)
    text = "walk.bag: /ft has no header stamps; times of receipt are used instead"
    assert said(notes) == [("receive_time", "warning", text)]


def test_what_is_broken_is_counted_and_a_bag_of_nothing_refused() -> None:
    broken, whole = topic("/ft", "x", series([0])), topic("/imu", "x")
    broken.broken, broken.count = 3, 9
    notes: list[Note] = []
    _check({"/ft": broken, "/imu": whole}, PATH, notes)
    text = "walk.bag: /ft: 3 of 9 messages cannot be decoded and are left out"
    assert said(notes) == [("messages_broken", "warning", text)]
    with pytest.raises(
        LogError,
        match=r"^walk\.bag: holds no message that plantar reads \(valid: sensor_msgs/JointState, sensor_msgs/Imu, "
        r"geometry_msgs/WrenchStamped\)$",
    ):
        _check({"/imu": whole}, PATH, notes)


def test_parts_of_a_bag_stand_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    for name in ("walk_10.MCAP", "walk_9.mcap", "walk_2.db3", "notes.txt"):
        (tmp_path / name).write_bytes(b"")
    assert [path.name for path in bag_files(tmp_path)] == ["walk_2.db3", "walk_9.mcap", "walk_10.MCAP"]
    assert bag_files(tmp_path / "walk_9.mcap") == [tmp_path / "walk_9.mcap"]


def test_chunks_that_cannot_be_unpacked() -> None:
    with pytest.raises(BrokenChunk, match=r"^unknown compression 'snappy'$"):
        decompress("snappy", b"", 10)
    with pytest.raises(BrokenChunk, match=r"^Invalid data stream$"):
        decompress("bz2", b"BZh9 what is not packed", 10)
    assert decompress("bz2", bz2.compress(b"0123456789"), 10) == b"0123456789"
    with pytest.raises(TooLong, match=r"^holds more than 9 bytes$"):
        decompress("bz2", bz2.compress(b"0123456789"), 9)


def test_messages_that_are_no_messages_are_counted() -> None:
    """Two of four bytes, and one whose frame claims to be longer than itself."""
    lies = b"\0\1\0\0" + struct.pack("<iII", 0, 0, 99) + b"f\0\0\0"
    buffer = np.frombuffer(b"abcdefgh" + lies, np.uint8)
    made = topic("/ft", WRENCH)
    made.add(buffer, [0, 4, 8], [4, 8, 8 + len(lies)], [1, 2, 3])
    assert (made.count, made.broken, made.series) == (3, 3, {})


def test_a_frame_that_is_elsewhere_is_told_with_its_distance_and_its_turn(robot: RobotModel) -> None:
    """The sole is 90 mm below the foot; the robot file puts the sensor 50 mm and 60 degrees off it."""
    place = Placement("left_foot", np.array([0.03, 0.04, -0.09]), np.array([0.0, 0.0, np.pi / 3]))
    wrench = topic("/ft", WRENCH)
    wrench.frames = ["", "/left_sole"]
    (note,) = _frame_elsewhere("wrench 'left'", place, wrench, robot, PATH)
    assert (note.code, note.severity) == ("sensor_frame", "warning")
    assert note.text == (
        "walk.bag: messages of wrench 'left' say that they are in frame left_sole, which is 50 mm and 60 deg away from "
        "where robot.yaml puts the sensor (link: left_foot); the robot file is followed"
    )
    for frames in (["left_foot"], ["nowhere"], []):
        wrench.frames = frames
        assert not _frame_elsewhere("wrench 'left'", place, wrench, robot, PATH)


def test_topics_to_choose_from_are_told_six_or_eight_at_a_time(robot: RobotModel) -> None:
    many = [topic(f"/device_{place}", WRENCH) for place in range(9)]
    six = ", ".join(f"/device_{place}" for place in range(6))
    with pytest.raises(LogError) as refused:
        assign(many, robot, PATH, [])
    assert str(refused.value) == (
        f"walk.bag: which topic is the wrench 'left'? (valid: topics: {{left: TOPIC}} in the robot file, TOPIC "
        f"one of {six})"
    )
    eight = f"{six}, /device_6, /device_7"
    told = replace(robot, topics={"left": "/other"})
    with pytest.raises(LogError) as unknown:
        assign(many, told, PATH, [])
    assert str(unknown.value) == (
        f"walk.bag: has no topic '/other' (topics in the robot file) (valid: {eight})"
    )
    notes: list[Note] = []
    both = replace(robot, topics={"left": "/device_8", "right": "/device_7"})
    chosen = assign([*many, topic("/device_9", WRENCH)], both, PATH, notes)
    assert {key: [one.name for one in topics] for key, topics in chosen.items()} == {
        "wrench.left": ["/device_8"], "wrench.right": ["/device_7"],
    }  # fmt: skip
    ignored = ", ".join(f"/device_{place}" for place in (*range(7), 9))
    assert said(notes) == [
        ("topics_ignored", "info", f"walk.bag: topics of no sensor in the robot file, not used: {ignored}")
    ]
    other = replace(robot, topics={"left": "/imu", "right": "/device_7"})
    with pytest.raises(LogError) as kind:
        assign([topic("/imu", IMU), *many], other, PATH, [])
    assert str(kind.value) == (
        f"walk.bag: topic '/imu' (topics in the robot file) is no geometry_msgs/WrenchStamped, but "
        f"sensor_msgs/Imu (valid: {eight})"
    )

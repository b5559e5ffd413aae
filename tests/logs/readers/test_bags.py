"""Bags: what is saved reads back, cut ones give what they have, bombs are left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot
from log_formats import write_mcap, write_ros1
from mcap_records import mcap_of_chunk
from plantar.errors import LogError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log, read_limit
from plantar.logs.readers.ros.joint_topics import joint_rank
from plantar.logs.save import save_log
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def original() -> MotionLog:
    return record(sway("log", duration=2.0))


@pytest.fixture(scope="module")
def bag(original: MotionLog, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bag")
    save_log(original, folder / "log.mcap")
    return folder / "log.mcap"


def test_what_is_saved_reads_back_bit_for_bit(original: MotionLog, bag: Path, tmp_path: Path) -> None:
    for path in (bag, tmp_path / "log.csv", tmp_path / "log.parquet"):
        if path is not bag:
            save_log(original, path)
        log = open_log(path)
        assert set(log.columns) == set(original.columns)
        np.testing.assert_allclose(log.time, original.time, rtol=0, atol=1e-9)
        for name, values in original.columns.items():
            np.testing.assert_array_equal(log.columns[name], values, err_msg=f"{path} {name}")


def test_a_saved_bag_is_read_by_rosbags(original: MotionLog, bag: Path) -> None:
    highlevel = pytest.importorskip("rosbags.highlevel")
    with highlevel.AnyReader([bag]) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == "/imu/chest":
                first = original.orientation("chest")
                assert first is not None
                assert message.orientation.w == first[0, 0]
                assert message.header.frame_id == "chest"
                break


@pytest.mark.parametrize("known", [True, False])
def test_a_bag_says_whether_an_imu_knows_its_attitude(
    original: MotionLog, tmp_path: Path, known: bool
) -> None:
    """sensor_msgs/Imu: without one, the first number of its covariance is -1."""
    highlevel = pytest.importorskip("rosbags.highlevel")
    columns = {name: v for name, v in original.columns.items() if known or ".orientation." not in name}
    save_log(MotionLog("log", original.time, columns), tmp_path / "log.mcap")
    with highlevel.AnyReader([tmp_path / "log.mcap"]) as reader:
        (imu,) = (one for one in reader.connections if one.topic == "/imu/chest")
        _, _, raw = next(reader.messages([imu]))
        assert reader.deserialize(raw, imu.msgtype).orientation_covariance[0] == (0.0 if known else -1.0)
    assert any(".orientation." in name for name in open_log(tmp_path / "log.mcap").columns) == known


def test_a_bag_cut_anywhere_gives_its_whole_records(bag: Path, tmp_path: Path, original: MotionLog) -> None:
    content = bag.read_bytes()
    seen = []
    for share in (0.3, 0.5, 0.7, 0.9, 0.99):
        path = tmp_path / "cut.mcap"
        path.write_bytes(content[: int(share * len(content))])
        log = open_log(path)
        seen.append(len(log))
        assert "file_cut" in {note.code for note in log.notes} or len(log) == len(original)
        for name, values in log.columns.items():
            np.testing.assert_array_equal(values, original.columns[name][: len(log)])
    assert seen == sorted(seen)
    assert 10 < seen[0] < seen[-2] < len(original)


def test_topics_of_the_robot_file_go_first_and_an_unknown_one_is_named(
    original: MotionLog, tmp_path: Path
) -> None:
    path, _ = write_mcap(original, tmp_path)
    swapped = make_robot(tmp_path / "swapped", topics={"left": "/ft/right", "right": "/ft/left"})
    log = open_log(path, swapped)
    np.testing.assert_array_equal(
        log.columns["wrench.left.force.z"], original.columns["wrench.right.force.z"]
    )
    wrong = make_robot(tmp_path / "wrong", topics={"left": "/ft/nowhere"})
    with pytest.raises(
        LogError,
        match=r"bag\.mcap: has no topic '/ft/nowhere' \(topics in the robot file\) \(valid: /ft/left, "
        r"/ft/right, /joint_states, /neck/joint_states, /sensors/torso/imu\)$",
    ) as caught:
        open_log(path, wrong)
    assert "/ft/left" in str(caught.value)


def test_sensors_that_no_topic_is_called_after_are_asked_for(original: MotionLog, tmp_path: Path) -> None:
    renamed = {name.replace("wrench.left", "wrench.a").replace("wrench.right", "wrench.b"): values
               for name, values in original.columns.items()}  # fmt: skip
    save_log(MotionLog("log", original.time, renamed), tmp_path / "log.mcap")
    with pytest.raises(
        LogError,
        match=r"log\.mcap: which topic is the wrench 'left'\? \(valid: topics: \{left: TOPIC\} in the "
        r"robot file, TOPIC one of /wrench/a, /wrench/b\)$",
    ):
        open_log(tmp_path / "log.mcap", make_robot(tmp_path / "robot"))


def test_a_command_does_not_fill_in_for_a_measurement(original: MotionLog, tmp_path: Path) -> None:
    """Two topics name the same joints; what the states lack is not taken from the commands."""
    measured = {name: values for name, values in original.columns.items() if not name.endswith(".velocity")}
    commands = {name: values + 1 for name, values in original.columns.items() if name.startswith("joint.")}
    save_log(MotionLog("log", original.time, measured), tmp_path / "bag" / "a.mcap")
    save_log(MotionLog("log", original.time, commands), tmp_path / "b.mcap")
    content = (tmp_path / "b.mcap").read_bytes().replace(b"/joint_states", b"/joint_wanted")
    (tmp_path / "bag" / "b.mcap").write_bytes(content)  # the chunk's own bytes hold no topic
    log = open_log(tmp_path / "bag")
    assert not [name for name in log.columns if name.endswith(".velocity")]
    np.testing.assert_array_equal(log.column("joint.neck.position"), original.column("joint.neck.position"))
    assert "joint_topics" in {note.code for note in log.notes}
    wanted = open_log(tmp_path / "bag", make_robot(tmp_path / "robot", topics={"joints": "/joint_wanted"}))
    np.testing.assert_array_equal(
        wanted.column("joint.left_leg_x.position"), commands["joint.left_leg_x.position"]
    )


def test_topics_of_no_sensor_are_told(original: MotionLog, tmp_path: Path) -> None:
    hand = {name.replace("wrench.left", "wrench.hand"): values for name, values in original.columns.items()}
    save_log(MotionLog("log", original.time, {**original.columns, **hand}), tmp_path / "log.mcap")
    log = open_log(tmp_path / "log.mcap", make_robot(tmp_path / "robot"))
    assert not [name for name in log.columns if "hand" in name]
    told = [note.text for note in log.notes if note.code == "topics_ignored"]
    assert told == ["log.mcap: topics of no sensor in the robot file, not used: /wrench/hand"]


def reshaped(original: MotionLog, folder: Path, names: list[list[str]], topic: str = "") -> Path:
    """A ROS 2 bag whose message i names `names[i % n]` of the joints; `topic`: another, with positions 0.1 off."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    kind = "sensor_msgs/msg/JointState"
    state, header, clock = (
        store.types[name] for name in (kind, "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    )
    empty = np.zeros(0)
    with Writer(folder / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for name, off in (("/joint_states", 0.0), *([(topic, 0.1)] if topic else [])):
            connection = writer.add_connection(name, kind, typestore=store)
            for row, stamp in enumerate(np.rint(original.time * 1e9).astype(int).tolist()):
                held = names[row % len(names)]
                at = np.array([original.column(f"joint.{joint}.position")[row] + off for joint in held])
                top = header(stamp=clock(sec=stamp // 10**9, nanosec=stamp % 10**9), frame_id="")
                message = state(header=top, name=held, position=at, velocity=empty, effort=empty)
                writer.write(connection, stamp, store.serialize_cdr(message, kind))
    return folder / "bag"


def test_a_joint_is_read_from_every_message_that_names_it(original: MotionLog, tmp_path: Path) -> None:
    """The order of names changes from message to message, and one joint stands in every second message only."""
    joints = list(dict.fromkeys(name.split(".")[1] for name in original.columns if name.startswith("joint.")))
    log = open_log(reshaped(original, tmp_path, [joints[1:], joints[::-1]]))
    assert len(log) == len(original) - 2  # cut to what the rare joint covers
    for joint in joints[1:]:
        column = f"joint.{joint}.position"
        np.testing.assert_array_equal(log.column(column), original.column(column)[1:-1], err_msg=joint)
    column = f"joint.{joints[0]}.position"
    np.testing.assert_array_equal(log.column(column)[::2], original.column(column)[1:-1:2])


@pytest.mark.parametrize(
    ("topic", "severity"),
    [("/arm/desired_joint_states", "info"), ("/a/joint_command", "info"), ("/a/joints", "warning")],
)
def test_of_two_topics_the_measured_one_is_read(
    original: MotionLog, tmp_path: Path, topic: str, severity: str
) -> None:
    log = open_log(reshaped(original, tmp_path, [["neck"]], topic))
    np.testing.assert_array_equal(log.column("joint.neck.position"), original.column("joint.neck.position"))
    (note,) = (note for note in log.notes if note.code == "joint_topics")
    assert note.severity == severity
    assert f"{topic} names joints that /joint_states holds; they are taken from /joint_states" in note.text


@pytest.mark.parametrize(
    ("frame", "height", "said"),
    [
        ("left_sole", -0.09, None),
        ("left_sole", -0.06, "frame left_sole, which is 30 mm and 0 deg away"),
        ("torso", -0.09, "frame torso, which is on another link"),
    ],
)
def test_messages_in_a_frame_that_is_elsewhere_are_told(
    original: MotionLog, tmp_path: Path, frame: str, height: float, said: str | None
) -> None:
    """The sole is 90 mm below the foot's origin."""
    robot = make_robot(tmp_path / "robot")

    def with_left(link: str, z: float) -> RobotModel:
        foot = robot.feet["left"]
        place = replace(foot.wrench.placement, link=link, xyz=np.array([0.0, 0.0, z]), rpy=np.zeros(3))
        moved = replace(foot, wrench=replace(foot.wrench, placement=place))
        return replace(robot, feet={**robot.feet, "left": moved})

    save_log(original, tmp_path / "log.mcap", with_left(frame, 0.0))
    log = open_log(tmp_path / "log.mcap", with_left("left_foot", height))
    told = [note for note in log.notes if note.code == "sensor_frame"]
    assert [note.severity for note in told] == ["warning"] * (said is not None)
    assert said is None or said in told[0].text


def test_a_topic_of_another_kind_is_refused(original: MotionLog, tmp_path: Path) -> None:
    save_log(original, tmp_path / "log.mcap")
    robot = make_robot(tmp_path / "robot", topics={"left": "/imu/chest"})
    with pytest.raises(
        LogError,
        match=r"log\.mcap: topic '/imu/chest' \(topics in the robot file\) is no "
        r"geometry_msgs/WrenchStamped, but sensor_msgs/Imu \(valid: /wrench/left, /wrench/right\)$",
    ):
        open_log(tmp_path / "log.mcap", robot)


def test_bags_that_lie_in_one_folder_are_joined_with_a_warning(original: MotionLog, tmp_path: Path) -> None:
    """Two recordings are no parts of one, as ROS 2 names them beside the parts."""
    save_log(original, tmp_path / "bags" / "walk_1.mcap")
    later = MotionLog("later", original.time + 100.0, original.columns)
    save_log(later, tmp_path / "bags" / "walk_2.mcap")
    (note,) = (note for note in open_log(tmp_path / "bags").notes if note.code == "bags_joined")
    assert "its 2 files are read as one recording: walk_1.mcap, walk_2.mcap" in note.text
    (tmp_path / "bags" / "metadata.yaml").touch()
    assert "bags_joined" not in {note.code for note in open_log(tmp_path / "bags").notes}


def test_the_folder_that_one_stands_in_has_its_name(
    original: MotionLog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_log(original, tmp_path / "sway" / "part_0.mcap")
    monkeypatch.chdir(tmp_path / "sway")
    assert open_log(".").name == "sway"


def test_a_ros1_bag_that_was_never_closed(original: MotionLog, tmp_path: Path) -> None:
    path, _ = write_ros1(original, tmp_path)
    content = path.read_bytes()
    (tmp_path / "open.bag.active").write_bytes(content[: int(0.6 * len(content))])
    log = open_log(tmp_path / "open.bag.active")
    assert 50 < len(log) < len(original)
    assert log.name == "open"


def test_without_a_robot_sensors_go_by_their_topics(original: MotionLog, tmp_path: Path) -> None:
    path, _ = write_mcap(original, tmp_path)
    names = {name.rsplit(".", 2)[0] for name in open_log(path).columns if not name.startswith("joint.")}
    assert {"wrench.left", "wrench.right"} < names
    assert any(name.startswith("imu.sensors_torso") for name in names)


def test_an_imu_without_attitude_has_no_such_columns(original: MotionLog, tmp_path: Path) -> None:
    bare = {name: values for name, values in original.columns.items() if ".orientation." not in name}
    save_log(MotionLog("bare", original.time, bare), tmp_path / "bare.mcap")
    assert set(open_log(tmp_path / "bare.mcap").columns) == set(bare)


def test_files_of_another_kind_are_refused_in_one_line(tmp_path: Path) -> None:
    for name, content in (
        ("a.mcap", b"PK\3\4"), ("b.bag", b"#ROSBAG V1.2\n"), ("c.db3", b"SQLite format 3\0garbage"), ("d.bin", b"ANNE"),
        ("e.bin", b"\x7fELF"), ("f.mat", b"MATLAB 5.0 MAT-file"), ("g.npz", b""), ("h.log", b""), ("i.log", b"a b c\n"),
        ("j.mcap", b"\x89MCAP0\r\n"), ("k.walk", b"1 2 3\n"), ("l.sh_q", b"words only\n"),
    ):  # fmt: skip
        (tmp_path / name).write_bytes(content)
        with pytest.raises(LogError) as caught:
            open_log(tmp_path / name)
        assert name in str(caught.value)
        assert "\n" not in str(caught.value)
    (tmp_path / "empty").mkdir()
    with pytest.raises(
        LogError,
        match=r"empty: is a directory without logs \(valid: a ROS bag, or YARP dumps with data\.log\)$",
    ):
        open_log(tmp_path / "empty")
    (tmp_path / "empty" / "sway.csv").touch()
    with pytest.raises(
        LogError, match=r"is a directory, no log \(valid: its files, such as .*empty/\*\.csv;"
    ):
        open_log(tmp_path / "empty")


def test_a_decompression_bomb_is_left_out(tmp_path: Path) -> None:
    zstandard = pytest.importorskip("zstandard")
    packed = zstandard.ZstdCompressor().compress(bytes(100 * 2**20))
    for claimed in (1000, 100 * 2**20, 2**60):
        (tmp_path / "bomb.mcap").write_bytes(mcap_of_chunk(packed, claimed))
        with pytest.raises(
            LogError,
            match=r"bomb\.mcap: holds no message that plantar reads \(valid: sensor_msgs/JointState, "
            r"sensor_msgs/Imu, geometry_msgs/WrenchStamped\)$",
        ):
            open_log(tmp_path / "bomb.mcap")


def test_a_bag_of_many_bombs_is_stopped_by_its_own_size(
    original: MotionLog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, _ = write_mcap(original, tmp_path)
    assert open_log(path).columns
    monkeypatch.setattr(read_limit, "SMALL", 1000)
    monkeypatch.setattr(read_limit, "RATIO", 0)
    with pytest.raises(
        LogError,
        match=r"bag\.mcap: unpacks to more than 1 kB \(valid: at most 1 kB from a file of 95\.2 kB: 1 "
        r"kB and 0 times its size\)$",
    ):
        open_log(path)


def test_of_topics_the_one_with_most_joints_is_measured_and_then_none_that_is_wanted() -> None:
    def topic(name: str, *joints: str) -> Any:
        return SimpleNamespace(name=name, series={0: SimpleNamespace(names=joints)})

    most, other, own, wanted = (
        topic("/joint_command", "a", "b", "c"), topic("/arm", "a", "b"), topic("/joint_states", "a", "b"),
        topic("/desired/joint_states", "a", "b"),
    )  # fmt: skip
    found = sorted((other, wanted, own, most), key=lambda one: joint_rank(one, None))
    assert found == [most, own, other, wanted]

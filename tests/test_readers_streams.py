"""Streams on clocks of their own; and what a bag, a map or a port may get wrong."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from biped import make_robot, record, sway
from log_formats import write_mcap, write_ros1
from plantar.errors import LogError
from plantar.log import MotionLog
from plantar.notes import Note
from plantar.readers import compressed, open_log
from plantar.readers.ros_layouts import IMU, JOINT_STATE, WRENCH, BrokenMessage, layout_of
from plantar.readers.save import save_log
from plantar.readers.streams import Stream, merge, resample
from plantar.robot import RobotModel


def stream(name: str, time: np.ndarray, **columns: np.ndarray) -> Stream:
    return Stream(name, time, {key.replace("__", "."): value for key, value in columns.items()})


# --- clocks -----------------------------------------------------------------------------------------------


def test_the_fastest_clock_is_the_base_and_the_rest_is_linear_in_between() -> None:
    fast, slow = np.arange(0, 2, 0.002), np.arange(0, 2, 0.01)
    notes: list[Note] = []
    joints = stream("j", fast, joint__a__position=np.sin(fast))
    force = stream("w", slow, wrench__l__force__z=3 * slow + 1)
    time, columns = merge([force, joints], Path("x"), notes)
    assert np.isin(time, fast).all()
    np.testing.assert_allclose(columns["wrench.l.force.z"], 3 * time + 1, atol=1e-12)
    assert "streams_resampled" in {note.code for note in notes}


def test_gaps_stay_gaps_and_samples_beside_them_stay_recorded() -> None:
    base, other = np.arange(0, 10, 0.01), np.r_[np.arange(0, 4, 0.02), np.arange(6, 10, 0.02)]
    columns, exact = resample(stream("w", other, wrench__l__force__z=np.ones(other.size)), base)
    hole = (base > 3.98 + 1e-9) & (base < 6 - 1e-9)
    values = columns["wrench.l.force.z"]
    assert np.isnan(values[hole]).all()
    assert (values[~hole & (base <= other[-1])] == 1).all()
    assert np.isnan(values[base > other[-1] + 1e-9]).all(), "nothing is extrapolated"
    assert not exact


def test_stamps_that_agree_are_not_interpolated() -> None:
    time = np.arange(0, 1, 0.01)
    values = np.random.default_rng(0).normal(size=time.size)
    columns, exact = resample(stream("w", time + 5e-9, wrench__l__force__z=values), time)
    assert exact
    assert np.array_equal(columns["wrench.l.force.z"], values)


def test_a_quaternion_that_changes_sign_is_interpolated_the_short_way() -> None:
    half = np.linspace(0, 1.5, 16)
    attitude = np.column_stack([np.cos(half), np.sin(half), 0 * half, 0 * half])
    attitude[1::2] *= -1
    time = np.arange(16) * 0.1
    names = [f"imu.c.orientation.{axis}" for axis in "wxyz"]
    columns, _ = resample(Stream("i", time, dict(zip(names, attitude.T, strict=True))), time[:-1] + 0.05)
    seen = np.column_stack([columns[name] for name in names])
    between = (half[:-1] + half[1:]) / 2
    wanted = np.column_stack([np.cos(between), np.sin(between), 0 * between, 0 * between])
    np.testing.assert_allclose(np.abs(np.sum(seen * wanted, axis=1)), 1, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(seen, axis=1), 1, atol=1e-12)


def test_the_log_is_cut_to_what_all_streams_cover_unless_little_is_left() -> None:
    base = np.arange(0, 10, 0.01)
    joints = stream("j", base, joint__a__position=base)
    notes: list[Note] = []
    late = base[base > 2]
    time, columns = merge([joints, stream("w", late, wrench__l__force__z=late)], Path("x"), notes)
    assert time[0] == late[0]
    assert not np.isnan(columns["wrench.l.force.z"]).any()
    assert "log_cut_to_overlap" in {note.code for note in notes}
    notes = []
    late = base[base > 9]
    time, columns = merge([joints, stream("w", late, wrench__l__force__z=late)], Path("x"), notes)
    assert time.size == base.size
    assert np.isnan(columns["wrench.l.force.z"][0])
    assert "streams_apart" in {note.code for note in notes}


def test_stray_stamps_go_with_a_note_and_a_clock_that_jumps_is_refused() -> None:
    time = np.arange(0, 10, 0.01)
    time[500] = np.nan
    time[700] = 3.0
    notes: list[Note] = []
    cleaned, _ = merge([stream("j", time, joint__a__position=time)], Path("x"), notes)
    assert cleaned.size == time.size - 2
    assert "time_order" in {note.code for note in notes}
    jumped = np.r_[np.arange(0, 10, 0.01), np.arange(5, 15, 0.01)]
    with pytest.raises(LogError, match="steps back") as caught:
        merge([stream("/joint_states", jumped, joint__a__position=jumped)], Path("x"), [])
    assert "/joint_states" in str(caught.value)


# --- messages ---------------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("kind", [JOINT_STATE, IMU, WRENCH])
@pytest.mark.parametrize("encoding", ["cdr", "ros1"])
def test_lengths_that_lie_are_broken_messages(kind: str, encoding: str) -> None:
    for data in (b"", b"\0\1\0\0", b"\0\1\0\0" + b"\xff" * 60, b"\0\1\0\0" + bytes(11)):
        with pytest.raises(BrokenMessage):
            layout_of(kind, encoding, data)  # type: ignore[arg-type]


# --- bags -------------------------------------------------------------------------------------------------


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
    with pytest.raises(LogError, match="/ft/nowhere") as caught:
        open_log(path, wrong)
    assert "/ft/left" in str(caught.value)


def test_sensors_that_no_topic_is_called_after_are_asked_for(original: MotionLog, tmp_path: Path) -> None:
    renamed = {name.replace("wrench.left", "wrench.a").replace("wrench.right", "wrench.b"): values
               for name, values in original.columns.items()}  # fmt: skip
    save_log(MotionLog("log", original.time, renamed), tmp_path / "log.mcap")
    with pytest.raises(LogError, match=r"which topic is the wrench 'left'.*/wrench/a, /wrench/b"):
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


def test_stamps_that_are_not_set_fall_back_to_times_of_receipt(original: MotionLog, tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    import log_formats

    real = log_formats.ros_messages

    def without_stamps(log, store, ros1):  # type: ignore[no-untyped-def]
        for topic, kind, stamp, message in real(log, store, ros1):
            message.header.stamp.sec = message.header.stamp.nanosec = 0
            yield topic, kind, stamp, message

    log_formats.ros_messages = without_stamps
    try:
        path, _ = write_ros1(original, tmp_path)
    finally:
        log_formats.ros_messages = real
    log = open_log(path)
    assert "receive_time" in {note.code for note in log.notes}
    np.testing.assert_allclose(log.time, original.time, atol=1e-8)


def test_an_imu_without_attitude_has_no_such_columns(original: MotionLog, tmp_path: Path) -> None:
    bare = {name: values for name, values in original.columns.items() if ".orientation." not in name}
    save_log(MotionLog("bare", original.time, bare), tmp_path / "bare.mcap")
    assert set(open_log(tmp_path / "bare.mcap").columns) == set(bare)


def test_epoch_stamps_keep_their_digits(original: MotionLog, tmp_path: Path) -> None:
    late = MotionLog("late", original.time + 1_700_000_000, original.columns)
    save_log(late, tmp_path / "late.mcap")
    log = open_log(tmp_path / "late.mcap")
    np.testing.assert_allclose(np.diff(log.time), np.diff(late.time), atol=1e-6)
    assert 0 <= log.time[0] < 1
    assert any("1700000000" in note.text for note in log.notes)


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
    with pytest.raises(LogError, match="directory without logs"):
        open_log(tmp_path / "empty")


def test_a_decompression_bomb_is_left_out(tmp_path: Path) -> None:
    zstandard = pytest.importorskip("zstandard")
    packed = zstandard.ZstdCompressor().compress(bytes(200 * 2**20))

    def text(word: bytes) -> bytes:
        return struct.pack("<I", len(word)) + word

    def record_of(code: int, body: bytes) -> bytes:
        return struct.pack("<BQ", code, len(body)) + body

    for claimed in (1000, 200 * 2**20, 2**60):
        chunk = (
            struct.pack("<QQQI", 0, 0, claimed, 0) + text(b"zstd") + struct.pack("<Q", len(packed)) + packed
        )
        (tmp_path / "bomb.mcap").write_bytes(b"\x89MCAP0\r\n" + record_of(6, chunk))
        with pytest.raises(LogError, match="no message"):
            open_log(tmp_path / "bomb.mcap")


def test_a_bag_of_many_bombs_is_stopped_by_its_own_size(
    original: MotionLog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, _ = write_mcap(original, tmp_path)
    assert open_log(path).columns
    monkeypatch.setattr(compressed, "SMALL", 1000)
    monkeypatch.setattr(compressed, "RATIO", 0)
    with pytest.raises(LogError, match="no message"):
        open_log(path)


# --- maps -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("columns", "expected"),
    [
        ({"joint.neck.position": {"from": "nick", "unit": "deg"}}, "neck_deg"),
        ({"joint.neck.position": {"from": "neck_deg", "unit": "N"}}, "deg"),
        ({"joint.neck.angle": "neck_deg"}, "no column of plantar"),
        ({"imu.chest.orientation": {"from": ["neck_deg"] * 4, "order": "zyxw"}}, "wxyz"),
        ({"wrench.left.force": ["neck_deg"]}, "three sources"),
        ({"joint.neck.position": {"from": "neck_deg", "sign": 2}}, "1 or -1"),
        ({"joint.neck.position": {"of": "neck_deg"}}, "from"),
        ({"joint.neck.position": 7}, "no column 7"),
    ],
)
def test_a_map_that_cannot_hold_is_one_clear_line(
    columns: dict[str, object], expected: str, tmp_path: Path
) -> None:
    (tmp_path / "log.csv").write_text("time,neck_deg\n0,1\n1,2\n2,3\n")
    robot = make_robot(tmp_path / "robot", columns=columns)
    with pytest.raises(LogError, match=expected) as caught:
        open_log(tmp_path / "log.csv", robot)
    assert "\n" not in str(caught.value)


def test_a_joint_vector_of_another_length_or_without_names_is_refused(tmp_path: Path) -> None:
    (tmp_path / "walk.sh_q").write_text("0.0 1 2 3\n0.1 1 2 3\n0.2 1 2 3\n")
    with pytest.raises(LogError, match=r"columns\.joints"):
        open_log(tmp_path / "walk.sh_q")
    robot = make_robot(tmp_path / "robot", columns={"joints": ["neck"]})
    with pytest.raises(LogError, match="3 values a sample, not 1"):
        open_log(tmp_path / "walk.sh_q", robot)


def test_a_text_log_with_broken_lines_keeps_the_good_ones(tmp_path: Path) -> None:
    lines = [f"{0.01 * i:.2f} {i}" for i in range(400)]
    lines[200] = "2.00 oops"
    (tmp_path / "walk.sh_q").write_text("\n".join(lines) + "\n4.0")
    log = open_log(tmp_path / "walk.sh_q", make_robot(tmp_path / "robot", columns={"joints": ["neck"]}))
    assert len(log) == 399
    assert {"lines_broken", "file_cut"} <= {note.code for note in log.notes}


words = st.sampled_from([
    "time", "a", "joint.neck.position", "imu.chest.orientation", "wrench.left.force", "joints", "ports", "from", "unit",
    "order", "sign", "deg", "N", "wxyz", "rpy", "role", "joints.position", "take", "",
])  # fmt: skip
scalars = st.none() | st.booleans() | st.integers(-3, 5) | st.floats(allow_nan=False) | words
trees = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(words, inner, max_size=4),
    max_leaves=8,
)


def refusal(path: Path, robot: RobotModel) -> str:
    """Why a log is refused, or nothing."""
    try:
        open_log(path, robot)
    except LogError as error:
        return str(error)
    return ""


@given(columns=st.dictionaries(words.filter(bool), trees, max_size=4))
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_stands_in_columns(columns: dict[str, object], tmp_path: Path, robot: RobotModel) -> None:
    """A log or one line, never anything else."""
    (tmp_path / "log.csv").write_text("time,a\n0,1\n1,2\n2,3\n")
    (tmp_path / "log.sh_q").write_text("0 1\n1 2\n2 3\n")
    for name in ("log.csv", "log.sh_q"):
        assert "\n" not in refusal(tmp_path / name, replace(robot, columns=columns))

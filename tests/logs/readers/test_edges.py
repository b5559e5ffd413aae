"""What readers accept, leave out and refuse at their limits, and the words with their numbers."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from biped_robot import make_robot
from plantar.errors import LogError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import mc_rtc, open_log, robot_logger, text_numbers
from plantar.logs.readers.force_cells import wrench_of_cells
from plantar.logs.readers.ports import joints_for
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.streams import Stream, increasing, merge, origin, resample
from plantar.logs.readers.text_numbers import read_numbers
from plantar.logs.save_mc_rtc import save_mc_rtc
from plantar.notes import Note

LOG = Path("x")
TIME = 0.01 * np.arange(1000)


def joints(time: np.ndarray, name: str = "j", column: str = "joint.a.position") -> Stream:
    return Stream(name, time, {column: np.arange(time.size, dtype=float)})


def back(count: int, total: int = 1000) -> np.ndarray:
    """Stamps of which so many, from the tenth on, step back by a second, every other one."""
    time = 0.01 * np.arange(total)
    time[10 : 10 + 2 * count : 2] -= 1.0
    return time


@pytest.mark.parametrize(
    ("strays", "total", "kept"), [(10, 1000, 990), (11, 1000, None), (1, 50, 49), (2, 50, None)]
)
def test_one_stamp_of_a_hundred_may_step_back(strays: int, total: int, kept: int | None) -> None:
    notes: list[Note] = []
    if kept is None:
        with pytest.raises(
            LogError,
            match=rf"value -0\.9: j: time does not increase in {strays} of {total} samples, first here",
        ):
            increasing(joints(back(strays, total)), LOG, notes)
        return
    found = increasing(joints(back(strays, total)), LOG, notes)
    assert found.time.size == kept
    assert found.columns["joint.a.position"][10] == 11.0
    assert [note.text for note in notes] == [
        f"x: j: {strays} samples whose time does not increase are left out"
    ]


@pytest.mark.parametrize(("strays", "fine"), [(10, True), (11, False)])
def test_one_row_of_a_hundred_may_step_back_in_a_table(strays: int, fine: bool, tmp_path: Path) -> None:
    rows = "\n".join(f"{time:.2f},1" for time in back(strays))
    (tmp_path / "log.csv").write_text(f"time,joint.a.position\n{rows}\n")
    if fine:
        log = open_log(tmp_path / "log.csv")
        assert len(log) == 1000 - strays
        assert (
            f"time does not increase in {strays} of 1000 rows (first after t = 0.09 s)" in log.notes[0].text
        )
    else:
        with pytest.raises(LogError, match="does not increase in 11 of 1000 rows"):
            open_log(tmp_path / "log.csv")


@pytest.mark.parametrize(("periods", "bridged"), [(2.4, True), (2.6, False)])
def test_a_hole_of_two_and_a_half_periods_stays_a_hole(periods: float, bridged: bool) -> None:
    late = np.r_[0.1 * np.arange(20), 1.9 + 0.1 * periods + 0.1 * np.arange(20)]
    columns, exact = resample(joints(late), np.array([1.95]))
    assert np.isfinite(columns["joint.a.position"][0]) == bridged
    assert not exact


@pytest.mark.parametrize(("apart", "exact"), [(0.9e-7, True), (1.1e-7, False)])
def test_stamps_within_a_tenth_of_a_microsecond_are_one(apart: float, exact: bool) -> None:
    columns, found = resample(joints(np.append(TIME + apart, 11.0)), TIME[1:-1])
    assert found == exact
    assert np.array_equal(columns["joint.a.position"], np.arange(1.0, 999.0)) == exact


@pytest.mark.parametrize(("start", "cut"), [(4.9, True), (5.1, False)])
def test_a_log_is_cut_to_what_half_of_it_covers(start: float, cut: bool) -> None:
    notes: list[Note] = []
    late = joints(start + 0.02 * np.arange(500), "w", "wrench.l.force.z")
    time, columns = merge([joints(TIME), late], ReadLimit(LOG, files=[]), notes)
    codes = [note.code for note in notes]
    if cut:
        assert (time[0], time[-1]) == pytest.approx((start, 9.99))
        assert notes[0].text == f"x: cut to {start:.3f} ... 9.990 s, which every stream covers"
    else:
        assert time.size == 1000
        assert np.isnan(columns["wrench.l.force.z"]).sum() == 510
        assert codes[0] == "streams_apart"
    assert notes[-1].text == "x: resampled to the clock of j (100 Hz): w"


@pytest.mark.parametrize(("shift", "told"), [(0.09, False), (0.11, True)])
def test_less_than_a_tenth_of_a_second_is_cut_without_a_word(shift: float, told: bool) -> None:
    notes: list[Note] = []
    merge([joints(TIME), joints(TIME + shift, "w", "wrench.l.force.z")], ReadLimit(LOG, files=[]), notes)
    assert ("log_cut_to_overlap" in [note.code for note in notes]) == told


@pytest.mark.parametrize(("rate", "base"), [(1.009, "joint.a.position"), (1.011, "imu.c.angular_velocity.x")])
def test_of_clocks_equal_to_a_hundredth_the_joints_one_is_the_base(rate: float, base: str) -> None:
    streams = [joints(TIME / rate, "i", "imu.c.angular_velocity.x"), joints(TIME)]
    time, columns = merge(streams, ReadLimit(LOG, files=[]), [])
    assert np.all(columns[base] == np.round(columns[base]))
    assert time[1] == pytest.approx(0.01 if base.startswith("joint") else 0.01 / rate)


def test_stamps_since_an_epoch_lose_whole_seconds() -> None:
    assert (origin(1_000_001.75), origin(999_999.75)) == (1_000_001.0, 0.0)


@pytest.mark.parametrize(("broken", "fine"), [(1, True), (10, True), (11, False)])
def test_one_line_of_a_hundred_may_be_broken(broken: int, fine: bool, tmp_path: Path) -> None:
    lines = [f"{place} {place}" for place in range(1000)]
    for place in range(broken):
        lines[20 + 7 * place] = "1 2 3" if place % 2 else "1 x"
    (tmp_path / "log.txt").write_text("# a b\n" + "\n".join(lines) + "\n")
    notes: list[Note] = []
    said = "line 22" if broken == 1 else f"line 22 and {broken - 1} more"
    if fine:
        values, names = read_numbers(tmp_path / "log.txt", ReadLimit(tmp_path / "log.txt"), notes)
        assert (values.shape, names) == ((1000 - broken, 2), ["a", "b"])
        assert [note.text for note in notes] == [f"log.txt: {said} left out: not 2 numbers"]
    else:
        with pytest.raises(LogError, match=f"{said} do not hold 2 numbers"):
            read_numbers(tmp_path / "log.txt", ReadLimit(tmp_path / "log.txt"), notes)


def test_names_count_where_there_are_as_many_as_columns(tmp_path: Path) -> None:
    path = tmp_path / "log.txt"
    path.write_text("a b c\n1 2\n3 4\n5")
    notes: list[Note] = []
    values, names = read_numbers(path, ReadLimit(path), notes)
    assert (values.tolist(), names) == ([[1, 2], [3, 4]], [])
    assert [note.text for note in notes] == ["log.txt ends in the middle of a line; that line is left out"]
    path.write_text("# nothing\n\n")
    with pytest.raises(LogError, match=r"log\.txt: holds no numbers \(valid: one sample a line\)$"):
        read_numbers(path, ReadLimit(path), notes)


@pytest.mark.parametrize("size", [16, 100, 4096])
def test_a_file_in_blocks_reads_as_it_does_whole(
    size: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the block's length cuts: a number, a line, the names above them, the count of lines."""
    path, rows = tmp_path / "log.txt", [f"{row} {row / 7:.6f}" for row in range(300)]
    rows[200] += " 3"
    path.write_text("\n".join(["# a b", *rows, ""]))
    monkeypatch.setattr(text_numbers, "BLOCK", size)
    notes: list[Note] = []
    values, names = read_numbers(path, ReadLimit(path), notes)
    assert names == ["a", "b"]
    assert values[:, 0].tolist() == [row for row in range(300) if row != 200]
    assert values[-1, 1] == pytest.approx(299 / 7, abs=1e-6)
    assert [note.text for note in notes] == ["log.txt: line 202 left out: not 2 numbers"]


def test_lines_without_anything_stand_before_and_among_numbers(tmp_path: Path) -> None:
    path = tmp_path / "log.txt"
    path.write_text("\n  \n/ /\n# a b\n\n1 2\n\n3 4\n")
    values, _ = read_numbers(path, ReadLimit(path), [])
    np.testing.assert_array_equal(values, [[1.0, 2.0], [3.0, 4.0]])


CELLS = [[0.1, 0.05], [0.1, -0.05], [-0.1, 0.0]]


@pytest.mark.parametrize(
    ("places", "said"),
    [([[0.999, 0.0], *CELLS[1:]], None), ([[1.01, 0.0], *CELLS[1:]], "a cell lies 1.01 m away; are these millimetres?"),
     ([[-0.1, 0.0], [0.0, 0.0064], [0.1, 0.0]], None),
     ([[-0.1, 0.0], [0.0, 0.0058], [0.1, 0.0]],
      r"^x: columns\.wrench\.left\.cells: the cells stand in one line and show no moment about it "
      r"\(valid: 3 or more cells that span an area\)$"),
     (CELLS[:2], r"^x: columns\.wrench\.left\.cells has 2 places for 3 cells \(valid: at: \[\[x, y\], \.\.\.\] \[m\], "
                 r"a pair for each column of from\)$")],
)  # fmt: skip
def test_force_cells_span_a_sole(places: list[list[float]], said: str | None) -> None:
    """Three points of which the middle one is d aside spread by √(2/3) d across their line."""
    values = np.array([[1.0, 2.0, 4.0]])
    if said is None:
        found = wrench_of_cells("wrench.left", values, places, LOG)
        assert found["wrench.left.force.z"] == [7.0]
        assert found["wrench.left.torque.x"] == pytest.approx(values[0] @ np.array(places)[:, 1])
        assert found["wrench.left.torque.y"] == pytest.approx(-values[0] @ np.array(places)[:, 0])
    else:
        with pytest.raises(LogError, match=said.replace("?", r"\?")):
            wrench_of_cells("wrench.left", values, places, LOG)
    with pytest.raises(LogError, match="stand in one line"):
        wrench_of_cells("wrench.left", values[:, :2], CELLS[:2], LOG)


def test_how_large_a_log_may_be(tmp_path: Path) -> None:
    """256 MiB and a hundred times the file, within the memory given; ten thousand columns."""
    path = tmp_path / "log.bin"
    path.touch()
    os.truncate(path, 1000)
    most = 2**28 + 100_000
    limit = ReadLimit(path, memory=2**40)
    assert (limit.unpacks_to, limit.left) == (most, most)
    limit.unpack(most)
    assert limit.left == 0
    with pytest.raises(LogError):
        limit.unpack(1)
    limit.columns(10_000)
    with pytest.raises(LogError, match=r"log\.bin: has more than 10000 columns \(valid: fewer columns\)$"):
        limit.columns(10_001)
    limit.numbers(most // 8, 1)
    with pytest.raises(LogError):
        limit.numbers(most // 8 + 1, 1)
    small = ReadLimit(path, memory=1600)
    small.numbers(100, 2)
    small.hold(800)
    small.hold(800)
    for too_much in (lambda: small.numbers(201, 1), lambda: small.hold(1)):
        with pytest.raises(LogError):
            too_much()


@pytest.mark.parametrize(("value", "read"), [(0.99e12, True), (1.01e12, False), (-1.01e12, False)])
def test_what_no_sensor_reads_is_no_number(value: float, read: bool) -> None:
    log = MotionLog("log", TIME[:3], {"joint.a.position": np.array([0.0, value, 1.0])})
    assert np.isfinite(log.column("joint.a.position")).sum() == 2 + read


def test_a_port_of_stamps_alone_is_refused(tmp_path: Path) -> None:
    """A packet's number and one stamp, or two where info.log says that both were dumped."""
    robot = make_robot(tmp_path / "robot", columns={"ports": {"left": "wrench.left"}})
    for info, line in (("Stamp: rx;", "1 0.01"), ("Stamp: tx;rx;", "1 0.01 0.02")):
        (tmp_path / "dump" / "left").mkdir(parents=True, exist_ok=True)
        (tmp_path / "dump" / "left" / "info.log").write_text(f"Type: Bottle;\n{info}\n")
        (tmp_path / "dump" / "left" / "data.log").write_text(f"{line}\n" * 100)
        with pytest.raises(LogError, match=r"data\.log: holds no values beside packet number and stamp"):
            open_log(tmp_path / "dump", robot)


def test_mat_files_of_another_kind_say_what_to_write_instead(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    old = tmp_path / "old.mat"
    old.write_bytes(b"MATLAB 5.0 MAT-file, Platform: GLNXA64" + bytes(200))
    with pytest.raises(LogError, match=r"old\.mat: is a MATLAB file older than 7\.3 .*writetable"):
        open_log(old)
    with h5py.File(tmp_path / "own.mat", "w") as file:
        file["hip_angle"] = np.zeros(4)
    with pytest.raises(LogError, match=r"holds no signal of a robot logger, but hip_angle .*writetable"):
        open_log(tmp_path / "own.mat")


@pytest.mark.parametrize("shape", [(3, 1, 4), (4, 3), (3, 4), (4, 1, 4), (4, 4)])
def test_a_signal_has_a_row_for_each_stamp_whichever_way_it_was_written(
    shape: tuple[int, ...], tmp_path: Path
) -> None:
    """Of as many numbers as samples as it comes: MATLAB's order is turned round by HDF5 already."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "log.mat", "w") as file:
        group = file.create_group("joints")
        group["timestamps"], group["data"] = (
            np.arange(4.0)[None],
            np.arange(np.prod(shape), dtype=float).reshape(shape),
        )
        time, values = robot_logger._signal(group, "joints", ReadLimit(tmp_path / "log.mat", 10**6))
    wanted = np.arange(np.prod(shape), dtype=float).reshape(shape[0], -1)
    np.testing.assert_array_equal(values, wanted if shape[0] == 4 else wanted.T)
    np.testing.assert_array_equal(time, np.arange(4.0))


def test_mc_rtc_versions_are_tried_up_to_the_tenth(tmp_path: Path) -> None:
    path, time = tmp_path / "log.bin", np.arange(20.0)
    save_mc_rtc(path, time, np.zeros((20, 2)), np.tile(np.eye(4), (20, 1, 1)))
    content = path.read_bytes()
    for version, refused in ((10, "does not name its 2 joints"), (11, "is not an mc_rtc binary log")):
        path.write_bytes(b"ANN" + bytes([0x45 + version]) + content[4:])
        with pytest.raises(LogError, match=refused):
            mc_rtc.read(path, None, ReadLimit(path, 10**9))


@pytest.mark.parametrize("magic", [b"ANNA", b"ANN", b"XNNE", b"ANNZ"])
def test_an_mc_rtc_log_begins_as_one(magic: bytes, tmp_path: Path) -> None:
    path = tmp_path / "log.bin"
    path.write_bytes(magic)
    with pytest.raises(LogError, match="is not an mc_rtc binary log"):
        mc_rtc.read(path, None, ReadLimit(path, []))


@pytest.mark.parametrize(
    ("rest", "notes"), [(0, []), (3, ["file_cut"]), (11, ["file_cut"]), (40, ["file_cut"])]
)
def test_an_mc_rtc_log_that_is_cut_gives_its_whole_entries(
    rest: int, notes: list[str], tmp_path: Path
) -> None:
    """Behind 20 entries of 60 bytes at least, `rest` bytes of one more: within its size, and within its content."""
    path, time = tmp_path / "log.bin", 0.005 * np.arange(21)
    save_mc_rtc(path, time[:20], np.zeros((20, 2)), np.tile(np.eye(4), (20, 1, 1)))
    whole = path.stat().st_size
    save_mc_rtc(path, time, np.zeros((21, 2)), np.tile(np.eye(4), (21, 1, 1)))
    path.write_bytes(path.read_bytes()[: whole + rest])
    told: list[Note] = []
    entries = mc_rtc._Entries(path, None, ReadLimit(path, 10**9))
    with path.open("rb") as file:
        file.seek(4)
        entries.read(file, told)
    assert len(entries.columns()["t"]) == 20
    assert [note.code for note in told] == notes


def test_joints_without_names_have_the_urdfs_order_where_their_number_agrees(tmp_path: Path) -> None:
    robot, notes = make_robot(tmp_path), list[Note]()
    count = len(robot.joint_names)
    assert joints_for(count, robot, LOG, notes) == robot.joint_names
    assert [(note.code, note.severity) for note in notes] == [("joint_order", "warning")]
    for wrong, known in ((count + 1, robot), (count, None)):
        with pytest.raises(LogError, match=f"does not name its {wrong} joints"):
            joints_for(wrong, known, LOG, notes)


@pytest.mark.parametrize(
    ("size", "chunks", "fine"), [(5, None, True), (6, None, False), (3, (6,), False), (3, (2, 2), True)]
)
def test_how_long_a_name_in_a_mat_file_may_be(
    size: int, chunks: tuple[int, ...] | None, fine: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also in the pieces that it is unpacked in."""
    monkeypatch.setattr(robot_logger, "NAME_LIMIT", 5)

    class Cell:
        def __init__(self) -> None:
            self.size, self.chunks = size, chunks

        def __getitem__(self, _: object) -> np.ndarray:
            return np.array([97, 98])

    if fine:
        assert robot_logger._text(Cell()) == "ab"
    else:
        with pytest.raises(ValueError, match="too long"):
            robot_logger._text(Cell())

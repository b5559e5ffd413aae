"""Table logs: three formats read alike, and every way they can be broken gives one line or a note."""

from __future__ import annotations

import gzip
import os
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from threading import Barrier

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pa_parquet
import pytest

from biped import record, sway
from biped_robot import make_robot
from made_tables import HEADER, as_csv, codes, csv_text, refusal, write
from plantar.errors import LogError
from plantar.logs.readers import motion_name, open_log


def test_csv_gzip_and_parquet_read_alike(tmp_path: Path) -> None:
    original = record(sway(duration=1.0))
    text = as_csv(original)
    plain = write(tmp_path, text, "a.csv")
    zipped = write(tmp_path, gzip.compress(text.encode()), "b.csv.gz")
    parquet = tmp_path / "c.parquet"
    pa_parquet.write_table(pa.table({"time": original.time, **original.columns}), parquet)
    for path in (plain, zipped, parquet):
        log = open_log(path)
        assert log.name == path.name[0]
        assert log.path == path
        assert log.sha256 is not None
        assert len(log.sha256) == 64
        assert log.notes == ()
        np.testing.assert_array_equal(log.time, original.time)
        assert set(log.columns) == set(original.columns)
        for name, values in original.columns.items():
            np.testing.assert_array_equal(log.columns[name], values, err_msg=f"{path.name} {name}")


def test_parquet_is_read_a_column_for_each_core_at_a_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All columns at once would take as much memory as their numbers, and one leaves cores idle."""
    names = ["time", *(f"joint.{x}.position" for x in "abcd")]
    table = pa.table({name: [place + 0.0, place + 1.0] for place, name in enumerate(names)})
    pa_parquet.write_table(table, tmp_path / "log.parquet")
    batches, at_work, most = pa_parquet.ParquetFile.iter_batches, list[str](), list[int]()
    together = Barrier(3)

    def iter_batches(file: pa_parquet.ParquetFile, size: int, columns: list[str], **options: bool) -> object:
        (name,) = columns
        at_work.append(name)
        if name in names[:3]:  # of each core the first one
            together.wait(10)
        most.append(len(at_work))
        yield from batches(file, size, columns=columns, **options)
        at_work.remove(name)

    monkeypatch.setattr(pa, "cpu_count", lambda: 3)
    monkeypatch.setattr(pa_parquet.ParquetFile, "iter_batches", iter_batches)
    log = open_log(tmp_path / "log.parquet")
    assert max(most) == 3
    read = [log.time, *log.columns.values()]
    assert [values.tolist() for values in read] == [[place, place + 1] for place in range(5)]


def test_columns_may_stand_in_any_order_and_have_windows_ends(tmp_path: Path) -> None:
    text = "joint.a.position,time\r\n1,0\r\n2,0.5\r\n3,1\r\n"
    log = open_log(write(tmp_path, text))
    np.testing.assert_array_equal(log.time, [0, 0.5, 1])
    np.testing.assert_array_equal(log.column("joint.a.position"), [1, 2, 3])


def test_a_byte_order_mark_is_no_part_of_the_first_name(tmp_path: Path) -> None:
    assert len(open_log(write(tmp_path, b"\xef\xbb\xbf" + csv_text().encode()))) == 5


def test_nanoseconds_since_1970_are_numbers(tmp_path: Path) -> None:
    """As pandas and bags stamp samples: more digits than a float64 has, which is no fault of the file."""
    stamps = np.int64(1_700_000_000_123_456_789) + 10_000_000 * np.arange(5)
    angles = {"joint.a.position": np.arange(5.0)}
    pa_parquet.write_table(pa.table({"stamp": stamps, **angles}), tmp_path / "log.parquet")
    robot = make_robot(tmp_path / "robot", columns={"time": {"from": "stamp", "unit": "ns"}})
    log = open_log(tmp_path / "log.parquet", robot)
    np.testing.assert_allclose(log.time - 1.7e9, 0.123456789 + 0.01 * np.arange(5), atol=1e-6)


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("kind", [pa.timestamp, pa.duration])
def test_dates_and_durations_are_seconds(
    kind: Callable[[str], pa.DataType], unit: str, tmp_path: Path
) -> None:
    ticks = pa.array(np.arange(5) * {"s": 1, "ms": 10, "us": 10**4, "ns": 10**7}[unit]).cast(kind(unit))
    table = pa.table({"time": ticks, "joint.a.position": np.arange(5.0)})
    pa_parquet.write_table(table, tmp_path / "log.parquet")
    period = 1.0 if unit == "s" else 0.01
    np.testing.assert_allclose(open_log(tmp_path / "log.parquet").time, period * np.arange(5), atol=1e-12)
    wrong = pa.table({"time": np.arange(5.0), "joint.a.position": ticks})
    pa_parquet.write_table(wrong, tmp_path / "wrong.parquet")
    with pytest.raises(LogError, match=r"column 'joint\.a\.position': holds "):
        open_log(tmp_path / "wrong.parquet")


@pytest.mark.parametrize("hole", ["", "nan", "NaN", "null"])
def test_empty_cells_are_nan(tmp_path: Path, hole: str) -> None:
    log = open_log(write(tmp_path, f"time,joint.a.position\n0,1\n0.1,{hole}\n0.2,3\n"))
    np.testing.assert_array_equal(log.column("joint.a.position"), [1, np.nan, 3])


def test_infinities_count_as_not_recorded(tmp_path: Path) -> None:
    log = open_log(write(tmp_path, "time,joint.a.position\n0,1\n0.1,inf\n0.2,-1e300\n"))
    np.testing.assert_array_equal(log.column("joint.a.position"), [1, np.nan, np.nan])
    assert codes(log) == ["absurd_values"]
    assert "joint.a.position" in log.notes[0].text


def test_columns_of_no_known_name_are_left_with_a_note(tmp_path: Path) -> None:
    header = "time,joint.a.position,battery,joint.a.temperature,wrench.left.force.w"
    log = open_log(write(tmp_path, csv_text(header=header)))
    assert list(log.columns) == ["joint.a.position"]
    assert codes(log) == ["columns_ignored"]
    for name in ("battery", "joint.a.temperature", "wrench.left.force.w"):
        assert name in log.notes[0].text


def test_a_text_among_ignored_columns_does_no_harm(tmp_path: Path) -> None:
    log = open_log(write(tmp_path, "time,label,joint.a.position\n0,walk,1\n0.1,stand,2\n"))
    np.testing.assert_array_equal(log.column("joint.a.position"), [1, 2])


@pytest.mark.parametrize("more", [",,", ",x,x", ",,x,x,x"])
def test_what_is_not_read_may_stand_twice(tmp_path: Path, more: str) -> None:
    """Spreadsheets end lines with commas, and loggers have columns of one name."""
    lines = csv_text().splitlines()
    text = "\n".join([lines[0] + more, *(line + "," * more.count(",") for line in lines[1:])]) + "\n"
    log = open_log(write(tmp_path, text))
    assert list(log.columns) == HEADER.split(",")[1:]
    assert [note.text.count("\0") for note in log.notes] == [0]


def test_missing_duplicate_and_texty_columns(tmp_path: Path) -> None:
    assert "column 'time': is missing: the header begins with 't' (valid: a first column" in refusal(
        tmp_path, "t,joint.a.position\n0,1\n0.1,2\n"
    )
    twice = refusal(tmp_path, "time,joint.a.position,joint.a.position\n0,1,2\n0.1,2,3\n")
    assert "column 'joint.a.position': stands twice" in twice
    texty = refusal(tmp_path, "time,joint.a.position\n0,1\n0.1,2\n0.2,off\n")
    assert "column 'joint.a.position', t = 0.2 s, value 'off': is not a number" in texty
    texty = refusal(tmp_path, "time,joint.a.position\n0,1\nsoon,2\n0.2,3\n")
    assert "column 'time', value 'soon'" in texty


def test_time_that_does_not_increase(tmp_path: Path) -> None:
    message = refusal(tmp_path, "time,joint.a.position\n0,1\n0.1,2\n0.1,3\n0.05,4\n0.2,5\n")
    assert "column 'time'" in message
    assert "does not increase" in message
    assert "t = 0.1 s" in message, message
    assert "time" in refusal(tmp_path, "time,joint.a.position\n3,1\n2,2\n1,3\n")


@pytest.mark.parametrize("clock", ["1e300", "-1e300", "1e25"])
def test_a_time_that_no_clock_shows_is_a_stray(tmp_path: Path, clock: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "time,joint.a.position\n" + "".join(f"{0.1 * i:.1f},{i}\n" for i in range(200)) + f"{clock},3\n"
    )
    log = open_log(path)
    assert log.time[-1] == pytest.approx(19.9)
    assert [note.code for note in log.notes] == ["time_order"]


def test_a_stray_time_is_left_out_with_a_note(tmp_path: Path) -> None:
    rows = [f"{0.01 * i:.2f},{i}" for i in range(300)]
    rows[100] = "0.00,100"
    log = open_log(write(tmp_path, "time,joint.a.position\n" + "\n".join(rows) + "\n"))
    assert len(log) == 299
    assert codes(log) == ["time_order"]
    assert "0.99" in log.notes[0].text
    assert 100 not in log.column("joint.a.position")


def test_a_ragged_row_in_the_middle_is_an_error(tmp_path: Path) -> None:
    lines = csv_text(8).splitlines()
    lines[4] += ",99"
    message = refusal(tmp_path, "\n".join(lines) + "\n")
    assert "4 values where the header has 3" in message
    lines[4] = "0.03,1"
    assert "2 values where the header has 3" in refusal(tmp_path, "\n".join(lines) + "\n")
    lines[4] = lines[-1].split(",")[-1]  # as the last row ends, but not the last row
    assert "1 values where the header has 3" in refusal(tmp_path, "\n".join(lines) + "\n")


def test_unknown_endings_and_missing_files(tmp_path: Path) -> None:
    assert ".csv" in refusal(tmp_path, "x", "log.xlsx")
    with pytest.raises(LogError, match=r"nowhere\.csv: does not exist"):
        open_log(tmp_path / "nowhere.csv")
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    with pytest.raises(
        LogError,
        match=r"folder\.csv: is a directory without logs \(valid: a ROS bag, or YARP dumps with "
        r"data\.log\)$",
    ):
        open_log(folder)


def test_a_name_that_is_no_text_is_refused_before_any_work(tmp_path: Path) -> None:
    """As archives from other systems leave them; results, which name motions by files, could not be written."""
    path = tmp_path / os.fsdecode(b"sway_\xe9.csv")
    path.write_text(csv_text())
    with pytest.raises(LogError, match=r"sway_\\udce9\.csv': has a name that is no text") as caught:
        open_log(path)
    assert str(caught.value).isascii()
    fine = open_log(path.rename(tmp_path / "sw\u00e9 y\u00a0\u6447.csv"))
    assert fine.name == "sw\u00e9 y\u00a0\u6447"


def test_motions_are_named_by_files() -> None:
    assert motion_name(Path("a/tilt_C.csv.gz")) == "tilt_C"
    assert motion_name(Path("Tilt.3.CSV")) == "Tilt.3"
    assert motion_name(Path("squat.parquet")) == "squat"


def test_real_logs_read(shared_data: Path) -> None:
    log = open_log(shared_data / "icub_walking" / "walking.csv.gz")
    assert 85 < log.duration < 93
    assert log.period == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize("mark", [";", "\t"])
def test_columns_that_are_parted_otherwise_are_told_so(tmp_path: Path, mark: str) -> None:
    message = refusal(tmp_path, csv_text().replace(",", mark))
    assert "is missing: the header begins with 'time" in message
    assert "commas between" in message


@pytest.mark.parametrize(
    "hole", ["", "nan", "NaN", "NULL", "None", "NA", "<NA>", "N/A", "#N/A", "-nan", "-nan(ind)", "-1.#IND"]
)
def test_what_programs_write_where_nothing_was_recorded_is_a_hole(tmp_path: Path, hole: str) -> None:
    path = write(tmp_path, f"{HEADER}\n0.0,1,2\n0.1,{hole},2\n0.2,1,2\n")
    np.testing.assert_array_equal(open_log(path).columns["joint.a.position"], [1.0, np.nan, 1.0])


def test_a_text_that_is_no_hole_is_an_error(tmp_path: Path) -> None:
    assert "value '-': is not a number (valid: a number, or an empty cell" in refusal(
        tmp_path, f"{HEADER}\n0.0,1,2\n0.1,-,2\n"
    )


def test_blanks_beside_names_are_not_theirs(tmp_path: Path) -> None:
    log = open_log(write(tmp_path, csv_text(header=" time, joint.a.position ,wrench.left.force.z")))
    assert set(log.columns) == {"joint.a.position", "wrench.left.force.z"}


def test_decimals_and_whole_numbers_of_a_parquet_file_are_numbers(tmp_path: Path) -> None:
    decimals = [Decimal("0.125"), Decimal("-1.5"), Decimal("2.25")]
    made = {
        "time": pa.array([0, 1, 2], pa.int32()), "joint.a.position": pa.array(decimals, pa.decimal128(10, 3)),
        "joint.b.position": pa.array([0.5, 1.5, None], pa.float32()),
        "joint.c.position": pa.array([3, 2, 1], pa.uint8()),
    }  # fmt: skip
    pa_parquet.write_table(pa.table(made), tmp_path / "log.parquet")
    columns = open_log(tmp_path / "log.parquet").columns
    np.testing.assert_array_equal(columns["joint.a.position"], [0.125, -1.5, 2.25])
    np.testing.assert_array_equal(columns["joint.b.position"], [0.5, 1.5, np.nan])
    np.testing.assert_array_equal(columns["joint.c.position"], [3.0, 2.0, 1.0])

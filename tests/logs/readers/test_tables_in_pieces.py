"""Tables that are read in pieces: nothing depends on where a piece ends."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pa_parquet
import pytest

from biped_robot import make_robot
from plantar.errors import LogError
from plantar.logs.readers import open_log
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.tables import csv_text, parquet_file
from plantar.logs.readers.tables.parquet_pages import BrokenPage, _Header, check_pages

SMALL = 2**28


@pytest.fixture(params=[(7, 20), (64, 64), (2**20, 2**23)])
def pieces(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks of text and pieces of lines, shorter than a line or longer than the file."""
    monkeypatch.setattr(csv_text, "BLOCK", request.param[0])
    monkeypatch.setattr(csv_text, "PIECE", request.param[1])
    monkeypatch.setattr(parquet_file, "BATCH", request.param[0])


def numbers(rows: int = 60) -> np.ndarray:
    values = np.random.default_rng(1).normal(size=(rows, 3)) * [1, 1e-9, 1e9]
    values[:, 0] = 0.01 * np.arange(rows)
    return values


def text(values: np.ndarray, end: str = "\n") -> str:
    lines = ["time,joint.a.position,joint.b.position", *(",".join(map(repr, row)) for row in values.tolist())]
    return end.join(lines) + end


@pytest.mark.usefixtures("pieces")
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("ending", ["csv", "csv.gz", "parquet"])
def test_every_number_arrives(ending: str, end: str, tmp_path: Path) -> None:
    values = numbers()
    path = tmp_path / f"log.{ending}"
    if ending == "parquet":
        names = ("time", "joint.a.position", "joint.b.position")
        pa_parquet.write_table(pa.table(dict(zip(names, values.T, strict=True))), path, row_group_size=17)
    else:
        content = b"\xef\xbb\xbf\n" + text(values, end).encode()
        path.write_bytes(gzip.compress(content) if ending == "csv.gz" else content)
    log = open_log(path)
    assert log.notes == ()
    np.testing.assert_array_equal(log.time, values[:, 0])
    np.testing.assert_array_equal(log.stack(["joint.a.position", "joint.b.position"]), values[:, 1:])


@pytest.mark.usefixtures("pieces")
def test_a_text_far_down_is_shown_with_its_time(tmp_path: Path) -> None:
    lines = text(numbers()).splitlines()
    lines[50] = "0.49,1,off"
    (tmp_path / "log.csv").write_text("\n".join(lines) + "\n")
    with pytest.raises(
        LogError, match=r"column 'joint\.b\.position', t = 0\.49 s, value 'off': is not a number"
    ):
        open_log(tmp_path / "log.csv")


@pytest.mark.usefixtures("pieces")
def test_numbers_that_only_python_reads(tmp_path: Path) -> None:
    lines = text(numbers()).splitlines()
    lines[50] = "0.49,+1_000, Infinity"
    lines[51] = "0.50,NAN,+2.5"
    (tmp_path / "log.csv").write_text("\n".join(lines) + "\n0.60,7\n")
    log = open_log(tmp_path / "log.csv")
    assert len(log) == 60, "the cut row at the end is left out"
    np.testing.assert_array_equal(log.column("joint.a.position")[49:51], [1000, np.nan])
    np.testing.assert_array_equal(log.column("joint.b.position")[49:51], [np.nan, 2.5])


@pytest.mark.usefixtures("pieces")
@pytest.mark.parametrize("cut", [1, 3, 30])
def test_a_cut_row_is_left_out_wherever_pieces_end(cut: int, tmp_path: Path) -> None:
    whole = text(numbers())
    (tmp_path / "log.csv").write_text(whole[:-cut])
    log = open_log(tmp_path / "log.csv")
    assert len(log) == 59
    assert [note.code for note in log.notes] == ["file_cut"]
    (tmp_path / "log.csv").write_text(whole + "0.60,7\n")
    log = open_log(tmp_path / "log.csv")
    assert len(log) == 60
    assert [note.code for note in log.notes] == ["file_cut"]
    (tmp_path / "log.csv").write_text(text(numbers(30)) + "0.60,7\n" + text(numbers()).partition("\n")[2])
    with pytest.raises(LogError, match="a row has 2 values where the header has 3"):
        open_log(tmp_path / "log.csv")
    rows = text(numbers(30)) + "0.60,7\n" + text(numbers()).partition("\n")[2] + "0.60,7\n"
    (tmp_path / "log.csv").write_text(rows)
    with pytest.raises(LogError, match="a row has 2 values where the header has 3"):
        open_log(tmp_path / "log.csv")


@pytest.mark.usefixtures("pieces")
def test_a_byte_that_is_no_text_is_shown_with_its_line(tmp_path: Path) -> None:
    content = text(numbers()).replace("\n0.49", "\né0.49").encode()
    (tmp_path / "log.csv").write_bytes(content.replace("é".encode(), b"\xff"))
    with pytest.raises(LogError, match="not UTF-8 text at line 51"):
        open_log(tmp_path / "log.csv")


@pytest.mark.usefixtures("pieces")
def test_mapped_columns_may_stand_beside_texts_and_nameless_ones(tmp_path: Path) -> None:
    values = numbers()
    rows = [f"{t!r},walk {i},{q!r},,\n" for i, (t, q, _) in enumerate(values.tolist())]
    (tmp_path / "log.csv").write_text("time,label,q,,\n" + "".join(rows))
    robot = make_robot(tmp_path / "robot", columns={"joint.a.position": "q", "joint.b.position": 1})
    log = open_log(tmp_path / "log.csv", robot)
    np.testing.assert_array_equal(log.column("joint.a.position"), values[:, 1])
    np.testing.assert_array_equal(
        log.column("joint.b.position"), values[:, 1], "numbers count columns of numbers"
    )


def test_pages_are_counted_by_their_own_headers(tmp_path: Path) -> None:
    """The footer's sum has the headers in it, a few dozen bytes each."""
    path = tmp_path / "log.parquet"
    values = np.random.default_rng(0).integers(0, 50, 100_000).astype(float)
    for options in ({}, {"use_dictionary": False}, {"data_page_version": "2.0"}, {"compression": "zstd"}):
        pa_parquet.write_table(pa.table({"time": values}), path, data_page_size=2**14, **options)
        column = pa_parquet.ParquetFile(path).metadata.row_group(0).column(0)
        start = column.dictionary_page_offset or column.data_page_offset
        limit = ReadLimit(path, files=[])
        with open(path, "rb") as handle:
            check_pages(handle, start, column.total_compressed_size, limit)
            headers = column.total_uncompressed_size - (SMALL - limit.left)
            assert 0 < headers < 0.05 * column.total_uncompressed_size
            small = ReadLimit(path, files=[])
            small.unpack(small.left - 1000)
            with pytest.raises(
                LogError,
                match=r"log\.parquet: unpacks to 268 MB or more \(valid: at most 268 MB from a file of 0 bytes: "
                r"268 MB and 100 times its size\)$",
            ):
                check_pages(handle, start, column.total_compressed_size, small)
            with pytest.raises(BrokenPage):
                check_pages(handle, start + 1, column.total_compressed_size, limit)


def test_a_page_that_unpacks_to_more_than_its_numbers_is_not_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a footer that lies would have it: its rows are few, its pages are not."""
    path = tmp_path / "log.parquet"
    pa_parquet.write_table(pa.table({"time": np.arange(1e4)}), path, use_dictionary=False, compression="zstd")
    monkeypatch.setattr(ReadLimit, "unpacks_to", 50_000)
    monkeypatch.setattr(ReadLimit, "numbers", lambda *_: None)
    with pytest.raises(
        LogError,
        match=r"log\.parquet: unpacks to 80 kB or more \(valid: at most 50 kB from a file of 11\.8 kB: "
        r"268 MB and 100 times its size\)$",
    ):
        open_log(path)


@pytest.mark.parametrize("count", [1, 14, 15, 200])
def test_a_list_in_a_pages_header_is_passed_over(count: int) -> None:
    """Thrift's compact form: up to 14 entries are counted in the list's first byte, more in a number behind it."""
    more = bytes([count]) if count < 128 else bytes([count & 127 | 128, count >> 7])
    listed = bytes([count << 4 | 5]) if count < 15 else b"\xf5" + more
    header = _Header(b"\x19" + listed + b"\x02" * count + b"\x15\x0e\x00")
    assert header.struct({1, 2}) == {2: 7}

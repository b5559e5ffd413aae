"""Tables that were cut, are empty, or are not what their names say."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pa_parquet
import pytest

from made_tables import HEADER, codes, csv_text, refusal, write
from plantar.errors import LogError
from plantar.logs.readers import open_log


@pytest.mark.parametrize("name", ["Tilt3.truth.parquet", "Tilt3.truth.json"])
def test_what_the_twin_knows_is_no_log(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("{}")
    with pytest.raises(
        LogError, match=rf"{name}: is what the twin knows, no log \(valid: the recording beside it"
    ):
        open_log(tmp_path / name)


@pytest.mark.parametrize(
    "name", ["a.mcap", "a.db3", "a.bag", "a.bin", "a.mat", "a.npz", "a.parquet", "data.log", "a.q"]
)
def test_a_file_of_no_bytes_is_empty_in_every_format(tmp_path: Path, name: str) -> None:
    (tmp_path / name).touch()
    with pytest.raises(LogError, match=f"{name}: is empty"):
        open_log(tmp_path / name)


def test_a_column_without_a_name_is_told_so(tmp_path: Path) -> None:
    """A comma at the end of every line, as some loggers write."""
    (tmp_path / "log.csv").write_text("time,joint.a.position,\n0,1,\n0.1,2,\n0.2,3,\n")
    (note,) = open_log(tmp_path / "log.csv").notes
    assert note.text == "log.csv: columns of no known name, not used: one without a name"


def test_empty_files(tmp_path: Path) -> None:
    assert "is empty" in refusal(tmp_path, "")
    assert "is empty" in refusal(tmp_path, " \n\n")
    assert "no samples" in refusal(tmp_path, HEADER + "\n")
    assert "fewer than two samples" in refusal(tmp_path, HEADER + "\n0,1,2\n")
    assert "is empty" in refusal(tmp_path, gzip.compress(b""), "log.csv.gz")
    refusal(tmp_path, b"", "log.csv.gz")
    assert "Parquet" in refusal(tmp_path, b"P", "log.parquet")


def test_a_file_cut_in_the_middle_of_a_row(tmp_path: Path) -> None:
    log = open_log(write(tmp_path, csv_text() + "0.05,7"))
    assert len(log) == 5
    assert codes(log) == ["file_cut"]
    log = open_log(write(tmp_path, csv_text() + "0.05,7\n"))
    assert len(log) == 5
    assert codes(log) == ["file_cut"]


def test_a_file_cut_in_the_middle_of_a_number_loses_that_row(tmp_path: Path) -> None:
    text = csv_text() + "0.05,123.456,789.125"
    for cut in range(1, 8):
        log = open_log(write(tmp_path, text[:-cut]))
        assert len(log) == 5, text[:-cut][-20:]
        assert codes(log) == ["file_cut"]


def test_a_last_line_without_an_end_of_line_is_left_out_with_a_note(tmp_path: Path) -> None:
    """Nobody can tell 12.5 from 12.59 cut short."""
    log = open_log(write(tmp_path, csv_text().rstrip("\n")))
    assert len(log) == 4
    assert codes(log) == ["file_cut"]


def test_a_file_cut_within_its_header(tmp_path: Path) -> None:
    refusal(tmp_path, "time,joint.a.posi")


def test_a_gzip_stream_cut_anywhere_gives_its_whole_lines(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    rows = [f"{0.01 * i:.2f},{random.normal()},{random.normal()}" for i in range(400)]
    whole = gzip.compress("\n".join([HEADER, *rows, ""]).encode())
    lengths = []
    for share in (0.5, 0.9, 0.999):
        log = open_log(write(tmp_path, whole[: int(share * len(whole))], "log.csv.gz"))
        assert "file_cut" in codes(log)
        expected = [float(row.split(",")[1]) for row in rows[: len(log)]]
        np.testing.assert_array_equal(log.column("joint.a.position"), expected)
        lengths.append(len(log))
    assert 100 < lengths[0] < lengths[1] < lengths[2] <= 400


def test_several_gzip_members_are_one_file(tmp_path: Path) -> None:
    first, second = csv_text(4), "0.10,1,2\n0.20,3,4\n"
    log = open_log(
        write(tmp_path, gzip.compress(first.encode()) + gzip.compress(second.encode()), "log.csv.gz")
    )
    assert len(log) == 6


def test_files_that_are_not_what_they_say(tmp_path: Path) -> None:
    assert "gzip" in refusal(tmp_path, csv_text(), "log.csv.gz")
    damaged = bytearray(gzip.compress(csv_text(200).encode()))
    damaged[len(damaged) // 2] ^= 0xFF
    assert "gzip" in refusal(tmp_path, bytes(damaged), "log.csv.gz")
    assert "Parquet" in refusal(tmp_path, csv_text(), "log.parquet")
    assert "not UTF-8 text at line 2" in refusal(tmp_path, bytes(range(1, 256)) * 8)


def test_a_cut_parquet_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "whole.parquet"
    pa_parquet.write_table(pa.table({"time": [0.0, 0.1], "joint.a.position": [1.0, 2.0]}), path)
    assert "Parquet" in refusal(tmp_path, path.read_bytes()[:-10], "log.parquet")

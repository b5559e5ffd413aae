"""The survey of a text table and its pieces, against the text itself: whatever the blocks, nothing is lost or held."""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path

import pytest

from made_tables import write
from plantar.errors import LogError
from plantar.logs.readers import open_log
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.tables import csv_text
from plantar.logs.readers.tables.csv_text import pieces, survey

HEADER = b"time,joint.a.position\n"


def rows(count: int, end: bytes = b"\n") -> bytes:
    return b"".join(b"%.2f,%d" % (0.01 * i, i**3) + end for i in range(count))


def small(patch: pytest.MonkeyPatch, block: int, piece: int = 2**23, line: int = 2**20) -> None:
    """Blocks, pieces and lines of so many bytes at most."""
    for name, size in (("BLOCK", block), ("PIECE", piece), ("LINE_LIMIT", line)):
        patch.setattr(csv_text, name, size)


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
@pytest.mark.parametrize("cut", [b"", b"0.40,1"])
def test_what_a_survey_finds(end: bytes, cut: bytes, tmp_path: Path) -> None:
    body = rows(40, end)
    path = write(tmp_path, b"\xef\xbb\xbf" + HEADER + body + cut)
    found = survey(path, ReadLimit(path))
    assert found.names == ["time", "joint.a.position"]
    assert (found.first, found.end) == (3 + len(HEADER), 3 + len(HEADER) + len(body))
    assert found.rows == 40
    assert (found.cut is not None) == bool(cut)


@pytest.mark.parametrize("block", [5, 16, 31, 64, 1000])
@pytest.mark.parametrize("last", [b"0.40,1\n", b"0.40," + b"7" * 90 + b"\n"])
@pytest.mark.parametrize("cut", [b"", b"0.41," + b"5" * 80])
def test_a_last_line_over_several_blocks(
    block: int, last: bytes, cut: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Blocks are let go once a line's length lies behind them; the last whole line is never among those."""
    small(monkeypatch, block, line=200)
    path = write(tmp_path, HEADER + rows(40) + last + cut)
    assert survey(path, ReadLimit(path)).last_line == last.rstrip()


@pytest.mark.parametrize(("block", "piece"), [(16, 64), (50, 50), (64, 300)])
def test_pieces_are_whole_lines_and_bounded(
    block: int, piece: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small(monkeypatch, block, piece)
    body = rows(100)
    path = write(tmp_path, HEADER + body + b"1.00,4")
    found = list(pieces(path, survey(path, ReadLimit(path))))
    assert b"".join(found) == body
    assert all(each.endswith(b"\n") for each in found)
    assert max(map(len, found)) < piece + block
    assert len(found) >= len(body) // (piece + block)
    assert all(len(each) > piece - 2 * block for each in found[:-1]), "a piece is not given away early"


@pytest.mark.parametrize("block", [5, 1000])
def test_a_line_may_be_as_long_as_the_limit(
    block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small(monkeypatch, block, line=100)
    for length, refused in ((100, False), (101, True)):
        path = write(tmp_path, b"time," + b"a" * (length - 5) + b"\n0,1\n")
        if refused:
            with pytest.raises(LogError, match="a line of more than 100 bytes"):
                survey(path, ReadLimit(path))
        else:
            assert survey(path, ReadLimit(path)).rows == 1


def test_blank_text_without_end_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small(monkeypatch, 10, line=100)
    path = write(tmp_path, b" \n" * 60 + HEADER + rows(3))
    with pytest.raises(
        LogError, match=r"log\.csv: has a line of more than 100 bytes \(valid: one sample a line\)$"
    ):
        survey(path, ReadLimit(path))


@pytest.mark.parametrize("block", [3, 7, 100, 2**20])
def test_a_cut_gzip_gives_all_that_it_holds(
    block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A few packed bytes can stand for a long text that repeats itself: what is inside comes out, too."""
    small(monkeypatch, block)
    packed = gzip.compress(HEADER + b"0.01,5\n" * 400 + rows(50))
    for length in range(60, len(packed), 7):
        held = zlib.decompressobj(wbits=31).decompress(packed[:length])
        path = write(tmp_path, packed[:length], "log.csv.gz")
        text = csv_text._Text(path)
        assert b"".join(text.blocks()) == held
        assert text.cut == "is a cut gzip file; what is whole was read"


@pytest.mark.parametrize("units", [b"s,deg", b"[s],", b"s,1", b" ms , rad "])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
@pytest.mark.parametrize("block", [7, 1000])
def test_a_line_of_units_below_the_names_is_no_sample(
    units: bytes, end: bytes, block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small(monkeypatch, block)
    names, body = HEADER.rstrip() + end, rows(20, end)
    path = write(tmp_path, names + units + end + body)
    found = survey(path, ReadLimit(path))
    assert found.units.encode() == units
    assert b"".join(pieces(path, found)).strip() == body.strip()
    assert open_log(path).time.size == 20


@pytest.mark.parametrize("first", [b"0.00,nan", b"nan,NA", b",", b"1,1", b"s", b"s,deg,V", b"0.0,deg"])
def test_a_row_with_a_number_a_hole_or_another_length_is_no_line_of_units(
    first: bytes, tmp_path: Path
) -> None:
    path = write(tmp_path, HEADER + first + b"\n" + rows(20))
    found = survey(path, ReadLimit(path))
    assert (found.units, found.first) == ("", len(HEADER))

"""Lines that Arrow reads: a short row is forgiven at the file's end alone, whatever stands before it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.errors import LogError
from plantar.logs.readers.tables.arrow_lines import ArrowLines

HEADER = ["q", "time"]
PATH = Path("log.csv")


def lines(last_line: bytes = b"", strict: bool = True) -> ArrowLines:
    return ArrowLines(PATH, HEADER, HEADER, last_line, strict)


def read(what: ArrowLines, piece: bytes, room: int = 4) -> np.ndarray:
    """The columns `q` and `time` of a piece."""
    values = np.full((2, room), -1.0)
    return values[:, : what.numbers_into(piece, values, 0)]


@pytest.mark.parametrize("end", [b"\n", b"\r\n"])
@pytest.mark.parametrize("texts", [False, True])
def test_a_last_row_that_is_short_is_cut_off(end: bytes, texts: bool) -> None:
    """Also where the piece has to be read a second time, for a spelling that only Python reads."""
    second = b"+1_000,0.1" if texts else b"1000,0.1"
    last = lines(b"5")
    found = read(last, end.join([b"7,0", second, b"5", b""]))
    np.testing.assert_array_equal(found, [[7, 1000], [0, 0.1]])
    assert last.cut
    whole = lines(b"1000,0.1")
    read(whole, end.join([b"7,0", second, b""]))
    assert not whole.cut


def test_only_one_row_may_be_short_and_the_message_shows_how_it_begins() -> None:
    long = ",".join(map(str, range(100, 140)))
    for piece in (b"7,0\n" + long.encode() + b"\n8,1\n", b"5\n5\n"):
        with pytest.raises(LogError, match=r"has (40|1) values where the header has 2: (100,101|5)") as told:
            read(lines(b"5"), piece)
        assert str(told.value).count(",") < 15, "a long row is not shown whole"


def test_a_file_that_has_grown_since_it_was_measured_is_told() -> None:
    assert read(lines(), b"1,0\n2,1\n3,2\n", room=3).shape == (2, 3)
    with pytest.raises(LogError, match=r"^log\.csv: changed while it was read$"):
        read(lines(), b"1,0\n2,1\n3,2\n4,3\n", room=3)


def test_a_text_names_its_time_and_takes_its_column_where_it_need_not_be_read() -> None:
    piece = b"7,0\nfoot,0.25\n9,0.5\n"
    with pytest.raises(
        LogError,
        match=r"^log\.csv, column 'q', t = 0\.25 s, value 'foot': is not a number \(valid: a number, or "
        r"an empty cell where nothing was recorded\)$",
    ):
        read(lines(), piece)
    loose = lines(strict=False)
    found = read(loose, piece)
    assert loose.texts == {"q"}
    assert np.isnan(found[0]).all()
    np.testing.assert_array_equal(found[1], [0, 0.25, 0.5])
    values = np.zeros((2, 1))
    loose.numbers_into(b"3,1\n", values, 0)
    assert values[0, 0] == 0, "a column of texts is not read again"

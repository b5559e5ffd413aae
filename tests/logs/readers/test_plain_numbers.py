"""Plain lines of numbers beside Python's own reading of each cell; all other lines are left to Arrow."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from plantar import _core
from plantar.logs.readers import open_log


def read(text: str, places: list[int], lines: int = 9, first: int = 0) -> tuple[int | None, np.ndarray]:
    values = np.full((max(places) + 1, lines), -7.0)
    return _core.numbers_into(text.encode(), places, values, first), values


def spelled() -> list[str]:
    """Doubles of every size in every usual spelling."""
    random = np.random.default_rng(3)
    any_bits = np.array(struct.unpack("<2000d", random.bytes(16_000)))
    usual = random.normal(size=2000) * 10.0 ** random.integers(-9, 9, 2000)
    values = [*any_bits[np.isfinite(any_bits) & (np.abs(any_bits) > 1e-300)].tolist(), *usual.tolist(), 0.0]
    texts = [form % value for value in values for form in ("%r", "%.17g", "%.6f", "%.3e", "%g")]
    return [*texts, "-0", "1.", ".5", "-.5", "007", "1E5", "12345678901234567890", "0.1e-7"]


def test_every_number_is_what_python_reads() -> None:
    texts = spelled()
    found, values = read("".join(f"{text}\n" for text in texts), [0], len(texts))
    assert found == len(texts)
    assert values[0].tobytes() == np.array([float(text) for text in texts]).tobytes()


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_columns_go_to_their_places_behind_what_is_there(end: str) -> None:
    found, values = read(end.join(["1,no number,3", "4,,6", "5,,", ""]), [1, -1, 0], 5, first=1)
    assert found == 3
    np.testing.assert_array_equal(values, [[-7, 3, 6, np.nan, -7], [-7, 1, 4, 5, -7]])


def test_holes_are_not_numbers() -> None:
    found, values = read("nan,1\nNaN,\n,2\n", [0, 1], 3)
    assert found == 3
    np.testing.assert_array_equal(values, [[np.nan] * 3, [1, np.nan, 2]])


@pytest.mark.parametrize(
    "line",
    [
        "1", "1,2,3", "", "1,two", '"1",2', " 1,2", "1,2 ", "+1,2", "1,inf", "1,-nan", "1,1e999", "1,1e-999", "1,0x1",
        "1,2\r3,4", "1,1_0", "1,-", "1,1e", "1,2.5.1", "1,²", "1,2\0",
    ],
)  # fmt: skip
def test_anything_else_is_left_to_others(line: str) -> None:
    assert read(f"3,4\n{line}\n", [0, 1])[0] is None


def test_no_more_lines_than_there_is_room_for_and_only_whole_ones() -> None:
    assert read("1,2\n3,4\n", [0, 1], 2)[0] == 2
    assert read("1,2\n3,4\n", [0, 1], 2, first=1)[0] is None
    assert read("1,2\n3,4", [0, 1])[0] is None
    assert read("1,2\n3,", [0, 1])[0] is None
    assert read("", [0, 1])[0] == 0


def test_places_beyond_the_values_are_refused() -> None:
    values = np.zeros((2, 3))
    for places in ([0, 2], [0, -2]):
        with pytest.raises(ValueError, match="row of the values"):
            _core.numbers_into(b"1,2\n", places, values, 0)
    with pytest.raises(ValueError, match="inside"):
        _core.numbers_into(b"1,2\n", [0, 1], values, 4)


@pytest.mark.parametrize("line", ["0.1,2", '0.1,"2"', " 0.1,2"])
def test_a_log_reads_the_same_in_either_way(line: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(f"time,joint.a.position\n0,1\n{line}\n0.3,\n")
    log = open_log(path)
    np.testing.assert_array_equal(log.time, [0, 0.1, 0.3])
    np.testing.assert_array_equal(log.column("joint.a.position"), [1, 2, np.nan])

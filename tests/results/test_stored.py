"""Rows read back from JSON: types, nulls, and the place of what does not fit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import pytest

from plantar.errors import PlantarError
from plantar.results.stored import row_of, rows_of, value_of

FILE = Path("result.json")


@dataclass(frozen=True)
class Row:
    name: str
    value: float
    interval95: tuple[float, float] | None = None
    maybe: float | None = None


def test_null_is_nan_where_a_number_must_stand_and_none_where_it_may_lack() -> None:
    row = row_of(
        Row, {"name": "a", "value": None, "interval95": [None, 2], "maybe": None, "new": 1}, "rows.0", FILE
    )
    assert math.isnan(row.value)
    assert row.interval95 == (-math.inf, 2.0)
    assert row.maybe is None


def test_missing_lists_are_empty_unless_required() -> None:
    assert rows_of(Row, {}, "rows", FILE) == ()
    with pytest.raises(
        PlantarError, match=r"^result\.json, column 'rows': is missing \(valid: a whole result\.json\)$"
    ):
        rows_of(Row, {}, "rows", FILE, required=True)


@pytest.mark.parametrize("entry", [{"name": "a"}, {"name": "a", "value": "x"}, {"name": "a", "value": [1]}])
def test_an_error_names_row_and_key(entry: object) -> None:
    with pytest.raises(PlantarError, match=r"column 'rows\.1\.value'"):
        rows_of(Row, {"rows": [{"name": "b", "value": 1}, entry]}, "rows", FILE)


@pytest.mark.parametrize("content", [{"rows": 3}, {"rows": {"a": 1}}, {"rows": "text"}])
def test_what_is_no_list_is_refused(content: dict[str, object]) -> None:
    with pytest.raises(PlantarError, match=r"^result\.json, column 'rows': Input should be a valid list$"):
        rows_of(Row, content, "rows", FILE)


def test_plain_values() -> None:
    assert value_of(dict[str, float], {"a": {"x": 1}}, "a", FILE) == {"x": 1.0}
    with pytest.raises(PlantarError, match=r"^result\.json, column 'a\.x': Input should be a valid number$"):
        value_of(dict[str, float], {"a": {"x": None}}, "a", FILE)

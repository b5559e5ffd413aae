"""What a fleet's summary may not depend on: the order of rows, feet's names, the unit of a value, the year."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date, timedelta
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from fleet_tables import changing_fleet, failures
from plantar.fleet.summary import summary_of

SOFTER, LATER = 0.01, 400  # a robot of a hundredth of the stiffness; days
VALUES = ("value", "low", "high", "sure_low", "sure_high")


def told(table: pa.Table) -> dict[str, list[dict[str, Any]]]:
    """The summary's rows by kind, in an order of their own."""
    content = summary_of(table, failures(), 0.1).to_dict()
    return {
        kind: sorted(
            content[kind], key=lambda row: (row.get("unit", ""), row["foot"], row["axis"], row["name"])
        )
        for kind in ("effects", "levels", "alarms")
    }


def changed(table: pa.Table, column: str, change: Callable[[Any], Any]) -> pa.Table:
    place = table.column_names.index(column)
    values = [None if value is None else change(value) for value in table[column].to_pylist()]
    return table.set_column(
        place, table.schema.field(place), pa.array(values, table.schema.field(place).type)
    )


def close(one: object, other: object, factor: float = 1.0) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return bool(np.isclose(one * factor, other, rtol=1e-6, equal_nan=True))
    return one == other


@pytest.fixture(scope="module")
def plain() -> dict[str, list[dict[str, Any]]]:
    return told(changing_fleet())


def test_the_order_of_rows_does_not_count(plain: dict[str, list[dict[str, Any]]]) -> None:
    table = changing_fleet()
    assert told(table.take(np.random.default_rng(0).permutation(table.num_rows))) == plain


def test_values_in_another_unit_move_numbers_and_no_share(plain: dict[str, list[dict[str, Any]]]) -> None:
    table = changing_fleet()
    for column in ("value", "std", "low", "high"):
        table = changed(table, column, lambda value: SOFTER * value)
    for kind, rows in told(table).items():
        assert len(rows) == len(plain[kind]) > 0
        for row, other in zip(rows, plain[kind], strict=True):
            for key, value in row.items():
                if key not in ("text", "advice"):
                    assert close(other[key], value, SOFTER if key in VALUES and kind != "alarms" else 1.0)


def test_feet_that_change_names_change_nothing_else(plain: dict[str, list[dict[str, Any]]]) -> None:
    other = {"left": "right", "right": "left"}
    swapped = told(changed(changing_fleet(), "foot", other.__getitem__))
    for kind, rows in plain.items():
        renamed = {(row.get("unit", ""), other[row["foot"]], row["axis"], row["name"]): row for row in rows}
        for row in swapped[kind]:
            before = renamed[row.get("unit", ""), row["foot"], row["axis"], row["name"]]
            assert {key for key in row if row[key] != before[key]} <= {"foot", "text", "advice"}


def test_another_year_is_like_this_one(plain: dict[str, list[dict[str, Any]]]) -> None:
    later = told(changed(changing_fleet(), "time", lambda time: time + timedelta(days=LATER)))
    for kind, rows in plain.items():
        for row, other in zip(rows, later[kind], strict=True):
            for key, value in row.items():
                if key in ("text", "advice"):
                    continue
                try:
                    moved: object = str(date.fromisoformat(value) + timedelta(days=LATER))
                except (TypeError, ValueError):
                    moved = value
                assert close(moved, other[key]), (kind, key)

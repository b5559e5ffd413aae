"""What a fleet says of tables, units and manifests that it cannot use; days of a series."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import numpy as np
import pytest

from plantar.errors import PlantarError
from plantar.fleet.manifest import read_manifest
from plantar.fleet.places import Store
from plantar.fleet.run import _said
from plantar.fleet.series import Series, SeriesKey, by_day
from plantar.fleet.tables import read_failures, read_results
from plantar.fleet.unit import SCHEMA, read_unit


def test_tables_that_are_not_there_or_are_none(tmp_path: Path) -> None:
    store, valid = Store(str(tmp_path)), "(valid: the --out of `plantar fleet run`)"
    with pytest.raises(PlantarError) as gone:
        read_results(store)
    assert str(gone.value) == f"{tmp_path}/results.parquet: does not exist {valid}"
    (tmp_path / "failures.parquet").write_bytes(b"PAR1")
    with pytest.raises(PlantarError) as broken:
        read_failures(store)
    assert str(broken.value).startswith(f"{tmp_path}/failures.parquet: is not such a table: ")
    assert str(broken.value).endswith(valid)


def test_units_and_manifests_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(PlantarError, match=r"^units/a\.json: is not JSON: "):
        read_unit(b"{", "units/a.json")
    for content in (b"[]", b'{"schema": "x"}'):
        with pytest.raises(PlantarError) as other:
            read_unit(content, "units/a.json")
        assert str(other.value) == f"units/a.json: is not a unit of a fleet (valid: schema '{SCHEMA}')"
    for text, said in (
        (b"\xff\xfe", "is not UTF-8 text (valid: a CSV file)"),
        (b"group,robot,log\n", "holds no rows (valid: rows under group, robot, log)"),
    ):
        (tmp_path / "fleet.csv").write_bytes(text)
        with pytest.raises(PlantarError) as refused:
            read_manifest(tmp_path / "fleet.csv")
        assert str(refused.value) == f"{tmp_path}/fleet.csv: {said}"


class KilledWorker(Exception):
    """Named as Dask's."""


def test_what_stopped_a_group_is_said_with_what_helps() -> None:
    assert _said(PlantarError("is empty", path="a.csv")) == "a.csv: is empty"
    assert _said(KilledWorker()) == (
        "its workers died, one after the other (valid: more memory for each with --memory, or shorter logs)"
    )
    assert _said(MemoryError()) == (
        "not enough memory for these logs (valid: more for each worker with --memory, or shorter logs)"
    )
    assert _said(ValueError("a\n  b")) == "internal error, please report it: ValueError: a b"


def test_days_hold_the_means_and_the_names_of_their_recordings() -> None:
    """Three recordings on one day, one on another; one without a time belongs to none."""
    times = np.array([100.1, 100.5, 100.9, 103.2, np.nan])
    series = Series(
        "A", SeriesKey("left", "pitch", "stiffness", ""), tuple("abcde"), times, np.arange(5.0), np.ones(5)
    )
    assert series.days == [100, 100, 100, 103, "e"]
    days = by_day(series)
    assert (days.day.tolist(), days.values.tolist(), days.counts.tolist()) == ([100, 103], [1, 3], [3, 1])
    assert days.groups == (("a", "b", "c"), ("d",))
    assert (days.date(0), days.date(1)) == (date(1970, 4, 11), date(1970, 4, 14))
    np.testing.assert_allclose(days.weights(0.3, 0.4), [1 / (0.16 + 0.03), 1 / 0.25])
    np.testing.assert_allclose(days.weights(0.3, None), [1 / 0.03, 1 / 0.09])
    np.testing.assert_array_equal(days.weights(None, None), [1, 1])

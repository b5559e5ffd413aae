"""Tables of made fleets: rows as `plantar fleet run` writes them, of robots that are known to change."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
import pyarrow as pa

from plantar.fleet.tables import FAILURES_SCHEMA, RESULTS_SCHEMA

START = datetime(2026, 1, 1, 9, tzinfo=UTC)
STEP_DAY = 60


def row(unit: str, day: int, foot: str, axis: str, value: float, **changes: Any) -> dict[str, Any]:
    return {
        "group": f"{unit}-{day}", "unit": unit, "time": START + timedelta(days=day), "foot": foot, "axis": axis,
        "name": "stiffness", "unit_of_value": "N.m/rad", "value": value, "std": 0.01 * value, "low": 0.98 * value,
        "high": 1.02 * value, "verdict": "usable", "model": "kelvin_voigt",
    } | changes  # fmt: skip


def results(rows: list[dict[str, Any]]) -> pa.Table:
    return pa.Table.from_pylist(rows, schema=RESULTS_SCHEMA)


def failures(*rows: tuple[str, str, str]) -> pa.Table:
    content = [{"group": group, "log": log, "error": error} for group, log, error in rows]
    return pa.Table.from_pylist(content, schema=FAILURES_SCHEMA)


def changing_fleet() -> pa.Table:
    """Three robots over 120 days: one whose left foot got a new sole, one whose rubber ages."""
    random, rows = np.random.default_rng(0), []
    for unit in ("steady", "new sole", "ageing"):
        for day in range(120):
            for foot in ("left", "right"):
                for axis in ("pitch", "roll"):
                    share = 0.005 * random.normal()
                    share += 0.06 if unit == "new sole" and foot == "left" and day >= STEP_DAY else 0.0
                    share += 0.02 * day / 30 if unit == "ageing" else 0.0
                    rows.append(row(unit, day, foot, axis, 400 * np.exp(share)))
    return results(rows)

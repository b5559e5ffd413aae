"""The feet report in a real browser on residuals that are odd or damaged."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet
import pytest

from plantar.report import write_feet_report
from report_samples import MOTIONS, write_campaign
from report_visit import INK, Visit, launched


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from launched()


def test_a_reconstruction_of_samples_left_out_does_not_set_the_scale(browser: Any, tmp_path: Path) -> None:
    campaign = write_campaign(tmp_path, seconds=4.0)
    columns = {name: values.copy() for name, values in campaign.columns.items()}
    columns["pitch.predicted"][~columns["used"].astype(bool)] = -5000.0
    pyarrow.parquet.write_table(pa.table(columns), tmp_path / "residuals.parquet")
    visit = Visit(browser, write_feet_report(tmp_path))
    torque = visit.plot(0, "torque", "right", "pitch")
    low, high = visit.scale(torque, "y")
    assert -200 < low < 0 < high < 200
    assert torque.evaluate("host => Math.min(...host.plot.data[2])") == pytest.approx(-5000, abs=5)
    visit.context.close()
    assert visit.complaints == []


def test_a_damaged_block_is_said_on_the_page(browser: Any, tmp_path: Path) -> None:
    report = write_feet_report(write_campaign(tmp_path, seconds=2.0).directory)
    text = report.read_text(encoding="utf-8")
    start = text.index(">", text.index('class="samples" data-motion="0"')) + 1
    damaged = tmp_path / "damaged.html"
    damaged.write_text(text[: start + 400] + text[text.index("<", start) :], encoding="utf-8")
    visit = Visit(browser, damaged)
    visit.page.locator("#motions").scroll_into_view_if_needed()
    visit.page.get_by_text("the page seems to be damaged").wait_for(timeout=10_000)
    visit.context.close()
    assert visit.complaints == []


def test_two_feet_with_times_of_their_own(browser: Any, tmp_path: Path) -> None:
    campaign = write_campaign(tmp_path, seconds=2.0)
    columns = {name: values.copy() for name, values in campaign.columns.items()}
    columns["time"][columns["foot"] == "left"] += 0.0021
    pyarrow.parquet.write_table(pa.table(columns), tmp_path / "residuals.parquet")
    (tmp_path / "result.json").write_text(json.dumps(campaign.result | {"phases": []}), encoding="utf-8")
    visit = Visit(browser, write_feet_report(tmp_path))
    visit.page.click("#open-all")
    host = visit.plot(MOTIONS.index(("tilt3", "fit", "both")), "angles", axis="pitch")
    assert host.evaluate("host => host.plot.data[0].length") == 800
    assert host.evaluate(INK)["red"] > 15
    visit.context.close()
    assert visit.complaints == []


def all_nan(columns: dict[str, np.ndarray]) -> None:
    for name in columns:
        if name.startswith(("pitch", "roll", "cop", "force")):
            columns[name] = np.full(columns["time"].size, np.nan)


def with_height(columns: dict[str, np.ndarray]) -> None:
    for quantity in ("deflection", "torque", "predicted"):
        columns[f"z.{quantity}"] = columns[f"pitch.{quantity}"]


def one_instant(columns: dict[str, np.ndarray]) -> None:
    columns["time"] = np.zeros(columns["time"].size)


def another_foot(columns: dict[str, np.ndarray]) -> None:
    columns["foot"] = np.where(columns["foot"] == "right", 'rear "left"', columns["foot"])


@pytest.mark.parametrize(
    ("change", "foot", "axis"),
    [(all_nan, "right", "pitch"), (with_height, "right", "z"), (one_instant, "right", "roll"),
     (another_foot, 'rear \\"left\\"', "pitch")],
)  # fmt: skip
def test_odd_residuals_are_drawn_without_complaint(
    browser: Any, tmp_path: Path, change: Any, foot: str, axis: str
) -> None:
    campaign = write_campaign(tmp_path, seconds=1.0)
    columns = {name: values.copy() for name, values in campaign.columns.items()}
    change(columns)
    pyarrow.parquet.write_table(pa.table(columns), tmp_path / "residuals.parquet")
    visit = Visit(browser, write_feet_report(tmp_path))
    for kind in ("torque", "loop"):
        low, high = visit.scale(visit.plot(0, kind, foot, axis), "y")
        assert low < high
    visit.plot(0, "pressure")
    visit.context.close()
    assert visit.complaints == []

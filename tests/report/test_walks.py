"""The report on walks as a page: what stands where, and nothing of it for feet that stand."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pyarrow as pa

from plantar.report import write_feet_report
from plantar.results.feet import FeetResult
from report_walks import standing_result, walk_result, walk_tracks


def written(result: FeetResult, folder: Path) -> str:
    columns: dict[str, list[object]] = {}
    for track in walk_tracks():
        count = len(track.time)
        same = {"motion": [track.motion] * count, "role": [track.role] * count, "foot": [track.foot] * count}
        rows = same | {"time": track.time, "used": track.used, "support": track.support} | dict(track.values)
        for name, column in rows.items():
            columns.setdefault(name, []).extend(column)  # type: ignore[call-overload]
    replace(result, residuals=pa.table(columns)).save(folder)
    return write_feet_report(folder).read_text(encoding="utf-8")


def test_warnings_verdicts_with_their_loops_walks_and_tables_come_in_this_order(tmp_path: Path) -> None:
    page = written(walk_result(), tmp_path)
    places = [
        page.index(text)
        for text in (
            "delay of the wrenches unknown", "<h2>left foot</h2>", "Each stance less its offset",
            "K by stance and by walk", "torque of unseen walks", "zero of the force sensor",
            "Table 1.", 'id="motions"', "zero taken off",
        )
    ]  # fmt: skip
    assert places == sorted(places)
    assert page.count("one sample bridged") == 1
    assert page.count('<figure class="chart">') == 2 + 2 + 2 + 2
    body = re.sub(r"<script.*?</script>|<style.*?</style>", "", page, flags=re.S)
    assert "nan" not in body.lower()
    assert "style=" not in body, "the page's policy forbids styles on elements"


def test_feet_that_stand_have_loops_and_no_walks(tmp_path: Path) -> None:
    page = written(standing_result(), tmp_path)
    assert "Each motion less its offset" in page
    assert 'id="walks"' not in page
    assert page.index("Each motion less its offset") < page.index("Table 1.")


def test_a_name_in_a_chart_is_text(tmp_path: Path) -> None:
    hostile = '"><img src=x>'
    rows = [replace(row, motion=hostile) if row.motion == "walk_1" else row for row in walk_result().stances]
    page = written(replace(walk_result(), stances=tuple(rows)), tmp_path)
    assert "<img" not in page

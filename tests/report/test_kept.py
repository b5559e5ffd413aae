"""Whole pages as they are kept, without scripts and styles: every word, number, line and place of every figure."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fleet_tables import START, changing_fleet, failures
from kept_texts import assert_as_kept
from plantar.fleet.summary import summary_of
from plantar.fleet.tables import GroupRow
from plantar.report import write_dynamics_report, write_feet_report
from plantar.report.feet import _page
from plantar.report.fleet import fleet_page
from report_samples import write_campaign
from report_walks import standing_result, walk_result, walk_tracks

KEPT = Path(__file__).parent / "kept"
MADE = "2026-01-01T00:00:00Z"
SHARED: dict[str, Any] = {
    "robot": "icub", "plantar": "0.1.0", "created": MADE, "settings": {"rows": "base"},
    "inputs": [{"path": "/logs/walk.csv", "sha256": "cd" * 32, "role": "fit"}],
    "notes": [{"code": "inertia.unexcited", "severity": "warning", "text": "the head is still"}],
    "rank": 234, "condition_number": 4.1e5,
    "base_parameters": [
        {"expression": "m(torso) + 0.3·mx(head)", "value": 12.34, "std": 0.02, "interval95": [12.30, 12.38],
         "relative_std_percent": 0.16},
        {"expression": "Izz(l_foot)", "value": None, "std": None, "interval95": [None, None],
         "relative_std_percent": None},
    ],
    "inertial_parameters": [
        {"link": f"link_{place}", "name": "m", "unit": "kg", "value": 1.5 + place, "cad": 1.4 + 0.9 * place}
        for place in range(12)
    ],
}  # fmt: skip
SCORE = {"kind": "cross", "motion": "walk", "max_abs": 40.0, "samples": 500, "mean_abs_error": 1.5, "rms_error": 2.2,
         "zero_mean_abs": 12.0, "cad_rms_error": 20.5}  # fmt: skip


def feet(folder: Path) -> str:
    campaign = write_campaign(folder, seconds=3.0, rate=20.0)
    return write_feet_report(campaign.directory).read_text()


def walks(_: Path) -> str:
    return _page(replace(walk_result(), created=MADE), Path("residuals.parquet"), walk_tracks())


def stands(_: Path) -> str:
    return _page(replace(standing_result(), created=MADE), None, ())


def dynamics(schema: str, **more: Any) -> Callable[[Path], str]:
    def page(folder: Path) -> str:
        (folder / "result.json").write_text(json.dumps(SHARED | {"schema": schema} | more))
        return write_dynamics_report(folder).read_text()

    return page


def fleet(_: Path) -> str:
    groups = [GroupRow(f"day {day}", unit, START, 32 * code) for day, unit, code in
              ((1, "new sole", "ab"), (2, "ageing", "cd"), (3, "steady", "ef"))]  # fmt: skip
    told = summary_of(
        changing_fleet(), failures(("g", "a.csv", "it is cut"), ("h", "b.csv", "it is cut")), 0.1
    )
    return fleet_page(told, groups, run={"groups": 300, "failed": 2, "reused": 11, "seconds": 61.5})


PAGES: dict[str, Callable[[Path], str]] = {
    "feet": feet, "walks": walks, "stands": stands, "fleet": fleet,
    "inertia": dynamics("plantar.inertia/1", validation=[
        SCORE | {"axis": "torque.x", "unit": "N.m"},
        SCORE | {"axis": "force.z", "unit": "N", "max_abs": 700.0, "rms_error": 7.9, "zero_mean_abs": 5.0}]),
    "joints": dynamics("plantar.joints/1", parameters=[
        {"joint": "a1", "name": "viscous", "unit": "N.m.s/rad", "value": 3.2, "std": 0.1, "interval95": [3.0, 3.4],
         "verdict": "usable", "reason": ""},
        {"joint": "a2", "name": "coulomb", "unit": "N.m", "value": 0.2, "std": 0.4, "interval95": [-0.6, 1.0],
         "verdict": "weak", "reason": "the joint hardly turns"}],
        validation=[SCORE | {"joint": "all", "unit": "N.m", "relative_error_percent": 2.31}]),
}  # fmt: skip


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    page = PAGES[name](tmp_path)
    page = re.sub(r"<style>.*?</style>|<script>.*?</script>|<meta http-equiv.*?>", "", page, flags=re.DOTALL)
    page = re.sub(r"[A-Za-z0-9+/=]{80,}", "DATA", page).replace(str(tmp_path), "FOLDER").replace("><", ">\n<")
    lines = [line.strip() for line in page.splitlines()]
    assert_as_kept("".join(f"{line}\n" for line in lines if line), KEPT / f"{name}.txt", share=1e-4)

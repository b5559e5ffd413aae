"""The fleet's page in a real browser: a robot's plots are drawn when it is opened, from this file alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from fleet_tables import START, changing_fleet, failures
from plantar.fleet.summary import summary_of
from plantar.fleet.tables import GroupRow
from plantar.report.fleet import fleet_page
from report_visit import INK, Visit, launched


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from launched()


def test_a_robot_is_drawn_when_it_is_opened(browser: Any, tmp_path: Path) -> None:
    page = tmp_path / "fleet.html"
    groups = [GroupRow("day 1", "new sole", START, "ab" * 32)]
    page.write_text(
        fleet_page(summary_of(changing_fleet(), failures(), 0.1), groups, run=None), encoding="utf-8"
    )
    visit = Visit(browser, page)
    robot = visit.page.locator("details.motion", has_text="new sole")
    assert visit.page.locator(".uplot").count() == 0
    robot.locator("summary").first.click()
    plots = robot.locator("figure.plot div[role=img]")
    plots.first.locator("canvas").wait_for()
    assert plots.count() == 4
    inks = [plots.nth(place).evaluate(INK) for place in range(4)]
    labels = [plots.nth(place).get_attribute("aria-label") for place in range(4)]
    for ink, label in zip(inks, labels, strict=True):
        colour = "red" if label.startswith("right") else "blue"
        assert ink[colour] > 100, (label, ink)
    assert robot.locator(".groups a").first.get_attribute("href") == f"groups/{'ab' * 32}/result.json"
    visit.context.close()
    assert visit.complaints == []
    assert [url for url in visit.requests if not url.startswith(("file:", "data:", "blob:"))] == []

"""The feet report in a real browser: plots drawn, zoom, no complaint, no request."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar.report import write_feet_report
from plantar.results.residuals import Track, read_residuals
from report_samples import MOTIONS, write_campaign
from report_visit import INK, Visit, launched

LONG_REASON = """() => {
    const tables = [...document.querySelectorAll("table")];
    const cell = tables.find((one) => one.caption?.innerText.startsWith("What is used")).querySelector("td:last-child");
    cell.innerText = "landing or lifting: just after or before a change of support (5.2 s); ".repeat(3);
    return cell.getBoundingClientRect().height;
}"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from launched()


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("browser")
    write_campaign(directory, seconds=20.0)
    return write_feet_report(directory)


@pytest.fixture
def visit(browser: Any, report: Path) -> Iterator[Visit]:
    one = Visit(browser, report)
    yield one
    one.context.close()
    assert one.complaints == []
    assert [url for url in one.requests if not url.startswith(("file:", "data:", "blob:"))] == []
    assert sum(url.startswith("file:") for url in one.requests) == 1


def test_plots_are_drawn(visit: Visit) -> None:
    for axis in ("pitch", "roll"):
        assert visit.plot(0, "angles", axis=axis).evaluate(INK)["red"] > 100
        for kind in ("torque", "loop"):
            ink = visit.plot(0, kind, "right", axis).evaluate(INK)
            assert ink["blue"] > 100, (kind, axis, ink)
            assert ink["red"] > 20, (kind, axis, ink)
    assert visit.plot(0, "force").evaluate(INK)["red"] > 100
    pressure = visit.plot(0, "pressure")
    assert pressure.evaluate(INK)["red"] > 100
    for name, (low, high) in (("x", (-90, 130)), ("y", (-60, 60))):
        seen = visit.scale(pressure, name)
        assert seen == pytest.approx((low - 0.05 * (high - low), high + 0.05 * (high - low)))


def test_a_bush_in_the_air_is_not_drawn(visit: Visit) -> None:
    """In the first motion the left foot is lifted; in the last ones both stand."""
    lines = "host => host.plot.series.slice(1).map((line) => line.label)"
    assert visit.plot(0, "angles", axis="pitch").evaluate(lines) == ["right"]
    assert visit.plot(0, "force").evaluate(lines) == ["left", "right"]
    visit.page.click("#open-all")
    assert visit.plot(5, "angles", axis="pitch").evaluate(lines) == ["left", "right"]


def test_only_what_is_seen_is_drawn(visit: Visit) -> None:
    visit.plot(0, "angles", axis="pitch")
    drawn = visit.page.locator(".canvas.drawn").count()
    assert 0 < drawn < visit.page.locator(".canvas").count()
    visit.page.click("#open-all")
    last = len(MOTIONS) - 1
    assert visit.plot(last, "torque", "left", "roll").evaluate(INK)["blue"] > 100


def test_the_browser_decodes_what_was_measured(visit: Visit, report: Path) -> None:
    tracks = read_residuals(report.parent / "residuals.parquet")
    track: Track = next(t for t in tracks if (t.motion, t.foot) == ("manual_right_roll", "right"))
    host = visit.plot(0, "torque", "right", "roll")
    time, measured, predicted = host.evaluate("host => host.plot.data.map((column) => Array.from(column))")
    np.testing.assert_allclose(time, track.time, atol=1e-6)
    np.testing.assert_allclose(measured, track.values["roll.torque"], atol=0.02)
    expected = track.values["roll.predicted"]
    got = np.array([np.nan if value is None else value for value in predicted])
    np.testing.assert_allclose(got, expected, atol=0.02)


def test_a_drag_zooms_all_plots_of_the_motion_and_a_double_click_resets(visit: Visit) -> None:
    angles = visit.plot(0, "angles", axis="pitch")
    torque = visit.plot(0, "torque", "right", "pitch")
    loop = visit.plot(0, "loop", "right", "pitch")
    whole = visit.scale(torque)
    before = loop.evaluate(INK)
    visit.drag(torque, (0.2, 0.5), (0.4, 0.5))
    low, high = visit.scale(torque)
    span = whole[1] - whole[0]
    assert low == pytest.approx(whole[0] + 0.2 * span, abs=0.02 * span)
    assert high == pytest.approx(whole[0] + 0.4 * span, abs=0.02 * span)
    assert visit.scale(angles) == (low, high)
    assert visit.page.locator('details[data-motion="0"] .shown').inner_text().endswith(" s")
    view = visit.page.locator('details[data-motion="0"] .timeline svg').first.get_attribute("viewBox")
    assert view is not None
    assert float(view.split()[0]) == pytest.approx(low)
    assert loop.evaluate(INK)["blue"] < before["blue"]
    late = visit.plot(0, "torque", "right", "roll")
    assert visit.scale(late) == (low, high)
    torque.locator(".u-over").scroll_into_view_if_needed()
    torque.locator(".u-over").dblclick()
    visit.settle("([host, low]) => host.plot.scales.x.min === low", [torque.element_handle(), whole[0]])
    assert visit.scale(torque) == whole
    assert visit.scale(angles) == whole


def test_a_loop_zooms_by_itself(visit: Visit) -> None:
    loop = visit.plot(0, "loop", "right", "pitch")
    torque = visit.plot(0, "torque", "right", "pitch")
    whole = [visit.scale(loop, name) for name in "xy"]
    loop.scroll_into_view_if_needed()
    visit.drag(loop, (0.3, 0.3), (0.6, 0.7))
    zoomed = [visit.scale(loop, name) for name in "xy"]
    for (low, high), (least, most) in zip(zoomed, whole, strict=True):
        assert 0.25 < (high - low) / (most - least) < 0.45
    first, last = visit.scale(torque)
    assert last - first == pytest.approx(20.0, abs=0.1)
    loop.locator(".u-over").dblclick()
    visit.page.wait_for_timeout(50)
    assert [visit.scale(loop, name) for name in "xy"] == whole


def test_a_phase_says_its_reason(visit: Visit) -> None:
    visit.page.locator('details[data-motion="0"] .timeline rect.out').last.hover()
    said = visit.page.locator('details[data-motion="0"] .timeline output').inner_text()
    assert said.startswith("right foot, 8.00 to 9.00 s: transition, left out: sole tips over its edge")


def test_dark_pages_have_their_own_colours(browser: Any, report: Path) -> None:
    visits = [Visit(browser, report, color_scheme=scheme) for scheme in ("light", "dark")]
    back = [one.page.evaluate("getComputedStyle(document.body).backgroundColor") for one in visits]
    assert back[0] == "rgb(255, 255, 255)"
    assert back[1] != back[0]
    assert visits[1].plot(0, "torque", "right", "pitch").evaluate(INK)["blue"] > 100
    visits[1].page.emulate_media(color_scheme="light")
    assert visits[1].plot(0, "torque", "right", "pitch").evaluate(INK)["blue"] > 100
    for one in visits:
        one.context.close()
        assert one.complaints == []


@pytest.mark.parametrize("width", [380, 1280])
def test_the_page_is_never_wider_than_the_window(browser: Any, report: Path, width: int) -> None:
    visit = Visit(browser, report, viewport={"width": width, "height": 800})
    visit.page.click("#open-all")
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= width
    assert visit.page.evaluate(LONG_REASON) < 150, "px: a row of some lines, not of one word each"
    host = visit.plot(1, "torque", "right", "pitch")
    assert host.evaluate("host => host.plot.width <= host.clientWidth")
    visit.context.close()
    assert visit.complaints == []

"""The feet report in a real browser: plots drawn, zoom, no complaint, no request."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar.report import write_feet_report
from plantar.report.residuals import Track, read_residuals
from report_samples import MOTIONS, write_campaign

CHROMIUM = shutil.which("chromium")
ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
]
INK = """host => {
  const canvas = host.querySelector("canvas");
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
  copy.drawImage(canvas, 0, 0);
  const pixels = copy.getImageData(0, 0, canvas.width, canvas.height).data;
  const [red, blue] = ["red", "blue"].map((name) => {
    const [r, g, b] = plantar.colour(name).match(/[0-9a-f]{2}/g).map((part) => parseInt(part, 16));
    let count = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      const near = Math.abs(pixels[i] - r) + Math.abs(pixels[i + 1] - g) + Math.abs(pixels[i + 2] - b) < 40;
      if (near && pixels[i + 3] > 200) count++;
    }
    return count;
  });
  return {red, blue};
}"""


class Visit:
    """A page, what it logged and what it asked the network for."""

    def __init__(self, browser: Any, report: Path, **context: Any) -> None:
        self.context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **context})
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("dialog", lambda dialog: self.complaints.append(f"dialog {dialog.message}"))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(report.as_uri())

    def plot(self, motion: int, kind: str, foot: str = "", axis: str = "") -> Any:
        """The place of one plot, scrolled to and drawn."""
        place = f'details[data-motion="{motion}"] figure[data-kind="{kind}"]'
        host = self.page.locator(f'{place}[data-foot="{foot}"][data-axis="{axis}"] .canvas')
        host.scroll_into_view_if_needed()
        self.page.wait_for_function("host => host.classList.contains('drawn')", arg=host.element_handle())
        return host

    def scale(self, host: Any, name: str = "x") -> tuple[float, float]:
        low, high = host.evaluate(f"host => [host.plot.scales.{name}.min, host.plot.scales.{name}.max]")
        return low, high

    def drag(self, host: Any, start: tuple[float, float], end: tuple[float, float]) -> None:
        """A drag between two points given as shares of the plot's area."""
        box = host.locator(".u-over").bounding_box()
        for name, (x, y) in (("down", start), ("up", end)):
            self.page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"], steps=4)
            getattr(self.page.mouse, name)()
        self.page.wait_for_timeout(50)

    def settle(self, script: str, arg: Any = None) -> None:
        self.page.wait_for_function(script, arg=arg)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    api = pytest.importorskip("playwright.sync_api", reason="the playwright package is not installed")
    with api.sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield started
        started.close()


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


def test_a_reconstruction_of_samples_left_out_does_not_set_the_scale(browser: Any, tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet

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
    host = visit.plot(1, "torque", "right", "pitch")
    assert host.evaluate("host => host.plot.width <= host.clientWidth")
    visit.context.close()
    assert visit.complaints == []


def test_a_damaged_block_is_said_on_the_page(browser: Any, report: Path, tmp_path: Path) -> None:
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
    import pyarrow as pa
    import pyarrow.parquet

    campaign = write_campaign(tmp_path, seconds=2.0)
    columns = {name: values.copy() for name, values in campaign.columns.items()}
    columns["time"][columns["foot"] == "left"] += 0.0021
    pyarrow.parquet.write_table(pa.table(columns), tmp_path / "residuals.parquet")
    (tmp_path / "result.json").write_text(json.dumps(campaign.result | {"phases": []}), encoding="utf-8")
    visit = Visit(browser, write_feet_report(tmp_path))
    host = visit.plot(0, "angles", axis="pitch")
    assert host.evaluate("host => host.plot.data[0].length") == 800
    assert host.evaluate(INK)["red"] > 15
    visit.context.close()
    assert visit.complaints == []

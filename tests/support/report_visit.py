"""A visit to a report in headless Chromium."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

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


def launched() -> Iterator[Any]:
    """Debian's Chromium for a module's fixture; skips where it or playwright is missing."""
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    api = pytest.importorskip("playwright.sync_api", reason="the playwright package is not installed")
    with api.sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield started
        started.close()

"""The pictures of the report with numbers on its parts, as docs/report.md explains them. From the twin, in Chromium.

python docs/images/make_report.py [FOLDER]      # logs and result go to FOLDER, out/picture where left out
"""

from __future__ import annotations

import io
import shutil
import sys
from pathlib import Path
from typing import Any

from make_what_it_does import HERE, identified
from PIL import Image
from playwright.sync_api import sync_playwright

from plantar.report import write_feet_report

WIDTH = 1100  # pixels of the page
COLOURS = 128  # of a picture: text and lines need no more
SCORES = '[aria-label^="Table 3"]'
MOTION = "details.motion[open]"
# Picture: the part of the page that it shows, how much of it [px], and what the numbers stand at.
PICTURES: dict[str, tuple[str, int, list[tuple[int, str]]]] = {
    "report_verdict": (
        "#verdict",
        725,
        [(1, ".trust"), (2, ".foot .statement"), (3, ".foot .reasons"), (4, ".foot svg")],
    ),
    "report_trust": (".feet + p", 275, [(5, ".feet + p")]),
    "report_parameters": ("#tables", 720, [(6, "#tables table")]),
    "report_scores": (SCORES, 230, [(7, f"{SCORES} caption")]),
    "report_motion": (
        MOTION,
        1110,
        [
            (8, f"{MOTION} .timeline"),
            (9, f'{MOTION} figure[data-kind="angles"]'),
            (10, f'{MOTION} figure[data-kind="pressure"]'),
            (11, f'{MOTION} figure[data-kind="torque"]'),
            (12, f'{MOTION} figure[data-kind="loop"]'),
        ],
    ),
}
BADGE = """([number, selector]) => {
  const place = document.querySelector(selector);
  if (!place) return false;
  const box = place.getBoundingClientRect(), badge = document.createElement("span");
  badge.textContent = number;
  badge.style.cssText = `position:absolute; left:${Math.max(2, box.left + scrollX - 30)}px; top:${box.top + scrollY}px;
    width:24px; height:24px; border-radius:12px; background:#c8470a; color:white; font:bold 14px/24px sans-serif;
    text-align:center; z-index:9`;
  document.body.append(badge);
  return true;
}"""


def shot(page: Any, name: str) -> Path:
    """One picture: its numbers put on the page, its part cut out."""
    part, height, numbers = PICTURES[name]
    for number, selector in numbers:
        page.locator(selector).first.scroll_into_view_if_needed()  # plots are drawn when they are seen
        page.wait_for_timeout(200)
        assert page.evaluate(BADGE, [number, selector]), f"{name}: nothing is at {selector}"
    top = page.evaluate("part => document.querySelector(part).getBoundingClientRect().top + scrollY", part)
    clip = {"x": 0, "y": max(0, top - 12), "width": WIDTH, "height": height}
    path = HERE / f"{name}.png"
    with Image.open(io.BytesIO(page.screenshot(full_page=True, clip=clip))) as image:
        image.convert("RGB").quantize(COLOURS).save(path, optimize=True)
    return path


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/picture")
    identified(folder)
    report = write_feet_report(folder / "feet")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": 1000})
        page.goto(report.resolve().as_uri())
        page.evaluate("document.body.style.paddingLeft = '34px'")
        page.wait_for_timeout(500)
        for name in PICTURES:
            print(shot(page, name))
        browser.close()


if __name__ == "__main__":
    main()

"""Where to read on: pages that are there, said where a number is not usable and nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

from plantar import pages

PAGES = Path(__file__).parents[1] / "docs"
TITLES = {
    page.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ") for page in PAGES.rglob("*.md")
}


@pytest.mark.parametrize(
    "title", [pages.REASONS, pages.IDENTIFIABLE, pages.STRUCTURE, pages.JOINTS, pages.ONLINE]
)
def test_a_page_of_that_title_is_in_the_documentation(title: str) -> None:
    assert title in TITLES


@pytest.mark.parametrize(
    ("verdicts", "expected"),
    [
        (["usable", "usable"], []),
        (["usable", "weak"], [pages.REASONS]),
        (["unidentifiable", "usable"], [pages.REASONS, pages.IDENTIFIABLE, pages.STRUCTURE]),
    ],
)
def test_each_verdict_leads_to_its_pages(verdicts: list[str], expected: list[str]) -> None:
    said = pages.on_feet(verdicts)
    assert bool(said) == bool(expected)
    assert said.count("“") == len(expected)
    assert all(page in said for page in expected)


def test_joints_have_pages_of_their_own() -> None:
    assert pages.on_joints(["usable"]) == ""
    assert pages.JOINTS in pages.on_joints(["unidentifiable"])

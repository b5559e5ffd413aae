"""Where to read on: pages that are there, said where a number is not usable and nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

from plantar.results import read_on

PAGES = Path(__file__).parents[2] / "docs"
TITLES = {
    page.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ") for page in PAGES.rglob("*.md")
}


@pytest.mark.parametrize("title", [read_on.REASONS, read_on.IDENTIFIABLE, read_on.STRUCTURE, read_on.JOINTS])
def test_a_page_of_that_title_is_in_the_documentation(title: str) -> None:
    assert title in TITLES


@pytest.mark.parametrize(
    ("verdicts", "pages"),
    [
        (["usable", "usable"], []),
        (["usable", "weak"], [read_on.REASONS]),
        (["unidentifiable", "usable"], [read_on.REASONS, read_on.IDENTIFIABLE, read_on.STRUCTURE]),
    ],
)
def test_each_verdict_leads_to_its_pages(verdicts: list[str], pages: list[str]) -> None:
    said = read_on.on_feet(verdicts)
    assert bool(said) == bool(pages)
    assert said.count("“") == len(pages)
    assert all(page in said for page in pages)


def test_joints_have_pages_of_their_own() -> None:
    assert read_on.on_joints(["usable"]) == ""
    assert read_on.JOINTS in read_on.on_joints(["unidentifiable"])

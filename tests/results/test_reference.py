"""A result among published and configured feet."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from command_line import run
from plantar.report.tables import neighbour_table
from plantar.results.feet_rows import Parameter
from plantar.results.reference import REFERENCES, neighbours

ROOT = Path(__file__).resolve().parents[2]


def row(foot: str, axis: str, name: str, value: float | None) -> Parameter:
    return Parameter(foot, axis, name, "", value, None, None, None, "usable", "")  # type: ignore[arg-type]


OWN = (
    row("left", "pitch", "stiffness", 800.0), row("left", "roll", "stiffness", 700.0),
    row("left", "pitch", "damping", 30.0), row("left", "roll", "damping", 10.0), row("left", "z", "stiffness", None),
    row("right", "pitch", "stiffness", 900.0),
)  # fmt: skip


def test_a_result_stands_among_its_neighbours_by_stiffness() -> None:
    lines = neighbours(OWN)
    assert len(lines) == len(REFERENCES) + 1, "a foot without roll has no place"
    assert [line.reference.rotation for line in lines] == sorted(line.reference.rotation for line in lines)
    place = next(place for place, line in enumerate(lines) if line.own)
    own, softer, stiffer = (lines[at].reference for at in (place, place - 1, place + 1))
    assert (own.robot, own.rotation, own.damping, own.z) == ("this result, left", 750.0, 20.0, None)
    assert softer.rotation < 750 < stiffer.rotation
    assert not any(line.own for line in neighbours())


def test_what_no_log_shows_is_nobodys_neighbour() -> None:
    doubtful = [
        replace(r, verdict="unidentifiable") if r.name == "damping" and r.axis == "roll" else r for r in OWN
    ]
    (own,) = [line.reference for line in neighbours(doubtful) if line.own]
    assert own.damping is None, "the mean of one number and of one that is not known is no number"
    unknown = [replace(r, verdict="unidentifiable") if r.name == "stiffness" else r for r in OWN]
    assert not any(line.own for line in neighbours(unknown))


def test_every_reference_says_where_it_is_from_and_whether_it_was_measured() -> None:
    assert all(one.source and one.origin in ("measured", "configured") for one in REFERENCES)
    assert {one.origin for one in REFERENCES} == {"measured", "configured"}
    page = (ROOT / "docs" / "how_to" / "typical_values.md").read_text()
    for one in REFERENCES:
        if one.rotation < 1e6:
            assert f"{one.pitch:.0f}" in page, one


def test_the_report_marks_the_result() -> None:
    table = neighbour_table(OWN)
    marked = [cells[0].text for cells in table.rows if cells[0].mark]
    assert marked == ["this result, left"]
    assert table.folded


def test_the_command_lists_them(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("show", "reference") == 0
    out = capsys.readouterr().out
    assert "JAXON" in out
    assert "configured" in out
    assert run("show", "nothing") == 2


# Pitch, roll [N·m/rad], z [N/m], damping [N·m·s/rad]. Of the paper's table 1 the damping is the mean of 15.9 and 17.5,
# of 24.3 and 28.2; REEM-C's is measured from public walks; the others are the robots' public configurations.
PUBLISHED = {
    ("HRP-2, right foot", 434, 323, None, 16.7), ("HRP-2, left foot", 480, 352, None, 26.2),
    ("HRP-2", 502, 707, 239018, None), ("HRP-2", 600, 600, 40000, 60),
    ("any, Kinetics Observer's default", 400, 400, 40000, 12), ("JAXON", 2500, 2500, 1.1e6, 2.5),
    ("JVRC-1", 3000, 3000, 1.3e6, 2.5), ("OpenHRP's sample robot", 1000, 1000, 5e5, 25), ("TALOS", 1e8, 1e8, 1e8, None),
    ("REEM-C, foot and leg in series", 1750, 1475, None, None),
}  # fmt: skip


def test_references_are_as_published_and_a_number_without_a_value_is_none() -> None:
    assert {(one.robot, one.pitch, one.roll, one.z, one.damping) for one in REFERENCES} == PUBLISHED
    k, other, damper = (
        row("left", "pitch", "stiffness", 500.0),
        row("left", "roll", "stiffness", 500.0),
        OWN[2],
    )
    (own,) = [one.reference for one in neighbours([k, other, damper, replace(OWN[3], value=None)]) if one.own]
    assert (own.rotation, own.damping) == (500.0, None)
    (own,) = [one.reference for one in neighbours([k, replace(other, value=700.0), *OWN[2:4]]) if one.own]
    assert (own.rotation, own.damping) == (600.0, 20.0)

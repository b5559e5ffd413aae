"""What commands print for scripts: JSON alone, with the numbers of what was found."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from command_line import refused
from plantar import campaign
from plantar.campaign import present
from plantar.cli import compare, demo, diagnose, select, show
from plantar.comparison import compare as comparison
from plantar.comparison.compare import KindScore
from plantar.contact.phases import Phase
from plantar.motions.select_motions import Choice, Selection
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Assumption, Diagnosis, Parameter

STIFFNESS = [
    Parameter("left", axis, "stiffness", "N.m/rad", value, 1.0, (value - 2, value + 2), 0.1, "usable", "narrow")
    for axis, value in (("pitch", 434.0), ("roll", 323.0))
]  # fmt: skip
RESULT = FeetResult(
    "biped", (), {}, "kelvin_voigt", tuple(STIFFNESS), (),
    (Phase("sway", "left", 0.0, 4.0, "double", True, None), Phase("sway", "left", 4.0, 5.5, "double", False, "slips")),
    (), (),
    diagnosis=(Diagnosis("left", "pitch", "stiffness", "noise", {"noise": 1.0}, 0.5, "noise limits it"),),
    assumptions=(Assumption("wrench_gain", "force", 0.01, None, None, 2.0, 2.5),),
)  # fmt: skip


@pytest.fixture
def loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FeetResult, "load", lambda *_, **__: RESULT)


def printed(capsys: pytest.CaptureFixture[str]) -> Any:
    return json.loads(capsys.readouterr().out)


@pytest.mark.usefixtures("loaded")
def test_diagnose(capsys: pytest.CaptureFixture[str]) -> None:
    diagnose.run(Path("result.json"), json=True)
    said = printed(capsys)
    assert said["schema"] == "plantar.diagnosis/1"
    (row,), (allowed,), (served,) = said["diagnosis"], said["assumptions"], said["served"]
    assert (row["foot"], row["axis"], row["limit"], row["half_width_percent"]) == (
        "left",
        "pitch",
        "noise",
        0.5,
    )
    assert (allowed["name"], allowed["assumed"], allowed["stiffness_percent"]) == ("wrench_gain", 0.01, 2.0)
    assert served == {
        "motion": "sway",
        "foot": "left",
        "seconds": 5.5,
        "served": 4.0,
        "reasons": "slips (1.5 s)",
    }


@pytest.mark.usefixtures("loaded")
def test_show_reference(capsys: pytest.CaptureFixture[str]) -> None:
    show.run(None, json=True)
    alone = printed(capsys)["references"]
    show.run(Path("result.json"), json=True)
    beside = printed(capsys)["references"]
    (own,) = (row for row in beside if row["own"])
    assert (own["pitch"], own["roll"]) == (434.0, 323.0)
    assert [row for row in beside if not row["own"]] == alone


@pytest.mark.parametrize("compared", [True, False])
def test_select(compared: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    key = ("left", "pitch", "stiffness")
    one, two = (Choice(motions, {key: width}, 10.0) for motions, width in ((("a",), 2.0), (("a", "b"), 1.0)))
    found = Selection((one,), (one, two), two, one if compared else None)
    for name, value in {"load_robot": None, "open_together": [], "select_motions": found}.items():
        monkeypatch.setattr(select, name, lambda *_, _value=value, **__: _value)
    select.run(Path("robot.yaml"), [Path("a.csv")], json=True, quiet=True)
    said = printed(capsys)
    (width,) = said["together"]["half_width_percent"]
    assert width == {"foot": "left", "axis": "pitch", "name": "stiffness", "percent": 1.0}
    assert [row["motions"] for row in said["best"]] == [["a"], ["a", "b"]]
    assert said["alone"][0]["usual"] == one.usual
    assert (said["compared"] == said["alone"][0]) if compared else (said["compared"] is None)


@pytest.mark.usefixtures("loaded")
def test_compare(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    row = KindScore("squat", "joints", 0.003, 0.004, 2.5, 12.0, fell=None)
    for module, name, value in (
        (compare, "load_robot", None), (compare, "open_together", []), (comparison, "compare", ([row], [])),
    ):  # fmt: skip
        monkeypatch.setattr(module, name, lambda *_, _value=value, **__: _value)
    compare.run(Path("result.json"), Path("robot.yaml"), [Path("a.csv")], out=tmp_path, json=True, quiet=True)
    said = capsys.readouterr().out
    assert json.loads(said)["scores"][0]["chest_roll"] == 0.004
    assert (tmp_path / "comparison.json").read_text() == said


def test_demo(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    asked: list[Any] = []

    def run_campaign(*given: Any) -> SimpleNamespace:
        asked.extend(given[:4])
        return SimpleNamespace(result=RESULT)

    monkeypatch.setattr(campaign, "run_campaign", run_campaign)
    monkeypatch.setattr(present, "write_campaign_report", lambda *_: None)
    demo.run(tmp_path, preset="harsh", seed=3, quick=True, json=True, quiet=True)
    assert printed(capsys) == json.loads(json.dumps(RESULT.to_dict()))
    assert asked == [tmp_path, campaign.Course.quick(), "harsh", 3]
    demo.run(tmp_path, quiet=True)
    assert (asked[5], capsys.readouterr().out) == (None, "")


def test_too_little_memory_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def load(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr(FeetResult, "load", load)
    assert "not enough memory for these logs (valid: fewer or shorter" in refused(
        capsys, "diagnose", "result.json"
    )

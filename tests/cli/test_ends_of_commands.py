"""What commands print when their work is done: the work is made up, so that every number is known."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import plantar.campaign
from plantar.campaign import present, scene
from plantar.campaign import tables as campaign_tables
from plantar.cli import compare, demo, design, main, select
from plantar.comparison import compare as comparison
from plantar.design import paper_motions, story
from plantar.design.paper_motions import PaperMotions
from plantar.design.writing import outputs
from plantar.logs.readers import open_log
from plantar.motions.select_motions import Choice, Selection
from plantar.notes import Note
from plantar.report.content import Cell, Column, Table

KEYS = [("left", "pitch", "stiffness"), ("left", "pitch", "damping")]
WIDTHS = [("left", axis, term) for axis in ("pitch", "roll") for term in ("stiffness", "damping")]


def made_up(monkeypatch: pytest.MonkeyPatch, module: object, **values: object) -> None:
    for name, value in values.items():
        monkeypatch.setattr(module, name, lambda *_, _value=value, **__: _value)


def choice(motions: str, width: float) -> Choice:
    return Choice(tuple(motions), dict(zip(KEYS, (width, width), strict=True)), 10.0)


def test_select_names_the_smallest_set_that_is_nearly_as_good_as_the_largest(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Within a fifth of the widths of the largest."""
    best = (choice("a", 2.0), choice("ab", 1.25), choice("abc", 1.19), choice("abcd", 1.0))
    found = Selection((choice("a", 2.0),), best, choice("abcd", 1.0), None)
    made_up(monkeypatch, select, load_robot=None, open_together=[], select_motions=found)
    select.run(Path("robot.yaml"), [Path("a.csv")], quiet=True)
    assert capsys.readouterr().out.splitlines()[-1] == "3 logs give nearly all the information: a, b, c."
    alone = Selection((choice("a", 2.0),), (choice("a", 2.0),), choice("a", 2.0), None)
    made_up(monkeypatch, select, select_motions=alone)
    select.run(Path("robot.yaml"), [Path("a.csv")], quiet=True)
    assert capsys.readouterr().out.splitlines()[-1] == "1 log gives nearly all the information: a."


def test_compare_ends_with_the_chest_of_all_motions_and_with_falls(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [
        comparison.KindScore("squat", "joints", 0.003, 0.004, 2.5, 12.0, fell=None),
        comparison.KindScore("sway", "joints", 0.0, 0.0, 1.5, 12.0, fell=None),
        comparison.KindScore("squat", "rigid", None, None, None, 0.0, 1.5),
        comparison.KindScore("sway", "rigid", 0.01, 0.01, 9.0, 4.5, 5.5),
    ]
    made_up(monkeypatch, compare, load_robot=None, open_together=[])
    monkeypatch.setattr(compare.FeetResult, "load", lambda *_, **__: None)
    made_up(monkeypatch, comparison, compare=(rows, []))
    compare.run(Path("result.json"), Path("robot.yaml"), [Path("a.csv")], quiet=False)
    lines = capsys.readouterr().out.splitlines()
    assert "chest, all motions: joints 3.54 mrad, rigid -" in lines
    assert "squat: on 'rigid' the robot falls at 1.5 s, too early to compare" in lines
    assert "sway: on 'rigid' the robot falls at 5.5 s, all are compared up to 4.5 s" in lines
    assert not any("tips" in line for line in lines)
    assert next(line.split() for line in lines if line.startswith("squat")) == [
        "squat",
        "joints",
        "3.00",
        "4.00",
        "2.50",
    ]


def test_compare_says_from_when_on_a_sole_tips_and_what_held_before(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    rows = [
        comparison.KindScore("sway", "joints", 0.003, 0.004, 2.5, 12.0, None, 7.25, 0.001),
        comparison.KindScore("squat", "joints", 0.003, 0.004, 2.5, 12.0, None, None, 0.001),
    ]
    made_up(monkeypatch, compare, load_robot=None, open_together=[])
    monkeypatch.setattr(compare.FeetResult, "load", lambda *_, **__: None)
    made_up(monkeypatch, comparison, compare=(rows, []))
    compare.run(Path("result.json"), Path("robot.yaml"), [Path("a.csv")], quiet=False)
    printed = capsys.readouterr().out
    assert "\x1b[33msway: from" in printed, "a warning is yellow"
    assert "chest, all motions: joints 5.00 mrad" in printed
    assert "chest, until a sole tips: joints 1.00 mrad" in printed
    assert "sway: from 7.2 s on a sole of the record stands on its edge" in printed
    assert "squat: from" not in printed


def test_design_prints_widths_and_rehearsals_in_their_units(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    at = [{"factor": 0.5, "half_width_percent": 2.5}, {"factor": 2.0, "half_width_percent": None}]
    content: dict[str, Any] = {
        "parameters": [
            {"foot": "left", "axis": "pitch", "name": "stiffness", "half_width_percent": 1.25, "at": at}
        ],
        "rehearsals": [
            {
                "factor": factor,
                "sole_margin": 0.0075,
                "least_load": 0.45,
                "friction": 0.12,
                "effort": 0.66,
                "bend": 0.034,
            }
            for factor in (0.5, 2.0)
        ],
        "notes": ["roll is not found"],
    }
    found = SimpleNamespace(
        robot=None,
        trajectory=SimpleNamespace(plan=lambda: None),
        nominal=SimpleNamespace(bushes=None),
    )
    made_up(monkeypatch, design, load_robot=None)
    made_up(monkeypatch, outputs, check_outputs=None, write_design=content)
    made_up(monkeypatch, story, design_motion=found)
    made_up(monkeypatch, scene, write_plan_scene=None)
    design.run(Path("robot.yaml"), tmp_path / "motion.csv", stiffness=500.0, quiet=True)
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["foot", "axis", "parameter", "predicted", "x0.5", "x2"] in lines
    assert ["left", "pitch", "stiffness", "1.25", "2.50", "–"] in lines
    heads = "stiffness margin on the soles [mm] least load [%] friction torque [% of limit] bend [rad]"
    assert heads.split() in lines
    assert ["x0.5", "7.50", "45.0", "0.12", "66.0", "0.034"] in lines
    assert ["note", "(warning):", "roll", "is", "not", "found"] in lines


@pytest.mark.parametrize("as_json", [False, True])
def test_design_like_the_paper_tells_the_best_motion_beside_the_best_set(
    as_json: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    best = SimpleNamespace(name="Tilt2", time=np.arange(3.0), positions=np.zeros((3, 1)), joints=("hip",))
    sets = [Choice(motions, dict.fromkeys(WIDTHS, width), 10.0) for motions, width in (
        (("Tilt2",), 2.5), (("Squat", "Tilt2"), 1.25)
    )]  # fmt: skip
    found = PaperMotions(Selection((sets[0],), tuple(sets), sets[1], None), {"Sweep": "it falls"}, best)  # type: ignore[arg-type]
    made_up(monkeypatch, design, load_robot=SimpleNamespace(name="biped", mass=100.0))
    made_up(monkeypatch, outputs, check_outputs=None)
    made_up(monkeypatch, paper_motions, paper_motions=found)
    out = tmp_path / "motion.csv"
    design.run(Path("robot.yaml"), out, stiffness=500.0, like="campaign", json=as_json, quiet=True)
    content, printed = json.loads(out.with_suffix(".json").read_text()), capsys.readouterr().out
    assert (content["best"], content["best_set"], content["refused"]) == (
        "Tilt2", ["Squat", "Tilt2"], {"Sweep": "it falls"},
    )  # fmt: skip
    assert (content["like"], content["robot"], content["motion"]) == ("campaign", "biped", "motion.csv")
    assert open_log(out).columns["joint.hip.position"].size == 2 * 200 + 1
    if as_json:
        assert json.loads(printed) == content
        return
    lines = [line.split() for line in printed.splitlines()]
    assert ["foot", "axis", "parameter", "Tilt2", "best", "set"] in lines
    assert ["left", "pitch", "stiffness", "2.5", "1.25"] in lines
    assert "The best set: Squat, Tilt2." in printed


def test_the_demo_prints_its_tables_one_by_one_and_warnings_in_yellow(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """A row has the colour of its first cell that is weak or bad."""
    rows = [
        (Cell("left", "good"), Cell("2.0", "weak"), Cell("9", "bad")),
        (Cell("right"), Cell("1.0", "good"), Cell("8", "bad")), (Cell("both"), Cell("3.0", "good"), "7"),
    ]  # fmt: skip
    made = Table.of("Table [b]", [Column("foot"), Column("error", "N·m"), Column("seen")], rows)
    notes = (Note("a", "info", "told elsewhere"), Note("b", "warning", "late [b] by 3 ms"))
    campaign = SimpleNamespace(result=SimpleNamespace(notes=notes))
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "200")
    made_up(monkeypatch, plantar.campaign, run_campaign=campaign)
    made_up(monkeypatch, present, write_campaign_report=SimpleNamespace(report="R [b]", scene="S"))
    made_up(monkeypatch, campaign_tables, tables=(made, made))
    demo.run(tmp_path, quiet=False)
    printed = capsys.readouterr().out
    lines = printed.splitlines()
    assert [line.split() for line in lines].count([]) == 2, "between tables and in front of the files"
    assert "error [N·m]" in printed
    colours = [("left", "33"), ("right", "31"), ("both", None)]
    for name, colour in colours:
        (line, _) = (line for line in lines if name in line)
        assert line.startswith(f"\x1b[{colour}m") if colour else "\x1b[3" not in line
    assert "\x1b[33mnote: late [b] by 3 ms" in printed
    assert "told elsewhere" not in printed
    assert lines[-4:] == [str(tmp_path / "result.json"), "R [b]", "S", str(tmp_path / "figures")]


@pytest.mark.parametrize("quiet", [True, False])
def test_a_quiet_demo_says_nothing_of_its_progress(
    quiet: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def played(*given: object) -> object:
        step = given[-1]
        step("play 2 motions on the twin: 5 %")  # type: ignore[operator]
        step("fit z")  # type: ignore[operator]
        return SimpleNamespace(result=SimpleNamespace(notes=()))

    monkeypatch.setattr(plantar.campaign, "run_campaign", played)
    made_up(monkeypatch, present, write_campaign_report=SimpleNamespace(report="R", scene="S"))
    made_up(monkeypatch, campaign_tables, tables=())
    demo.run(tmp_path, quiet=quiet)
    said = capsys.readouterr()
    assert ("play 2 motions" in said.err) is not quiet
    assert "fit z" not in said.err, "it takes no time"
    assert (said.out == "") is quiet


def test_a_command_that_is_interrupted_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def run() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("plantar.cli.show.run", run)
    with pytest.raises(SystemExit) as ended:
        main(["show", "reference"])
    assert ended.value.code == 130
    assert capsys.readouterr().err == "plantar: interrupted\n"


def test_a_reader_that_goes_away_ends_the_command_in_silence(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def run() -> None:
        raise BrokenPipeError

    monkeypatch.setattr("plantar.cli.show.run", run)
    turned: list[int] = []
    monkeypatch.setattr("os.dup2", lambda _, to: turned.append(to))
    with pytest.raises(SystemExit) as ended:
        main(["show", "reference"])
    assert (ended.value.code, len(turned)) == (1, 1)
    assert capfd.readouterr() == ("", "")

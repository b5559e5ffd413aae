"""Usage, refusals, progress and last lines of commands, word by word, as they are kept: their work is made up."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped_robot import write_robot
from command_line import run
from kept_texts import assert_as_kept
from plantar.cli import COMMANDS, GROUPS, compare
from plantar.cli.console.options import size_in_bytes
from plantar.cli.fleet import run as fleet_run
from plantar.comparison import compare as comparison
from plantar.fleet.run import Outcome, Progress
from plantar.fleet.tables import Written
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log

KEPT = Path(__file__).parent / "kept"
STILL = "time,joint.knee.position\n0,0.5\n0.01,0.5\n0.02,0.5\n"
Said = Callable[..., str]


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Said:
    """What a command writes to both streams, stderr being a terminal, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setenv("NO_COLOR", "1")

    def said(*words: object) -> str:
        monkeypatch.setattr("sys.stderr.isatty", lambda: True)
        capsys.readouterr()
        code = run(*words)
        out, err = capsys.readouterr()
        shown = err.replace("\r\033[K", "\n<cleared>")
        return f"$ {' '.join(map(str, words))}\n{code}\n{out}\n{shown}\n".replace(str(tmp_path), "FOLDER")

    return said


def test_usage_and_lists_of_commands(said: Said) -> None:
    """Of each command what it takes; of a group and of plantar itself the whole help."""
    groups = [said(*words, "--help") for words in ([], *([group] for group in GROUPS))]
    usages = [said(*verb.split(), "--help").split("\n\n")[0] for verb in COMMANDS]
    assert_as_kept("\n".join([*groups, *usages]), KEPT / "usage.txt")


def test_refusals(said: Said, tmp_path: Path) -> None:
    robot = write_robot(tmp_path).name
    for name in ("a.csv", "b.csv", "other/a.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(STILL)
    asked = [
        ("convert", "a.csv", "b.csv", "--out", "all.csv"), ("convert", "a.csv", "b.csv", "--out", "a.csv"),
        ("convert", "a.csv", "--out", "all.xls"), ("convert", "a.csv", "b.csv", "--out", "all", "--to", "xls"),
        ("convert", "a.csv", "other/a.csv", "--out", "all"),
        ("design", robot, "--out", "m.txt", "--stiffness", 500), ("design", robot, "--out", "m.csv"),
        ("design", robot, "--out", "m.csv", "--stiffness", 500, "--like", "walk"),
        ("compare", "r.json", robot, "a.csv", "--simulator", "bullet"),
        ("simulate", "Squat", "--out", "twin", "--sway", 10), ("simulate", "Squat", "--out", "twin", "--bush", "1,2"),
        ("simulate", "Squat", "--out", "twin", "--robot", robot),
        ("online", robot, "a.csv", "--plot", "a.gif"),
        ("fleet", "plan", "a.csv", "--robot", robot, "--unit", "(a", "-q"),
        ("fleet", "plan", "a.csv", "--robot", robot, "--unit", "(a)(b)", "-q"),
        ("fleet", "plan", "a.csv", "--robot", robot, "--unit", "x(y)", "-q"),
        ("fleet", "plan", "none*.csv", "--robot", robot, "-q"),
        ("fleet", "run", "m.csv", "--out", "x", "--workers", 2, "--scheduler", "tcp://here:1"),
        ("select", robot, "a.csv", "--memory", "0.4"), ("select", robot, "a.csv", "--wrench-delay", "x"),
        ("online", robot, "a.csv", "--wrench-delay", "fast"), ("init", "none.urdf", "--out", robot),
    ]  # fmt: skip
    assert_as_kept("".join(said(*words) for words in asked), KEPT / "refusals.txt")


def test_the_smallest_size_is_one_byte() -> None:
    assert [size_in_bytes(text) for text in ("1", "1.5 kB", " 2 mb", "3G", "1T")] == [
        1, 1500, 2_000_000, 3 * 10**9, 10**12,
    ]  # fmt: skip


def test_a_comparison(said: Said, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Errors and falls of made-up replays, as a table, in a folder and for scripts."""
    robot = write_robot(tmp_path).name
    rows = [
        comparison.KindScore("squat", "joints", 0.003, 0.004, 2.5, 12.0, None, 7.25, 0.001),
        comparison.KindScore("squat", "contact", 0.0021, 0.005, 3.5, 12.0, None, 7.25, 0.0015),
        comparison.KindScore("squat", "rigid", None, None, None, 0.0, 1.5, 7.25),
        comparison.KindScore("sway", "rigid", 0.01, 0.02, 9.0, 4.5, 5.5),
    ]

    def compared(*given: Any) -> tuple[list[comparison.KindScore], list[object]]:
        given[3]("replay squat")
        return rows, []

    monkeypatch.setattr(compare, "open_together", lambda *_: [])
    monkeypatch.setattr(compare.FeetResult, "load", lambda *_, **__: None)
    monkeypatch.setattr(comparison, "compare", compared)
    words = ("compare", "r.json", robot, "a.csv")
    text = said(*words, "--out", "compared") + said(*words, "--json") + said(*words, "--quiet")
    assert_as_kept(text, KEPT / "compare.txt")
    assert [path.name for path in (tmp_path / "compared").iterdir()] == ["comparison.json"]
    written = (tmp_path / "compared" / "comparison.json").read_text()
    assert written in text
    assert [row["feet"] for row in json.loads(written)["scores"]] == ["joints", "contact", "rigid", "rigid"]


def test_a_plan_of_a_fleet(said: Said, tmp_path: Path) -> None:
    robot = write_robot(tmp_path).name
    for name in ("ada_2026-03-01.csv", "bob_2026-03-01.csv", "bob_2026-03-02.csv"):
        (tmp_path / name).write_text(STILL)
    words = ("fleet", "plan", "*_2026*.csv", "--robot", robot)
    text = (
        said(*words, "--unit", "/([a-z]+)_2026")
        + said(*words, "--unit", "r2", "--out", "m.csv", "-q")
        + said(*words)
    )
    text += (tmp_path / "m.csv").read_text().replace(str(tmp_path), "FOLDER")
    assert_as_kept(text, KEPT / "plan.txt")


def test_a_fleets_run(said: Said, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    class Connected:
        def __init__(self, *_: object) -> None: ...
        def __enter__(self) -> str:
            return "client"

        def __exit__(self, *_: object) -> None: ...

    def over(*given: Any) -> Outcome:
        given[4](Progress(9, 2, 3, 1, 100.0))
        given[4](Progress(9, 2, 6, 1, None))
        return Outcome(9, 2, 6, Written(7, 1, 4), 12.5, 20.0)

    monkeypatch.setattr(fleet_run, "read_manifest", lambda _: [None] * 9)
    monkeypatch.setattr(fleet_run, "connected", Connected)
    monkeypatch.setattr(fleet_run, "dashboard", lambda _: "http://here:8787")
    monkeypatch.setattr(fleet_run, "run_fleet", over)
    monkeypatch.setattr(fleet_run, "write_report", lambda _: SimpleNamespace(alarms=(), failures=()))
    words = ("fleet", "run", "m.csv", "--out", tmp_path / "out")
    text = said(*words) + said(*words, "--json", "-q") + said(*words, "-q")
    assert_as_kept(text, KEPT / "fleet_run.txt")
    written = json.loads((tmp_path / "out" / "run.json").read_text())
    assert written["written"] == {"finished": 7, "failed": 1, "failures": 4}
    assert (written["groups"], written["reused"], written["done"]) == (9, 2, 6)


def test_a_conversion_says_what_was_assumed(said: Said, tmp_path: Path) -> None:
    time = np.arange(50) / 100
    log = MotionLog("walk", time, {f"joint.{name}.position": np.sin(time) for name in ("hip", "knee")})
    for name in ("walk", "run"):
        save_log(log, tmp_path / f"{name}.csv")
    text = said("convert", "walk.csv", "run.csv", "--out", "bags", "--to", "mcap")
    text += said("convert", "walk.csv", "--out", "walk.MCAP", "-q") + said(
        "convert", "walk.csv", "--out", "v1.2"
    )
    assert_as_kept(text, KEPT / "converted.txt")

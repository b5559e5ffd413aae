"""What commands print, as it is kept: one after the other on the same logs, every table, note and last line."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

import pytest

import small_biped
from biped import record, sway
from biped_robot import URDF, write_robot
from command_line import run, write_csv
from feet_trials import noisy, stepping
from kept_texts import assert_as_kept

KEPT = Path(__file__).parent / "kept"
OUT = "out [b]"  # no markup
FEET = ["ROBOT", "sway.csv", "bow.csv", "--validate", "walk.csv"]
COMMANDS: dict[str, Sequence[str]] = {
    "inspect": ["inspect", "ROBOT", "sway.csv", "walk.csv", "--columns"],
    "feet": ["identify", "feet", *FEET, "--out", OUT],
    "feet of one offset": ["identify", "feet", *FEET, "--offset", "shared", "--wrench-delay", "0", "--out", "shared"],
    "validate": ["validate", OUT, "ROBOT", "bow.csv", "walk.csv"],
    "diagnose": ["diagnose", OUT],
    "diagnose for scripts": ["diagnose", OUT, "--json"],
    "select": ["select", "ROBOT", "sway.csv", "bow.csv"],
    "show": ["show", "reference", OUT],
    "online": ["online", "ROBOT", "sway.csv", "--result", OUT],
    "online alone": ["online", "ROBOT", "walk.csv", "--wrench-delay", "0", "--cutoff", "3"],
    "export": ["export", OUT, "--to", "urdf", "--out", "robot.urdf"],
    "export yaml": ["export", OUT, "--to", "yaml", "--out", "feet.yaml"],
    "report": ["report", OUT],
    "convert": ["convert", "sway.csv", "--out", "sway.parquet"],
    "init": ["init", "biped.urdf", "sway.csv", "--out", "guess.yaml"],
    "inertia": ["identify", "inertia", "moving/biped.yaml", "moving/one.csv", "--validate", "moving/two.csv", "--out",
                "inertia"],
}  # fmt: skip
# Its terms of which the logs say nothing are zero but for rounding.
JOINTS = [
    "identify",
    "joints",
    "moving/biped.yaml",
    "moving/short.csv",
    "--inertia",
    "known",
    "--out",
    "joints",
]
READING = {**COMMANDS, "joints": JOINTS}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("kept")
    write_robot(folder, uncertainty={})
    (folder / "biped.urdf").write_text(URDF)
    logs = [sway("sway", 1), sway("bow", 2), sway("walk", 3)]
    made = [noisy(record(one), seed) for seed, one in enumerate(logs)]
    for log in (*made[:2], stepping(made[2])):
        write_csv(log, folder / f"{log.name}.csv")
    (folder / "moving").mkdir()
    robot = small_biped.robot(folder / "moving")
    real = small_biped.truth(robot.floating_model, 1)
    for seed, (name, seconds) in enumerate((("one", 20.0), ("two", 20.0), ("short", 4.0))):
        write_csv(
            small_biped.record(robot, real, name, seed, seconds, 0.5), folder / "moving" / f"{name}.csv"
        )
    return folder


def test_commands_print_what_is_kept(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, words in COMMANDS.items():
        code = run(*(word.replace("ROBOT", "robot.yaml") for word in words))
        said = capsys.readouterr()
        text = f"{code}\n{said.out}\n{said.err}".replace(str(folder), "FOLDER")
        text = re.sub(r"[\d.]+ µs", "0 µs", re.sub(r"[─━]+|\x1b\[0m", "", text))
        text = re.sub(r"\x1b\[([\d;]+)m", r"<\1>", text)
        text = re.sub(r"(<[\d;]+>)(.*)", lambda line: line[1] + line[2].replace(line[1], ""), text)
        assert_as_kept(text, KEPT / f"{name.replace(' ', '_')}.txt", share=1e-3)


def test_every_command_that_reads_logs_hears_how_much_memory_they_may_take(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    for name in ("inspect", "feet", "select", "online alone", "convert", "inertia", "joints"):
        words = [word.replace("ROBOT", "robot.yaml") for word in READING[name]]
        assert run(*words, "--memory", "100KB") == 1, name
        assert "memory" in capsys.readouterr().err, name
    assert run("bug-report", "robot.yaml", "sway.csv", "--memory", "100KB") == 0
    assert "is refused" in capsys.readouterr().out


def test_what_is_printed_for_scripts_is_json_alone(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    for name in (
        "inspect",
        "feet",
        "validate",
        "diagnose",
        "select",
        "show",
        "online alone",
        "inertia",
        "joints",
    ):
        assert run(*(word.replace("ROBOT", "robot.yaml") for word in READING[name]), "--json") == 0, name
        text = capsys.readouterr().out
        assert isinstance(json.loads(text), dict), name
        assert text.count("\n\n") == 0, name


def test_joints_name_their_files_unless_they_are_quiet(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    assert run(*JOINTS) == 0
    names = ("result.json", "identified.urdf", "report.html")
    assert capsys.readouterr().out.split()[-3:] == [f"joints/{name}" for name in names]
    assert run(*JOINTS, "--quiet") == 0
    assert capsys.readouterr() == ("", "")

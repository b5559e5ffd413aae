"""The commands on good logs: what they write, print and take as settings."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from command_line import identifying_first, refused, run, write_csv


def test_identify_feet_writes_results_and_tables(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    logs = [campaign / "first.csv", campaign / "second.csv", "--validate", campaign / "third.csv"]
    assert run("identify", "feet", campaign / "robot.yaml", *logs, "--out", out) == 0
    captured = capsys.readouterr()
    assert {path.name for path in out.iterdir()} == {"result.json", "residuals.parquet", "report.html"}
    content = json.loads((out / "result.json").read_text())
    assert [row["role"] for row in content["inputs"]] == ["fit", "fit", "validate"]
    assert all(len(row["sha256"]) == 64 for row in content["inputs"])
    for part in ("Table 1", "Table 2", "Table 3", "stiffness", "usable", str(out / "result.json")):
        assert part in captured.out
    assert "prepare first" in captured.err, "progress goes to stderr"
    assert "prepare" not in captured.out


def test_json_and_quiet(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = identifying_first(campaign, tmp_path / "out")
    assert run(*arguments, "--json", "--quiet") == 0
    captured = capsys.readouterr()
    assert json.loads(captured.out) == json.loads((tmp_path / "out" / "result.json").read_text())
    assert captured.err == ""
    assert run(*arguments, "--quiet") == 0
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", "")


def test_several_logs_after_one_validate(campaign: Path, tmp_path: Path) -> None:
    logs = [campaign / f"{name}.csv" for name in ("first", "second", "third")]
    assert (
        run(
            "identify",
            "feet",
            campaign / "robot.yaml",
            logs[0],
            "--validate",
            *logs[1:],
            "-q",
            "--out",
            tmp_path,
        )
        == 0
    )
    content = json.loads((tmp_path / "result.json").read_text())
    assert [row["role"] for row in content["inputs"]] == ["fit", "validate", "validate"]


def test_shared_offset_and_window_are_settings(campaign: Path, tmp_path: Path) -> None:
    options = ["--offset", "shared", "--window", "2", "--cutoff", "4", "-q", "--out", tmp_path]
    assert run("identify", "feet", campaign / "robot.yaml", campaign / "first.csv", *options) == 0
    settings = json.loads((tmp_path / "result.json").read_text())["settings"]
    assert settings["offset"] == "shared"
    assert settings["cutoff"] == 4.0
    assert settings["window"] == pytest.approx(np.radians(2))


def test_inspect(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("inspect", campaign / "robot.yaml", campaign / "first.csv", "--columns") == 0
    out = capsys.readouterr().out
    for part in ("first", "12.0 s", "100 Hz", "the feet carry", "wrench.left.force.z", "usable"):
        assert part in out
    assert run("inspect", campaign / "robot.yaml", campaign / "first.csv", "--json") == 0
    assert json.loads(capsys.readouterr().out)["logs"][0]["name"] == "first"


def test_inspect_shows_the_logs_beside_those_that_cannot_be_read(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cut, empty = tmp_path / "cut.csv", tmp_path / "empty.csv"
    cut.write_text("time,joint.a.position\n0,1\n0.1,x\n")
    empty.touch()
    assert run("inspect", campaign / "robot.yaml", cut, campaign / "first.csv", empty, "--json") == 1
    out, error = capsys.readouterr()
    assert [log["name"] for log in json.loads(out)["logs"]] == ["first"]
    assert "cut.csv" in error
    assert "empty.csv: is empty" in " ".join(error.split())


def test_inspect_says_1_where_a_log_cannot_serve(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = record(sway("bad", duration=8.0))
    names = [name for name in log.columns if name.startswith("wrench")]
    bad = write_csv(log.with_columns({name: -log.column(name) for name in names}), tmp_path / "bad.csv")
    assert run("inspect", campaign / "robot.yaml", bad) == 1
    assert "problem" in capsys.readouterr().out


def test_validate(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = campaign / "robot.yaml"
    assert run("identify", "feet", robot, campaign / "first.csv", "--out", tmp_path, "-q") == 0
    assert run("validate", tmp_path / "result.json", robot, campaign / "third.csv") == 0
    assert "Table 3" in capsys.readouterr().out
    words = ("validate", tmp_path / "result.json", robot, campaign / "third.csv", "-q")
    assert "more with --memory" in refused(capsys, *words, "--memory", "1kB")
    assert run("validate", tmp_path / "result.json", robot, campaign / "third.csv", "--json", "-q") == 0
    rows = json.loads(capsys.readouterr().out)["validation"]
    assert {(row["foot"], row["axis"]) for row in rows} >= {
        (f, a) for f in ("left", "right") for a in ("pitch", "roll")
    }
    assert all(row["kind"] == "cross" for row in rows)

"""The commands on bad files and words: one line for known errors, the exit code, and nothing left behind."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from pathlib import Path
from unittest import mock

import pytest
from typer import BadParameter

from command_line import identifying_first, refused, run
from plantar.cli.console.options import seconds


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "is empty"),
        ("time,joint.a.position\n0,1\n0,2\n0,3\n", "does not increase"),
        ("time,joint.a.position\n0,1\n0.1,2\n0.2,3\n", "joint_names"),
        ("time,joint.a.position\n0,1\n0.1,x\n", "value 'x'"),
        ("stamp,joint.a.position\n0,1\n0.1,2\n", "`columns` in the robot file"),
    ],
)
def test_bad_logs_are_one_line_and_leave_nothing(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, expected: str
) -> None:
    bad = tmp_path / "bad.csv"
    bad.write_text(text)
    out = tmp_path / "out"
    line = refused(
        capsys, "identify", "feet", campaign / "robot.yaml", campaign / "first.csv", bad, "--out", out
    )
    assert "bad.csv" in line
    assert expected in line
    assert not out.exists()


@pytest.mark.parametrize(
    "verb", ["inspect", "identify feet", "identify inertia", "identify joints", "select"]
)
def test_logs_keep_to_the_memory_given(
    verb: str, campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = ("--out", tmp_path / "out") if verb.startswith("identify") else ()
    words = (*verb.split(), campaign / "robot.yaml", campaign / "first.csv", *out, "--memory")
    message = refused(capsys, *words, "0.1 mb", *(() if verb.startswith("identify") else ("--quiet",)))
    assert "first.csv: holds 1201 rows x " in message
    assert "at most 100 kB, or more with --memory" in message
    assert not (tmp_path / "out").exists()
    assert run(*words, "much") == 2


def test_convert_keeps_to_the_memory_given(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("convert", campaign / "first.csv", "--out", tmp_path / "log.parquet", "--memory")
    assert "at most 1 kB" in refused(capsys, *words, "1KB")
    assert run(*words, "1GB") == 0


def test_an_error_leaves_an_earlier_result_untouched(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["identify", "feet", campaign / "robot.yaml", campaign / "first.csv", "--out", tmp_path, "-q"]
    assert run(*arguments) == 0
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    refused(capsys, *arguments, campaign / "nowhere.csv")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_bad_robot_files_and_places(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = tmp_path / "robot.yaml"
    robot.write_text((campaign / "robot.yaml").read_text() + "colour: red\n")
    log = campaign / "first.csv"
    assert "unknown key 'colour'" in refused(capsys, "inspect", robot, log)
    assert "No such file" in refused(capsys, "inspect", tmp_path / "none.yaml", log)
    assert "does not exist" in refused(
        capsys, "inspect", campaign / "robot.yaml", tmp_path / "none.csv", "-q"
    )
    assert "is a file" in refused(capsys, "identify", "feet", campaign / "robot.yaml", log, "--out", robot)
    assert "is a file" in refused(capsys, "simulate", "Tilt3", "--out", robot)
    twice = ["identify", "feet", campaign / "robot.yaml", log, log, "--out", tmp_path / "out"]
    assert "first.csv is given twice" in refused(capsys, *twice)
    assert "given twice" in refused(capsys, *twice[:4], "--validate", log, *twice[-2:])
    assert "another kind of result" in refused(
        capsys, "validate", write_json(tmp_path, {"schema": "x"}), campaign / "robot.yaml", log
    )


def write_json(folder: Path, content: object) -> Path:
    path = folder / "content.json"
    path.write_text(json.dumps(content))
    return path


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["identify"],
        ["identify", "hands"],
        ["identify", "feet"],
        ["identify", "feet", "robot.yaml", "log.csv"],
        ["identify", "feet", "robot.yaml", "log.csv", "--out", "x", "--offset", "none"],
        ["identify", "feet", "robot.yaml", "log.csv", "--out", "x", "--model", "x"],
        ["identify", "feet", "robot.yaml", "log.csv", "--out", "x", "--cutoff", "fast"],
        ["identify", "feet", "robot.yaml", "log.csv", "--out", "x", "--cutof", "5"],
        ["fleet", "run", "m.csv", "--out", "x", "--model", "x"],
        ["fleet", "run", "m.csv", "--out", "x", "--workers", "2", "--scheduler", "tcp://here:1"],
        ["inspect"],
        ["--unknown"],
    ],
)
def test_wrong_usage_is_2(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(*arguments) == 2
    captured = capsys.readouterr()
    assert "Traceback" not in captured.err + captured.out


def test_a_setting_out_of_its_range_is_one_line(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = identifying_first(campaign, tmp_path / "out")
    assert "wrench_delay is not valid" in refused(capsys, *arguments, "--wrench-delay", "5000")
    assert "window is not valid" in refused(capsys, *arguments, "--window", "400")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("verb", ["identify feet", "online", "fleet run"])
def test_a_delay_in_seconds_is_not_taken_for_milliseconds(
    verb: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = {"fleet run": ["m.csv", "--out", "x"], "online": ["r.yaml", "l.csv"]}
    given = [*verb.split(), *words.get(verb, ["r.yaml", "l.csv", "--out", "x"]), "--wrench-delay", "0.0075"]
    assert run(*given) == 2
    said = " ".join(capsys.readouterr().err.replace("│", " ").split())
    assert "the unit is ms (valid: 7.5 for 0.0075 s" in said


@pytest.mark.parametrize(
    "word", ["inspect {robot} {long}.csv", "inspect {long}.yaml {log}", "init {long}.urdf"]
)
def test_a_name_that_is_too_long_for_the_system_is_one_line(
    campaign: Path, capsys: pytest.CaptureFixture[str], word: str
) -> None:
    places = {"robot": campaign / "robot.yaml", "log": campaign / "first.csv", "long": "x" * 300}
    assert "x" * 300 in refused(capsys, *word.format(**places).split())


def test_what_the_system_refuses_is_one_line(
    campaign: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "/tmp/kept")
    monkeypatch.setattr("plantar.cli.inspect.load_robot", mock.Mock(side_effect=full))
    line = refused(capsys, "inspect", campaign / "robot.yaml", campaign / "first.csv")
    assert line == "plantar: /tmp/kept: No space left on device"


def test_no_traceback_in_a_real_process(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "plantar", "inspect", str(tmp_path / "none.yaml"), "none.csv"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert "none.yaml" in done.stderr


@pytest.mark.parametrize("text", ["0.099", "-0.099", "5 ms", ""])
def test_what_no_delay_in_milliseconds_can_be_is_refused(text: str) -> None:
    with pytest.raises(BadParameter, match=r"ms is no delay|is not a number of milliseconds"):
        seconds(text)
    assert [seconds(said) for said in ("0", "0.1", "-0.1", "7.5")] == [0.0, 1e-4, -1e-4, 7.5e-3]

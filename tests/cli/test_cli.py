"""The command line: exit codes, one line for known errors, tables, JSON, and a light start."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import get_type_hints

import numpy as np
import pytest
from rich.markup import render

from biped import record, sway
from biped_robot import write_robot
from plantar import __version__
from plantar.cli import COMMANDS, main
from plantar.cli.terminal import console, table
from plantar.logs.motion_log import MotionLog


def write_csv(log: MotionLog, path: Path) -> Path:
    header = ",".join(["time", *log.columns])
    np.savetxt(
        path,
        np.column_stack([log.time, *log.columns.values()]),
        delimiter=",",
        header=header,
        comments="",
        fmt="%.10g",
    )
    return path


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the biped's robot file and three logs."""
    folder = tmp_path_factory.mktemp("campaign")
    write_robot(folder)
    for seed, name in enumerate(("first", "second", "third")):
        write_csv(record(sway(name, seed, duration=12.0)), folder / f"{name}.csv")
    return folder


def run(*arguments: object) -> int:
    """The exit code of `plantar ARGUMENTS`."""
    try:
        main([str(argument) for argument in arguments])
    except SystemExit as done:
        return 0 if done.code is None else int(done.code)
    return 0


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """The one line on stderr with which a command fails."""
    assert run(*arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    lines = [line for line in captured.err.splitlines() if not line.startswith("  ")]
    assert len(lines) == 1, captured.err
    assert lines[0].startswith("plantar: ")
    return lines[0]


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
    arguments = [
        "identify",
        "feet",
        campaign / "robot.yaml",
        campaign / "first.csv",
        "--out",
        tmp_path / "out",
    ]
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


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "is empty"),
        ("time,joint.a.position\n0,1\n0,2\n0,3\n", "does not increase"),
        ("time,joint.a.position\n0,1\n0.1,2\n0.2,3\n", "joint_names"),
        ("time,joint.a.position\n0,1\n0.1,x\n", "value 'x'"),
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
    assert "two logs are called 'first'" in refused(capsys, *twice)
    assert "not such a result" in refused(
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
    arguments = [
        "identify",
        "feet",
        campaign / "robot.yaml",
        campaign / "first.csv",
        "--out",
        tmp_path / "out",
    ]
    assert "wrench_delay is not valid" in refused(capsys, *arguments, "--wrench-delay", "5000")
    assert "window is not valid" in refused(capsys, *arguments, "--window", "400")
    assert not (tmp_path / "out").exists()


def test_units_in_brackets_are_text_not_markup(capsys: pytest.CaptureFixture[str]) -> None:
    console().print(table("Sway [deg]", ("mass [kg]", "of"), [("3", "[red]")]))
    shown = capsys.readouterr().out
    for text in ("Sway [deg]", "mass [kg]", "[red]"):
        assert text in shown


def test_numbers_stand_to_the_right_and_sentences_to_the_left() -> None:
    drawn = table("", ("value", "why"), [("4.1 ± 0.5", "95 % interval ±1 %, 44 s served"), ("1e+05", "")])
    assert [column.justify for column in drawn.columns] == ["right", "left"]


@pytest.mark.parametrize("verb", COMMANDS)
def test_no_help_loses_a_unit_to_markup(verb: str) -> None:
    """`[ms]` in a help text is a tag to the one who prints it, and vanishes."""
    run = import_module(f"plantar.cli.{COMMANDS[verb][0]}").run
    annotations = get_type_hints(run, include_extras=True).values()
    options = [option for annotation in annotations for option in getattr(annotation, "__metadata__", ())]
    assert all(render(option.help or "").plain == option.help for option in options)


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--version") == 0
    assert capsys.readouterr().out.strip() == __version__


def python(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout


HEAVY = (
    "numpy",
    "scipy",
    "pinocchio",
    "pyarrow",
    "mujoco",
    "matplotlib",
    "rosbags",
    "viser",
    "clarabel",
    "pink",
    "pydantic",
    "jinja2",
)


def test_help_lists_every_command_and_imports_nothing_heavy() -> None:
    code = f"""
import sys
from plantar.cli import main
try:
    main(["--help"])
except SystemExit as done:
    assert not done.code
print("HEAVY:", [name for name in {HEAVY!r} if name in sys.modules])
"""
    out = python(code)
    for verb in COMMANDS:
        assert verb.split()[0] in out
    assert "HEAVY: []" in out


def test_importing_plantar_imports_nothing_heavy() -> None:
    out = python(f"import sys, plantar; print([name for name in {HEAVY!r} if name in sys.modules])")
    assert out.strip() == "[]"


def test_no_traceback_in_a_real_process(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "plantar", "inspect", str(tmp_path / "none.yaml"), "none.csv"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert "none.yaml" in done.stderr


def test_public_names() -> None:
    import plantar

    for name in plantar.__all__:
        if name not in ("dynamics", "identify_inertia", "identify_joints"):
            assert getattr(plantar, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = plantar.nonsense

"""The command line itself: help, version, tables, and a light start."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import get_type_hints

import numpy as np
import pytest
from rich.markup import render

from command_line import run, write_csv
from kept_texts import assert_as_kept
from plantar import __version__
from plantar.cli import COMMANDS
from plantar.cli.console.terminal import console, table
from plantar.cli.identify.feet_tables import advised
from plantar.logs.readers import open_log
from plantar.results.feet import Parameter
from plantar.robot.model import load_robot


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


def test_options_and_their_defaults_are_as_they_are_kept() -> None:
    """Of each command: in which order, under what name, between what limits, and what holds where nothing is told."""
    lines = []
    for verb, (module, text) in COMMANDS.items():
        run = import_module(f"plantar.cli.{module}").run
        lines.append(f"{verb}: {text}")
        hints = get_type_hints(run, include_extras=True)
        for name, one in inspect.signature(run).parameters.items():
            told = "needed" if one.default is one.empty else repr(one.default).removeprefix("Posix")
            options = getattr(hints[name], "__metadata__", ())
            limits = [(each.param_decls, each.min, each.max, each.metavar, each.help) for each in options]
            lines.append(f"  {name} {told} {' '.join(map(str, limits))}")
    assert_as_kept("\n".join(lines) + "\n", Path(__file__).parent / "kept" / "options.txt")


def test_advice_is_given_once() -> None:
    rows = [
        Parameter("left", axis, name, "", None, None, None, None, verdict, reason, advice)
        for axis, name, verdict, reason, advice in (
            ("pitch", "stiffness", "weak", "short", "record longer"),
            ("pitch", "damping", "weak", "noisy", "record longer"),
            ("roll", "stiffness", "weak", "short", "record longer"),
            ("roll", "damping", "usable", "fine", None),
            ("z", "stiffness", "unidentifiable", "still", None),
        )
    ]
    assert list(advised(rows)) == [
        ("weak", "left pitch stiffness, left roll stiffness", "short. Next: record longer."),
        ("weak", "left pitch damping", "noisy. Next: as for left pitch stiffness."),
        ("unidentifiable", "left z stiffness", "still."),
    ]


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


@pytest.mark.parametrize("group", sorted({verb.split()[0] for verb in COMMANDS if " " in verb}))
def test_a_group_gives_an_example_of_its_own(group: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(group, "--help") == 0
    assert f"Example: plantar {group} " in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("verb", COMMANDS)
def test_what_an_option_takes_is_named_as_users_call_it(
    verb: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A folder is DIR, a file FILE, a count N: not Python's `<path>` or `<int>`; what is required has no braces."""
    assert run(*verb.split(), "--help") == 0
    shown = capsys.readouterr().out
    usage, _, rest = shown.partition("\n\n")
    assert not re.findall(r"[{}<>]", usage)
    assert not re.findall(r"<(?:path|list|str|int|float)\b\S*", rest)


def test_importing_plantar_imports_nothing_heavy() -> None:
    out = python(f"import sys, plantar; print([name for name in {HEAVY!r} if name in sys.modules])")
    assert out.strip() == "[]"


def test_public_names() -> None:
    import plantar

    for name in plantar.__all__:
        if name not in ("dynamics", "identify_inertia", "identify_joints"):
            assert getattr(plantar, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = plantar.nonsense


def test_inspect_says_once_what_is_wrong_and_what_the_weight_holds(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The right foot carries all from second 4 to 10, while the left sensor, not zeroed, reads 80 N and more."""
    log = open_log(campaign / "first.csv", load_robot(campaign / "robot.yaml"))
    lifted = (log.time > 4.0) & (log.time < 10.0)
    left, right = (log.column(f"wrench.{foot}.force.z") for foot in ("left", "right"))
    columns = {"wrench.left.force.z": np.where(lifted, 0.0, left) + 40.0}
    columns["wrench.right.force.z"] = np.where(lifted, left + right, right)
    file = write_csv(log.with_columns(columns), tmp_path / "lifted.csv")
    assert run("inspect", campaign / "robot.yaml", file) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert said.count("hangs in the air, so its zero is off") == 1
    assert "kg on average as recorded, zeros of the force sensors included" in said
    assert run("inspect", campaign / "robot.yaml", campaign / "first.csv") == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "kg on average; the URDF weighs" in told
    assert "names no feet" not in told


def test_inspect_of_a_robot_without_feet_says_what_goes_on(
    campaign: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    urdf = next(campaign.glob("*.urdf"))
    bolted = campaign / "bolted.yaml"
    bolted.write_text(f"name: bolted\nurdf: {urdf.name}\nbase: fixed\n")
    assert run("inspect", bolted, campaign / "first.csv") == 0
    assert "bolted.yaml names no feet: `plantar identify joints`" in capsys.readouterr().out


def test_plain_numbers_of_a_csv_are_read_without_arrow_and_robots_without_pydantic(tmp_path: Path) -> None:
    log = tmp_path / "still.csv"
    log.write_text("time,joint.knee.position\n0,0.5\n0.01,0.5\n")
    code = f"""
import sys
import plantar
import plantar.cli.identify.feet
plantar.open_log({str(log)!r})
print("pyarrow" in sys.modules, "pydantic" in sys.modules)
"""
    assert python(code).strip() == "False False"


def test_the_collector_does_not_walk_over_every_module_when_a_command_ends() -> None:
    code = """
import atexit, gc
from plantar.cli import main
atexit.register(lambda: print("FROZEN:", gc.get_freeze_count() > 10_000))
main(["--version"])
"""
    assert "FROZEN: True" in python(code)


@pytest.mark.parametrize(
    ("group", "commands"), [("identify", ("feet", "inertia")), ("fleet", ("plan", "report"))]
)
def test_a_group_alone_shows_its_commands(
    group: str, commands: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    run(group)
    said = "".join(capsys.readouterr())
    assert "Missing command" not in said
    for command in commands:
        assert f" {command} " in said

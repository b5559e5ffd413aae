"""Numbers in tables on the terminal: in the unit of their column, beside the name that is theirs."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console

from command_line import refused, run
from plantar.cli.identify.dynamics_tables import print_joints
from plantar.cli.identify.feet_tables import validation_table
from plantar.cli.inspect import _foot_rows, _print
from plantar.cli.online import _foot_row
from plantar.cli.select import _table
from plantar.inspection.log_summary import ColumnRange, FootSummary, LogSummary
from plantar.motions.select_motions import UNKNOWN, Choice
from plantar.online.estimates import FIELDS, Contact, Flag
from plantar.online.replay import Replay
from plantar.results.dynamics_rows import DynamicsScore, JointParameter
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Diagnosis, Parameter, ValidationRow
from plantar.signals.resampling import Sampling


def printed(*drawn: object) -> list[list[str]]:
    """The words of each line."""
    out = io.StringIO()
    for one in drawn:
        Console(file=out, width=200).print(one)
    return [line.split() for line in out.getvalue().splitlines()]


def summary(*feet: FootSummary) -> LogSummary:
    sampling = Sampling(100.0, 0.0005, ((1.0, 1.5),))
    columns = (ColumnRange("joint.a.position", -0.5, 1.25, 7),)
    return LogSummary("sway", 20.0, 2001, sampling, columns, 60.0, 59.5, feet, (), (), (), assumptions=())


def test_a_log_is_summed_up() -> None:
    out = io.StringIO()
    _print(Console(file=out, width=200), summary(), True, "URDF")
    text = out.getvalue()
    assert "sway: 20.0 s, 2001 samples at 100 Hz, jitter 0.5 ms, 1 gaps, 1 columns" in text
    assert "  gap from 1.000 to 1.500 s" in text
    assert "  joint.a.position: 7 samples without a value" in text
    assert "  the feet carry 60.00 kg on average; the URDF weighs 59.50 kg" in text
    assert [*map(str.split, text.splitlines())][-1] == ["joint.a.position", "−0.5000", "1.250", "7"]


def test_a_foots_angles_are_in_degrees() -> None:
    foot = FootSummary(
        "left", 12.34, 3.21, 300.4, 10.04, {"pitch": 0.02, "roll": 0.01}, {"pitch": 0.1234, "roll": 0.05}
    )
    expected = ("left", "12.3", "3.2", "300", "10.0", "1.15", "0.57", "0.123", "0.050")
    assert _foot_rows(summary(foot)) == [expected]


def test_a_replay_is_summed_up_in_percent_and_milliradians() -> None:
    """Three of four samples stand; the angle in the air does not count, the flag does."""
    rows = np.zeros((4, 1, len(FIELDS)))
    rows[:, 0, FIELDS.index("contact")] = [Contact.STANCE] * 3 + [Contact.AIR]
    rows[:, 0, FIELDS.index("pitch.deflection")] = [0.01, 0.03, 0.02, 9.0]
    rows[:, 0, FIELDS.index("roll.deflection")] = [0.0, 0.003, 0.006, 9.0]
    rows[:, 0, FIELDS.index("flags")] = [0, Flag.EDGE, 0, Flag.EDGE | Flag.NOT_STANDING]
    replay = Replay(np.arange(4.0), ("left",), rows, np.zeros(4))
    expected = ("left", "75.0", f"{10 * np.sqrt(2 / 3):.2f}", f"{3 * np.sqrt(2 / 3):.2f}")
    assert _foot_row(replay, "left") == (*expected, "NOT_STANDING 25.0, EDGE 50.0")


def test_a_diagnosis_has_its_shares_in_percent(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    row = Parameter("left", "pitch", "damping", "N.m.s/rad", 20.0, 0.2, (19.6, 20.4), 0.1, "weak", "wide")
    shares = {"delay": 0.737, "noise": 0.25, "place": 0.01, "model": 0.003}
    told = Diagnosis("left", "pitch", "damping", "delay", shares, 2.04, "said", advice="measure it")
    result = FeetResult("b", (), {}, "kelvin_voigt", (row,), (), (), (), (), diagnosis=(told,))
    assert run("diagnose", result.save(tmp_path)) == 0
    text = capsys.readouterr().out
    assert "left  pitch  damping" in text
    assert " 2.0  delay       delay 74 %, noise 25 %, place 1 %\n" in text, (
        "what makes next to nothing is left out"
    )
    assert "Against delay: measure it." in text
    advised = replace(result, parameters=(replace(row, advice="measure it"),))
    assert run("diagnose", advised.save(tmp_path)) == 0
    text = capsys.readouterr().out
    assert "Next: measure it." in text
    assert "Against" not in text, "what a number's verdict says is not said again"


def test_a_diagnosis_of_no_parameter_is_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = Diagnosis("left", "pitch", "damping", "delay", {"delay": 1.0}, 2.04, "said", advice="measure it")
    result = FeetResult("b", (), {}, "kelvin_voigt", (), (), (), (), (), diagnosis=(told,))
    line = refused(capsys, "diagnose", result.save(tmp_path))
    assert "diagnosis of left pitch damping, which is no parameter" in line


@pytest.mark.parametrize(
    ("schema", "valid"), [("plantar.feet/0", "plantar.feet/1"), ("plantar.arms/1", "plantar.inertia/1")]
)
def test_a_report_of_another_version_names_the_one_that_is_read(
    schema: str, valid: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "result.json"
    path.write_text(f'{{"schema": "{schema}"}}')
    assert valid in refused(capsys, "report", path)


def test_scores_stand_under_their_heads() -> None:
    row = ValidationRow("cross", "squat", "left", "pitch", 0.25, 0.5, 20.0, 1.25, 4.0, 100)
    lost = ValidationRow("cross", "still", "left", "roll", 2.0, 3.0, 5.0, None, 2.0, 100)
    lines = printed(validation_table("Table 3.", [row, lost]))
    assert ["squat", "left", "pitch", "0.250", "0.500", "20.00", "1.25", "4.00"] in lines
    assert [
        "still",
        "left",
        "roll",
        "2.00",
        "3.00",
        "5.000",
        "–",
        "2.00",
        *["no", "better", "than", "the", "offset", "alone"],
    ] in lines


def test_a_joints_terms_and_scores_stand_under_their_heads() -> None:
    term = JointParameter("knee", "viscous", "N.m.s/rad", 3.0, 0.1, (2.8, 3.2), "usable", "narrow")
    dust = JointParameter(
        "hip", "viscous", "N.m.s/rad", 1.557e-13, 1e-13, (-2e-14, 3.3e-13), "usable", "exact"
    )
    score = DynamicsScore(
        "cross", "squat", "N.m", 0.3, 0.4, 9.0, zero_mean_abs=5.0, cad_rms_error=2.0, samples=10,
        relative_error_percent=7.5, joint="knee",
    )  # fmt: skip
    out = io.StringIO()
    result = SimpleNamespace(robot="arm", parameters=(term, dust), validation=(score,), notes=())
    print_joints(Console(file=out, width=200), result)  # type: ignore[arg-type]
    lines = [line.split() for line in out.getvalue().splitlines()]
    assert ["knee", "viscous", "3.000", "N.m.s/rad", "2.800", "to", "3.200", "usable", "narrow"] in lines
    assert ["hip", "viscous", "0", "N.m.s/rad", "0", "to", "0", "usable", "exact"] in lines
    assert ["squat", "knee", "N.m", "0.400", "2.00", "0.300", "5.00", "7.50"] in lines


def test_what_logs_promise_stands_under_foot_axis_and_symbol() -> None:
    """Whatever letters a foot's name has."""
    keys = [("SD", axis, term) for axis in ("pitch", "roll") for term in ("stiffness", "damping")]
    choice = Choice(("a", "b"), dict(zip(keys, (1.5, 3.0, UNKNOWN, 12.0), strict=True)), 42.0)
    lines = printed(_table("Sets", [choice]))
    heads = "logs SD pitch K SD pitch C SD roll K SD roll C mean condition"
    assert heads in [" ".join(line) for line in lines]
    assert lines[-1][:7] == ["a", "+", "b", "1.50", "3.00", "–", "12.0"]
    assert lines[-1][-1] == "42.0"

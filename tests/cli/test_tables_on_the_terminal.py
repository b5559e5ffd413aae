"""Whole tables on the terminal: every number under the head that is its own, in the unit that the head says."""

from __future__ import annotations

import io
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console

from plantar.cli.compare import _cells
from plantar.cli.fleet import run as fleet_run
from plantar.cli.fleet.report import print_summary
from plantar.cli.fleet.run import _reporter
from plantar.cli.identify.dynamics_tables import print_inertia
from plantar.cli.identify.feet_tables import print_feet
from plantar.cli.inspect import _print
from plantar.cli.online import _print as print_replay
from plantar.comparison.compare import KindScore
from plantar.contact.phases import Phase
from plantar.fleet.run import Progress
from plantar.fleet.summary import Reason
from plantar.inspection.log_summary import ColumnRange, FootSummary, LogSummary
from plantar.notes import Finding, Note
from plantar.online.estimates import FIELDS, Contact
from plantar.online.replay import Replay
from plantar.results.dynamics_rows import DynamicsScore, InertialParameter
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Parameter, ValidationRow
from plantar.results.usage import used_shares
from plantar.signals.resampling import Sampling

K = Parameter("left", "pitch", "stiffness", "N.m/rad", 434.0, 1.5, (430.5, 437.5), 0.0125, "usable", "narrow")
C = Parameter("left", "pitch", "damping", "N.m.s/rad", 20.0, 4.0, (12.25, 28.0), 0.5, "weak", "wide", "sway")
Z = Parameter("left", "z", "stiffness", "N/m", None, None, None, None, "unidentifiable", "no shift", "shift")


def shown(draw: object, *arguments: object) -> list[str]:
    """The lines that something prints on a wide terminal."""
    out = io.StringIO()
    draw(Console(file=out, width=240, highlight=False), *arguments)  # type: ignore[operator]
    return out.getvalue().splitlines()


def under(lines: list[str], title: str) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of the table of that title: what stands two spaces apart."""
    place = next(place for place, line in enumerate(lines) if line.strip().startswith(title))
    body = [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in lines[place + 1 :]]
    end = next((row for row, cells in enumerate(body) if not cells), len(body))
    return body[0], body[1:end]


def test_feet_are_told_with_interval_deviation_and_scores() -> None:
    scores = (
        ValidationRow("direct", "sway", "left", "pitch", 0.125, 0.25, 30.0, 0.5, 5.0, 100),
        ValidationRow("cross", "squat", "left", "pitch", 0.5, 0.75, 20.0, 2.5, 2.0, 100),
    )
    notes = (Note("drift", "warning", "it drifts"), Note("band", "info", "a filter"))
    result = FeetResult("b", (), {"offset": "per-motion"}, "kelvin_voigt", (K, C, Z), (), (), scores, notes)
    lines = shown(print_feet, result)
    heads, rows = under(lines, "Table 1. Feet of b (kelvin_voigt, offset per-motion)")
    assert heads == [
        "foot",
        "axis",
        "parameter",
        "value",
        "unit",
        "95 % interval",
        "std",
        "white std %",
        "verdict",
    ]
    assert rows[:3] == [
        ["left", "pitch", "stiffness", "434.00", "N.m/rad", "430.50 to 437.50", "1.50", "0.013", "usable"],
        ["left", "pitch", "damping", "20.000", "N.m.s/rad", "12.250 to 28.000", "4.00", "0.50", "weak"],
        ["left", "z", "stiffness", "–", "N/m", "–", "–", "–", "unidentifiable"],
    ]
    assert "left pitch damping: weak: wide. Next: sway." in lines
    for title, numbers in (
        (
            "Table 2. Direct validation [N·m]",
            ["sway", "left", "pitch", "0.125", "0.250", "30.00", "0.500", "5.00"],
        ),
        (
            "Table 3. Cross validation [N·m]",
            ["squat", "left", "pitch", "0.500", "0.750", "20.00", "2.50", "2.00"],
        ),
    ):
        heads, rows = under(lines, title)
        assert heads == [
            "motion",
            "foot",
            "axis",
            "mean |error|",
            "rms",
            "max |torque|",
            "% of max",
            "offset alone",
        ]
        assert rows[0] == numbers
    first, last = lines.index("note (warning): it drifts"), lines.index("note (info): a filter")
    assert first == 0
    assert last == len(lines) - 1


@pytest.mark.parametrize(
    ("lost", "named", "alone"),
    [
        ((10,), "walk_10", "18.4"),
        ((1, 4, 10), "walk_1, walk_4, walk_10", "15.1"),
        ((1, 4, 7, 10), "walk_1, walk_4, walk_7 and 1 more", "13.5"),
    ],
)
def test_feet_of_many_logs_fit_a_screen(lost: tuple[int, ...], named: str, alone: str) -> None:
    """Eleven walks: 44 rows of errors are four, over all samples; notes that are no warnings take four lines."""
    walks = [f"walk_{place}" for place in range(11)]
    rows = [
        ValidationRow("direct", walk, foot, axis, 1.0 + place, 2.0, 10.0 + place, 9.0, 20.0 - 18 * (place in lost), 100)
        for foot in ("left", "right")
        for axis in ("pitch", "roll")
        for place, walk in enumerate(walks)
    ]  # fmt: skip
    notes = [
        Note("weight", "warning", "the feet carry too much"),
        *(Note(f"n{i}", "info", "so it is") for i in range(9)),
    ]
    result = FeetResult(
        "b", (), {"offset": "per-motion"}, "kelvin_voigt", (K, C, Z), (), (), tuple(rows), tuple(notes)
    )
    lines = shown(print_feet, result)
    assert len(lines) <= 25
    heads, cells = under(lines, "Table 2. Direct validation [N·m]")
    assert heads[0] == "motions"
    said = f"no better than the offset alone: {named}"
    assert cells[:4] == [
        ["11", foot, axis, "6.00", "2.00", "20.00", "30.0", alone, said]
        for foot in ("left", "right")
        for axis in ("pitch", "roll")
    ]
    assert "over all motions; each of them stands in report.html" in lines
    assert lines[-1] == "and 5 more notes, in the result's notes"


def test_no_word_is_cut_on_a_terminal_of_eighty_columns() -> None:
    """Long numbers, long words: the widest columns wrap, table 1 leaves out its deviations."""
    wide = Parameter(
        "right",
        "pitch",
        "slip_torque",
        "N.m.s/rad",
        -0.00123456,
        1e-5,
        (-0.00234567, -0.00123456),
        0.012,
        "usable",
        "x",
    )
    high = Parameter(
        "right", "z", "stiffness", "N/m", 239131.0, 4e4, (176843.0, 369182.0), 0.025, "unidentifiable", "x"
    )
    row = ValidationRow(
        "direct", "step_12_no_fall_1", "right", "pitch", 0.0125, 0.0125, 62.62, 0.0125, 11.25, 100
    )
    result = FeetResult("b", (), {"offset": "per-motion"}, "kelvin_voigt", (wide, high), (), (), (row,), ())
    out = io.StringIO()
    print_feet(Console(file=out, width=80, highlight=False), result)
    text = out.getvalue()
    assert "…" not in text, "a long name of a log goes on in the next line"
    assert max(map(len, text.splitlines())) <= 80
    for word in (
        "slip_torque",
        "N.m.s/rad",
        "unidentifiable",
        "239131",
        "0.0125",
        "pitch",
    ):
        assert word in text
    assert "white" not in text


def test_inertias_are_told_beside_the_urdfs() -> None:
    names = ("m", "mx", "my", "mz")
    found = [
        InertialParameter(link, name, "", value, cad)
        for link, first in (("leg", 1.0), ("arm", 11.0))
        for name, value, cad in zip(names, first + np.arange(4), first + 0.5 + np.arange(4), strict=True)
    ]
    score = DynamicsScore(
        "cross", "squat", "N", 0.25, 0.375, 9.0, zero_mean_abs=1.5, cad_rms_error=3.0, samples=12,
        relative_error_percent=7.5, axis="force.x",
    )  # fmt: skip
    result = SimpleNamespace(
        robot="b", mass=12.0, inertial_parameters=found, validation=(score,), notes=(), schema=""
    )
    lines = shown(print_inertia, result)
    heads, rows = under(lines, "Inertial parameters of b: 12.00 kg")
    assert heads == ["link", "mass [kg] (URDF)", "m·cx [kg.m]", "m·cy [kg.m]", "m·cz [kg.m]"]
    assert rows[:2] == [
        ["leg", "1.000 (1.500)", "2.000 (2.500)", "3.000 (3.500)", "4.000 (4.500)"],
        ["arm", "11.00 (11.50)", "12.00 (12.50)", "13.00 (13.50)", "14.00 (14.50)"],
    ]  # fmt: skip
    assert rows[2][0].endswith("the numbers of one link alone may be far off.")
    heads, rows = under(lines, "Cross validation")
    assert heads == ["motion", "of", "unit", "rms", "rms by URDF", "mean |error|", "mean alone", "error %"]
    assert rows == [["squat", "force.x", "N", "0.375", "3.00", "0.250", "1.50", "7.50"]]


def test_a_log_is_told_foot_by_foot_with_what_it_identifies() -> None:
    foot = FootSummary(
        "left", 12.34, 3.21, 300.4, 10.04, {"pitch": 0.02, "roll": 0.01}, {"pitch": 0.1, "roll": 0.05}
    )
    sampling = Sampling(100.0, 0.0005, tuple((float(at), at + 0.25) for at in range(1, 8)))
    columns = tuple(ColumnRange(f"c{place}", 0.0, 1.0, place) for place in range(8))
    findings = (
        Finding("air_reading", "reads 3 N in the air"),
        *(Finding("gap", f"a hole, {place}", fatal=True) for place in range(5)),
    )
    log = LogSummary(
        "sway", 20.0, 2001, sampling, columns, 60.0, 59.5, (foot,), (K, C), findings, (), assumptions=()
    )
    lines = shown(_print, log, False, "URDF")
    heads, rows = under(lines, "Feet")
    assert heads == [
        "foot", "both stand s", "alone s", "load N", "used s", "pitch deg rms", "roll deg rms", "pitch rad/s rms",
        "roll rad/s rms",
    ]  # fmt: skip
    assert rows[0] == ["left", "12.3", "3.2", "300", "10.0", "1.15", "0.57", "0.100", "0.050"]
    assert [line for line in lines if "gap from" in line] == [
        f"  gap from {at}.000 to {at}.250 s" for at in range(1, 6)
    ], "the first five, all are counted above"
    assert sum("samples without a value" in line for line in lines) == 5
    assert any("zeros of the force sensors included" in line for line in lines)
    assert [
        line.strip() for line in lines if "a hole" in line or "reads" in line or "like these" in line
    ] == [
        *(f"problem: a hole, {place}" for place in range(3)),
        "and 2 more like these; --json has all",
        "warning: reads 3 N in the air",
    ]
    heads, rows = under(lines, "What this log identifies, in SI units")
    assert heads == ["foot", "axis", "parameter", "value", "verdict", "reason"]
    assert rows == [
        ["left", "pitch", "stiffness", "434.0", "usable", "narrow"],
        ["left", "pitch", "damping", "20.00", "weak", "wide"],
    ]


def test_a_replay_ends_with_its_numbers_and_the_time_of_a_step(capsys: pytest.CaptureFixture[str]) -> None:
    values = np.zeros((2000, 1, len(FIELDS)))
    values[:, 0, FIELDS.index("contact")] = Contact.STANCE
    latency = 1e-6 * np.repeat([4.0, 12.0, 20.0], [1990, 9, 1])
    print_replay(Replay(np.arange(2000.0), ("left",), values, latency), (K, C))
    lines = capsys.readouterr().out.splitlines()
    heads, rows = under(lines, "At the end of the log")
    assert heads == ["foot", "axis", "parameter", "value", "95 %", "unit", "verdict"]
    assert rows[:2] == [
        ["left", "pitch", "stiffness", "434.0", "± 3.5", "N.m/rad", "usable"],
        ["left", "pitch", "damping", "20.00", "± 7.9", "N.m.s/rad", "weak"],
    ]
    assert [line for line in lines if "wide" in line] == ["left pitch damping: weak: wide. Next: sway."]
    assert any("what each flag means" in line for line in lines)
    heads, rows = under(lines, "Through the log")
    assert heads == ["foot", "stands %", "pitch mrad rms", "roll mrad rms", "flags, % of the samples"]
    assert lines[-1] == "a step: median 4.0 µs, 99.9 % 12.0 µs, longest 20.0 µs"


def test_replays_of_a_simulator_are_told_in_milliradians() -> None:
    score = KindScore("squat", "joints", 0.0015, 0.002, 3.25, 12.0, fell=None)
    assert _cells(score) == ("squat", "joints", "1.50", "2.00", "3.25")
    assert score.chest == pytest.approx(0.0025)
    assert _cells(KindScore("squat", "rigid", None, None, None, 0.0, 1.5))[2:] == ("falls",) * 3


def test_alarms_fill_a_screen_and_the_rest_is_counted(capsys: pytest.CaptureFixture[str]) -> None:
    alarms = [SimpleNamespace(kind="step", text=f"alarm {place}") for place in range(19)]
    failures = (Reason("does not exist", 3, "a.csv: does not exist"),)
    print_summary(SimpleNamespace(alarms=alarms, failures=failures))  # type: ignore[arg-type]
    *lines, failed = capsys.readouterr().out.splitlines()
    assert failed == "failed, 3 like this: a.csv: does not exist"
    assert lines[:2] == ["step: alarm 0", "step: alarm 1"]
    assert lines[-1] == "and 3 more alarms: see fleet.html"
    assert len(lines) == 17


def test_progress_counts_what_is_done_and_what_was_there() -> None:
    said: list[str] = []
    report = _reporter(said.append)
    report(Progress(9, 2, 6, 1, 30.0))
    assert said == ["8 of 9 groups done, 2 of them there already, 1 failed, 30 s left"]


@pytest.mark.parametrize(("terminal", "shown"), [(False, [0, 5, 9]), (True, [0, 1, 5, 6, 9])])
def test_progress_in_a_file_is_a_line_now_and_then_and_the_last(
    terminal: bool, shown: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    clock, said = SimpleNamespace(now=1000.0), list[str]()
    monkeypatch.setattr(fleet_run, "time", SimpleNamespace(monotonic=lambda: clock.now))
    monkeypatch.setattr(fleet_run, "sys", SimpleNamespace(stderr=SimpleNamespace(isatty=lambda: terminal)))
    report = _reporter(said.append)
    for done, later in ((0, 0.0), (1, 4.9), (5, 0.2), (6, 4.9), (9, 0.0)):
        clock.now += later
        report(Progress(12, 1, done, 2, None))
    assert said == [f"{done + 1} of 12 groups done, 1 of them there already, 2 failed" for done in shown]


def test_how_much_of_a_log_was_used_adds_up_by_motion_and_foot() -> None:
    phases = [
        Phase("walk", "left", 0.0, 2.0, "double", True, None),
        Phase("walk", "left", 2.0, 3.5, "transition", False, "tips"),
        Phase("walk", "left", 3.5, 4.0, "transition", False, "tips"),
        Phase("walk", "right", 0.0, 4.0, "single", True, None),
    ]
    assert [share.to_dict() for share in used_shares(phases)] == [
        {"motion": "walk", "foot": "left", "seconds": 4.0, "served": 2.0, "reasons": "tips (2.0 s)"},
        {"motion": "walk", "foot": "right", "seconds": 4.0, "served": 4.0, "reasons": ""},
    ]

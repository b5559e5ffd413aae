"""Parts of a design as they are kept: legs, the robot about its stance, the limits of a motion, what it tells, and what
is promised of rehearsals whose results are made up."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import design_samples
from kept_texts import assert_as_kept, described, lines_of
from plantar.design.family import Lines
from plantar.design.information import (
    CRITERIA,
    badness,
    delay_half_width,
    half_widths,
    information,
    vertical_half_width,
)
from plantar.design.known import Known
from plantar.design.reach import Reach
from plantar.design.rehearsals import rehearsal
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.design.story import Design, DesignSettings
from plantar.design.trajectory import Trajectory
from plantar.design.writing.outputs import content_of, write_design
from plantar.design.writing.sheet import sheet
from plantar.logs.readers import open_log
from plantar.results.feet import DelayEstimate, Diagnosis, FeetResult, Parameter
from plantar.twin.bush import PAPER
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics
from twin_samples import flung, tilted

KEPT = Path(__file__).parent / "kept"


def of_reach(reach: Reach) -> dict[str, object]:
    """All numbers of it, and what they say of a motion."""
    motion = 0.02 * np.random.default_rng(2).standard_normal(reach.lines.size)
    numbers = {
        name: value
        for name, value in vars(reach).items()
        if isinstance(value, np.ndarray | list | float | int)
    }
    return numbers | {
        "alone": reach.alone(), "used": reach.used(motion), "by kind": reach.used_by_kind(motion),
        "over none": reach.used_over_none(motion), "near": reach.near(motion), "close": vars(reach.close(motion, 0.1)),
        "held": vars(reach.held(0.5 + 0 * reach.used_by_kind(motion), 0.9)), "torque": reach.of(reach.rate, motion),
    }  # fmt: skip


def without_objects(text: str) -> str:
    return "".join(f"{line}\n" for line in text.splitlines() if "object at" not in line)


def test_legs_and_limits_are_as_they_are_kept() -> None:
    legs, lines = design_samples.legs(), design_samples.reach().lines
    motion = 0.02 * np.random.default_rng(2).standard_normal(lines.size)
    displacements = lines.displacements(motion, lines.time(5.0))
    told = {
        "soft": design_samples.told(), "linear": design_samples.linear(), "lines": lines,
        "columns": legs.columns, "directions": legs.directions, "ahead": legs.ahead, "rest": legs.rest[:2],
        "followed": legs.follow(displacements), "displacements": displacements,
        "reach": of_reach(design_samples.reach()),
    }  # fmt: skip
    assert_as_kept(without_objects(described(told)), KEPT / "parts.txt", share=1e-4, least=1e-6)


def test_what_motions_tell_is_as_it_is_kept() -> None:
    """Of three motions together, one of which hardly moves; with nothing and with something known before."""
    reach = design_samples.reach()
    size = np.array([[1.0], [0.4], [0.01]])
    motions = 0.3 * size * np.random.default_rng(3).standard_normal((3, reach.lines.size)) / reach.alone()
    known = 1e-3 * np.random.default_rng(4).random((2, 2, 2, 2)) + np.eye(2)
    firm = [reach.of(part, motions) for part in (reach.firm_deflection, reach.firm_rate)]
    told = {
        "information": information(reach, *firm), "late": delay_half_width(reach, motions),
        "widths": half_widths(reach, motions), "known": half_widths(reach, motions[0], known),
        "vertical": vertical_half_width(reach, motions),
        "bad": {name: badness(reach, motions, name, 0.0) for name in CRITERIA},
        "bad beside": {name: badness(reach, motions, name, known) for name in CRITERIA},
    }  # fmt: skip
    assert_as_kept(described(told), KEPT / "told.txt", share=1e-4)


def row(foot: str, axis: str, name: str, value: float, half: float, verdict: str = "usable") -> Parameter:
    ends = (value * (1 - half), value * (1 + half))
    return Parameter(foot, axis, name, "", value, half * value / 2, ends, 1.0, verdict, "", "")


def earlier() -> FeetResult:
    """Of one pitch an element slips, of the other it may be hidden; one roll is weak."""
    rows = [
        row("left", "pitch", "stiffness", 480.0, 0.02), row("left", "pitch", "damping", 19.0, 0.1),
        row("left", "pitch", "slip_torque", 4.0, 0.1), row("left", "pitch", "slip_angle", 0.011, 0.1),
        row("left", "roll", "stiffness", 350.0, 0.4, "weak"), row("left", "roll", "damping", 15.0, 0.5, "weak"),
        row("right", "pitch", "stiffness", 620.0, 0.3, "weak"), row("right", "pitch", "damping", 21.0, 0.2),
        row("right", "roll", "stiffness", 330.0, 0.05), row("right", "roll", "damping", 14.0, 0.15),
        row("right", "z", "stiffness", 3e5, 0.1),
    ]  # fmt: skip
    hidden = Diagnosis("right", "pitch", "stiffness", "noise", {"hidden memory": 0.7}, 0.3, "")
    return FeetResult("before", (), {}, "kelvin_voigt", tuple(rows), (), (), (), (), diagnosis=(hidden,))


def found(factor: float, draw: int) -> FeetResult:
    """What `identify feet` might find of a rehearsal: weak in roll where feet are stiff, wrong in one damping."""
    off = 1 + 0.004 * np.random.default_rng([draw, round(100 * factor)]).standard_normal(10)
    weak = "weak" if factor > 1.5 else "usable"
    values = {("pitch", "stiffness"): (500.0, 0.01, "usable"), ("pitch", "damping"): (20.0, 0.06, "usable"),
              ("roll", "stiffness"): (500.0, 0.02, weak), ("roll", "damping"): (23.0, 0.05, "usable")}  # fmt: skip
    rows = [
        row(foot, axis, name, factor * value * off[place], half * (1.2 if foot == "left" else 1.0), verdict)
        for foot in ("left", "right")
        for place, ((axis, name), (value, half, verdict)) in enumerate(values.items(), 4 * (foot == "left"))
    ]
    rows += [row(foot, "z", "stiffness", 3.4e5 * off[9], 0.1 + 0.1 * draw) for foot in ("left", "right")]
    late = DelayEstimate(0.005 * off[8], 2e-4 * (1 + draw), True)
    return FeetResult("h", (), {}, "kelvin_voigt", tuple(rows), (), (), (), (), sensor_delay=late)


def test_what_a_rehearsal_shows_is_as_it_is_kept() -> None:
    """Of feet that differ in pitch and roll, left and right; of a centre of pressure that comes near edges."""
    shown = [
        rehearsal._measured(0.7, hrp2.robot(), rollout(), Physics(bushes=PAPER))
        for rollout in (tilted, flung)
    ]
    told = described([replace(one, rollout=None, world=None) for one in shown])
    assert_as_kept(told, KEPT / "rehearsed.txt", share=1e-2, least=1e-6)


def rehearsed(factor: float, place: int) -> Rehearsal:
    sway = np.column_stack([0.012 * np.sin(np.arange(50.0)), 0.009 * np.cos(np.arange(50.0))]) / factor
    return Rehearsal(
        factor, (0.011 + 0.001 * place, 0.014), (0.05, 0.04), 0.6 - 0.03 * place, 0.1 + 0.02 * place,
        0.5 + 0.06 * place, 0.03 / factor, bushes={"left": sway, "right": 0.8 * sway},
        yields={(foot, axis): 0.003 for foot in ("left", "right") for axis in ("pitch", "roll")},
        results=tuple(found(factor, draw) for draw in range(2)),
    )  # fmt: skip


def test_what_is_promised_is_as_it_is_kept(tmp_path: Path) -> None:
    """The motion, its files and gentler versions, and what its rehearsals say; alone and after an earlier result."""
    legs, lines = design_samples.legs(), Lines.drawn(10.0, np.random.default_rng(1))
    motion = 0.006 * np.random.default_rng(2).standard_normal(lines.size)
    trajectory = Trajectory.of("made", legs, lines, motion)
    made = Design(
        DesignSettings(500.0, duration=20.0), hrp2.robot(), design_samples.told(), (0.5, 2.0), 237.5, legs, lines,
        motion, trajectory, tuple(rehearsed(*each) for each in ((0.5, 2), (1.0, 0), (1.4, 3), (2.0, 1))), 12, None,
    )  # fmt: skip
    path, targets = tmp_path / "motion.csv", ("ros", "openhrp", "mc_rtc")
    content = write_design(made, path, 25.0, targets, approach=True)
    after = replace(made, known=Known.of(earlier()), pairs=0, rehearsals=made.rehearsals[:2])
    again = content_of(after, path, 100.0)
    told = {
        "known": after.known, "sure": after.known.sure if after.known else None,
        "precise": after.known.precision(("left", "right")) if after.known else None,
        "base": trajectory.base(30.0), "used": trajectory.limits_used(), "plan": vars(trajectory.plan()),
        "files": {file.name: open_log(file).columns for file in sorted(tmp_path.glob("*.csv"))},
        "pos": np.loadtxt(path.with_suffix(".pos")), "ros": path.with_suffix(".yaml").read_text()[:900],
        "names": sorted(file.name for file in tmp_path.iterdir()),
    }  # fmt: skip
    pages = path.with_suffix(".md").read_text() + sheet(again, approach=False)
    text = without_objects(described(told)) + lines_of(content) + lines_of(again) + pages
    assert_as_kept(text.replace(str(tmp_path), "FOLDER"), KEPT / "promised.txt", share=1e-4, least=1e-6)

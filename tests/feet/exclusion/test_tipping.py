"""Logs of soles that tip: what leans is left out with what the filter smears beside it, what stays flat serves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from biped import TRUTH, BushModel, Motion, Slipping, record, sines, sway
from biped_robot import FEET, make_robot, robot_entry
from feet_trials import LINEAR, noisy
from plantar.feet.identify import identify_feet
from plantar.results.feet import FeetResult
from plantar.robot.guesses import Guess
from plantar.robot.model import RobotModel

LIMIT = 8.5  # N·m: half of the weight on an edge 29 mm from the middle
PERIOD = 0.01
SMEARED = 0.05  # s beside a lean that a filter of 5 Hz spoils
STILL = sines((0.0, 0.0, 0.0))


@dataclass(frozen=True)
class Tipping(BushModel):
    """A bush under a sole that tips: the torque ends at `low` and `high` [N·m], and the foot turns on."""

    low: float = -np.inf
    high: float = np.inf

    def torque(self, deflection: np.ndarray, rate: np.ndarray) -> np.ndarray:
        return np.clip(super().torque(deflection, rate), self.low, self.high)


def pitching(
    angle: Callable[[np.ndarray], np.ndarray],
    low: float = -np.inf,
    high: float = np.inf,
    zero: float = 0.0,
) -> Motion:
    """Both feet pitch by one angle, and roll a little; no weight moves; the sensors' torque in pitch reads `zero`
    [N·m] too much."""
    truth = {
        key: Tipping(law.stiffness, law.damping, zero, 0.0, low + zero, high + zero)
        if key[1] == "pitch"
        else replace(law, offset=0.0)
        for key, law in TRUTH.items()
    }
    ankles = {foot: (angle, sines((np.radians(0.8), 0.31, 0.0))) for foot in FEET}
    return sway("pitch", 1, duration=30.0, torso=(STILL,) * 3, ankles=ankles, shift=0.0, truth=truth)


def short_soled(folder: Path, half: float, **changes: object) -> RobotModel:
    """The biped on soles of 2·half length [m]; `changes` of each foot's entry."""
    entry = robot_entry()
    assert isinstance(entry["feet"], dict)
    for foot in entry["feet"].values():
        foot["sole"]["polygon"] = [[half, 0.08], [-half, 0.08], [-half, -0.08], [half, -0.08]]
        foot.update(changes)
    return make_robot(folder, feet=entry["feet"])


def columns(found: FeetResult, foot: str) -> dict[str, np.ndarray]:
    """The table of residuals of one foot."""
    table = found.residuals.to_pydict()
    mine = np.array(table["foot"]) == foot
    return {name: np.array(values)[mine] for name, values in table.items()}


def tips(found: FeetResult, foot: str) -> list[tuple[float, float]]:
    return [
        (phase.start, phase.end)
        for phase in found.phases
        if phase.foot == foot and phase.reason is not None and phase.reason.startswith("tipping")
    ]


@pytest.mark.parametrize("guessed", [True, False])
def test_an_outline_that_is_a_guess_may_be_too_large(tmp_path: Path, guessed: bool) -> None:
    """The sole tips 7 mm inside of the edge that the robot file draws, and by too little for the torque's end to show:
    looked for where the file calls it a guess."""
    motion = pitching(sines((np.radians(1.6), 0.25, 0.3)), -LIMIT, LIMIT)
    robot = short_soled(tmp_path, 0.036)
    if guessed:
        marks = tuple(Guess(f"feet.{foot}.sole", "the lowest points of its shape", 0.005) for foot in FEET)
        robot = replace(robot, guesses=marks)
    found = identify_feet(robot, [noisy(record(motion), 1)], settings=LINEAR)
    for foot in FEET:
        row, truth = found.parameter(foot, "pitch", "stiffness"), TRUTH[foot, "pitch"].stiffness
        assert (len(tips(found, foot)) > 10) == guessed
        assert (row.value == pytest.approx(truth, rel=0.03)) == guessed


@pytest.mark.parametrize("zero", [1.0, -1.0, 2.0, -3.0, 5.0])
def test_a_torque_that_reads_wrong_moves_the_edge(tmp_path: Path, zero: float) -> None:
    """By 3 to 17 mm: on one side the sole tips that far inside of where the centre of pressure seems to be at its edge,
    on the other the centre of pressure reads outside of the sole."""
    motion = pitching(sines((np.radians(2.5), 0.25, 0.3)), -LIMIT, LIMIT, zero)
    found = identify_feet(short_soled(tmp_path, 0.03), [noisy(record(motion), 1)], settings=LINEAR)
    for foot in FEET:
        row = found.parameter(foot, "pitch", "stiffness")
        assert row.value == pytest.approx(TRUTH[foot, "pitch"].stiffness, rel=0.02)
        assert row.half_width_percent < 1.0


@pytest.mark.parametrize(
    ("middle", "reach", "zero"), [(1.0, 1.6, 0.0), (1.0, 1.6, 2.0), (1.0, 1.6, 5.0), (0.5, 1.3, 1.5)]
)
def test_a_sole_that_tips_over_one_edge_shows_where_it_is(
    tmp_path: Path, middle: float, reach: float, zero: float
) -> None:
    """Up to 18 mm inside of the outline, and never outside of another edge: there the torque stops growing. The last
    one leans too little for that, but the torque's own offset says how far inside it may lean."""

    def forwards(t: np.ndarray) -> np.ndarray:
        return np.radians(middle) + sines((np.radians(reach), 0.25, 0.3))(t)

    motion = pitching(forwards, -LIMIT, LIMIT, zero)
    found = identify_feet(short_soled(tmp_path, 0.03), [noisy(record(motion), 1)], settings=LINEAR)
    for foot in FEET:
        row = found.parameter(foot, "pitch", "stiffness")
        assert row.value == pytest.approx(TRUTH[foot, "pitch"].stiffness, rel=0.02)
        assert columns(found, foot)["used"].mean() > 0.4


def sticking(t: np.ndarray) -> np.ndarray:
    return sines((np.radians(1.2), 0.29, 0.4), (np.radians(0.5), 0.83, 2.0))(t)


@pytest.mark.parametrize("share", [0.25, 0.1])
def test_friction_that_ends_the_torque_on_the_way_out_is_no_edge(tmp_path: Path, share: float) -> None:
    """Its torque falls on the way back."""
    truth = {
        key: Slipping(share * law.stiffness, law.damping, 0.0, slip=8.0, angle=0.012)
        for key, law in TRUTH.items()
    }
    ankles = {foot: (sticking, sines((np.radians(0.8), 0.31, 0.0))) for foot in FEET}
    motion = sway("stick", 1, duration=30.0, torso=(STILL,) * 3, ankles=ankles, shift=0.0, truth=truth)
    found = identify_feet(short_soled(tmp_path, 0.13), [noisy(record(motion), 1)], settings=LINEAR)
    assert [tips(found, foot) for foot in FEET] == [[], []]


def test_what_lies_beside_a_lean_is_left_out_with_it(tmp_path: Path) -> None:
    motion = pitching(sines((np.radians(2.5), 0.25, 0.3)), -LIMIT, LIMIT)
    found = identify_feet(short_soled(tmp_path, 0.03), [noisy(record(motion), 1)], settings=LINEAR)
    for foot in FEET:
        leans, table = tips(found, foot), columns(found, foot)
        time, used = table["time"], table["used"]
        assert len(leans) > 10
        assert 5.0 < used.sum() * PERIOD < 15.0
        for start, end in leans:
            beside = (time > start - SMEARED) & (time < end + SMEARED)
            assert not used[beside].any(), f"beside the lean from {start:.2f} to {end:.2f} s"
        stiffness = found.parameter(foot, "pitch", "stiffness").value
        assert stiffness == pytest.approx(TRUTH[foot, "pitch"].stiffness, rel=0.02)


def test_a_quick_sway_to_the_edge_is_no_lean(tmp_path: Path) -> None:
    """Damping takes its share of the torque: angle and torque part by 10 mrad, and the sole stays flat."""
    robot = short_soled(tmp_path, half := 0.043)
    angle = sines((np.radians(1.4), 1.0, 0.0))
    found = identify_feet(robot, [noisy(record(pitching(angle)), 2)], settings=LINEAR)
    for foot in FEET:
        table = columns(found, foot)
        assert half - 0.005 < np.abs(table["cop_x"]).max() < half, "the edge is visited"
        assert tips(found, foot) == []
        assert table["used"].mean() > 0.95


def held_at_the_edge(t: np.ndarray) -> np.ndarray:
    """From rest within 0.3 s to 1 and back a second later, every 4 s, to both sides by turns."""

    def risen(since: np.ndarray) -> np.ndarray:
        x = np.clip(since / 0.3, 0, 1)
        return x**3 * (10 - 15 * x + 6 * x**2)

    phase, side = np.mod(t, 4.0), np.where(np.mod(t, 8.0) < 4.0, 1.0, -1.0)
    return side * (risen(phase - 1.0) - risen(phase - 2.3))


def test_a_foot_that_is_quickly_put_to_its_edge_and_held_there_serves(tmp_path: Path) -> None:
    """Damping on the way there is no angle beyond the bush's; 12 N·m hold the pressure 3 mm inside the edge."""
    half, torque = 0.045, 12.3

    def angle(t: np.ndarray) -> np.ndarray:
        return torque / TRUTH["left", "pitch"].stiffness * held_at_the_edge(t)

    found = identify_feet(short_soled(tmp_path, half), [noisy(record(pitching(angle)), 5)], settings=LINEAR)
    table = columns(found, "left")
    assert half - 0.005 < np.percentile(np.abs(table["cop_x"]), 90) < half, "the edge is visited"
    assert tips(found, "left") == []
    assert table["used"].mean() > 0.95


def resting(t: np.ndarray) -> np.ndarray:
    """From a pose in which the foot spends most of its time out to 2.5 degrees on both sides."""
    return np.radians(2.5) * np.sin(2 * np.pi * 0.2 * t) ** 5


@pytest.mark.parametrize(("side", "other"), [("positive", "negative"), ("negative", "positive")])
def test_a_torque_that_stops_growing_is_tipping_on_either_side(tmp_path: Path, side: str, other: str) -> None:
    """Feet whose centre of pressure means nothing: the bend of the torque over the angle tells."""
    limits = {"positive": (-np.inf, LIMIT), "negative": (-LIMIT, np.inf)}[side]
    robot = short_soled(tmp_path, 0.13, contact="always")
    found = identify_feet(robot, [noisy(record(pitching(resting, *limits)), 3)], settings=LINEAR)
    for foot in FEET:
        reasons = {phase.reason for phase in found.phases if phase.foot == foot and phase.reason}
        stops = [reason for reason in reasons if "the torque stops growing, pitch" in reason]
        assert len(stops) == 1
        assert side in stops[0]
        assert other not in stops[0]
        bend = LIMIT / TRUTH[foot, "pitch"].stiffness
        table = columns(found, foot)
        angle = (1.0 if side == "positive" else -1.0) * table["pitch.deflection"][table["used"]]
        assert angle.max() < 1.3 * bend
        assert angle.min() < -0.9 * np.radians(2.5), "the other side serves"


def test_a_window_holds_on_both_sides(tmp_path: Path) -> None:
    robot, window = short_soled(tmp_path, 0.13), np.radians(1.0)
    settings = replace(LINEAR, window=float(window))
    found = identify_feet(robot, [noisy(record(pitching(resting)), 4)], settings=settings)
    for foot in FEET:
        table = columns(found, foot)
        angle = table["pitch.deflection"]
        used = angle[table["used"]]
        assert np.abs(used).max() < 1.2 * window
        assert used.min() < -0.8 * window
        assert used.max() > 0.8 * window

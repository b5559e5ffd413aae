"""What may be said of a number, and which samples of a tipping sole are left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sines, sway
from biped_robot import FEET, make_robot, robot_entry
from plantar.feet.assess.verdicts import (
    SIGNS,
    Evidence,
    judge,
    judge_term,
)
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.readers import open_log
from plantar.results.feet import ValidationRow
from plantar.robot.model import load_robot

NOISY = 0.13

GOOD = Evidence(seconds=60.0, excitation=0.02, explained=0.98, lag=0.0)


@pytest.mark.parametrize(
    ("value", "interval", "evidence", "verdict", "part"),
    [
        (400.0, (390.0, 410.0), GOOD, "usable", "60 s"),
        (400.0, (320.0, 480.0), GOOD, "weak", "±20 %"),
        (400.0, (240.0, 560.0), GOOD, "weak", "±40 %"),
        (400.0, (100.0, 700.0), GOOD, "unidentifiable", "±75 %"),
        (400.0, (-10.0, 810.0), GOOD, "unidentifiable", "reaches zero"),
        (-40.0, (-50.0, -30.0), GOOD, "unidentifiable", "negative"),
        (400.0, (390.0, 410.0), Evidence(2.0, 0.02, 0.98, lag=0.0), "unidentifiable", "2.0 s"),
        (400.0, (390.0, 410.0), Evidence(8.0, 0.02, 0.98, lag=0.0), "weak", "8.0 s"),
        (400.0, (390.0, 410.0), Evidence(60.0, 0.02, 0.1, lag=0.0), "unidentifiable", "10 %"),
        (400.0, (390.0, 410.0), Evidence(60.0, 0.02, 0.6, lag=0.0), "weak", "60 %"),
        (0.0, (-1.0, 1.0), GOOD, "unidentifiable", "reaches zero"),
        (400.0, (np.nan, np.nan), GOOD, "unidentifiable", "could not be worked out"),
        (400.0, (390.0, 410.0), replace(GOOD, excitation=1e-16), "unidentifiable", "nothing moves"),
        (
            400.0,
            (390.0, 410.0),
            replace(GOOD, caution="another model predicts better"),
            "weak",
            "another model",
        ),
    ],
)
def test_verdicts(
    value: float, interval: tuple[float, float], evidence: Evidence, verdict: str, part: str
) -> None:
    found, reason, advice = judge("left", "pitch", "stiffness", value, interval, evidence)
    assert found == verdict
    assert part in reason
    assert (advice is None) == (verdict == "usable")
    if part == "negative":
        assert advice == SIGNS
    else:
        assert advice is None or ("left foot" in advice and "forward and backward" in advice)


@pytest.mark.parametrize(
    ("change", "inside", "outside", "verdicts"),
    [
        ("half", 0.149, 0.151, ("usable", "weak")),
        ("half", 0.499, 0.501, ("weak", "unidentifiable")),
        ("seconds", 10.1, 9.9, ("usable", "weak")),
        ("seconds", 3.1, 2.9, ("weak", "unidentifiable")),
        ("explained", 0.81, 0.79, ("usable", "weak")),
        ("explained", 0.31, 0.29, ("weak", "unidentifiable")),
        ("leaning", 0.049, 0.051, ("usable", "weak")),
        ("excitation", 1.1e-7, 0.9e-7, ("usable", "unidentifiable")),
    ],
)
def test_verdicts_turn_where_the_page_says(
    change: str, inside: float, outside: float, verdicts: tuple[str, str]
) -> None:
    """One step over each edge, all else as good as it may be; of both signs where the width is meant."""
    for size, verdict in zip((inside, outside), verdicts, strict=True):
        half = size if change == "half" else 0.01
        evidence = GOOD if change == "half" else replace(GOOD, **{change: size})
        interval = (400.0 * (1 - half), 400.0 * (1 + half))
        assert judge("left", "pitch", "stiffness", 400.0, interval, evidence)[0] == verdict, size


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_further_terms_may_be_twice_as_wide(sign: float) -> None:
    ends = [
        tuple(sorted((sign * 2.0 * (1 - half), sign * 2.0 * (1 + half))))
        for half in (0.299, 0.301, 0.99, 1.01)
    ]
    verdicts = [judge_term(sign * 2.0, (low, high), GOOD)[0] for low, high in ends]
    assert verdicts == ["usable", "weak", "weak", "unidentifiable"]


def test_damping_asks_for_faster_motion() -> None:
    wide = (1.0, 39.0)
    _, _, slow = judge("left", "roll", "stiffness", 20.0, wide, GOOD)
    _, _, fast = judge("left", "roll", "damping", 20.0, wide, GOOD)
    assert "slowly" in str(slow)
    assert "faster" in str(fast)


def test_a_window_leaves_out_what_is_beyond_it(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    log = record(sway())
    wide = identify_feet(robot, [log])
    narrow = identify_feet(robot, [log], settings=FeetSettings(window=np.radians(1.0)))
    reasons = {phase.reason for phase in narrow.phases}
    assert any(reason and "beyond the window of 1 deg" in reason for reason in reasons)
    served = [sum(p.end - p.start for p in found.phases if p.used) for found in (wide, narrow)]
    assert 0.05 * served[0] < served[1] < 0.9 * served[0]
    assert narrow.parameter("left", "pitch", "stiffness").value == pytest.approx(420.0, rel=1e-3)


def test_a_pressure_near_the_edge_is_left_out(tmp_path: Path) -> None:
    """The same motion over a sole of half the length: its centre of pressure leaves it."""
    entry = robot_entry()
    assert isinstance(entry["feet"], dict)
    for foot in entry["feet"].values():
        foot["sole"]["polygon"] = [[0.03, 0.08], [-0.03, 0.08], [-0.03, -0.08], [0.03, -0.08]]
    found = identify_feet(make_robot(tmp_path, feet=entry["feet"]), [record(sway())])
    tipping = [phase for phase in found.phases if phase.reason and "tipping" in phase.reason]
    assert {phase.foot for phase in tipping} == set(FEET)
    assert sum(phase.end - phase.start for phase in tipping) > 1.0


def test_real_mats_soften_with_their_layers(shared_data: Path) -> None:
    """Firm floor, then one and three layers of mat: pitch stiffness falls, roll is not to be trusted."""
    robot = load_robot(shared_data / "icub_mats" / "robot.yaml")
    stiffness = []
    for name in ("firm", "mat_1_layer", "mat_3_layers"):
        found = identify_feet(robot, [open_log(shared_data / "icub_mats" / f"{name}.csv", robot)])
        stiffness.append(found.parameter("right", "pitch", "stiffness").value)
        assert found.parameter("right", "roll", "stiffness").verdict != "usable"
        assert any(phase.reason and "tipping" in phase.reason for phase in found.phases)
    assert None not in stiffness
    assert stiffness[0] > stiffness[1] > stiffness[2] > 0


@pytest.mark.parametrize("name", ["firm", "mat_1_layer", "mat_3_layers"])
def test_real_mats_do_not_change_with_the_window(name: str, shared_data: Path) -> None:
    """From 1 to 4 degrees: a fit of all that moves would fall tenfold."""
    robot = load_robot(shared_data / "icub_mats" / "robot.yaml")
    log = open_log(shared_data / "icub_mats" / f"{name}.csv", robot)
    rows = [
        identify_feet(robot, [log], settings=FeetSettings(window=window and np.radians(window))).parameter(
            "right", "pitch", "stiffness"
        )
        for window in (None, 1.0, 4.0)
    ]
    for row in rows:
        assert row.value == pytest.approx(rows[0].value, rel=0.1)
        assert row.interval95 is not None
        low, high = row.interval95
        assert low < rows[0].value < high


def test_still_axes_are_not_judged_by_moving_ones(tmp_path: Path) -> None:
    """Pitch moves, roll hardly: roll's numbers are not called usable under noise."""
    still = sines((1e-5, 0.3, 0.0))
    motion = sway()
    ankles = {foot: (motion.ankles[foot][0], still) for foot in FEET}
    log = record(sway(torso=(still, motion.torso[1], sines((0.0, 0.0, 0.0))), ankles=ankles))
    random = np.random.default_rng(0)
    noisy = log.with_columns(
        {n: v + random.normal(0, 0.2, len(log)) for n, v in log.columns.items() if "torque" in n}
    )
    found = identify_feet(make_robot(tmp_path), [noisy])
    for foot in FEET:
        assert found.parameter(foot, "pitch", "stiffness").verdict == "usable"
        assert found.parameter(foot, "roll", "stiffness").verdict == "unidentifiable"


def test_a_motion_that_contradicts_the_others_makes_numbers_weak() -> None:
    missed = ValidationRow("direct", "tilt", "left", "pitch", 4.1, 4.1, 9.2, 1.0, 2.3, 1000)
    evidence = Evidence(60.0, 0.02, 0.97, contradicted=missed, lag=0.0)
    verdict, reason, advice = judge("left", "pitch", "stiffness", 480.0, (475.0, 485.0), evidence)
    assert verdict == "weak"
    assert "tilt" in reason
    assert advice is not None
    assert "encoders" in advice


def test_a_memory_that_goes_through_a_long_lean_is_weak() -> None:
    evidence = Evidence(60.0, 0.02, 0.99, leaning=0.14, lag=0.0)
    verdict, reason, advice = judge("left", "pitch", "stiffness", 480.0, (475.0, 485.0), evidence)
    assert verdict == "weak"
    assert "leans for 14 %" in reason
    assert advice is not None
    assert "inside the sole" in advice
    short = Evidence(60.0, 0.02, 0.99, leaning=0.02, lag=0.0)
    assert judge("left", "pitch", "stiffness", 480.0, (475.0, 485.0), short)[0] == "usable"


@pytest.mark.parametrize(("noise", "verdict"), [(0.99 * NOISY, "usable"), (1.01 * NOISY, "weak")])
def test_noise_of_the_angle_that_is_no_small_part_of_the_slip_angle(noise: float, verdict: str) -> None:
    """It turns an element where nothing slips: spring and element take from each other."""
    noisy = replace(GOOD, noise=noise)
    told = [
        judge("left", "roll", "stiffness", 400.0, (390.0, 410.0), noisy),
        judge_term(2.0, (1.9, 2.1), noisy),
    ]
    assert [one[0] for one in told] == [verdict, verdict]
    if verdict == "weak":
        assert all("13 % of the slip angle" in one[1] for one in told)


def test_what_spring_and_element_may_have_taken_from_each_other_holds_for_both() -> None:
    unsure = replace(GOOD, caution="hardly turned round")
    assert judge_term(2.0, (1.9, 2.1), unsure) == ("weak", "hardly turned round", None)
    assert judge_term(2.0, (-0.1, 4.1), unsure)[0] == "unidentifiable"
    assert judge_term(2.0, (1.9, 2.1), GOOD)[0] == "usable"

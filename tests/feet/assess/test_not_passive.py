"""Numbers that no bush can have, and terms that are hardly known, are not called usable."""

from __future__ import annotations

from dataclasses import replace

import pytest

from biped import TRUTH, record, sway
from biped_robot import FEET
from feet_trials import AXES, LINEAR, noisy
from plantar.feet.assess.verdicts import Evidence, judge, judge_term
from plantar.feet.identify import identify_feet
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel


def test_a_stiffness_beside_negative_damping_is_weak() -> None:
    evidence = Evidence(seconds=60.0, excitation=0.02, explained=0.98, lag=0.02)
    verdict, reason, advice = judge("left", "pitch", "stiffness", 400.0, (390.0, 410.0), evidence)
    assert verdict == "weak"
    assert "damping is negative" in reason
    assert advice is not None


@pytest.mark.parametrize(
    ("half_width", "verdict"),
    [
        (0.2, "usable"),
        (0.28, "usable"),
        (0.32, "weak"),
        (0.4, "weak"),
        (0.99, "weak"),
        (1.01, "unidentifiable"),
    ],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_further_term_is_judged_by_its_width(half_width: float, verdict: str, sign: float) -> None:
    """Twice as wide as stiffness and damping may be; it may be negative, if not zero."""
    ends = sorted((sign * 5000.0 * (1 - half_width), sign * 5000.0 * (1 + half_width)))
    assert judge_term(sign * 5000.0, (ends[0], ends[1]), Evidence(60.0, 0.02, 0.98, lag=0.0))[0] == verdict


def identified(robot: RobotModel, damping: float) -> FeetResult:
    truth = {key: replace(law, damping=damping) for key, law in TRUTH.items()}
    log = noisy(record(sway("sway", 3, truth=truth)), 3)
    return identify_feet(robot, [log], settings=LINEAR)


def test_negative_damping_beyond_doubt_spoils_the_stiffness_too(robot: RobotModel) -> None:
    found = identified(robot, -4.0)
    for foot in FEET:
        for axis in AXES:
            assert found.parameter(foot, axis, "damping").verdict == "unidentifiable"
            stiffness = found.parameter(foot, axis, "stiffness")
            assert stiffness.verdict == "weak"
            lag = -1e3 * found.parameter(foot, axis, "damping").value / stiffness.value
            assert f"damping is negative, as of a torque read {lag:.0f} ms late or more" in stiffness.reason


def test_damping_that_may_be_zero_does_not(robot: RobotModel) -> None:
    """A bush that hardly damps: its damping reaches zero, and its spring is as good as any."""
    found = identified(robot, 0.0)
    for foot in FEET:
        for axis in AXES:
            damping = found.parameter(foot, axis, "damping")
            assert damping.value + 2 * damping.std > 0 > damping.value - 2 * damping.std
            assert damping.verdict == "unidentifiable"
            assert found.parameter(foot, axis, "stiffness").verdict == "usable"

"""What a user reads of a verdict, a limit and a contradiction: every number in its unit, by value."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.feet.assess.contradiction import missed_motions
from plantar.feet.assess.diagnosis import REMEDY, share_of
from plantar.feet.assess.verdicts import LATE, SIGNS, Evidence, judge, judge_term
from plantar.feet.place.place_notes import far_arms
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt
from plantar.results.feet_rows import ValidationRow

GOOD = Evidence(seconds=63.4, excitation=np.radians(1.26), explained=0.98, lag=0.0)
NARROW = (390.0, 410.0)
MISSED = ValidationRow("direct", "Tilt3", "left", "pitch", 1.26, 2.0, 30.0, 4.0, 2.52, 900)
SLOWLY = "slowly and by some degrees, at 0.1 to 0.5 Hz, for 30 s or more, without lifting the sole's edge"
SWAY = f"sway the robot forward and backward with its weight on the left foot, {SLOWLY}"
GAVE = "the motion gave 1.3 deg rms of pitch"
TIPS = "as where a sole tips whose outline (sole: polygon) is told too large"
SOFT = f"the spring loses 31 % of its slope as it bends, {TIPS}"
OF = "of the torque's variance"
NO, WEAK, YES = "unidentifiable", "weak", "usable"
LARGER = "sway the robot forward and backward with its weight on the left foot, by larger angles"


def with_(**change: object) -> Evidence:
    return replace(GOOD, **change)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("interval", "evidence", "said"),
    [
        (NARROW, GOOD, (YES, "95 % interval ±2.5 %, 63 s used", None)),
        ((340.0, 460.0), GOOD, (YES, "95 % interval ±15 %, 63 s used", None)),
        ((330.0, 470.0), GOOD, (WEAK, f"the 95 % interval is ±18 %; {GAVE}", SWAY)),
        ((100.0, 700.0), GOOD, (NO, f"the 95 % interval is ±75 %; {GAVE}", SWAY)),
        ((0.0, 800.0), GOOD, (NO, f"the 95 % interval reaches zero; {GAVE}", SWAY)),
        (NARROW, with_(excitation=np.radians(5e-6)), (
            NO, "nothing moves: 5e-06 deg rms of pitch", SWAY)),
        (NARROW, with_(seconds=2.96), (NO, "only 3.0 s of samples can be used", SWAY)),
        (NARROW, with_(explained=0.256), (NO, f"the model explains 26 % {OF}", SWAY)),
        (NARROW, with_(explained=-0.3), (NO, f"the model explains 0 % {OF}", SWAY)),
        (NARROW, with_(explained=0.756), (WEAK, f"the model explains only 76 % {OF}", SWAY)),
        (NARROW, with_(seconds=9.96), (
            WEAK, "only 10.0 s of samples are used, too short to tell slow drift from the foot "
            "(valid: 10 s or more)", SWAY)),
        (NARROW, with_(lag=0.0486), (
            WEAK, "damping is negative, as of a torque read 49 ms late or more: something other than the bush "
            "contributes to this torque", LATE)),
        (NARROW, with_(contradicted=MISSED), (
            WEAK, "misses Tilt3 by 1.3 N.m on average, where a constant misses by 2.5 (both beside slow drift), "
            "although the model holds in other motions",
            "check in Tilt3 the encoders between IMU and foot, and whether anything touched the robot")),
        (NARROW, with_(leaning=0.126), (
            WEAK, "the sole leans for 13 % of the time, where hysteresis cannot be followed",
            f"{SWAY}: the centre of pressure has to stay inside the sole")),
        (NARROW, with_(softened=0.31), (
            WEAK, SOFT, "measure the left sole's outline for the robot file, or sway by smaller angles")),
        (NARROW, with_(softened=0.29), (YES, "95 % interval ±2.5 %, 63 s used", None)),
        (NARROW, with_(noise=0.131), (
            WEAK, "the angle's noise may be 13 % of the slip angle, and hysteresis depends on the angle itself",
            "use an attitude that wanders less: beside its errors the slip angle is small in any motion")),
        (NARROW, with_(noise=0.129), (YES, "95 % interval ±2.5 %, 63 s used", None)),
        (NARROW, with_(caution="because"), (WEAK, "because", LARGER)),
    ],
)  # fmt: skip
def test_a_verdict_s_words(
    interval: tuple[float, float], evidence: Evidence, said: tuple[str, str, str | None]
) -> None:
    assert judge("left", "pitch", "stiffness", 400.0, interval, evidence) == said


def test_a_negative_number_and_other_axes() -> None:
    """Negative only where the whole interval is; each axis and term has its own motion."""
    assert judge("left", "roll", "damping", -9.0, (-20.0, 0.0), GOOD)[1:] == (
        "damping is negative: something other than the bush produces this torque",
        SIGNS,
    )
    assert judge("left", "roll", "damping", -9.0, (-20.0, 0.0), with_(lag=0.0486))[1:] == (
        "damping is negative, as of a torque read 49 ms late or more: something other than the bush produces this "
        "torque",
        LATE,
    )
    assert judge("left", "roll", "damping", -9.0, (-20.0, 2.0), GOOD)[:2] == (
        "unidentifiable", "the 95 % interval reaches zero; the motion gave 1.3 deg rms of roll"
    )  # fmt: skip
    assert judge("right", "roll", "damping", 9.0, (-1.0, 19.0), GOOD)[2] == (
        "sway the robot left and right with its weight on the right foot, faster, at 0.3 to 1 Hz, for 30 s or more, "
        "without lifting the sole's edge"
    )
    assert str(judge("right", "z", "stiffness", 9.0, (-1.0, 19.0), GOOD)[2]).startswith(
        "shift the weight from foot"
    )


@pytest.mark.parametrize(
    ("value", "interval", "evidence", "said"),
    [
        (2.0, (1.5, 2.5), GOOD, ("usable", "95 % interval ±25 %", None)),
        (-2.0, (-2.5, -1.5), GOOD, ("usable", "95 % interval ±25 %", None)),
        (2.0, (1.3, 2.7), GOOD, ("weak", "95 % interval ±35 %", None)),
        (2.0, (0.0, 4.0), GOOD, ("unidentifiable", "the 95 % interval reaches zero", None)),
        (0.0, (1.0, 2.0), GOOD, ("unidentifiable", "the 95 % interval reaches zero", None)),
        (2.0, (1.5, 2.5), replace(GOOD, softened=0.31), ("weak", SOFT, None)),
    ],
)
def test_a_further_term_s_words(
    value: float, interval: tuple[float, float], evidence: Evidence, said: tuple[str, str, str | None]
) -> None:
    assert judge_term(value, interval, evidence) == said


def test_doubts_in_their_order() -> None:
    assert str(replace(GOOD, softened=0.5, noise=0.5, caution="c").doubt).startswith("the spring loses 50 %")
    assert str(replace(GOOD, noise=0.5, caution="c").doubt).startswith("the angle's noise may be 50 %")
    assert replace(GOOD, caution="c").doubt == "c"
    assert GOOD.doubt is None


@pytest.mark.parametrize(
    ("share", "said"), [(0.899, "90 % of its variance from delay"), (0.901, "nearly all of it from delay"),
                        (0.346, "35 % of its variance from delay")],
)  # fmt: skip
def test_a_cause_s_share_in_words(share: float, said: str) -> None:
    assert share_of("delay", {"delay": share, "noise": 1 - share}) == said
    assert "delay" in REMEDY


@pytest.mark.parametrize(
    ("held", "error", "torque", "missed"),
    [(0.29, 0.51, 0.11, 1), (0.31, 0.51, 0.11, 0), (0.29, 0.49, 0.11, 0), (0.29, 0.51, 0.09, 0)],
)
def test_a_motion_that_is_missed_loads_the_axis_and_another_holds(
    held: float, error: float, torque: float, missed: int
) -> None:
    """`held`, `error`: mean errors over that of a constant; `torque`: over that of the liveliest motion."""
    lively = replace(MISSED, motion="lively", zero_mean_abs=10.0, mean_abs_error=10.0 * held)
    other = replace(MISSED, zero_mean_abs=10.0 * torque, mean_abs_error=10.0 * torque * error)
    nothing = replace(MISSED, zero_mean_abs=0.0, mean_abs_error=1.0)
    assert missed_motions([lively, other, nothing]) == [other] * missed
    assert missed_motions([nothing]) == []


@pytest.mark.parametrize(
    ("axis", "arms", "said"),
    [("pitch", (-0.0412, 0.0), "left pitch 41 mm forward or backward"),
     ("roll", (0.0412, 0.0), "left roll 41 mm to the side"),
     ("roll", (0.0, -0.0412), "left roll 41 mm above or below"), ("roll", (0.039, 0.039), None)],
)  # fmt: skip
def test_an_arm_in_millimetres(axis: str, arms: tuple[float, float], said: str | None) -> None:
    fit = AxisFit(
        foot="left", axis=axis, model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),  # type: ignore[arg-type]
        covariance=np.eye(2), freedom=np.full(2, 30.0), white_std=np.ones(2), offset_std={}, equivalent=(400.0, 20.0),
        choice=None, reason="", moment_arms=arms,
    )  # fmt: skip
    notes = far_arms([fit])
    assert len(notes) == (said is not None)
    assert not notes or f"robot file: {said}. Corrected" in notes[0].text

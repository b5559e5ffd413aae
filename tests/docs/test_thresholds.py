"""Limits that a page tells its readers are those of the code: a changed threshold changes what users were promised."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from plantar.contact import phases, slip_indicator, stances
from plantar.design import information, reach, soles
from plantar.design.rehearsals import attempt
from plantar.estimation import residual_covariance, slow_drift, stance_least_squares
from plantar.feet.assess import verdicts
from plantar.feet.exclusion import edge_rolling, moved_edges
from plantar.feet.interval_width import slip_angle, systematic
from plantar.feet.place import place_notes, spread
from plantar.model_selection import cross_validation, selection
from plantar.motions import gait
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors import attitude_scale
from plantar.sensors.delays import lagged_log
from plantar.sensors.moments import law_rows, moment_fit

DOCS = Path(__file__).resolve().parents[2] / "docs"
WORDS = {3: "three", 5: "five"}
CM, DEGREES = 100 * place_notes.FARTHEST[0], np.degrees(place_notes.FARTHEST[2])
SOLES = 1e3 * soles.EDGE, 1e3 * attempt.KEPT


@cache
def page(name: str) -> str:
    """A page's text in one line, its marks of emphasis taken out."""
    return re.sub(r"\s+", " ", (DOCS / name).read_text().replace("*", ""))


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("why_did_my_fit_fail.md", f"less than {verdicts.LEAST_SECONDS:g} s are left"),
        (
            "why_did_my_fit_fail.md",
            f"{verdicts.LEAST_SECONDS:g} to {verdicts.SHORT_SECONDS:g} s: the interval rests",
        ),
        ("why_did_my_fit_fail.md", f"beyond {CM:.0f} cm or {DEGREES:.0f} deg no longer trusted"),
        ("why_did_my_fit_fail.md", f"some sensor is later than {1e3 * lagged_log.SEARCHED:.0f} ms"),
        ("why_did_my_fit_fail.md", f"allows for ±{1e3 * 1.96 * Uncertainty().wrench_delay:.0f} ms (95 %)"),
        ("intervals.md", f"lowest cosines, up to {residual_covariance.SCORE_BANDWIDTH:.1f} Hz"),
        ("intervals.md", f"(one chance in {1 / moment_fit.CHANCE:.0f})"),
        ("intervals.md", f"Only what is slower than {law_rows.BAND:.0f} Hz is asked"),
        ("intervals.md", f"({1e3 * spread.GUESSED:.0f} mm for a line marked GUESS)"),
        ("intervals.md", f"From {WORDS[stance_least_squares.FEWEST_RECORDINGS]} recordings on, refits"),
        ("intervals.md", f"cosines of {slow_drift.DRIFT_PERIOD:.0f} s and longer"),
        ("put_right.md", f"From {100 * attitude_scale.SCALE_OFF:.0f} % on, and six deviations"),
        ("left_out.md", f"certain at one sample ({slip_indicator.SURE:g} deviations)"),
        (
            "left_out.md",
            f"possible ({slip_indicator.POSSIBLE:g} deviations and {1e3 * slip_indicator.LEAST_SPEED:g} mm/s), "
            f"covers {1e3 * slip_indicator.LEAST_PATH:g} mm, and friction above a twentieth",
        ),
        ("left_out.md", f"further inside, by up to {100 * moved_edges.MISPLACED:g} cm"),
        ("left_out.md", f"turns on by {1e3 * moved_edges.LEAST_PLATEAU:g} mrad or more"),
        (
            "left_out.md",
            f"changes above {phases.SHAKING_BAND:g} Hz by more than {100 * phases.SHAKING_SHARE:g} % of the weight",
        ),
        ("left_out.md", f"{1e3 * edge_rolling.LEAST_LEAN:g} mrad for a lean"),
        (
            "walking.md",
            f"has {WORDS[stances.FEWEST_STANCES]} stances or more that usually last less than "
            f"{stances.LONGEST_STANCE:g} s",
        ),
        ("walking.md", f"{100 * systematic.SLOPE_UNSURE:g} % of the element's slope"),
        (
            "walking.md",
            f"{100 * systematic.ELEMENT_UNSURE:g} % of its slip torque and of the damping beside it, and "
            f"no slip angle is known better than to {100 * slip_angle.UNRESOLVED_IN_STEPS:g} %",
        ),
        ("walks.md", f"`--period` ({gait.SHORTEST:g} to {gait.LONGEST:g} s)"),
        ("walks.md", f"about {gait.WALKING:g} s of steps"),
        ("walks.md", f"`WalkTurn` | {gait.TURN_STEP:g} m, {np.degrees(gait.TURN):.0f}° to the left"),
        ("bush_models.md", f"rms error is at least {100 * selection.LEAST_GAIN:.0f} % lower"),
        (
            "bush_models.md",
            f"at least {WORDS[cross_validation.FEWEST_RECORDINGS]} and none has more than half of the motion, else "
            "contiguous fifths",
        ),
        ("how_to/design.md", f"no bush bends by more than {reach.BEND:g} rad"),
        (
            "how_to/design.md",
            f"stiffness within {100 * information.WANTED[0]:g} %, damping within {100 * information.WANTED[1]:g} %, "
            f"the delay of the force sensors within {1e3 * information.WANTED_DELAY:g} ms, the vertical compliance of "
            f"both feet together within {100 * information.WANTED_VERTICAL:g} %",
        ),
        ("how_to/design.md", f"with {SOLES[0]:g} mm to the border"),
        (
            "how_to/design.md",
            f"must stay {SOLES[1]:g} mm inside the soles, horizontal forces below {reach.FRICTION:g} of vertical ones, "
            f"and torques below {attempt.EFFORT:g} of the URDF's limits",
        ),
    ],
)
def test_a_page_tells_the_limits_of_the_code(name: str, said: str) -> None:
    assert said in page(name)


def test_what_pages_say_in_words() -> None:
    """A twentieth of the load, a tenth of a stance, six deviations."""
    assert "friction above a twentieth of the load" in page("left_out.md")
    assert slip_indicator.SMOOTH == 1 / 20
    assert "A tenth of a stance at landing and at lifting is left out" in page("walking.md")
    assert phases.SETTLING_SHARE == systematic.STANCE_END == 1 / 10
    assert attitude_scale.SURE == 6
    assert (cross_validation.DOMINANT, cross_validation.FOLDS) == (1 / 2, 5)
    assert "at most four fifths of their way and of their speed" in page("how_to/design.md")
    assert reach.ROOM == 4 / 5

"""Why samples are left out, as users read it, and small parts of how slides are told: by hand."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.contact.phases import hoisted_note, joined, widened
from plantar.contact.reasons import EDGES, TIPPING, LeftOut, Reason
from plantar.contact.slip_indicator import SlipIndicator, _largest_around, as_usual, usual_deviation
from plantar.notes import Note

TEXTS = {
    Reason.IN_THE_AIR: "in the air: no load on this foot",
    Reason.NOT_RECORDED: "not recorded: NaN, a gap or a channel that stands still, in a column that this foot needs",
    Reason.SETTLING: "landing or lifting: just after or before a change of contact",
    Reason.IMPACT: "impact: the force changes faster than the sampling rate can resolve, as when the sole hits the "
    "floor",
    Reason.FILTER_EDGE: "filter's edge",
    Reason.WINDOW: "beyond the window of 0.1 rad",
    Reason.TORQUE_SATURATION: "tipping: the torque stops growing, 0.1 rad",
    Reason.ON_THE_EDGE: "tipping: the centre of pressure is at the sole's edge and the foot turns further than its "
    "bush",
    Reason.OUTSIDE_THE_SOLE: "tipping: the centre of pressure is outside the sole",
    Reason.NEAR_THE_EDGE: "tipping: the centre of pressure is near the sole's edge, where leaning cannot "
    "be told from flat",
    Reason.BESIDE_TIPPING: "filter's edge: beside a sole that tips",
    Reason.SOLES_APART: "slip: the soles move against each other",
    Reason.SOLE_TURNS: "slip: the sole turns on the floor",
    Reason.SOLE_SLIDES: "slip: the sole moves over the floor",
    Reason.OUTLIER: "outlier: the 0.1 rad torque is far from its model for a short time",
    Reason.SET_ASIDE: "set aside for a first fit",
}


def test_every_reason_in_words() -> None:
    assert {reason: LeftOut(reason, "0.1 rad").text for reason in Reason} == TEXTS
    tips = {reason for reason, text in TEXTS.items() if text.startswith("tipping")}
    assert tips == TIPPING
    assert {Reason.TORQUE_SATURATION} == TIPPING - EDGES


def test_a_robot_that_a_rope_holds_in_words() -> None:
    """Two samples of five, in a log of 8 s that begins at 3 s."""
    time, held = np.array([3.0, 5.0, 7.0, 9.0, 11.0]), np.array([False, False, True, True, False])
    text = (
        "log: for 3.2 s, first at t = 7 s, the feet carry over 10 % of the weight less or more than as a rule, as "
        "where a rope or a hand holds the robot for a while or force sensors have unlike gains: left out"
    )
    assert hoisted_note("log", time, held, "left out") == Note("held_for_a_while", "info", text)


def test_stretches_grow_in_front_and_behind_and_join_over_short_gaps() -> None:
    samples = np.array([0, 0, 0, 1, 1, 0, 0, 0, 0, 1], dtype=bool)
    assert np.flatnonzero(widened(samples, 1)).tolist() == [2, 3, 4, 5, 8, 9]
    assert np.flatnonzero(widened(samples, 1, 2)).tolist() == [2, 3, 4, 5, 6, 8, 9]
    assert np.flatnonzero(widened(samples, 9, 0)).tolist() == list(range(10))
    assert np.flatnonzero(joined(samples, 3)).tolist() == [3, 4, 9]
    assert np.flatnonzero(joined(samples, 4)).tolist() == [3, 4, 5, 6, 7, 8, 9]
    ends = np.array([0, 1, 0], dtype=bool)
    assert np.flatnonzero(joined(ends, 9)).tolist() == [1], "what lies at an end is no gap"


def test_how_clear_a_speed_is_in_its_samples() -> None:
    indicator = SlipIndicator(
        np.array([9.0, 0.02, np.nan, 0.03, 9.0]), np.array([1.0, 0.005, 0.0, 0.01, 1.0])
    )
    assert indicator.clearness(slice(1, 4)) == pytest.approx(4.0)
    assert indicator.clearness(slice(2, 3)) == 0.0
    exact = SlipIndicator(np.array([2e-6]), np.array([0.0]))
    assert exact.clearness(slice(0, 1)) == pytest.approx(2.0), "less than a micrometre a second is no noise"


def test_the_usual_speed_of_noise_is_four_fifths_of_a_plane_vectors() -> None:
    """Half of the samples slide, or are not known: of white noise 80 % of the lengths are below 1.794 deviations."""
    random = np.random.default_rng(0)
    noise = np.hypot(*random.normal(0, 0.003, (2, 40_000)))
    assert usual_deviation(noise) == pytest.approx(0.003, rel=0.02)
    assert usual_deviation(np.append(noise, np.full(9, np.nan))) == usual_deviation(noise)
    assert usual_deviation(np.full(3, np.nan)) == 0.0
    np.testing.assert_array_equal(as_usual(noise).deviation, np.full(40_000, usual_deviation(noise)))


@pytest.mark.parametrize("reach", [0, 1, 2, 3])
def test_the_largest_value_up_to_some_samples_away(reach: int) -> None:
    values = np.array([3.0, 1.0, 0.0, 0.0, 7.0, 2.0, 2.0, 5.0])
    expected = [max(values[max(0, k - reach) : k + reach + 1]) for k in range(8)]
    assert _largest_around(values, reach).tolist() == expected

"""A foot that steps is told from one that stands, and its samples weigh as its load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.contact.phases import SUPPORTS, detect_contact
from plantar.contact.reasons import TIPPING, LeftOut, Reason
from plantar.contact.stances import Stances, stances_of, without_rolling

PERIOD, WEIGHT = 0.01, 600.0


def steps(seconds: float, count: int) -> np.ndarray:
    """Vertical force (N,) of `count` stances of so many seconds, each with ramps, and as long in the air."""
    time = np.arange(0, 2 * seconds * count, PERIOD)
    phase = np.mod(time, 2 * seconds) / seconds
    return np.where(phase < 1, WEIGHT * np.clip(8 * np.minimum(phase, 1 - phase), 0, 1), -20.0)


def contact_of(force: np.ndarray):
    return detect_contact({"left": force}, {"left": False}, WEIGHT, PERIOD)["left"]


def test_each_stance_of_a_walk_has_its_number() -> None:
    force = steps(1.0, 6)
    stances = stances_of(contact_of(force), force, WEIGHT, PERIOD)
    assert stances is not None
    assert stances.count == 6
    assert np.all(stances.number[force < 0] == -1)
    assert list(np.unique(stances.number)) == [-1, 0, 1, 2, 3, 4, 5]


def test_a_sample_weighs_as_its_foot_carries() -> None:
    force = steps(1.0, 6)
    stances = stances_of(contact_of(force), force, WEIGHT, PERIOD)
    assert stances is not None
    assert stances.weight == pytest.approx(np.clip(force / WEIGHT, 0, 1))


@pytest.mark.parametrize(("seconds", "count"), [(1.0, 2), (8.0, 5)])
def test_few_or_long_stances_are_no_walk(seconds: float, count: int) -> None:
    force = steps(seconds, count)
    assert stances_of(contact_of(force), force, WEIGHT, PERIOD) is None


def test_short_stances_settle_faster_than_long_ones() -> None:
    """Long stances lose a quarter of a second at either end, short ones a tenth of themselves."""
    transition = SUPPORTS.index("transition")
    for seconds, expected in ((1.0, 0.1), (6.0, 0.25)):
        contact = contact_of(
            np.concatenate([np.zeros(50), np.full(int(seconds / PERIOD), WEIGHT), np.zeros(50)])
        )
        lost = PERIOD * np.sum(contact.support == transition)
        assert lost == pytest.approx(2 * expected, abs=2 * PERIOD)


def test_leaving_out_gives_a_new_contact_and_keeps_the_first_reason() -> None:
    contact = contact_of(steps(1.0, 6))
    before, samples = contact.used.copy(), np.zeros(len(contact.code), dtype=bool)
    samples[30:60] = True
    less = contact.without(samples, Reason.OUTSIDE_THE_SOLE).without(samples, Reason.OUTLIER, "pitch")
    assert np.array_equal(contact.used, before)
    assert not less.used[samples].any()
    assert np.array_equal(less.left_out_for(TIPPING), samples & before)
    assert not less.left_out_for({Reason.OUTLIER}).any()
    assert (
        LeftOut(Reason.OUTLIER, "roll").text
        == "outlier: the roll torque is far from its model for a short time"
    )


def test_a_long_stance_before_the_first_step_counts_as_several() -> None:
    force = np.concatenate([np.full(round(6.0 / PERIOD), WEIGHT), np.full(100, -20.0), steps(1.0, 6)])
    stances = stances_of(contact_of(force), force, WEIGHT, PERIOD)
    assert stances is not None
    first = stances.number[: round(6.0 / PERIOD)]
    assert list(np.unique(first)) == [0, 1, 2]
    assert stances.count == 3 + 6


def test_what_rolls_on_the_outline_at_either_end_belongs_to_no_stance() -> None:
    force = steps(1.0, 6)
    stances = stances_of(contact_of(force), force, WEIGHT, PERIOD)
    assert stances is not None
    sole = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    rows = np.flatnonzero(stances.number == 2)
    cop = np.zeros((len(force), 2))
    cop[rows[:5], 0] = -0.099  # the heel strikes
    cop[rows[-3:]] = np.nan  # too light for a centre of pressure
    cop[rows[40:45], 0] = 0.099  # in the middle of a stance the toe is loaded, and nothing is cut
    flat = without_rolling(stances, cop, sole)
    assert list(np.flatnonzero(flat.number == 2)) == list(rows[5:-3])
    others = stances.number != 2
    assert np.array_equal(flat.number[others], stances.number[others])
    assert np.array_equal(flat.weight, stances.weight)
    cop[rows] = [-0.099, 0.0]  # a foot that stays on its heel keeps all but a tenth at either end
    kept = np.flatnonzero(without_rolling(stances, cop, sole).number == 2)
    assert len(kept) == len(rows) - 2 * int(0.1 * len(rows))


def test_readings_of_a_sensor_that_repeats_its_values_count_once() -> None:
    force = steps(1.0, 6)
    stances = stances_of(contact_of(force), force, WEIGHT, PERIOD)
    assert stances is not None
    wrench = np.random.default_rng(0).standard_normal((len(force), 6))
    whole = np.median(np.bincount(stances.number[stances.number >= 0]))
    assert stances.readings(wrench) == whole
    held = np.repeat(wrench[::10], 10, axis=0)[: len(wrench)]
    assert stances.readings(held) == pytest.approx(whole / 10, abs=1)
    assert replace(stances, number=np.full(len(force), -1)).readings(wrench) == 0


def test_a_foot_that_stays_in_the_air_has_no_stance() -> None:
    assert Stances(np.full(5, -1), np.zeros(5)).count == 0
    assert Stances(np.array([-1, 0, 0, 2]), np.zeros(4)).count == 3

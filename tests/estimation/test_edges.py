"""Limits and deviations of the estimators beside numbers worked out by hand: tones, drift columns, stances, shares."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.fft import dct
from scipy.stats import t as student

from plantar.conventions import Array
from plantar.estimation.blocks import Block, StanceRows
from plantar.estimation.delays.bands import banded
from plantar.estimation.delays.delay import Delay, Pair, closes, estimate_delay, unexplained
from plantar.estimation.delays.sensor_delays import Balance, estimate_delays
from plantar.estimation.errors_in_variables import attenuation, noise_after_filter, offsets_moved
from plantar.estimation.random_effects import Differences, share_between
from plantar.estimation.residual_covariance import pooled_freedom, relative_std_percent, score_cosines
from plantar.estimation.slow_drift import drift_basis, drift_beside
from plantar.estimation.stance_problem import StanceProblem, _scaled_inverse
from plantar.estimation.triangular import TriangularFactor
from plantar.estimation.weighted_mean import weighted_mean

PERIOD = 0.01
TIME = PERIOD * np.arange(4000)


def tone(hertz: float, late: float = 0.0, phase: float = 0.0) -> Array:
    return np.sin(2 * np.pi * hertz * (TIME - late) + phase)


def rate_of(hertz: float, late: float = 0.0) -> Array:
    return 2 * np.pi * hertz * tone(hertz, late, np.pi / 2)


def pair(hertz: float = 0.55, late: float = 0.0, torque: Array | None = None) -> Pair:
    """Six axes that read one tone, `late` [s]; the torque about x may read something else."""
    measured, rate, predicted = (
        np.tile(one[:, None], 6) for one in (tone(hertz, late), rate_of(hertz, late), tone(hertz))
    )
    if torque is not None:
        measured[:, 3], rate[:, 3] = torque, np.gradient(torque, PERIOD)
    return Pair("tone", measured, rate, predicted, PERIOD)


def taking_part(torque: Array, hertz: float = 0.55) -> bool:
    """Whether the torque about x is asked in every band in which the five others are."""
    whole, found = estimate_delay([pair(hertz)]), estimate_delay([pair(hertz, torque=torque)])
    assert whole is not None
    assert found is not None
    assert found.cells in (whole.cells, whole.cells * 5 // 6)
    return found.cells == whole.cells


@pytest.mark.parametrize(("gain", "asked"), [(0.79, False), (0.81, True), (1.24, True), (1.26, False)])
def test_an_axis_is_asked_for_its_delay_where_its_gain_is_about_one(gain: float, asked: bool) -> None:
    assert taking_part(gain * tone(0.55)) == asked


@pytest.mark.parametrize(("share", "asked"), [(0.19, True), (0.21, False)])
def test_and_where_the_prediction_explains_four_fifths(share: float, asked: bool) -> None:
    """`share` of the variance is the same tone a quarter later: no filter tells one from the other."""
    torque = np.sqrt(1 - share) * tone(0.55) + np.sqrt(share) * tone(0.55, phase=np.pi / 2)
    assert taking_part(torque) == asked


@pytest.mark.parametrize(("late", "told"), [(0.047, True), (-0.047, True), (0.053, False), (-0.053, False)])
def test_later_than_fifty_milliseconds_is_no_delay(late: float, told: bool) -> None:
    found = estimate_delay([pair(0.3, late)])
    assert (found is not None) == told
    assert found is None or found.value == pytest.approx(late, rel=0.01)


def test_a_tone_s_delay_is_known_to_three_thousandths_of_its_phase() -> None:
    found = estimate_delay([pair(0.55, 0.01)])
    assert found is not None
    assert found.value == pytest.approx(0.01, rel=1e-3)
    assert found.std == pytest.approx(0.003 / (2 * np.pi * 0.55) / np.sqrt(found.cells), rel=0.03)
    assert Delay(0.0, 2.0, 4.0, 1).wide_std == pytest.approx(2 * student.ppf(0.975, 4) / 1.959964, rel=1e-4)


@pytest.mark.parametrize(("share", "found"), [(0.066, True), (0.074, False)])
def test_forces_close_where_seven_per_cent_are_missed_and_torques_do_not_count(
    share: float, found: bool
) -> None:
    one = pair(0.5)
    measured = one.measured + np.sqrt(share / (1 - share)) * tone(1.5)[:, None]
    measured[:, 3:] = 100 * tone(3.0)[:, None]
    assert closes(replace(one, measured=measured + 7.0)) == found


@pytest.mark.parametrize(("late", "missed"), [(0.049, 0.0), (0.06, 0.01), (-0.07, 0.02)])
def test_what_is_unexplained_is_what_no_delay_of_fifty_milliseconds_mends(late: float, missed: float) -> None:
    rate = np.tile(rate_of(0.5)[:, None], 6)
    predicted = np.tile(tone(0.5)[:, None], 6)
    left = unexplained(predicted - late * rate, rate, predicted)
    assert left == pytest.approx(missed**2 * np.sum(rate**2), abs=1e-6)


@pytest.mark.parametrize(
    ("period", "rows"),  # of the five bands (4000 - 2 · end) / stride, end = 2 / lower edge up to a quarter of all
    [(0.01, [(0.25, 2000, 31), (0.4, 3000, 15), (0.8, 3500, 7), (1.6, 3750, 3), (3.2, 3876, 1)]),
     (0.1, [(0.25, 3734, 3), (0.4, 3900, 1), (0.8, 3950, 1), (1.6, 3976, 1)]),
     (0.13, [(0.25, 3794, 2), (0.4, 3924, 1), (0.8, 3962, 1)]),
     (1.0, []), (2.0, [])],
)  # fmt: skip
def test_bands_are_cut_and_thinned_as_their_edges_say(
    period: float, rows: list[tuple[float, int, int]]
) -> None:
    found = list(banded(np.tile(tone(0.5)[:, None], 2), period, slice(1, 2)))
    assert [(round(width, 9), len(kept), stride) for width, kept, _, stride in found] == [
        (width, -(-count // stride), stride) for width, count, stride in rows
    ]
    assert all(rates.shape == (len(kept), 1) for _, kept, rates, _ in found)


def test_delays_that_show_nowhere_or_always_together_are_not_told() -> None:
    """Three sensors carry tones of their own; the second's delay is once that of the first, and once shows nowhere."""
    parts = [
        np.column_stack([tone(f * k) for k in (1.0, 1.3, 1.7, 2.1, 2.7, 3.3)]) for f in (0.25, 0.31, 0.37)
    ]
    rates = np.array([np.gradient(part, PERIOD, axis=0) for part in parts[:2]])
    balance = Balance(np.sum(parts, axis=0), np.array(parts), rates, PERIOD)
    assert estimate_delays([balance]) is not None
    for other in (rates[[0, 0]], rates * [[[1.0]], [[0.0]]]):
        assert estimate_delays([replace(balance, by_delay=other)]) is None
    few = [np.where(np.arange(6) < 1, part, 0.0) for part in parts]
    less = Balance(np.sum(few, axis=0), np.array(few), rates, PERIOD)
    assert 0 < len(less.cells) < 6
    assert estimate_delays([less]) is None


@pytest.mark.parametrize(("count", "most"), [(6, 5), (7, 6), (200, 4)])
def test_cosines_of_the_scores_are_the_lowest_of_a_transform(count: int, most: int) -> None:
    """As many as a length of 30 s gives, up to one less than there are samples; at least four."""
    scores = np.random.default_rng(count).normal(size=(count, 2))
    duration = 30.0 if count < 10 else 5.0
    expected = dct(scores, norm="ortho", axis=0)[1 : most + 1] * np.sqrt(count / most)
    assert score_cosines(scores, duration) == pytest.approx(expected)


def test_freedoms_deviations_and_means_by_hand() -> None:
    variances, freedoms = np.array([[4.0, 0.0], [1.0, 0.0]]), np.array([[8.0], [2.0]])
    assert pooled_freedom(variances, freedoms) == pytest.approx([25 / (16 / 8 + 1 / 2), 1e6])
    assert relative_std_percent(-50.0, 2.0) == pytest.approx(4.0)
    assert relative_std_percent(0.0, 2.0) is None
    assert weighted_mean([1.0, 5.0], [1.0, 1.0]) == pytest.approx((3.0, np.sqrt(8) / np.sqrt(2), np.sqrt(8)))
    assert weighted_mean([2.0], [0.5]) == pytest.approx((2.0, 0.5, 0.0))


@pytest.mark.parametrize(("length", "columns"), [(9.9, 1), (10.1, 2), (30.1, 4), (700.0, 61)])
def test_a_drift_has_a_cosine_for_each_ten_seconds(length: float, columns: int) -> None:
    assert drift_basis(np.linspace(5.0, 5.0 + length, 300)).shape == (300, columns)


@pytest.mark.parametrize(("share", "columns"), [(0.48, 4), (0.52, 1)])
def test_a_motion_half_of_which_is_slow_keeps_the_line_alone(share: float, columns: int) -> None:
    basis = drift_basis(np.linspace(0.0, 30.1, 300))
    quick = np.tile([1.0, -1.0], 150)
    quick -= basis @ (basis.T @ quick)
    quick -= quick.mean()
    motion = (
        9 * basis[:, 0] + np.sqrt(share) * basis[:, 2] + np.sqrt(1 - share) * quick / np.linalg.norm(quick)
    )
    assert drift_beside(motion + 3.0, basis).shape[1] == columns


def test_of_differences_that_say_nothing_the_prior_is_left() -> None:
    """Half a Student's distribution of three degrees of freedom."""
    found = share_between([Differences(np.zeros(1), np.eye(1) * 1e6)], 0.01)
    assert (found.low, found.high) == pytest.approx(0.01 * student.ppf([0.5125, 0.9875], 3), rel=0.04)


def regressed(noise: float, count: int = 100) -> Block:
    """One column, ± 1 about 3, so that its square about the mean is one."""
    column = 3.0 + np.tile([1.0, -1.0], count // 2)[:, None]
    return Block("a", column, 2 * column[:, 0], PERIOD, noise=np.array([noise]))


def test_what_noise_takes_off_is_its_share_and_half_is_too_much() -> None:
    """share / (1 - share) of the value; the offset keeps the mean response."""
    lost = attenuation([regressed(0.2)], np.array([2.0]), shared_offset=False)
    assert lost == pytest.approx([2 * 0.2 / 0.8])
    assert attenuation([regressed(0.49)], np.array([2.0]), shared_offset=False) == pytest.approx(
        [2 * 0.49 / 0.51]
    )
    assert attenuation([regressed(0.51)], np.array([2.0]), shared_offset=False) is None
    other = replace(regressed(0.2), label="b", regressor=regressed(0.2).regressor + 4.0)
    blocks = [regressed(0.2), other]
    assert offsets_moved(blocks, np.array([0.5]), shared_offset=False) == pytest.approx(
        {"a": -1.5, "b": -3.5}
    )
    assert offsets_moved(blocks, np.array([0.5]), shared_offset=True) == pytest.approx({"a": -2.5, "b": -2.5})


@pytest.mark.parametrize(("cutoff", "shown"), [(9.9, True), (10.1, False)])
def test_white_noise_behind_a_filter(cutoff: float, shown: bool) -> None:
    """Four cutoffs lie below 0.8 of 50 Hz; what is left is the variance times the mean square of the filter's gain."""
    random = np.random.default_rng(0)
    found = noise_after_filter(
        *random.normal(0, 0.3, (2, 20000, 1)), random.normal(size=(20000, 1)), PERIOD, cutoff
    ).ravel()
    share = np.tan(np.pi * PERIOD * np.linspace(0, 50, 5000, endpoint=False)) / np.tan(
        np.pi * PERIOD * cutoff
    )
    passed = 1 / (1 + share**8) ** 2
    assert found == pytest.approx(np.full(2, 0.09 * passed.mean() * shown), rel=0.15)
    short = random.normal(size=(2, 49, 1))
    assert not noise_after_filter(*short, random.normal(size=(49, 1)), PERIOD, 2.0).any()
    assert noise_after_filter(*np.tile(short, (1, 4, 1)), random.normal(size=(196, 1)), PERIOD, 2.0).all()


def stepping(rows: int, means: list[tuple[float, float]], weight: float = 0.5) -> Block:
    """Stances of so many rows whose two halves read these means; the regressor is orthogonal to both."""
    half = (rows + 1) // 2
    response = np.concatenate([[a] * half + [b] * (rows - half) for a, b in means])
    column = np.tile([1.0, -1.0, 1.0, -1.0][:rows], len(means))[:, None]
    number = np.repeat(np.arange(len(means)), rows)
    return Block("a", column, response, PERIOD, stances=StanceRows(number, np.full(response.size, weight)))


def test_stances_differ_by_what_their_halves_have_in_common() -> None:
    """The share of the scatter of means that both halves see; means of 1 and -1, halves apart by 1."""
    both = [(1.5, 0.5), (-0.5, -1.5)]
    share = (1.5 * 0.5 + 0.5 * 1.5) / (1.0 + 1.0)
    problem = StanceProblem.drawn_together([stepping(4, both)])
    assert problem.prior == pytest.approx(0.5 * 4 * (1 / share - 1))
    assert problem.own_share == pytest.approx(share)
    assert StanceProblem.drawn_together([stepping(3, both)]).prior == 0.0, "halves of one row tell nothing"
    apart = StanceProblem.drawn_together([stepping(4, [(1.0, -0.9), (-1.0, 0.9)])])
    assert apart.prior == pytest.approx(0.5 * 4 * (1 / 1e-3 - 1)), "nothing in common: hardly any own offset"


def test_a_usual_stance_is_the_median_one() -> None:
    numbers = StanceRows(np.repeat(np.arange(3), [4, 4, 40]), np.ones(48))
    block = Block("a", np.zeros((48, 1)), np.zeros(48), PERIOD, stances=numbers)
    assert StanceProblem.of([block], prior=12.0).own_share == pytest.approx(4 / 16)


def test_a_factor_without_parameters_and_one_of_dependent_columns() -> None:
    empty = TriangularFactor.of(np.ones((3, 1)))
    assert (empty.condition_number, empty.rank, empty.residual_norm) == (
        float("inf"),
        0,
        pytest.approx(np.sqrt(3)),
    )
    column = np.array([1.0, 2.0, 3.0])
    twice = TriangularFactor.of(np.column_stack([column, 5 * column, column]))
    assert twice.rank == 1
    assert twice.condition_number > 1e12
    scaled = TriangularFactor.of(np.array([[1e6, 0, 1], [0, 1e-6, 2], [0, 0, 0]]))
    assert (scaled.rank, scaled.condition_number) == (2, pytest.approx(1.0))


@pytest.mark.parametrize("units", [(1.0, 1e-4, 1e3), (1e-9, 1e-9, 1e-9), (1e6, 1e-2, 1.0)])
def test_an_inverse_is_the_same_in_any_units(units: tuple[float, ...]) -> None:
    """Also of a column that holds nothing, and of one that is another's share."""
    columns = np.random.default_rng(6).standard_normal((20, 3))
    whole, outer = columns.T @ columns, np.outer(units, units)
    np.testing.assert_allclose(_scaled_inverse(whole * outer) * outer, np.linalg.inv(whole), rtol=1e-9)
    for last in (np.zeros(20), 0.5 * columns[:, 0]):
        columns[:, 2] = last
        less = columns.T @ columns
        np.testing.assert_allclose(
            _scaled_inverse(less * outer) * outer, _scaled_inverse(less), rtol=1e-7, atol=1e-9
        )

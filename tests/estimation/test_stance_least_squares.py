"""Fits over stances: against a dense solution, and whether their intervals cover."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.estimation.blocks import Block, StanceRows
from plantar.estimation.linear import (
    effect_of,
    fit_blocks,
    fits_of_halves,
    influences_of,
    information_inverse,
    least_left,
)
from plantar.estimation.orthonormal import orthonormal
from plantar.estimation.residual_covariance import interval95
from plantar.estimation.stance_least_squares import fit_stances, jackknife
from plantar.estimation.stance_problem import StanceProblem

VALUES, ARM, ROWS = np.array([450.0, 20.0]), 0.02, 40


def walk(seed: int, stances: int = 8, scatter: float = 3.0, noise: float = 1.0) -> Block:
    """One recording: torque of a spring, a damper and a load, an offset for each stance, errors smooth within it."""
    random = np.random.default_rng(seed)
    time = np.linspace(0, 1, ROWS)
    rows, torque, load, number = [], [], [], []
    for stance in range(stances):
        angle = 0.02 * np.sin(2 * np.pi * time + random.normal()) + 0.01 * random.normal() * time
        rate = np.gradient(angle, time)
        force = 600 * np.clip(6 * np.minimum(time, 1 - time), 0, 1) + 20 * random.normal()
        wander = noise * np.interp(time, np.linspace(0, 1, 4), random.normal(size=4))
        rows.append(np.column_stack([angle, rate]))
        load.append(force)
        torque.append(rows[-1] @ VALUES + ARM * force + scatter * random.normal() + 5 * seed % 7 + wander)
        number.append(np.full(ROWS, stance))
    weight = np.clip(np.concatenate(load) / 600, 0, 1)
    return Block(
        label=f"walk_{seed}",
        regressor=np.vstack(rows),
        response=np.concatenate(torque),
        period=0.025,
        stances=StanceRows(np.concatenate(number), weight),
        common_nuisance=np.concatenate(load)[:, None],
    )


def dense(blocks: list[Block], prior: float) -> np.ndarray:
    """The same problem as one matrix: columns for every offset, a row for each stance's prior."""
    designs, responses = [], []
    total = sum(len(block.stances.split()) for block in blocks)
    place = 0
    for i, block in enumerate(blocks):
        root = np.sqrt(block.stances.weight)
        recording = np.zeros((len(block.response), len(blocks)))
        recording[:, i] = 1
        own = np.zeros((len(block.response), total))
        for rows in block.stances.split():
            own[rows, place] = 1
            place += 1
        design = np.hstack([block.regressor, block.common_nuisance, recording, own])
        designs.append(design * root[:, None])
        responses.append(block.response * root)
    pulls = np.hstack([np.zeros((total, 3 + len(blocks))), np.sqrt(prior) * np.eye(total)])
    stacked, measured = np.vstack([*designs, pulls]), np.concatenate([*responses, np.zeros(total)])
    return np.linalg.lstsq(stacked, measured, rcond=None)[0]


@pytest.mark.parametrize("prior", [0.5, 30.0])
def test_it_is_the_dense_solution(prior: float) -> None:
    blocks = [walk(seed) for seed in range(3)]
    solution, expected = StanceProblem.of(blocks, prior).solve(), dense(blocks, prior)
    assert solution.values == pytest.approx(expected[:3], rel=1e-8)
    assert solution.own[:, -1] == pytest.approx(expected[3:6], rel=1e-6)


@pytest.mark.parametrize("apart", [0.0, 1e-7])
def test_columns_that_are_alike_share_what_they_explain(apart: float) -> None:
    """To rounding, too: their products are then regular by name only."""
    block = walk(0)
    single = StanceProblem.of([block], 4.0).solve().values
    angle = block.regressor[:, 0]
    other = angle * (1 + apart * np.cos(np.arange(len(angle))))
    twice = replace(block, regressor=np.column_stack([block.regressor, other]))
    found = StanceProblem.of([twice], 4.0).solve().values
    assert found[[0, 2]] == pytest.approx(np.full(2, single[0] / 2), rel=1e-3)


def test_leaving_a_stance_or_a_recording_out_is_fitting_the_rest() -> None:
    blocks = [walk(seed) for seed in range(3)]
    problem = StanceProblem.of(blocks, 4.0)
    kept = blocks[1].stances.number != 2
    less = replace(
        blocks[1],
        regressor=blocks[1].regressor[kept],
        response=blocks[1].response[kept],
        stances=StanceRows(blocks[1].stances.number[kept], blocks[1].stances.weight[kept]),
        common_nuisance=blocks[1].common_nuisance[kept],
    )
    rest = StanceProblem.of([blocks[0], less, blocks[2]], 4.0).solve().values
    assert problem.without_each_stance[8 + 2] == pytest.approx(rest, rel=1e-9)
    rest = StanceProblem.of(blocks[:2], 4.0).solve().values
    assert problem.without_each_recording()[2] == pytest.approx(rest, rel=1e-9)


def test_exact_data_give_exact_values() -> None:
    blocks = [walk(seed, noise=0.0) for seed in range(2)]
    fit = fit_stances(blocks)
    assert fit.values == pytest.approx(VALUES, rel=2e-3)
    assert fit.common_nuisance == pytest.approx([ARM], rel=0.02)


def test_offsets_that_do_not_scatter_are_drawn_together() -> None:
    """The prior is heavy where stances have one offset, and light where each has its own."""
    alike = [walk(seed, scatter=0.0) for seed in range(4)]
    apart = [walk(seed, scatter=20.0) for seed in range(4)]
    weight = float(alike[0].stances.weight[:ROWS].sum())
    assert StanceProblem.drawn_together(alike).prior > 0.3 * weight
    assert StanceProblem.drawn_together(apart).prior < 0.02 * weight


def test_recordings_that_differ_tell_with_as_much_freedom_as_they_are_many() -> None:
    """Six recordings of other springs and dampers each: their scatter widens, and has five degrees of freedom."""
    alike = [walk(seed, noise=0.2) for seed in range(6)]
    differing = [
        replace(block, response=block.response + block.regressor @ (share * VALUES))
        for block, share in zip(alike, np.linspace(-0.2, 0.2, 6), strict=True)
    ]
    sure, unsure = fit_stances(alike), fit_stances(differing)
    assert unsure.freedom[:2].tolist() == [5.0, 5.0]
    assert unsure.std[0] > 3 * sure.std[0]
    assert unsure.std[0] == pytest.approx(
        VALUES[0] * np.std(np.linspace(-0.2, 0.2, 6), ddof=1) / 6**0.5, rel=0.3
    )


@pytest.mark.parametrize("recordings", [1, 4])
def test_intervals_cover_the_truth(recordings: int) -> None:
    hits = np.zeros(2)
    trials = 150
    for trial in range(trials):
        fit = fit_stances([walk(1000 * trial + seed) for seed in range(recordings)])
        for place in range(2):
            low, high = interval95(float(fit.values[place]), float(fit.std[place]), float(fit.freedom[place]))
            hits[place] += low <= VALUES[place] <= high
    assert np.all(hits / trials > 0.90)
    assert np.all(hits / trials < 1.0)


def test_recordings_that_differ_widen_the_interval() -> None:
    """K that changes from walk to walk shows in the deviation, though within each walk everything fits."""
    same = [walk(seed, noise=0.2) for seed in range(8)]
    factors = 1 + 0.05 * np.random.default_rng(0).normal(size=8)
    differing = [
        replace(block, response=block.response + (factor - 1) * VALUES[0] * block.regressor[:, 0])
        for block, factor in zip(same, factors, strict=True)
    ]
    assert fit_stances(differing).std[0] > 4 * fit_stances(same).std[0]


def test_the_effect_of_a_change_is_that_of_fitting_it() -> None:
    blocks = [walk(seed) for seed in range(3)]
    changes = [block.regressor @ np.array([3.0, -0.5]) for block in blocks]
    assert effect_of(influences_of(blocks), changes) == pytest.approx([3.0, -0.5], rel=1e-6)


def test_information_counts_weighted_rows() -> None:
    blocks = [walk(seed) for seed in range(2)]
    assert information_inverse(
        [*blocks, *[replace(b, label=b.label + "b") for b in blocks]]
    ) == pytest.approx(information_inverse(blocks) / 2, rel=0.05)


def test_scaling_the_torque_scales_values_and_deviations() -> None:
    blocks = [walk(seed) for seed in range(3)]
    scaled = [replace(block, response=10 * block.response) for block in blocks]
    one, ten = fit_blocks(blocks), fit_blocks(scaled)
    assert ten.values == pytest.approx(10 * one.values, rel=1e-9)
    assert ten.std == pytest.approx(10 * one.std, rel=1e-9)
    assert ten.white_std == pytest.approx(10 * one.white_std, rel=1e-9)
    assert ten.common_nuisance == pytest.approx(10 * one.common_nuisance, rel=1e-9)
    assert ten.offsets == pytest.approx({label: 10 * value for label, value in one.offsets.items()}, rel=1e-9)
    assert ten.freedom == pytest.approx(one.freedom)


def test_white_deviations_are_the_scatter_under_white_noise() -> None:
    """Of stances with one offset and rows that all weigh alike."""
    found = []
    for seed in range(60):
        plain = walk(0, scatter=0.0, noise=0.0)
        noise = 2.0 * np.random.default_rng(seed).standard_normal(len(plain.response))
        even = StanceRows(plain.stances.number, np.ones(len(noise)))
        found.append(fit_stances([replace(plain, response=plain.response + noise, stances=even)]))
    scatter = np.std([fit.values for fit in found], axis=0, ddof=1)
    assert np.mean([fit.white_std for fit in found], axis=0)[:2] == pytest.approx(scatter, rel=0.25)


def test_white_deviations_of_every_second_row_are_those_of_all() -> None:
    plain = walk(0)
    assert plain.stances is not None
    twice = replace(
        plain,
        regressor=np.repeat(plain.regressor, 2, axis=0),
        response=np.repeat(plain.response, 2),
        stances=StanceRows(np.repeat(plain.stances.number, 2), np.repeat(plain.stances.weight, 2)),
        common_nuisance=np.repeat(plain.common_nuisance, 2, axis=0),  # type: ignore[arg-type]
    )
    found = fit_stances([replace(plain, thinned=2)])
    assert found.white_std == pytest.approx(fit_stances([twice]).white_std, rel=0.02)


def test_one_lone_stance_promises_nothing() -> None:
    fit = fit_stances([walk(0, stances=1)])
    low, high = interval95(float(fit.values[0]), float(fit.std[0]), float(fit.freedom[0]))
    assert low < 0 < high


def test_an_offset_is_a_mean_over_stances() -> None:
    """Of four times as many stances that scatter alike it is twice as well known, as the scatter says."""
    few, many = (
        np.mean([fit_stances([walk(seed, stances)]).offset_std(f"walk_{seed}") for seed in range(12)])
        for stances in (8, 32)
    )
    assert many == pytest.approx(few / 2, rel=0.3)
    assert many == pytest.approx(3.0 / np.sqrt(32), rel=0.5), "3 N·m from stance to stance"


def test_a_common_column_without_anything_in_it_is_as_if_it_were_not_there() -> None:
    """Vertical force cells read no horizontal force, by which a bush's height would show."""
    blocks = [walk(seed) for seed in range(3)]
    empty = [
        replace(
            block,
            common_nuisance=np.hstack([block.common_nuisance, np.zeros((len(block.response), 1))]),
            common_spread=np.array([np.inf, 0.006]),
        )
        for block in blocks
    ]
    plain, found = fit_stances(blocks), fit_stances(empty)
    assert found.values == pytest.approx(plain.values)
    assert found.std[:2] == pytest.approx(plain.std[:2])
    assert found.common_nuisance[1] == 0.0


def test_one_offset_for_all_takes_no_heed_of_stances() -> None:
    """Information, influences and fit with a shared offset are those of the same rows without stances."""
    stepping = replace(walk(0), common_nuisance=None)
    plain = replace(stepping, stances=None)
    for found in (information_inverse, lambda blocks, **one: influences_of(blocks, **one)[0]):
        assert found([stepping], shared_offset=True) == pytest.approx(found([plain], shared_offset=True))
        assert found([stepping]) != pytest.approx(found([plain]))
    assert fit_blocks([stepping], shared_offset=True).values == pytest.approx(
        fit_blocks([plain], shared_offset=True).values
    )


def test_what_a_further_column_leaves_at_least() -> None:
    """The plain squares of every column beside all others, and no fit with weights and priors leaves less."""
    blocks = [walk(seed) for seed in range(4)]
    random = np.random.default_rng(1)
    true = [random.normal(size=(len(block.response), 1)) for block in blocks]
    blocks = [
        replace(block, response=block.response + 3 * own[:, 0])
        for block, own in zip(blocks, true, strict=True)
    ]
    columns = [np.hstack([random.normal(size=(len(own), 2)), own]) for own in true]
    for column, least in enumerate(least_left(blocks, columns)):
        wider = [
            replace(block, regressor=np.column_stack([block.regressor, own[:, column]]))
            for block, own in zip(blocks, columns, strict=True)
        ]
        rows = np.vstack([np.hstack([block.regressor, block.common_nuisance]) for block in wider])
        each = np.kron(np.eye(len(blocks)), np.ones((len(blocks[0].response), 1)))
        response = np.concatenate([block.response for block in wider])
        left = np.linalg.lstsq(np.hstack([rows, each]), response)[1]
        assert least == pytest.approx(left[0], rel=1e-9)
        assert least <= fit_blocks(wider).squares


def test_what_was_known_of_a_coefficient_draws_it_to_zero() -> None:
    """By the shares of both variances; the other values follow, as far as in a fit without the column."""
    blocks = [walk(seed) for seed in range(3)]
    problem = StanceProblem.drawn_together(blocks)
    free = problem.solve().values
    own = jackknife(problem.without_each_stance)[0][2, 2]
    bare = [replace(block, common_nuisance=None) for block in blocks]
    never = StanceProblem.of(bare, problem.prior).solve().values
    for spread in (0.0, np.sqrt(own), 3 * np.sqrt(own), np.inf):
        keep = 1.0 if np.isinf(spread) else spread**2 / (spread**2 + own)
        fit = fit_blocks([replace(block, common_spread=np.array([spread])) for block in blocks])
        assert fit.common_nuisance == pytest.approx([keep * free[2]], rel=1e-9, abs=1e-15)
        assert fit.values == pytest.approx(keep * free[:2] + (1 - keep) * never, rel=1e-9)


def test_halves_are_fitted_each_alone() -> None:
    """Of five stances the first two and the last three, by number and not by row."""
    block = replace(
        walk(3, stances=5), nuisance=orthonormal(np.random.default_rng(0).normal(size=(5 * ROWS, 1)))
    )
    order = np.random.default_rng(1).permutation(5 * ROWS)
    shuffled = block.part(order)
    np.testing.assert_array_equal(shuffled.response, block.response[order])
    assert shuffled.stances is not None
    assert block.stances is not None
    np.testing.assert_array_equal(shuffled.stances.weight, block.stances.weight[order])
    for rows, half in zip(np.split(np.arange(5 * ROWS), [2 * ROWS]), fits_of_halves(block), strict=True):
        alone = Block(
            label=block.label,
            regressor=block.regressor[rows],
            response=block.response[rows],
            period=block.period,
            nuisance=orthonormal(block.nuisance[rows]),
            stances=StanceRows(block.stances.number[rows], block.stances.weight[rows]),
            common_nuisance=block.common_nuisance[rows],
        )
        np.testing.assert_allclose(half.values, fit_stances([alone]).values, rtol=1e-9)

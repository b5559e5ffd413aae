"""The best motion within limits: at them, not beyond, and the same for the same seed."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from unittest.mock import patch

import numpy as np
import pytest
from scipy.optimize import linprog

import design_samples
from plantar import cores
from plantar.contact.polygon import inside_distance
from plantar.design import search
from plantar.design.family import Lines
from plantar.design.reach import KINDS, Reach
from plantar.design.rubber import (
    SHARE,
    remembered,
)
from plantar.design.search import best_motion, better_motion
from plantar.design.soles import margin_kept
from plantar.twin.robots import hrp2

BEND = 0.1
SLIP_ANGLE = 0.01


def test_the_motion_found_is_at_its_limits_and_not_beyond() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    assert reach.used(coefficients) == pytest.approx(1.0, abs=0.02)
    coefficients = coefficients / reach.used(coefficients)
    bent, load = reach.of(reach.deflection, coefficients), reach.of(reach.load, coefficients)
    rate = reach.of(reach.rate, coefficients)
    assert np.abs(bent).max() < 1.02 * BEND
    for place, foot in enumerate(reach.feet):
        polygon = hrp2.robot().feet[foot].sole.polygon  # the bush is over its middle
        for row, (k, c) in enumerate(zip(reach.stiffness, reach.damping, strict=True)):
            one = bent[row, place]
            slips = remembered(one, [SLIP_ANGLE])[:, 0]
            torque = (
                k * one + c * rate[row, place] + design_samples.STIFFNESS * np.array(SHARE)[:, None] * slips
            )
            pressure = np.column_stack([-torque[0], torque[1]]) / (reach.weight + load[row, place])[:, None]
            assert inside_distance(pressure, polygon).min() > margin_kept(polygon) - 2e-3


def test_the_same_seed_gives_the_same_motion_and_another_another() -> None:
    """On other frequencies, too: the best of all beginnings, each of which has its own."""

    def found(seed: int) -> tuple[int, Lines, np.ndarray]:
        with (
            patch.object(search, "TRIED", 1),
            patch.object(search, "TRIES", 2),
            patch.object(search, "STARTS", 2),
        ):
            return best_motion([reach_on], 20.0, "A", seed, known=0.0, progress=lambda _: None)

    def reach_on(lines: Lines) -> Reach:
        reach = Reach(design_samples.legs(), design_samples.linear(), lines, told, [told], element=None)
        tried.append(lines.frequencies)
        return reach

    told, tried = design_samples.told(), list[np.ndarray]()
    with patch.object(cores, "usable_cores", lambda: 1):
        _, lines, motion = found(2)
        assert np.array_equal(motion, found(2)[2])
        own, others = tried[:2]
        assert not np.array_equal(own, others)
        assert any(np.array_equal(lines.frequencies, each) for each in (own, others))
        assert not np.array_equal(lines.frequencies, found(3)[1].frequencies)


def test_beginnings_take_the_stances_in_turn_and_the_best_one_stands_as_its_own_did() -> None:
    def reach_of(stance: int) -> Callable[[Lines], Reach]:
        def reach_on(lines: Lines) -> Reach:
            reach = Reach(design_samples.legs(), design_samples.linear(), lines, told, [told], element=None)
            stances.append((stance, lines.frequencies))
            return reach.held(np.full((1, len(KINDS)), 1.0 if stance == 1 else 0.1))

        return reach_on

    told, stances = design_samples.told(), list[tuple[int, np.ndarray]]()
    with (
        patch.object(cores, "usable_cores", lambda: 1),
        patch.object(search, "TRIED", 1),
        patch.object(search, "TRIES", 2),
        patch.object(search, "STARTS", 4),
        patch.object(search, "FOLLOWED", 2),
    ):
        stance, lines, _ = best_motion(
            [reach_of(0), reach_of(1)], 20.0, "A", 2, known=0.0, progress=lambda _: None
        )
    assert [each for each, _ in stances] == [0, 1, 0, 1, 1, 1], "the best two are followed"
    assert stance == 1, "whose limits are wider"
    assert any(np.array_equal(lines.frequencies, own) for each, own in stances if each == 1)


@pytest.mark.parametrize("tries", [1, 3])
def test_a_motion_that_was_rehearsed_is_bettered_by_small_steps(tries: int) -> None:
    """Of what is linear every step helps, and goes as far as it may: a tenth of what is just allowed of each."""
    reach = copy(design_samples.reach())
    reach.element = 0 * reach.element
    units = np.array([1 / reach.used(row) for row in np.eye(reach.lines.size)])
    slope = 1 / units
    start = 0.5 * design_samples.coefficients()
    linear = patch.object(search, "badness", lambda _, coefficients, *__: coefficients @ slope)
    with linear, patch.object(search, "TRIED", tries):
        found = better_motion(reach, "widest", start, known=0.0)
    moved = np.abs(found - start / reach.used(start)) / units
    assert 0.1 * tries - 0.02 < moved.max() < 0.1 * tries + 0.02


def test_the_best_motion_is_the_corner_of_the_limits_that_a_slope_leads_to() -> None:
    """Of what is linear a linear program over all samples knows the optimum."""
    reach = copy(design_samples.reach())
    reach.element = 0 * reach.element
    units = np.array([1 / reach.used(row) for row in np.eye(reach.lines.size)])
    slope = np.random.default_rng(3).standard_normal(units.size) / units
    linear = patch.object(search, "badness", lambda _, coefficients, *__: coefficients @ slope)
    with linear, patch.object(search, "TRIED", 25):
        found = better_motion(reach, "widest", 0.1 * units, known=0.0)  # every beginning leads there
    rows = reach._watched.reshape(reach.lines.size, -1).T
    high, low = (np.repeat(limit, reach.time.size) for limit in (reach._high, reach._low))
    shares = np.vstack([rows / high[:, None], -rows / low[:, None]])
    close = shares[shares @ found > 0.5]  # the optimum of these alone is no worse than that of all
    best = linprog(slope * units, A_ub=close * units, b_ub=np.ones(len(close)), bounds=(-9, 9)).fun
    assert reach.used(found) <= 1 + 1e-9
    assert slope @ found == pytest.approx(best, rel=0.02)

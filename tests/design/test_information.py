"""What a motion tells of the bushes, beside plain least squares; limits, beside their definition."""

from __future__ import annotations

import numpy as np
import pytest

import design_samples
from plantar.contact.polygon import inside_distance
from plantar.design.information import MISSED, badness, half_widths, information
from plantar.design.reach import BEND, RATE, margin_kept
from plantar.design.rubber import NEARBY, SHARE, SLIP_ANGLE, remembered
from plantar.design.search import best_motion
from plantar.twin.robots import hrp2


def test_an_element_slips_as_its_definition_says() -> None:
    path = np.cumsum(np.random.default_rng(0).normal(0, 2e-3, (3, 400)), axis=1)
    path -= path[:, :1]
    state = np.zeros((3, 400))
    for row in range(1, 400):
        state[:, row] = np.clip(state[:, row - 1] + path[:, row] - path[:, row - 1], -SLIP_ANGLE, SLIP_ANGLE)
    assert remembered(path, [SLIP_ANGLE])[:, 0] == pytest.approx(state, abs=1e-12)


def test_information_is_that_of_least_squares() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    found = information(reach, coefficients)
    bent = reach.of(reach.firm_deflection, coefficients)[1, 0, 1]  # told stiffness, first foot, roll
    rate = reach.of(reach.firm_rate, coefficients)[1, 0, 1]
    element = remembered(bent[None], [SLIP_ANGLE, NEARBY * SLIP_ANGLE])[0]
    turned = (element[1] - element[0]) / np.log(NEARBY)
    line = np.linspace(-1, 1, bent.size)
    design = np.column_stack([bent, rate, element[0], turned, np.ones(bent.size), line]) / MISSED
    normal = design.T @ design * 10 / RATE
    normal[2, 2] += 1 / reach.stiffness[1] ** 2
    normal[3, 3] += 4 / reach.stiffness[1] ** 2
    covariance = np.linalg.inv(normal)[:2, :2]
    assert np.linalg.inv(found[1, 0, 1]) == pytest.approx(covariance, rel=1e-5)


def test_a_smaller_motion_promises_less_and_what_is_known_promises_more() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    whole, half = half_widths(reach, coefficients), half_widths(reach, 0.5 * coefficients)
    assert (half > 1.9 * whole).all()
    known = np.zeros((2, 2, 2, 2))
    known[0, 0] = np.diag([1.0, 100.0])
    more = half_widths(reach, coefficients, known)
    assert (more[:, 0, 0] < whole[:, 0, 0]).all()
    assert more[:, 1] == pytest.approx(whole[:, 1])
    assert badness(reach, coefficients, "D") < badness(reach, 0.5 * coefficients, "D")


def test_the_motion_found_is_at_its_limits_and_not_beyond() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    assert reach.used(coefficients) == pytest.approx(1.0, abs=0.02)
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
    def found(seed: int) -> np.ndarray:
        from unittest.mock import patch

        from plantar.design import search

        with patch.object(search, "TRIES", 5):
            return best_motion(design_samples.reach(), "A", np.random.default_rng(seed))

    assert np.array_equal(found(2), found(2))
    assert not np.array_equal(found(2), found(3))

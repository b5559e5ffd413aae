"""What a motion tells of the bushes, beside plain least squares."""

from __future__ import annotations

import numpy as np
import pytest

import design_samples
from plantar.conventions import NORMAL95
from plantar.design import information as objective
from plantar.design.family import CHANNELS
from plantar.design.information import (
    Criterion,
    badness,
    delay_half_width,
    half_widths,
    information,
    vertical_half_width,
)
from plantar.design.rubber import (
    SHARE,
    remembered,
)

MISSED = 0.1
UNCLOSED = np.array([0.4, 0.2, 0.2])
MODEL_ERROR = 0.003
FIRM_RATE = 10.0
NEARBY = 1.05
SECANT = 0.6
SLIP_ANGLE = 0.01
DRIFT_PERIOD = 20.0


def test_an_element_slips_as_its_definition_says() -> None:
    path = np.cumsum(np.random.default_rng(0).normal(0, 2e-3, (3, 400)), axis=1)
    path -= path[:, :1]
    state = np.zeros((3, 400))
    for row in range(1, 400):
        state[:, row] = np.clip(state[:, row - 1] + path[:, row] - path[:, row - 1], -SLIP_ANGLE, SLIP_ANGLE)
    assert remembered(path, [SLIP_ANGLE])[:, 0] == pytest.approx(state, abs=1e-12)


def test_information_is_that_of_least_squares() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    firm = [reach.of(part, coefficients) for part in (reach.firm_deflection, reach.firm_rate)]
    found = information(reach, *firm)
    bent = reach.of(reach.firm_deflection, coefficients)[1, 0, 1]  # told stiffness, first foot, roll
    rate = reach.of(reach.firm_rate, coefficients)[1, 0, 1]
    element = remembered(bent[None], [SLIP_ANGLE, NEARBY * SLIP_ANGLE])[0]
    turned = (element[1] - element[0]) / np.log(NEARBY)
    share = (np.arange(bent.size) / (bent.size - 1))[:, None]
    cosines = np.cos(np.pi * share * np.arange(1, 2 * reach.lines.duration / DRIFT_PERIOD + 1))
    slow = np.hstack([np.ones_like(share), share, cosines])
    design = np.column_stack([bent, rate, element[0], turned, slow]) / MISSED
    assert slow.shape[1] > 3, "an offset, a line and cosines"
    normal = design.T @ design * 10 / FIRM_RATE
    normal[2, 2] += 1 / reach.stiffness[1] ** 2
    normal[3, 3] += 4 / reach.stiffness[1] ** 2
    covariance = np.linalg.inv(normal)[:2, :2]
    assert np.linalg.inv(found[1, 0, 1]) == pytest.approx(covariance, rel=1e-5)


def test_a_smaller_motion_promises_less_and_what_is_known_promises_more() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    whole, half = half_widths(reach, coefficients), half_widths(reach, 0.5 * coefficients)
    assert (half[..., 0] > 1.9 * whole[..., 0]).all()
    assert (half >= whole).all()  # of damping, an unknown delay leaves no more than is usual
    known = np.zeros((2, 2, 2, 2))
    known[0, 0] = np.diag([1.0, 100.0])
    more = half_widths(reach, coefficients, known)
    assert (more[:, 0, 0] < whole[:, 0, 0]).all()
    assert more[:, 1] == pytest.approx(whole[:, 1])
    assert badness(reach, coefficients, "D", known=0.0) < badness(reach, 0.5 * coefficients, "D", known=0.0)


def test_a_number_out_of_reach_is_not_all_that_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where one width is hopeless the others still count; none of them is bought by it."""
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    monkeypatch.setattr(objective, "delay_half_width", lambda *_: objective.WANTED_DELAY)
    monkeypatch.setattr(objective, "vertical_half_width", lambda *_: np.full(3, objective.WANTED_VERTICAL))
    widths = np.full((3, 2, 2, 2), 0.02)
    widths[:, 0, 1, 0] = 50.0  # of a roll that small soles cannot bend

    def of(changed: np.ndarray, known: float = 0.0) -> float:
        monkeypatch.setattr(objective, "half_widths", lambda *_: changed)
        return float(badness(reach, coefficients, "widest", known))

    hopeless = of(widths)
    told, less = widths.copy(), widths.copy()
    told[:, :, 0] /= 2
    less[:, 0, 1, 0] /= 2
    assert of(told) < hopeless - 0.05
    assert hopeless - 0.1 < of(less) < hopeless
    assert of(widths, 1.0) - of(less, 1.0) > 0.5 * np.log(
        2
    )  # after an earlier motion it is what is left to do
    reached = np.full_like(widths, 0.02)
    half = reached.copy()
    half[:, 0, 1, 0] *= 2
    assert of(half) - of(reached) > 0.5 * np.log(2)  # of what is in reach the widest counts


def test_what_is_narrower_than_wanted_is_bought_last(monkeypatch: pytest.MonkeyPatch) -> None:
    """Damping that is twice as narrow once more does not outweigh a stiffness that is not yet as wanted."""
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    monkeypatch.setattr(objective, "delay_half_width", lambda *_: objective.WANTED_DELAY)
    monkeypatch.setattr(objective, "vertical_half_width", lambda *_: np.full(3, objective.WANTED_VERTICAL))

    def of(stiffness: float, damping: float, criterion: Criterion) -> float:
        widths = np.array([stiffness, damping]) * objective.WANTED * np.ones((3, 2, 2, 2))
        monkeypatch.setattr(objective, "half_widths", lambda *_: widths)
        return float(badness(reach, coefficients, criterion, known=0.0))

    assert of(1.5, 0.25, "widest") > of(1.3, 0.5, "widest")
    assert of(0.5, 0.25, "widest") < of(0.5, 0.5, "widest"), "it still counts"
    assert of(1.5, 0.25, "D") < of(1.3, 0.5, "D"), "the volume of all is what it is"


@pytest.mark.parametrize("criterion", ["widest", "D", "A"])
def test_motions_together_count_as_one_by_one(criterion: Criterion) -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    several = np.linspace(0.3, 1.0, 6).reshape(2, 3, 1) * coefficients
    several[1, :, ::3] *= -0.5
    found = badness(reach, several, criterion, known=0.0)
    alone = [[float(badness(reach, one, criterion, known=0.0)) for one in row] for row in several]
    assert found == pytest.approx(np.array(alone), rel=1e-9)
    assert len(set(np.round(found.ravel(), 6))) == 6


@pytest.mark.parametrize("criterion", ["widest", "D", "A"])
def test_widths_that_are_all_as_wanted_times_a_number_count_as_its_logarithm(
    monkeypatch: pytest.MonkeyPatch, criterion: Criterion
) -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    monkeypatch.setattr(objective, "delay_half_width", lambda *_: 1.5 * objective.WANTED_DELAY)
    wide = np.full(3, 1.5 * objective.WANTED_VERTICAL)
    monkeypatch.setattr(objective, "vertical_half_width", lambda *_: wide)
    all_alike = 1.5 * np.array(objective.WANTED) * np.ones((3, 2, 2, 2))
    monkeypatch.setattr(objective, "half_widths", lambda *_: all_alike)
    assert badness(reach, coefficients, criterion, known=0.0) == pytest.approx(np.log(1.5))


def test_a_delay_shows_where_force_and_moments_change_and_costs_damping(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What a late sensor misses at each moment is the rate times the delay; C is off by K times the delay. A share of
    the amplitude that no model knows looks like a delay of that over the pulsation."""
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    monkeypatch.setattr(objective, "USUAL_DELAY", np.inf)  # nothing known before
    forces = np.sqrt(np.mean(np.sum(reach.of(reach.forces, coefficients) ** 2, axis=0)))
    monkeypatch.setattr(objective, "SEEN_FORCE", 2 * forces)
    unseen = delay_half_width(reach, coefficients)
    monkeypatch.setattr(objective, "SEEN_FORCE", forces)
    assert unseen > 10 * delay_half_width(reach, coefficients)
    time = reach.lines.time(200.0)
    moved = reach.lines.displacements(coefficients, time)
    pushed = np.gradient(np.gradient(moved, time, axis=1), time, axis=1)
    rates = np.gradient(design_samples.linear().wrench(moved, pushed)[2:5], time, axis=1) / UNCLOSED[:, None]
    quick = np.sum(np.gradient(rates, time, axis=1) ** 2) / np.sum(rates**2)
    noise = 1 / (np.sum(rates**2) * 10 / 200.0)
    expected = NORMAL95 * np.sqrt(noise + MODEL_ERROR**2 / quick)
    assert delay_half_width(reach, coefficients) == pytest.approx(expected, rel=0.1)
    monkeypatch.setattr(objective, "MODEL_ERROR", 0.0)
    wide = delay_half_width(reach, coefficients)
    assert wide == pytest.approx(NORMAL95 * np.sqrt(noise), rel=0.1)
    assert delay_half_width(reach, 2 * coefficients) == pytest.approx(wide / 2)
    unsure = half_widths(reach, coefficients)
    monkeypatch.setattr(objective, "UNCLOSED", (1e-9, 1e-9, 1e-9))
    known = half_widths(reach, coefficients)
    assert unsure[..., 0] == pytest.approx(known[..., 0])
    added = np.sqrt(unsure[..., 1] ** 2 - known[..., 1] ** 2) / wide
    firm = reach.stiffness[:, None] + SECANT * design_samples.STIFFNESS * np.array(SHARE)
    late = np.broadcast_to((firm / reach.damping[:, None])[:, None], added.shape)
    assert added == pytest.approx(late, rel=1e-6)


def test_vertical_compliance_shows_where_load_goes_from_foot_to_foot() -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    whole = vertical_half_width(reach, coefficients)
    load = reach.of(reach.load, coefficients)
    moved = np.std(load[:, 0] - load[:, 1], axis=-1) / reach.vertical
    assert whole == pytest.approx(NORMAL95 * objective.UNEVEN / moved), "95 %, as everywhere"
    assert vertical_half_width(reach, 0.5 * coefficients) == pytest.approx(2 * whole)
    middle = coefficients.reshape(len(CHANNELS), -1).copy()
    for channel in ("centre.y", "trunk.roll", "left.roll", "right.roll", "left.pitch", "right.pitch"):
        middle[CHANNELS.index(channel)] = 0.0
    assert (vertical_half_width(reach, middle.ravel()) > 20 * whole).all()

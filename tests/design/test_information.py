"""What a motion tells of the bushes, beside plain least squares; limits, beside their definition."""

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
from plantar.conventions import NORMAL95
from plantar.design import information as objective
from plantar.design import search
from plantar.design.family import CHANNELS, Lines
from plantar.design.information import (
    Criterion,
    badness,
    delay_half_width,
    half_widths,
    information,
    vertical_half_width,
)
from plantar.design.reach import (
    KINDS,
    Reach,
    margin_kept,
)
from plantar.design.rubber import (
    SHARE,
    remembered,
)
from plantar.design.search import best_motion, better_motion
from plantar.design.soft_feet import Softness
from plantar.twin.presets import SLIP_TORQUE
from plantar.twin.robots import hrp2

MISSED = 0.1
UNCLOSED = np.array([0.4, 0.2, 0.2])
MODEL_ERROR = 0.003
BEND = 0.1
LIFT = 0.35
RATE = 20.0
NEARBY = 1.05
SECANT = 0.6
SLIP_ANGLE = 0.01
DRIFT_PERIOD = 20.0
SIDES = 8


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
    share = (np.arange(bent.size) / (bent.size - 1))[:, None]
    cosines = np.cos(np.pi * share * np.arange(1, 2 * reach.lines.duration / DRIFT_PERIOD + 1))
    slow = np.hstack([np.ones_like(share), share, cosines])
    design = np.column_stack([bent, rate, element[0], turned, slow]) / MISSED
    assert slow.shape[1] > 3, "an offset, a line and cosines"
    normal = design.T @ design * 10 / RATE
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
    assert badness(reach, coefficients, "D") < badness(reach, 0.5 * coefficients, "D")


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
        return float(badness(reach, coefficients, criterion))

    assert of(1.5, 0.25, "widest") > of(1.3, 0.5, "widest")
    assert of(0.5, 0.25, "widest") < of(0.5, 0.5, "widest"), "it still counts"
    assert of(1.5, 0.25, "D") < of(1.3, 0.5, "D"), "the volume of all is what it is"


@pytest.mark.parametrize("criterion", ["widest", "D", "A"])
def test_motions_together_count_as_one_by_one(criterion: Criterion) -> None:
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    several = np.linspace(0.3, 1.0, 6).reshape(2, 3, 1) * coefficients
    several[1, :, ::3] *= -0.5
    found = badness(reach, several, criterion)
    alone = [[float(badness(reach, one, criterion)) for one in row] for row in several]
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
    assert badness(reach, coefficients, criterion) == pytest.approx(np.log(1.5))


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
        with patch.object(search, "TRIES", 1), patch.object(search, "STARTS", 2):
            return best_motion([reach_on], 20.0, "A", seed)

    def reach_on(lines: Lines) -> Reach:
        reach = Reach(design_samples.legs(), design_samples.linear(), lines, told, [told])
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
            reach = Reach(design_samples.legs(), design_samples.linear(), lines, told, [told])
            stances.append((stance, lines.frequencies))
            return reach.held(np.full((1, len(KINDS)), 1.0 if stance == 1 else 0.1))

        return reach_on

    told, stances = design_samples.told(), list[tuple[int, np.ndarray]]()
    with (
        patch.object(cores, "usable_cores", lambda: 1),
        patch.object(search, "TRIES", 1),
        patch.object(search, "STARTS", 4),
    ):
        stance, lines, _ = best_motion([reach_of(0), reach_of(1)], 20.0, "A", 2)
    assert [each for each, _ in stances] == [0, 1, 0, 1]
    assert stance == 1, "whose limits are wider"
    assert any(np.array_equal(lines.frequencies, own) for each, own in stances if each == 1)


def test_the_element_is_at_least_the_rubber_of_the_rehearsals() -> None:
    """Of a robot of this weight, however soft its springs were told: limits would be passed in rehearsals."""
    lines = Lines.drawn(20.0, np.random.default_rng(1))
    soft = Softness.told(hrp2.robot(), 300.0, None)
    found = Reach(design_samples.legs(), design_samples.linear(), lines, soft, [soft]).element
    assert found == pytest.approx(np.array(SLIP_TORQUE) / SLIP_ANGLE)
    stiff = Softness.told(hrp2.robot(), 800.0, None)
    more = Reach(design_samples.legs(), design_samples.linear(), lines, stiff, [stiff]).element
    assert more == pytest.approx(800.0 * np.array(SHARE))


def test_limits_are_held_to_shares_of_each_kind_over_each_bush() -> None:
    """Where motions may use half of one kind over one bush, they seem to use twice as much of it there."""
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    whole, shares = reach.used_by_kind(coefficients), np.ones((3, len(KINDS)))
    load, bent = reach.of(reach.load, coefficients), reach.of(reach.deflection, coefficients)
    assert whole[:, KINDS.index("load")] == pytest.approx(
        -load.min(axis=(1, 2)) / ((1 - LIFT) * reach.weight)
    )
    assert whole[:, KINDS.index("bend")] == pytest.approx(np.abs(bent).max(axis=(1, 2, 3)) / BEND)
    for place in np.ndindex(shares.shape):
        less, expected = shares.copy(), whole.copy()
        less[place], expected[place] = 0.5, 2 * whole[place]
        assert reach.held(less).used_by_kind(coefficients) == pytest.approx(expected)
    assert reach.held(0.5 * shares, 0.5).used(coefficients) == pytest.approx(2 * reach.used(coefficients))
    still = reach.held(shares, still=("arms",))
    assert still.used(coefficients) > 1e6
    without = reach.lines.without(coefficients, "arms")
    assert still.used(without) == pytest.approx(reach.used(without))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_feet_are_beyond_their_limits_where_a_centre_of_pressure_is(sign: float) -> None:
    """Whichever way the motion goes: soles are longer in front than behind."""
    reach, inside = design_samples.reach(), []
    of_feet, feet = copy(reach), reach.deflection[0, ..., 0].size + reach.load[0, ..., 0].size
    floor = len(reach.feet) * len(reach.bushes) * SIDES  # friction has a test of its own
    feet += floor + len(reach.bushes) * sum(len(room) for _, room in reach._edges)
    of_feet._low, of_feet._high = reach._low.copy(), reach._high.copy()
    of_feet._high[-floor:] = np.inf
    of_feet._low[:-feet], of_feet._high[:-feet] = np.inf, np.inf
    shape = sign * design_samples.coefficients()
    for size in np.linspace(0.3, 2.0, 36):  # not 1: a designed motion stands at a limit there
        bent, load = reach.of(reach.deflection, size * shape), reach.of(reach.load, size * shape)
        rate = reach.of(reach.rate, size * shape)
        slips = remembered(bent.reshape(-1, bent.shape[-1]), [SLIP_ANGLE]).reshape(bent.shape)
        torque = reach.stiffness[:, None, None, None] * bent + reach.damping[:, None, None, None] * rate
        torque += reach.element[:, None] * slips
        free = np.abs(bent).max() < BEND
        for place, (normals, room) in enumerate(reach._edges):
            carried = reach.weight + load[:, place]
            pressure = np.stack([-torque[:, place, 0], torque[:, place, 1]]) / carried
            free &= bool((np.einsum("ek,ksn->esn", normals, pressure) + room[:, None, None] > 0).all())
        free &= bool((-load.min() / reach.weight) < 1 - LIFT)
        inside.append(free)
        assert (of_feet.used(size * shape) <= 1.0) == free, size
    assert any(inside)
    assert not all(inside)


def test_joints_have_their_own_room_to_each_side() -> None:
    reach, shape = copy(design_samples.reach()), design_samples.coefficients()
    gain = design_samples.linear().joints[:, 6:]
    moved = gain[:, np.abs(gain).max(axis=0) > 1e-9].T @ reach.lines.displacements(shape, reach.time)
    rows = slice(len(CHANNELS), len(CHANNELS) + len(moved))
    for side, most in (("_low", -moved.min(axis=1)), ("_high", moved.max(axis=1))):
        reach._low, reach._high = (np.full_like(reach._low, np.inf) for _ in range(2))
        getattr(reach, side)[rows] = 1e-3
        assert reach.used(shape) == pytest.approx(most.max() / 1e-3)


def test_near_its_limits_a_motion_has_room_as_told() -> None:
    """Of springs alone all is linear: what is left of each limit after a small step is what the rows say."""
    reach, shape = copy(design_samples.reach()), design_samples.coefficients()
    reach.element = 0 * reach.element
    rows, left = reach.near(shape)
    assert left.min() == pytest.approx(1 - reach.used(shape))
    assert left.max() < 0.2, "only what is near"
    passed, over = reach.near(1.5 * shape, 1.0)
    assert len(passed) > 0
    assert over.max() < 0.0, "only what is passed"
    assert rows @ shape == pytest.approx(1 - left)


def test_the_best_motion_is_the_corner_of_the_limits_that_a_slope_leads_to() -> None:
    """Of what is linear a linear program over all samples knows the optimum."""
    reach = copy(design_samples.reach())
    reach.element = 0 * reach.element
    units = np.array([1 / reach.used(row) for row in np.eye(reach.lines.size)])
    slope = np.random.default_rng(3).standard_normal(units.size) / units
    with patch.object(search, "badness", lambda _, coefficients, *__: coefficients @ slope):
        found = better_motion(reach, "widest", 0.1 * units)  # every beginning leads there
    rows = reach._watched.reshape(reach.lines.size, -1).T
    high, low = (np.repeat(limit, reach.time.size) for limit in (reach._high, reach._low))
    shares = np.vstack([rows / high[:, None], -rows / low[:, None]])
    close = shares[shares @ found > 0.5]  # the optimum of these alone is no worse than that of all
    best = linprog(slope * units, A_ub=close * units, b_ub=np.ones(len(close)), bounds=(-9, 9)).fun
    assert reach.used(found) <= 1 + 1e-9
    assert slope @ found == pytest.approx(best, rel=0.02)

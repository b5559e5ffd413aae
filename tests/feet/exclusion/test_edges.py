"""Leans, outliers and saturated torques at their limits, on signals without noise made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import FOOT, made_recording
from plantar.contact.reasons import Reason
from plantar.conventions import Array
from plantar.feet.exclusion.edge_rolling import leaning
from plantar.feet.exclusion.moved_edges import moved_inwards
from plantar.feet.exclusion.outliers import outliers
from plantar.feet.exclusion.torque_saturation import without_torque_saturation
from plantar.feet.settings import FeetSettings
from plantar.robot.model import RobotModel

PERIOD, LOAD = 0.005, 300.0
ROWS = np.arange(2000)


def leant(
    size: float,
    samples: int = 60,
    change: float = 0.0,
    depth: float = -1e-3,
    flat: tuple[int, int] = (0, 2000),
) -> Array:
    """Samples said to lean by `size` [rad], of a visit to the edge from sample 1000 on; the excess wanders by `change`
    in a tenth of a second; the sole counts as flat from `flat[0]` to `flat[1]` alone."""
    visit = (ROWS >= 1000) & (1000 + samples > ROWS)
    wander = change * np.tile(np.repeat([0.0, 1.0], 20), 50)
    excess = np.column_stack([0.6 * size * visit + wander, 0.8 * size * visit])
    inside = np.where(visit, depth, 0.05)
    rest = (flat[0] <= ROWS) & (flat[1] > ROWS)
    return np.flatnonzero(leaning(excess, inside, np.full(2000, LOAD), visit, rest, PERIOD))


@pytest.mark.parametrize(
    ("size", "change", "found"),
    [(0.0029, 0.0, 0), (0.0031, 0.0, 60), (0.0062, 0.001, 60), (0.0047, 0.001, 0)],
)
def test_a_sole_leans_by_three_milliradians_and_six_usual_changes(
    size: float, change: float, found: int
) -> None:
    """The wander itself is in the lean, or against it, by one change; nearer to the limit nothing is certain."""
    assert len(leant(size, change=change)) == found


@pytest.mark.parametrize(
    ("start", "stop", "found"), [(890, 905, 0), (890, 899, 60), (1155, 1200, 0), (1161, 1200, 60)]
)
def test_a_flat_sole_is_looked_for_within_half_a_second(start: int, stop: int, found: int) -> None:
    """Before the visit or behind it; without one, all of the visit is a lean, however small."""
    assert len(leant(0.002, flat=(start, stop))) == found


@pytest.mark.parametrize(("samples", "small"), [(7, 0), (9, 12)])
def test_an_edge_is_known_from_four_hundredths_of_a_second_of_sure_lean(samples: int, small: int) -> None:
    """Then what is smaller than the wander is a lean there as well."""
    large = (ROWS >= 600) & (600 + samples > ROWS)
    visit = (ROWS >= 1000) & (ROWS < 1012)
    wander = np.tile(np.repeat([0.0, 0.001], 20), 50)
    excess = np.column_stack([0.1 * large + 0.0045 * visit, wander])
    inside = np.where(large | visit, -1e-3, 0.05)
    everywhere = np.ones(2000, dtype=bool)
    found = leaning(excess, inside, np.full(2000, LOAD), large | visit, everywhere, PERIOD)
    assert (found[large].sum(), found[visit].sum()) == (samples, small)


@pytest.mark.parametrize(("depth", "found"), [(0.0006, 12), (0.0008, 0)])
def test_what_is_within_seven_tenths_of_a_millimetre_of_where_it_stopped_is_at_the_edge(
    depth: float, found: int
) -> None:
    large, visit = (ROWS >= 600) & (ROWS < 640), (ROWS >= 1000) & (ROWS < 1012)
    wander = np.tile(np.repeat([0.0, 0.001], 20), 50)
    excess = np.column_stack([0.1 * large + 0.0045 * visit, wander])
    inside = np.where(large, 0.0, np.where(visit, depth, 0.05))
    said = leaning(excess, inside, np.full(2000, LOAD), large | visit, np.ones(2000, dtype=bool), PERIOD)
    assert said[visit].sum() == found


def off(bins: int, size: float, usual: float = 1.0, spread: float = 0.0, count: int = 6000) -> Array:
    """Outliers of a misfit of ± `usual`, larger over so many tenths of a second from 10 s on, at 100 Hz."""
    missed = usual * np.tile([1.0, -1.0], count // 2)
    missed[1000 : 1000 + 10 * bins] *= size / usual
    return np.flatnonzero(outliers(missed, spread, 0.01, 0.0))


@pytest.mark.parametrize(
    ("bins", "size", "spread", "found"),
    [(3, 5.9, 0.0, 0), (3, 6.1, 0.0, 30), (10, 9.0, 0.0, 100), (11, 9.0, 0.0, 0), (3, 9.0, 299.0, 30),
     (3, 9.0, 301.0, 0)],
)  # fmt: skip
def test_six_usual_misfits_for_a_second_and_three_per_cent_of_the_torque(
    bins: int, size: float, spread: float, found: int
) -> None:
    assert len(off(bins, size, spread=spread)) == found


@pytest.mark.parametrize(("seconds", "found"), [(5.9, 0), (6.1, 20)])
def test_misfits_are_compared_over_six_seconds(seconds: float, found: int) -> None:
    count = round(seconds * 100)
    missed = np.tile([1.0, -1.0], count // 2)
    missed[300:320] *= 9
    assert outliers(missed, 0.0, 0.01, 0.0).sum() == found


def test_up_to_a_tenth_of_a_recording_may_be_outliers() -> None:
    """Of 60 s twelve stretches of half a second, the filter's reach beside them counted in."""
    missed = np.tile([1.0, -1.0], 3000)
    for place in range(12):
        missed[400 + 450 * place : 440 + 450 * place] *= 9
    assert outliers(missed, 0.0, 0.01, 0.05).sum() == 600
    assert outliers(missed, 0.0, 0.01, 0.06).sum() == 0


def saturated(robot: RobotModel, share: float, angle: Array) -> set[str]:
    """What is said of a torque that grows with `share` of its slope beyond 1.2 degrees."""
    bend = np.radians(1.2)
    torque = 400.0 * np.where(angle > bend, bend + share * (angle - bend), angle)
    always = replace(robot, feet={FOOT: replace(robot.feet[FOOT], contact="always")})
    found = without_torque_saturation(always, made_recording("tips", angle, torque), FeetSettings())
    return {why.text for why in found.contacts[FOOT].reasons if why.reason is Reason.TORQUE_SATURATION}


@pytest.mark.parametrize(("share", "told"), [(0.45, True), (0.55, False)])
def test_a_torque_stops_at_half_of_its_slope(robot: RobotModel, share: float, told: bool) -> None:
    time = 0.01 * np.arange(6000)
    angle = np.radians(2.5) * np.sin(2 * np.pi * 0.2 * time) ** 5
    texts = saturated(robot, share, angle)
    assert bool(texts) == told
    assert all(text.endswith("deg positive of the resting pose") for text in texts)


def test_a_window_is_told_in_degrees(robot: RobotModel) -> None:
    angle = np.radians(2.5) * np.sin(0.0126 * np.arange(6000)) ** 5
    found = without_torque_saturation(
        robot, made_recording("sway", angle, 400 * angle), FeetSettings(window=np.radians(1.25))
    )
    assert {why.text for why in found.contacts[FOOT].reasons} == {"beyond the window of 1.25 deg"}
    assert np.abs(angle[found.used(FOOT)]).max() == pytest.approx(np.radians(1.25), abs=np.radians(0.13))


@pytest.mark.parametrize(("samples", "moved"), [(3, 0.0), (5, 0.002)])
def test_a_centre_of_pressure_outside_of_an_edge_moves_the_opposite_one(samples: int, moved: float) -> None:
    """By as much, where it is there for 0.04 s in all."""
    square = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    angle = np.zeros(3000)
    recording = made_recording("sway", angle, angle)
    depth = np.full((3000, 4), 0.05)
    depth[500 : 500 + samples, 0] = -0.002
    assert moved_inwards(recording, FOOT, depth, square).max(axis=0).max() == pytest.approx(moved)


@pytest.mark.parametrize(("deviations", "leans"), [(3.5, True), (4.5, False)])
def test_a_small_lean_counts_within_four_usual_deviations_of_where_the_pressure_stops(
    deviations: float, leans: bool
) -> None:
    """Moments stop at -0.1, 0 and 0.1 N.m in turn, a deviation of 0.148; a later visit leans by 4.5 mrad."""
    sure, later = (ROWS >= 1000) & (ROWS < 1060), (ROWS >= 1400) & (ROWS < 1460)
    wander = 0.001 * np.tile(np.repeat([0.0, 1.0], 20), 50)
    excess = np.column_stack([0.01 * sure + 0.0045 * later + wander, 0.0 * ROWS])
    moment = np.where(sure, 0.1 * (ROWS % 3 - 1), np.where(later, 0.14826 * deviations, 20.0))
    load = np.full(2000, LOAD)
    found = leaning(excess, moment / LOAD, load, sure | later, ROWS >= 0, PERIOD)
    assert found[sure].all()
    assert (found[later].all(), found[later].any()) == (leans, leans)

"""Recordings that differ widen the intervals of few and of many, and only then."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped import TRUTH, record, sway
from feet_trials import PUNCTUAL, noisy
from made_recording import FOOT, made_recording, swayed
from plantar.estimation.random_effects import Differences
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width.between_recordings import (
    Apart,
    AxisDifferences,
    apart_notes,
    axis_differences,
    between_recordings,
    recordings_apart,
)
from plantar.feet.prepare import prepare_all
from plantar.feet.regression.tangent import Tangent
from plantar.robot.model import RobotModel

LINEAR = replace(PUNCTUAL, model="kelvin_voigt")


def share(robot: RobotModel, shares: list[float], prior: float = 0.0) -> float:
    """The share of the stiffness of one axis that recordings' differences make uncertain."""
    logs = []
    for seed, own in enumerate(shares, 3):
        truth = {key: replace(law, stiffness=(1 + own) * law.stiffness) for key, law in TRUTH.items()}
        logs.append(noisy(record(sway(f"sway_{seed}", seed, truth=truth)), seed))
    ready = prepare_all(robot, logs, [], LINEAR, lambda _: None)
    fit = fit_axis(ready.fitted, "left", "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_recordings(Tangent.of(fit, ready.fitted, False), Apart(prior, 2))
    return float(cause.share[0] / fit.values[0])


@pytest.mark.parametrize("shares", [[-0.02, 0.02], [-0.02, 0.0, 0.02]])
def test_few_that_differ(robot: RobotModel, shares: list[float]) -> None:
    assert share(robot, shares) > 0.6 * np.std(shares, ddof=1) / np.sqrt(len(shares))


def test_few_that_are_alike(robot: RobotModel) -> None:
    assert share(robot, [0.0, 0.0, 0.0]) < 0.002
    assert share(robot, [0.0, 0.0, 0.0], prior=0.03) == pytest.approx(0.03 / np.sqrt(3), rel=0.1)


def test_axes_together_show_what_one_does_not() -> None:
    one = np.array([[0.004**2]])
    names = frozenset({"a", "b"})
    alike = AxisDifferences(Differences(np.array([0.0]), one), 0.001, names)
    apart = AxisDifferences(Differences(np.array([0.04]), one), 0.001, names | {"c"})
    assert recordings_apart([alike], 0.0, exact=False).share < 0.005
    pooled = recordings_apart([alike, apart, apart], 0.0, exact=False)
    assert pooled.share > 0.01
    assert pooled.others == 2
    assert recordings_apart([alike, apart, apart], 0.1, exact=False).share == 0.1
    assert recordings_apart([], 0.02, exact=False).share == 0.02


@pytest.mark.parametrize("known", [0.0003, 0.003, 0.01])
def test_differences_that_hardly_show_may_be_as_large(known: float) -> None:
    """Before they are compared, recordings differ by what they can be told apart by: a few of ten do not make it much
    larger, however well the stiffness itself is known."""
    stds = np.array([known, 30.0 * known])
    alike = AxisDifferences(Differences(np.zeros(2), np.diag(stds**2)), 1e-5, frozenset("abc"))
    assert 0.5 * known < recordings_apart([alike] * 4, 0.0, exact=False).share < 2.0 * known


def test_recordings_that_differ_are_a_result(robot: RobotModel) -> None:
    names, known = frozenset("abc"), 0.002**2 * (np.eye(2) + 1.0)
    told, alike = (
        recordings_apart(
            [AxisDifferences(Differences(np.array(found), known), 0.001, names)], 0.0, exact=False
        )
        for found in ([0.04, -0.03], [0.001, 0.002])
    )
    (note,) = apart_notes(told)
    assert (note.code, note.severity) == ("between_recordings", "info")
    assert "3 recordings" in note.text
    assert apart_notes(alike) == []


def test_what_recordings_differ_by_is_told_in_percent() -> None:
    """A standard deviation from the first and two others."""
    assert apart_notes(Apart(0.03, 2)) == []
    (note,) = apart_notes(Apart(0.03, 2, (0.012, 0.061)))
    assert "by a standard deviation of 1.2 to 6.1 % (95 %; from all axes of 3 recordings)" in note.text


def test_a_prior_that_few_recordings_hold_up_is_no_more_sure_than_these() -> None:
    angle = [swayed(3000, seed=seed) for seed in range(3)]
    recordings = [made_recording(f"sway_{k}", own, 400.0 * own) for k, own in enumerate(angle)]
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), Apart(0.05, 2))
    assert cause.freedom == 2.0
    assert cause.share[0] == pytest.approx(0.05 * 400.0 / np.sqrt(3), rel=0.1)


def test_many_that_differ_say_it_by_what_each_moves() -> None:
    """Fits without one of six recordings each (jackknife), what the fit itself is unsure by taken off."""
    stiffness = 400.0 * (1 + np.array([-0.05, 0.03, 0.0, 0.04, -0.03, 0.01]))
    noise = np.random.default_rng(1)
    recordings = []
    for seed, own in enumerate(stiffness):
        angle = swayed(3000, seed=seed)
        slow = np.convolve(noise.standard_normal(3000), np.ones(200) / 14.0, "same")
        recordings.append(made_recording(f"sway_{seed}", angle, own * angle + slow))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), Apart(0.0, 5))
    assert cause.freedom == pytest.approx(5.0)
    without = [fit_axis([*recordings[:k], *recordings[k + 1 :]], FOOT, "pitch", LINEAR) for k in range(6)]
    values = np.array([one.values for one in without if one is not None])
    jackknife = np.sqrt(5 * np.var(values, axis=0))
    assert cause.share[0] > fit.std[0] > 1.0
    assert np.hypot(cause.share, fit.std) == pytest.approx(jackknife, rel=0.01)


def test_a_number_that_hangs_on_one_recording_takes_what_recordings_differ_by() -> None:
    """Five hardly move and one does: a refit without it is the noise of the others, a hundred times too wide."""
    random = np.random.default_rng(5)
    angles = [size * swayed(3000, seed=seed) for seed, size in enumerate([1.0, *[0.003] * 5])]
    recordings = [
        made_recording(f"sway_{k}", own, 400.0 * own + 0.1 * random.standard_normal(3000))
        for k, own in enumerate(angles)
    ]
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    tangent = Tangent.of(fit, recordings, False)
    alike, apart = (between_recordings(tangent, Apart(share, 5))[0] for share in (0.0, 0.03))
    assert alike.share[0] < 0.005 * 400.0
    assert apart.share[0] == pytest.approx(0.03 * 400.0, rel=0.02)
    assert apart.freedom == 5.0


def test_few_recordings_differ_by_what_other_axes_show() -> None:
    angle = [swayed(3000, seed=seed) for seed in range(3)]
    recordings = [made_recording(f"sway_{k}", own, 400.0 * own) for k, own in enumerate(angle)]
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), Apart(0.02, 7))
    assert cause.freedom == 7.0
    assert cause.share[0] == pytest.approx(0.02 * 400.0 / np.sqrt(3), rel=0.1)


def test_recordings_that_hardly_move_say_nothing_of_how_recordings_differ() -> None:
    """One moves and knows the stiffness; in the others, fifty times smaller, half of the torque is a crosstalk. How far
    the one is off is what all axes show, and a refit without it shows nothing."""
    recordings = []
    for seed in range(6):
        angle = swayed(3000, seed=seed) / (50.0 if seed else 1.0)
        noise = 0.02 * np.random.default_rng(seed).standard_normal(3000)
        recordings.append(made_recording(f"sway_{seed}", angle, (800.0 if seed else 400.0) * angle + noise))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), Apart(0.01, 3))
    assert cause.share[0] == pytest.approx(0.01 * fit.values[0], rel=0.1)
    assert cause.freedom == 3.0
    assert axis_differences(Tangent.of(fit, recordings, False)) is None


@pytest.mark.parametrize(("count", "widened"), [(4, True), (5, False)])
def test_of_few_recordings_all_are_compared(count: int, widened: bool) -> None:
    """One knows the stiffness, the others know a hundredth and differ by a tenth: of five and more, all axes tell."""
    recordings = []
    for seed in range(count):
        angle = (0.1 if seed else 1.0) * swayed(3000, seed=seed)
        stiffness = 400.0 * (1 + (0.1 if seed % 2 else -0.1) * (seed > 0))
        noise = 0.02 * np.random.default_rng(seed).standard_normal(3000)
        recordings.append(made_recording(f"sway_{seed}", angle, stiffness * angle + noise))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), Apart(0.0, 1))
    assert bool(cause.share[0] > 0.02 * fit.values[0]) is widened


@pytest.mark.parametrize(("size", "unsure"), [(0.01, True), (0.5, False)])
def test_an_angle_that_wanders_in_a_recording_that_hardly_moves_is_no_other_stiffness(
    size: float, unsure: bool
) -> None:
    """Three alike; one of them moves less and its attitude wanders four times as much as a hundredth of the others, or
    as much as half of them: its own stiffness is a tenth, or a half. Who tells much of the stiffness differs."""
    wandering = swayed(3000, amplitude=0.0012 if unsure else 0.015, seed=9)
    recordings = []
    for seed, own in enumerate((1.0, 0.9, size)):
        angle = own * swayed(3000, seed=seed)
        noise = 0.02 * np.random.default_rng(seed).standard_normal(3000)
        read = angle + (wandering if seed == 2 else 0.0)
        recordings.append(made_recording(f"sway_{seed}", read, 400.0 * angle + noise))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    found = axis_differences(Tangent.of(fit, recordings, False))
    assert found is not None
    known = np.sqrt(np.diag(found.differences.covariance))
    assert found.differences.shares[1] < (-0.8 if unsure else -0.3)
    assert known[1] > 0.4 if unsure else known[1] < 0.1
    assert known[0] < 0.1
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), Apart(0.0, 1))
    assert (cause.share[0] < 0.01 * fit.values[0]) == unsure


def test_a_recording_that_knows_a_twentieth_is_compared() -> None:
    """Two of five recordings, by the square of their sizes: a share of a thirtieth, of a twelfth."""
    for size, compared in ((0.18, False), (0.3, True)):
        angle = [own * swayed(3000, seed=seed) for seed, own in enumerate((1.0, size, *[0.001] * 3))]
        noise = np.random.default_rng(0).standard_normal((5, 3000))
        recordings = [made_recording(f"sway_{k}", angle[k], 400.0 * angle[k] + noise[k]) for k in range(5)]
        fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
        assert fit is not None
        assert (axis_differences(Tangent.of(fit, recordings, False)) is not None) == compared


@pytest.mark.parametrize(
    ("sizes", "share", "told"),
    [
        ((1.0, 0.5, *[0.01] * 4), 0.03, 0.03 * np.hypot(0.8, 0.2)),
        ((1.0, 0.5, *[0.01] * 4), 0.0, 0.0),
        ((1.0, 0.98, *[0.01] * 4), 0.03, 0.03 / np.sqrt(2)),
        ((1.0,) * 6, 0.03, 0.0),
    ],
)
def test_few_that_know_most_are_as_far_off_as_all_axes_show(
    sizes: tuple[float, ...], share: float, told: float
) -> None:
    """Of six recordings one or two know nearly all and are alike here: by chance, if others differ. Where all know as
    much, refits tell."""
    recordings = []
    for seed, size in enumerate(sizes):
        angle = size * swayed(3000, seed=seed)
        noise = 0.2 * np.random.default_rng(seed).standard_normal(3000)
        recordings.append(made_recording(f"sway_{seed}", angle, 400.0 * angle + noise))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    apart = Apart(share, 4, (0.01, 0.06) if share else None)
    (cause,) = between_recordings(Tangent.of(fit, recordings, False), apart)
    assert cause.share[0] / fit.values[0] == pytest.approx(told, rel=0.1, abs=0.003)


@pytest.mark.parametrize(("wandering", "compared"), [(0.0012, False), (0.0, True)])
def test_a_motion_for_each_axis_leaves_each_number_to_its_own(wandering: float, compared: bool) -> None:
    """The other one moves a hundredth as much: beside an angle that wanders it could only show what rubber never does.
    Without, it shows that the rubber is the same, and is believed."""
    recordings = []
    for seed, own in enumerate((1.0, 0.01)):
        angle = own * swayed(3000, seed=seed)
        noise = 0.0002 * np.random.default_rng(seed).standard_normal(3000)
        read = angle + (seed and wandering) * swayed(3000, amplitude=1.0, seed=9)
        recordings.append(made_recording(f"sway_{seed}", read, 400.0 * angle + noise))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    assert (axis_differences(Tangent.of(fit, recordings, False)) is not None) is compared
    tangent = Tangent.of(fit, recordings, False)
    (cause,) = between_recordings(tangent, Apart(0.0, 1))
    assert cause.share[0] < 0.01 * fit.values[0]


@pytest.mark.parametrize(("size", "told"), [(0.02, False), (0.5, True)])
def test_an_axis_about_which_a_foot_hardly_turns_says_nothing_of_recordings(size: float, told: bool) -> None:
    """Three motions that hardly turn a stiff foot: its angles wander by as much, in each by another share."""
    recordings = []
    for seed, wander in enumerate((0.0003, 0.001, 0.0005)):
        angle = size * swayed(3000, seed=seed)
        noise = 0.02 * np.random.default_rng(seed).standard_normal(3000)
        read = angle + swayed(3000, amplitude=wander, seed=9 + seed)
        recordings.append(made_recording(f"sway_{seed}", read, 4000.0 * angle + noise))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    assert (axis_differences(Tangent.of(fit, recordings, False)) is not None) == told


@pytest.mark.parametrize("shared", [False, True])
def test_a_drift_is_beside_offsets_of_each_recording_alone(
    shared: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[bool] = []

    def blocks(*_: object, drift: bool, fit: object) -> list[object]:
        told.append(drift)
        return []

    monkeypatch.setattr("plantar.feet.regression.tangent.blocks_of", blocks)
    fit: Any = SimpleNamespace(foot=FOOT, axis="pitch", shape=np.zeros(0))
    assert Tangent.of(fit, [], shared).shared is shared
    assert told == [not shared]

"""Walks differ by what they and their stances show: no constant stands for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from feet_trials import PUNCTUAL
from made_recording import FOOT, made_recording, swayed
from plantar.contact.stances import Stances
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width import between_walks as module
from plantar.feet.interval_width.between_recordings import Apart, axis_differences
from plantar.feet.interval_width.between_walks import between_walks
from plantar.feet.interval_width.cause import Cause
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import data_set_of
from plantar.feet.regression.tangent import Tangent
from plantar.models import MODELS

LINEAR = replace(PUNCTUAL, model="kelvin_voigt")
ALIKE = Apart(0.0, 1)
STANCE = 100  # samples, one second


def walk(seed: int, share: float, scatter: float) -> Recording:
    """20 stances of a spring of 400 N·m/rad that is stiffer by `share`, in each by another share of size `scatter`."""
    angle, number = swayed(2000, seed=seed), np.arange(2000) // STANCE
    stiffness = 400.0 * (1 + share + scatter * np.random.default_rng(seed).standard_normal(20))
    torque = stiffness[number] * angle + 0.05 * np.random.default_rng(seed + 50).standard_normal(2000)
    recording = made_recording(f"walk_{seed}", angle, torque, stances=Stances(number, np.ones(2000)))
    recording.raw[FOOT].torque[:, 1] = 0.0  # else a turned sensor would explain all
    return recording


def cause_of(shares: list[float], scatter: float, every: Apart = ALIKE) -> tuple[AxisFit, Cause]:
    walks = [walk(seed, own, scatter) for seed, own in enumerate(shares)]
    fit = fit_axis(walks, FOOT, "pitch", LINEAR)
    assert fit is not None
    (cause,) = between_walks(Tangent.of(fit, walks, False), every)
    return fit, cause


def told(shares: list[float], scatter: float, every: Apart = ALIKE) -> float:
    """The share of the stiffness that what walks differ by makes unsure."""
    fit, cause = cause_of(shares, scatter, every)
    return float(cause.share[0] / fit.values[0])


def test_walks_that_agree_stance_by_stance_are_alike() -> None:
    """One of three walks knows its stiffness to 0.2 / sqrt(20) and to a hundredth of that."""
    assert told([0.0] * 3, 0.001) < 0.002
    assert 0.01 < told([0.0] * 3, 0.2) < 0.07


def test_walks_that_differ_show_it() -> None:
    shares = [-0.04, 0.0, 0.04]
    assert told(shares, 0.001) == pytest.approx(0.04 / np.sqrt(3), rel=0.4)
    assert cause_of(shares, 0.001)[1].freedom == 2.0, "three walks"


@pytest.mark.parametrize("scatter", [0.02, 0.2])
def test_a_single_walk_is_as_sure_as_its_stances_agree(scatter: float) -> None:
    fit, cause = cause_of([0.0], scatter)
    assert 1.0 < float(cause.share[0] / fit.std[0]) < 2.0
    assert cause.freedom == 3.0


def test_what_all_axes_show_holds_for_one_that_shows_less() -> None:
    _, cause = cause_of([0.0] * 3, 0.001, Apart(0.05, 4))
    assert cause.share[0] == pytest.approx(0.05 * 400.0 / np.sqrt(3), rel=0.05)
    assert cause.freedom == 4.0


def with_memory(fit: AxisFit) -> AxisFit:
    """A slip torque of 5 N·m at 0.01 rad beside its spring and damper."""
    return replace(
        fit, model=MODELS["elastoplastic"], values=np.append(fit.values, 5.0), shape=np.array([0.01])
    )


@pytest.mark.parametrize("differ", [0.0, 0.2], ids=["memory alike", "memory apart"])
@pytest.mark.parametrize("count", [3, 5])
def test_a_memory_is_as_unsure_as_the_stiffness_or_as_refits_without_one_walk_show(
    monkeypatch: pytest.MonkeyPatch, count: int, differ: float
) -> None:
    """Of five walks the fit's own deviation holds what spring and damper differ by, of three the cause does."""
    shares = [-0.04, 0.04, 0.0, 0.04, -0.04][:count]
    walks = [walk(seed, own, 0.01) for seed, own in enumerate(shares)]
    fit = fit_axis(walks, FOOT, "pitch", LINEAR)
    assert fit is not None
    tangent = replace(
        Tangent.of(fit, walks, False), fit=replace(with_memory(fit), turned=0.02, crosstalk=0.004)
    )
    for one in walks:
        one.raw[FOOT].torque[:, 1] = 30.0 * np.cos(one.time)
    refits = np.tile(tangent.fit.numbers, (count, 1))
    refits[0] += differ * np.array([400.0, 12.0, 5.0, 0.01])
    given: list[tuple[object, ...]] = []
    monkeypatch.setattr(module, "refits_without_each", lambda *each: given.append(each) or refits)
    (cause,) = between_walks(tangent, ALIKE)
    stiffness = float(cause.share[0] / fit.values[0]) if count == 3 else np.std(shares, ddof=1) / np.sqrt(5)
    shown = differ * (count - 1) / count  # of refits of which one is apart
    np.testing.assert_allclose(cause.share[2:] / tangent.fit.numbers[2:], max(stiffness, shown), rtol=0.4)
    assert cause.share[:2].any() == (count == 3)
    assert cause.freedom == count - 1
    ((model, shape, _, sets, cutoff),) = given
    assert (model, shape, cutoff) == (tangent.fit.model, tangent.fit.shape, walks[0].cutoff)
    placed = data_set_of(walks[1], FOOT, "pitch", sets[1].steps.share, *tangent.fit.place[1:])
    np.testing.assert_array_equal(sets[1].torque, placed.torque)
    assert np.ptp(sets[1].torque - walks[1].raw[FOOT].torque[:, 0]) == pytest.approx(
        2 * 0.02 * 30.0, rel=0.01
    )
    assert 0 < sets[1].steps.share < 1
    assert (axis_differences(Tangent.of(fit, walks, False)) is None) == (count == 5)


def test_a_single_walk_has_no_refits(monkeypatch: pytest.MonkeyPatch) -> None:
    one = walk(0, 0.0, 0.02)
    fit = fit_axis([one], FOOT, "pitch", LINEAR)
    assert fit is not None
    monkeypatch.setattr(module, "refits_without_each", None)
    (cause,) = between_walks(replace(Tangent.of(fit, [one], False), fit=with_memory(fit)), ALIKE)
    assert cause.share[2] / 5.0 == pytest.approx(cause.share[3] / 0.01)
    assert cause.share[2] / 5.0 == pytest.approx(cause.share[0] / fit.values[0])

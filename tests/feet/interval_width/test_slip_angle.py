"""A slip angle that is claimed to be known better than its derivative's step is not, and what follows it neither."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.stances import Stances
from plantar.feet.assess.diagnosis import REMEDY
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width import slip_angle
from plantar.feet.interval_width.cause import inflated
from plantar.feet.interval_width.slip_angle import (
    NAME,
    slip_angle_causes,
)
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.feet.settings import FeetSettings

UNRESOLVED = 0.005

COUNT = 6000
RUBBER = Rubber(stiffness=150.0, damping=6.0, slip_torque=2.4, slip_angle=0.01)
PLACE = 3  # of the slip angle, behind stiffness, damping and slip torque


@pytest.fixture(scope="module")
def recordings() -> list[Recording]:
    """A sway that bends rubber to one and a half slip angles, read almost without noise."""
    angle = swayed(COUNT, seed=1)
    angle *= 1.5 * RUBBER.slip_angle / np.abs(angle).max()
    torque = RUBBER.torque(angle, np.gradient(angle, PERIOD))
    torque += 1e-4 * np.random.default_rng(1).standard_normal(COUNT)
    return [made_recording("sway", angle, torque)]


def fitted(recordings: list[Recording], model: str) -> AxisFit:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model=model))
    assert fit is not None
    return fit


@pytest.fixture(scope="module")
def fit(recordings: list[Recording]) -> AxisFit:
    return fitted(recordings, "elastoplastic")


def claimed(fit: AxisFit, share: float) -> AxisFit:
    """The fit with its slip angle claimed to be known to this share of it."""
    factor = np.ones(len(fit.numbers))
    factor[PLACE] = share * fit.shape[0] / fit.std[PLACE]
    return replace(fit, covariance=fit.covariance * np.outer(factor, factor))


def test_what_is_claimed_too_well_is_known_to_half_a_per_cent(
    fit: AxisFit, recordings: list[Recording]
) -> None:
    assert fit.std[PLACE] < UNRESOLVED * fit.shape[0]
    wide = inflated(fit, slip_angle_causes(Tangent.of(fit, recordings, False)))
    assert wide.std[PLACE] == pytest.approx(0.005 * fit.shape[0], rel=1e-3)


def test_values_follow_as_a_slip_angle_moved_by_a_per_cent_moves_them(
    fit: AxisFit, recordings: list[Recording]
) -> None:
    """At K·x + T·min(x/a, 1) a larger angle a takes from the spring what the element then has, the torque staying."""
    (cause,) = slip_angle_causes(Tangent.of(claimed(fit, 1e-6), recordings, False))
    assert cause.std == pytest.approx(UNRESOLVED, rel=1e-6)
    assert cause.effect[PLACE] == pytest.approx(fit.shape[0])
    element = fit.values[2] / fit.shape[0]
    assert cause.effect[0] < -0.1 * element
    assert cause.effect[2] > 0.1 * fit.values[2]


@pytest.mark.parametrize(("share", "said"), [(0.99 * UNRESOLVED, 1), (1.01 * UNRESOLVED, 0)])
def test_what_is_claimed_less_well_is_believed(
    fit: AxisFit, recordings: list[Recording], share: float, said: int
) -> None:
    causes = slip_angle_causes(Tangent.of(claimed(fit, share), recordings, False))
    assert len(causes) == said
    if causes:  # hardly anything is missing
        assert inflated(claimed(fit, share), causes).std[PLACE] == pytest.approx(UNRESOLVED * fit.shape[0])


def test_of_a_foot_that_steps_it_is_known_less_well_and_moves_spring_and_damper_no_more(
    fit: AxisFit, recordings: list[Recording], monkeypatch: pytest.MonkeyPatch
) -> None:
    stances = Stances(np.arange(COUNT) // 500, np.ones(COUNT))
    stepping = [replace(one, stances={FOOT: stances}) for one in recordings]
    (cause,) = slip_angle_causes(Tangent.of(claimed(fit, 0.012), stepping, False))
    assert cause.std == pytest.approx(np.sqrt(0.025**2 - 0.012**2), rel=1e-6)
    assert slip_angle_causes(Tangent.of(claimed(fit, 0.012), recordings, False)) == []
    (wide,) = slip_angle_causes(Tangent.of(claimed(fit, 1e-6), stepping, False))
    monkeypatch.setattr(slip_angle, "UNRESOLVED_IN_STEPS", UNRESOLVED)
    (usual,) = slip_angle_causes(Tangent.of(claimed(fit, 1e-6), stepping, False))
    assert wide.share[:2] == pytest.approx(usual.share[:2], rel=1e-3)
    assert wide.share[2:] == pytest.approx(5 * usual.share[2:], rel=1e-3)


def test_a_spring_without_memory_has_none(recordings: list[Recording]) -> None:
    assert slip_angle_causes(Tangent.of(fitted(recordings, "kelvin_voigt"), recordings, False)) == []


def test_the_cause_has_its_remedy() -> None:
    assert NAME in REMEDY

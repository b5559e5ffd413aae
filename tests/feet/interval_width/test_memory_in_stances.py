"""What spring and element take from each other in stances, where the element turns round, and where nobody sees it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, made_recording, swayed
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width.systematic import _shared_slope
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.models import MODELS

PLACE = np.arange(2000)


@pytest.fixture(scope="module")
def linear() -> AxisFit:
    angle = swayed(2000)
    fit = fit_axis([made_recording("walk", angle, 400.0 * angle)], FOOT, "pitch", LINEAR)
    assert fit is not None
    return fit


@pytest.fixture(scope="module")
def fit(linear: AxisFit) -> AxisFit:
    """An element of 300 N·m/rad until it slips at 3 N·m and 0.01 rad."""
    values = np.array([400.0, 20.0, 3.0])
    return replace(linear, model=MODELS["elastoplastic"], values=values, shape=np.array([0.01]))


def walk(reach: float) -> Recording:
    """Stances of 0.5 s: a straight way of `reach` [rad] each."""
    angle = reach * (PLACE % 50) / 50
    return made_recording("walk", angle, 400.0 * angle, stances=Stances(PLACE // 50, np.ones(2000)))


def test_what_spring_and_element_take_from_each_other(linear: AxisFit, fit: AxisFit) -> None:
    """Before it slips, the element is a spring of slip_torque / slip_angle beside the other."""
    stands = [made_recording("walk", swayed(2000), 400.0 * swayed(2000))]
    assert _shared_slope(linear, stands) == []
    (cause,) = _shared_slope(fit, stands)
    assert cause.share == pytest.approx([0.003 * 300.0, 0.012 * 20.0, 0.012 * 3.0, 0.0])


def test_what_an_element_that_never_turns_takes_from_the_spring_leaves_their_sum(fit: AxisFit) -> None:
    (cause,) = _shared_slope(fit, [walk(0.01)])
    assert cause.share[0] == pytest.approx(300.0 / np.sqrt(3))
    assert cause.effect[0] + cause.effect[2] / 0.01 == pytest.approx(0.0)
    assert cause.share[3] == pytest.approx(0.01 / np.sqrt(3))


def test_an_element_turned_round_where_no_sample_is_used_is_a_guess_beside_a_spring_that_is_known(
    fit: AxisFit,
) -> None:
    """Stances bend the foot by three slip angles, and by less than one and a half while it is flat."""
    whole = walk(0.03)
    flat = whole.without(FOOT, PLACE % 50 > 24, Reason.NEAR_THE_EDGE)
    ((seen,), (unseen,)) = (_shared_slope(fit, [one]) for one in (whole, flat))
    assert seen.share == pytest.approx([0.9, 0.24, 0.036, 0.0])
    assert unseen.share == pytest.approx([0.9, 0.24, 3.0 / np.sqrt(3), 0.01 / np.sqrt(3)])

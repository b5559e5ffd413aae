"""Causes of width beside numbers worked out by hand: gains of sensors, turned sensors, recordings that differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from made_recording import FOOT, made_recording, swayed
from plantar.estimation.random_effects import Differences
from plantar.feet.interval_width.between_recordings import (
    Apart,
    AxisDifferences,
    apart_notes,
    recordings_apart,
)
from plantar.feet.interval_width.cause import Cause, inflated
from plantar.feet.interval_width.force_gain import (
    GainError,
    force_gain_causes,
    force_gain_notes,
    torque_gain_causes,
)
from plantar.feet.interval_width.systematic import robot_causes
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.models import KelvinVoigt
from plantar.robot.model import RobotModel

FIT = AxisFit(
    foot=FOOT, axis="pitch", model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),
    covariance=np.diag([16.0, 1.0]), freedom=np.full(2, 30.0), white_std=np.ones(2), offset_std={},
    equivalent=(400.0, 20.0), choice=None, reason="",
)  # fmt: skip


@pytest.mark.parametrize(
    ("share", "sure"), [(0.0299, False), (0.0301, True), (-0.0299, False), (-0.0301, True)]
)
def test_a_gain_is_beyond_doubt_at_three_deviations_of_all_that_explains_it(share: float, sure: bool) -> None:
    assert GainError(share, 0.0, 0.006, 0.008).sure == sure


@pytest.mark.parametrize(("share", "std"), [(0.04, 0.01), (-0.04, 0.01), (0.04, 0.2), (0.3, 0.01)])
def test_how_far_a_gain_reaches_is_a_mixture_of_usual_sensors_and_faulty_ones(
    share: float, std: float
) -> None:
    """85 of 100 are as good as told, the others off by a tenth; each given what is seen, half a deviation farther."""
    usual, other = 0.01, 0.02
    sure = abs(share) > 3 * np.hypot(usual, other)
    seen = abs(share / (1 + share)) + (0.0 if sure else 0.5 * min(std, abs(share)))
    sizes, total = np.array([usual, 0.1]), np.hypot([usual, 0.1], other)
    odds = np.array([0.85, 0.15]) * norm.pdf(seen, scale=total)
    mean, wide = seen * (sizes / total) ** 2, sizes * other / total
    reach = GainError(share, std, usual, other).reach
    most = np.sqrt(seen**2 + 1.96**2 * (std**2 + usual**2))
    outside = float(odds @ (norm.sf(reach, mean, wide) + norm.cdf(-reach, mean, wide)) / odds.sum())
    assert (
        reach == pytest.approx(most, rel=1e-4)
        if reach > 0.999 * most
        else outside == pytest.approx(0.05, rel=1e-4)
    )


def test_what_a_gain_adds_to_a_number_is_beyond_its_usual_error() -> None:
    error = GainError(0.05, 0.01, 0.01, 0.02)
    (cause,) = force_gain_causes(FIT, {FOOT: error})
    assert (cause.name, list(cause.effect)) == ("force gain", [400.0, 20.0])
    assert cause.std == pytest.approx(np.sqrt((error.reach / 1.96) ** 2 - 0.01**2), rel=1e-4)
    assert force_gain_causes(FIT, {"right": error}) == []
    assert force_gain_causes(FIT, {FOOT: GainError(0.0, 0.0, 0.01, 1e-6)}) == []
    assert torque_gain_causes(FIT, {}) == []


def test_gains_are_told_in_per_cent_of_the_weight(robot: RobotModel) -> None:
    errors = {"left": GainError(0.123, 0.01, 0.01, 0.01), "right": GainError(-0.078, 0.01, 0.01, 0.01)}
    (note,) = force_gain_notes(robot, errors)
    assert (
        "add up to the URDF's 60.0 kg: the left foot's +12 % and the right foot's -8 %. Either" in note.text
    )
    assert force_gain_notes(robot, {"left": GainError(0.02, 0.01, 0.01, 0.01)}) == []


def test_forces_that_do_not_add_up_to_a_weighed_robot_are_the_sensors_fault(robot: RobotModel) -> None:
    errors = {"left": GainError(0.123, 0.01, 0.01, 0.01)}
    (of_urdf,), (of_weighed,) = (
        force_gain_notes(each, errors) for each in (robot, replace(robot, weighed=robot.mass))
    )
    assert (
        "Either its masses are wrong, a load or a rope is not in it, or wrong are the force sensors' gains, which"
        in of_urdf.text
    )
    assert "add up to the weighed 60.0 kg" in of_weighed.text
    assert "Wrong are the force sensors' gains, which" in of_weighed.text


def sways(*stiffness: float) -> list[Recording]:
    found = []
    for seed, own in enumerate(stiffness):
        angle = swayed(3000, seed=seed)
        random = np.random.default_rng(seed)
        torque = own * angle + 0.05 * own * np.gradient(angle, 0.01) + random.normal(0, 0.3, angle.size)
        found.append(made_recording(f"sway_{seed}", angle, torque))
    return found


@pytest.mark.parametrize("turned", [0.0, 0.1])
def test_a_gain_and_a_turned_sensor_add_up(turned: float) -> None:
    """A sensor turned by ψ reads cos ψ of the torque."""
    fit = replace(FIT, turned=turned, offsets={"sway_0": 0.0})
    tangent = Tangent.of(fit, sways(400.0), False)
    causes = robot_causes(tangent, 0.003, Apart(0.0, 1))
    assert [cause.name for cause in causes] == ["sensor gain"]
    assert causes[0].std == pytest.approx(np.hypot(0.003, 1 - np.cos(turned)))
    assert list(causes[0].share) == pytest.approx([400 * causes[0].std, 20 * causes[0].std])
    assert bool(robot_causes(tangent, 0.0, Apart(0.0, 1))) == (turned > 0)


def test_causes_add_to_the_covariance_and_share_their_freedom() -> None:
    """Squares of the shares, and what they have in common; Welch and Satterthwaite's degrees of freedom."""
    wide = inflated(
        FIT, [Cause("one", np.array([3.0, -1.0]), 1.0, 2.0), Cause("two", np.array([0.0, 2.0]), 0.5)]
    )
    assert wide.covariance == pytest.approx(np.array([[16.0 + 9.0, -3.0], [-3.0, 1.0 + 1.0 + 1.0]]))
    assert wide.freedom[0] == pytest.approx(25**2 / (16**2 / 30 + 9**2 / 2))
    assert FIT.covariance[0, 0] == 16.0


def test_recordings_differ_by_what_their_axes_show_together_at_least_by_the_prior() -> None:
    differing = Differences(np.array([0.1, -0.08, 0.12]), 1e-8 * np.eye(3))
    names = frozenset({"a", "b", "c", "d"})
    apart = recordings_apart([AxisDifferences(differing, 0.001, names)] * 2, 0.01, exact=False)
    assert 0.05 < apart.share < 0.15
    assert (apart.others, apart.shown is not None) == (3, True)
    alike = AxisDifferences(Differences(np.zeros(3), 1e-8 * np.eye(3)), 0.01, names)
    assert recordings_apart([alike], 0.03, exact=False) == Apart(0.03, 3, None)
    assert recordings_apart([], 0.03, exact=False) == Apart(0.03, 1)
    (note,) = apart_notes(Apart(0.05, 3, (0.0123, 0.0456)))
    assert "by a standard deviation of 1.2 to 4.6 % (95 %; from all axes of 4 recordings)" in note.text
    assert apart_notes(Apart(0.05, 3)) == []


@pytest.mark.parametrize(("low", "severity"), [(0.029, "info"), (0.031, "warning")])
def test_recordings_that_surely_differ_by_over_three_per_cent_are_warned_of(
    low: float, severity: str
) -> None:
    (note,) = apart_notes(Apart(0.05, 3, (low, 0.1)))
    assert note.severity == severity

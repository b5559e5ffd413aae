"""Steps tell how the IMU is turned in its mount; angles are put right, and what is not known widens the fit."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from made_recording import FOOT, PERIOD, made_recording
from plantar.contact.stances import Stances
from plantar.conventions import Array
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.interval_width.sensor_causes import imu_turn_causes
from plantar.feet.place.imu_mount import ImuTurn
from plantar.feet.prepare import PreparedLogs
from plantar.feet.put_right.imu_of_steps import imu_turn_notes, is_worth, put_right, turn_shown
from plantar.feet.recording import Recording
from plantar.feet.regression.tangent import Tangent
from plantar.feet.settings import FeetSettings
from plantar.models import KelvinVoigt
from plantar.signals.filters import differentiate

MOUNT = 0.01  # rad
TURN = np.array([0.012, -0.02, 0.0])
STIFFNESS, DAMPING, STEPS, STEP = 420.0, 18.0, 40, 120


@pytest.fixture(scope="module")
def exact() -> Recording:
    """Steps that differ, the ankle turned otherwise beside the IMU in each, as the torque says they are."""
    rng, count = np.random.default_rng(3), STEPS * STEP
    along = np.tile(np.linspace(0.0, 1.0, STEP), STEPS)
    size = np.repeat(rng.uniform(0.5, 1.5, STEPS), STEP)
    angle = 0.02 * size * np.sin(2 * np.pi * along + np.repeat(rng.uniform(0, 6, STEPS), STEP))
    way = np.repeat(rng.uniform(-0.5, 0.5, (2, STEPS)), STEP, axis=1)
    effects = np.zeros((count, 2, 3))
    effects[:, 0, 0], effects[:, 0, 1] = 1.0, 0.3 * way[1] * along
    effects[:, 0, 0] += 0.5 * way[0] * along
    stances = Stances(np.arange(count) // STEP, np.ones(count))
    torque = STIFFNESS * angle + DAMPING * np.gradient(angle, PERIOD) + rng.normal(0, 0.02, count)
    recording = made_recording("walk", angle, torque, stances=stances)
    both = np.column_stack([torque, rng.normal(0, 5, count)])
    loads = {name: replace(bush, wrench=rng.normal(0, 50, bush.wrench.shape), force_z=rng.uniform(300, 700, count),
                           torque=both) for name, bush in recording.bushes.items()}  # fmt: skip
    return replace(recording, bushes=loads, raw=loads, imu_turns={FOOT: effects})


@pytest.fixture(scope="module")
def read(exact: Recording) -> Recording:
    """As an IMU reads them that is turned by TURN, and is taken not to be."""
    x, y, z = (-TURN).tolist()
    return exact.with_imu_turned((x, y, z))


def ready(recording: Recording) -> PreparedLogs:
    none: Any = None
    return PreparedLogs(
        none,
        (recording,),
        (),
        FeetSettings(),
        none,
        none,
        (),
        imu_turn=ImuTurn.unknown(MOUNT),
        gain_errors={},
        torque_gains={},
        turned={},
        slow_filter=None,
        bending=none,
    )


def fitted(logs: PreparedLogs) -> dict[str, FittedFoot]:
    fit = fit_axis(logs.fitted, FOOT, "pitch", FeetSettings(), KelvinVoigt())
    assert fit is not None
    thin: Any = SimpleNamespace(fitted=logs.fitted)
    return {FOOT: FittedFoot(FOOT, None, {"pitch": fit}, {}, logs, thin, (), elsewhere=None)}  # type: ignore[arg-type]


def stiffness(feet: dict[str, FittedFoot]) -> float:
    return float(feet[FOOT].fits["pitch"].values[0])


def test_the_turn_is_found_and_the_stiffness_with_it(read: Recording) -> None:
    logs = ready(read)
    feet = fitted(logs)
    shown = turn_shown(feet, logs.imu_turn, MOUNT)
    assert shown is not None
    np.testing.assert_allclose(shown.angles[:2], TURN[:2], atol=0.002)
    assert (shown.angles[2], shown.covariance[2, 2]) == pytest.approx((0.0, MOUNT**2)), "nothing shows it"
    assert is_worth(shown, logs.imu_turn)
    right = put_right(logs, shown)
    assert right.imu_turn is shown
    before, after = (abs(stiffness(own) / STIFFNESS - 1) for own in (feet, fitted(right)))
    assert after < 0.005
    assert before > 3 * after
    again = turn_shown(fitted(right), right.imu_turn, MOUNT)
    assert again is not None
    assert not is_worth(again, shown)
    np.testing.assert_allclose(again.angles, shown.angles, atol=0.001)


def test_what_was_put_right_once_is_not_put_right_twice(exact: Recording, read: Recording) -> None:
    x, y, z = TURN.tolist()
    told = put_right(ready(read), ImuTurn((x, y, z), np.zeros((3, 3))))
    for states in (told.fitted[0].bushes, told.fitted[0].raw):
        np.testing.assert_allclose(states[FOOT].deflection, exact.bushes[FOOT].deflection, atol=1e-12)
        np.testing.assert_allclose(states[FOOT].rate, exact.bushes[FOOT].rate, atol=1e-9)
    assert put_right(told, told.imu_turn).fitted[0] is told.fitted[0]


def test_rates_are_those_of_the_angles_and_the_air_stays_as_it_is(exact: Recording) -> None:
    effects = exact.imu_turns[FOOT].copy()
    effects[:STEP] = np.nan
    turned = replace(exact, imu_turns={FOOT: effects}).with_imu_turned((0.01, 0.0, 0.0))
    angle, rate = (
        getattr(turned.bushes[FOOT], name) - getattr(exact.bushes[FOOT], name)
        for name in ("deflection", "rate")
    )
    assert not angle[:STEP].any()
    assert not rate[: STEP - 2].any()
    slope: Array = differentiate(0.01 * effects[:, :, 0], exact.period)
    np.testing.assert_allclose(rate[STEP + 2 :], slope[STEP + 2 :], atol=1e-12)
    assert np.abs(rate[STEP - 2 : STEP + 2]).max() < 0.1, "no jump from the air into a stance"


def test_nothing_is_told_by_who_does_not_step_or_is_told_exact(read: Recording) -> None:
    logs = ready(read)
    assert turn_shown(fitted(logs), logs.imu_turn, 0.0) is None
    still = ready(replace(read, stances={FOOT: None}))
    feet = fitted(logs)
    feet[FOOT] = replace(feet[FOOT], thin=still)
    assert turn_shown(feet, still.imu_turn, MOUNT) is None


def test_what_is_not_known_of_the_turn_widens_the_fit(read: Recording) -> None:
    logs = ready(read)
    fit = fitted(logs)[FOOT].fits["pitch"]
    (wide,), (narrow,) = (
        imu_turn_causes(Tangent.of(fit, logs.fitted, False), ImuTurn.unknown(std))
        for std in (MOUNT, MOUNT / 2)
    )
    np.testing.assert_allclose(wide.share, 2 * narrow.share)
    assert wide.share[0] > abs(fit.values[0] - STIFFNESS) / 4
    assert imu_turn_causes(Tangent.of(fit, logs.fitted, False), ImuTurn.unknown(0.0)) == []
    standing = [replace(read, stances={FOOT: None})]
    assert imu_turn_causes(Tangent.of(fit, standing, False), ImuTurn.unknown(MOUNT)) == []


def test_a_turn_far_beyond_the_robot_files_is_a_warning() -> None:
    assert imu_turn_notes(ImuTurn.unknown(MOUNT), MOUNT) == []
    (some,) = imu_turn_notes(ImuTurn((0.01, 0.0, 0.0), 1e-6 * np.eye(3)), MOUNT)
    (far,) = imu_turn_notes(ImuTurn((0.0, -0.05, 0.0), 1e-6 * np.eye(3)), MOUNT)
    assert (some.severity, far.severity) == ("info", "warning")
    assert "x -0.57 ± 0.11" in some.text, (
        "the angles are put right by the opposite of what the IMU is turned by"
    )


@pytest.mark.parametrize(("share", "severity"), [(2.9, "info"), (3.1, "warning"), (-3.1, "warning")])
def test_a_turn_is_worth_a_look_from_three_deviations_on(share: float, severity: str) -> None:
    (note,) = imu_turn_notes(ImuTurn((0.0, share * 0.01, 0.002), 1e-6 * np.eye(3)), 0.01)
    assert note.severity == severity
    assert f"y {-np.degrees(share * 0.01):+.2f} ± 0.11" in note.text

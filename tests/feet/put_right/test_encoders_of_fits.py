"""Encoders that are late beside the IMU: fits of standing feet show it beside what Newton's law says of them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.stances import Stances
from plantar.conventions import Array
from plantar.feet import identify
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.place.imu_mount import ImuTurn
from plantar.feet.prepare import PreparedLogs
from plantar.feet.put_right.encoders_of_fits import (
    Late,
    encoders_shown,
    newton_told,
    read_at,
    retold,
    tried_first,
)
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.models import MODELS
from plantar.notes import Note
from plantar.sensors.delays.sensor_delay import SensorDelay

COUNT, STIFFNESS, DAMPING = 4000, 420.0, 17.0
LATE = 0.0006  # s
JOINTS = 10 * swayed(COUNT, seed=7)[::-1]  # rad: hips turn ten times as far as the bush
RATES = np.gradient(JOINTS, PERIOD)
NEWTON = Late(0.0003, 0.0004)


def recorded(late: float, slip_torque: float = 0.0) -> Recording:
    """A foot whose bush's angle is off by what encoders are later than Newton's law says; rubber slips at 0.01 rad."""
    angle = swayed(COUNT)
    torque = STIFFNESS * angle + DAMPING * np.gradient(angle, PERIOD)
    torque += slip_torque * slipped(angle) + np.random.default_rng(1).normal(0, 0.02, COUNT)
    recording = made_recording("sway", angle - late * RATES, torque)
    return replace(recording, encoder_rates={FOOT: np.column_stack([RATES, RATES])})


def slipped(angle: Array) -> Array:
    states, state = np.zeros(COUNT), 0.0
    for row, step in enumerate(np.diff(angle, prepend=angle[0])):
        state = float(np.clip(state + step / 0.01, -1, 1))
        states[row] = state
    return states


def ready(recording: Recording, delay: Late = NEWTON) -> PreparedLogs:
    none: Any = None
    told = SensorDelay(0.005, 3e-4, np.inf, True, Note("delay", "info", ""), {}, delay.value, delay.std)
    return PreparedLogs(
        none,
        (recording,),
        (),
        FeetSettings(),
        told,
        none,
        (),
        gain_errors={},
        torque_gains={},
        turned={},
        imu_turn=ImuTurn.unknown(0.0),
        slow_filter=None,
        bending=none,
    )


def fitted(logs: PreparedLogs, model: str = "kelvin_voigt") -> dict[str, FittedFoot]:
    fit = fit_axis(logs.fitted, FOOT, "pitch", FeetSettings(), MODELS[model])
    assert fit is not None
    thin: Any = SimpleNamespace(fitted=logs.fitted)
    return {FOOT: FittedFoot(FOOT, None, {"pitch": fit}, {}, logs, thin, (), elsewhere=None)}  # type: ignore[arg-type]


@pytest.mark.parametrize(("model", "slip_torque"), [("kelvin_voigt", 0.0), ("elastoplastic", 3.0)])
def test_late_encoders_are_found_and_what_they_took_for_damping_is_gone(
    model: str, slip_torque: float
) -> None:
    """At once also where rubber slips, which as a spring is nearly as stiff as the bush."""
    logs = read_at(ready(recorded(LATE - NEWTON.value, slip_torque)), Late(0.0, NEWTON.std))
    feet = fitted(logs, model)
    shown = encoders_shown(feet, NEWTON, 0.0)
    assert shown is not None
    assert shown.value == pytest.approx(LATE, abs=5e-5)
    assert shown.std < 5e-5
    assert shown.is_worth(0.0)
    right = read_at(logs, shown)
    assert (right.sensor_delay.encoders, right.sensor_delay.encoders_std) == shown
    before, after = (float(own[FOOT].fits["pitch"].values[1]) for own in (feet, fitted(right, model)))
    assert abs(before / DAMPING - 1) > 0.02
    assert after == pytest.approx(DAMPING, rel=0.01)
    again = encoders_shown(fitted(right, model), NEWTON, shown.value)
    assert again is not None
    assert not again.is_worth(shown.value)


def test_force_sensors_are_read_with_the_encoders_as_newton_ties_them() -> None:
    """Newton's law had both 0.0015 s early, as where it knows only how far they are apart: damping is off by K times
    as much until the fits show the encoders."""
    late = 0.0015
    logs = ready(recorded(0.0), Late(0.0, NEWTON.std))
    logs = replace(logs, fitted=(logs.fitted[0].with_wrenches_later(-late),))
    logs = replace(logs, sensor_delay=replace(logs.sensor_delay, follows=1.25, feet={FOOT: 0.004}))
    right = read_at(replace(logs, unseen=logs.fitted), Late(late / 1.25, 1e-4))
    np.testing.assert_array_equal(right.unseen[0].bushes[FOOT].torque, right.fitted[0].bushes[FOOT].torque)
    assert right.sensor_delay.delay == pytest.approx(0.005 + late)
    assert right.sensor_delay.feet == pytest.approx({FOOT: 0.004 + late})
    torques = [one.fitted[0].bushes[FOOT].torque[50:-50, 0] for one in (logs, right, ready(recorded(0.0)))]
    before, after = (float(np.std(torque - torques[2])) for torque in torques[:2])
    assert after < 0.15 * before


def test_joints_that_hardly_move_tell_nothing_where_no_noise_hides_what_the_law_misses() -> None:
    """A bush that hardens by a ten-thousandth passes for encoders that are late by far more than its deviation says."""
    angle = swayed(COUNT)
    torque = STIFFNESS * angle * (1 + 3e-4 * (angle / angle.std()) ** 2) + DAMPING * np.gradient(
        angle, PERIOD
    )
    rates = np.column_stack([RATES, RATES])

    def told(share: float) -> Late:
        recording = replace(made_recording("sway", angle, torque), encoder_rates={FOOT: share * rates})
        shown = encoders_shown(fitted(ready(recording)), NEWTON, 0.0)
        assert shown is not None
        return shown

    assert told(1e-3).std == pytest.approx(NEWTON.std, rel=0.1)
    assert told(1.0).std < 0.1 * NEWTON.std


def test_where_no_joint_turns_newton_is_believed() -> None:
    still = replace(recorded(0.0), encoder_rates={FOOT: np.zeros((COUNT, 2))})
    assert encoders_shown(fitted(ready(still)), NEWTON, 0.0) is None


def test_what_newton_knows_well_outweighs_a_fit_and_what_is_no_delay_is_left() -> None:
    feet = fitted(read_at(ready(recorded(LATE - NEWTON.value)), Late(0.0, 1e-4)))
    sure = encoders_shown(feet, Late(0.0, 1e-9), 0.0)
    assert sure is not None
    assert sure.value == pytest.approx(0.0, abs=1e-7)
    far = fitted(read_at(ready(recorded(0.0055 - NEWTON.value)), Late(0.0, 1e-4)))
    assert encoders_shown(far, NEWTON, 0.0) is None


def test_a_fit_asks_only_of_feet_that_stand_and_encoders_that_newton_tells() -> None:
    stood = recorded(LATE)
    assert newton_told(ready(stood)) == NEWTON
    assert newton_told(ready(stood, Late(0.0, 0.001))) is None, "no better than what is usual"
    assert newton_told(ready(stood, Late(0.0, 0.0))) is None
    walk = replace(stood, stances={FOOT: Stances(np.zeros(COUNT, dtype=int), np.ones(COUNT))})
    assert newton_told(ready(walk)) is None
    logs = ready(stood)
    for doubt in ({"measured": False}, {"doubtful": True}):
        assert newton_told(replace(logs, sensor_delay=replace(logs.sensor_delay, **doubt))) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(("told", "first"), [(0.0014, 0.0), (-0.0014, 0.0), (-0.0016, -0.0016)])
def test_most_robots_read_all_at_once(told: float, first: float) -> None:
    assert tried_first(Late(told, 3e-4)) == first


@pytest.mark.parametrize(
    ("late", "worth"), [(Late(4e-5, 1e-6), False), (Late(6e-5, 1e-6), True), (Late(-2.9e-4, 1e-4), False)]
)
def test_a_fit_is_made_again_for_what_is_clear_and_matters(late: Late, worth: bool) -> None:
    assert late.is_worth(0.0) == worth


def test_the_note_says_how_the_logs_are_read_now() -> None:
    robot: Any = SimpleNamespace(feet={"left": None, "right": None})
    other = Note("gap", "info", "0.2 s missing")
    logs = ready(recorded(0.0))
    told = replace(
        logs.sensor_delay, note=Note("delay", "info", "wrenches are +5.0 ms late"), feet={"right": 0.007}
    )
    before = replace(logs, robot=robot, sensor_delay=told, notes=(other, told.note))
    after = retold(read_at(before, Late(LATE, 1e-5)))
    assert after.notes == (other, after.sensor_delay.note)
    assert after.sensor_delay.note.text == (
        "wrenches are +5.0 ms late; fits of the standing feet then showed encoders +0.6 ms late beside the IMU, "
        "and all is read so (wrenches: left +5.0, right +7.0 ms)"
    )


@pytest.mark.parametrize(
    ("shown", "again"), [(None, False), (Late(0.0002, 0.0001), False), (Late(0.0021, 0.0003), True)]
)
def test_feet_are_fitted_again_where_they_show_another_delay_than_they_were_read_at(
    shown: Late | None, again: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """First at none, as Newton's law says nothing clear; what is fitted again is read as the fits show it."""

    def as_read(ready: Any, late: Late) -> Any:
        return SimpleNamespace(sensor_delay=SimpleNamespace(encoders=late.value), std=late.std, told=False)

    monkeypatch.setattr(identify, "read_at", as_read)
    monkeypatch.setattr(identify, "retold", lambda ready: SimpleNamespace(**vars(ready) | {"told": True}))
    monkeypatch.setattr(identify, "_fitted_feet", lambda ready, _: {"left": ready.sensor_delay.encoders})
    asked: list[Any] = []
    monkeypatch.setattr(identify, "encoders_shown", lambda *told: asked.append(told) or shown)
    said: list[str] = []
    ready, feet = identify._with_encoders_right(SimpleNamespace(), NEWTON, said.append)  # type: ignore[arg-type]
    assert asked == [({"left": 0.0}, NEWTON, 0.0)]
    assert feet == {"left": shown.value if again and shown else 0.0}
    assert (ready.std, ready.told, len(said)) == (
        (shown.std, True, 1) if again and shown else (NEWTON.std, False, 0)
    )

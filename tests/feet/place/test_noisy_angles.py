"""What noise of angles and encoders read apart from the IMU make of a bush's place: it is not believed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.place import bush_place
from plantar.feet.place.bush_place import about_its_place
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.recording import Recording

STIFFNESS, PUSHED = 400.0, 0.8  # N.m/rad; m: how far above the bush a hand pushes


def pushed(seed: int, wander: float) -> Recording:
    """A foot that a push at one height bends: the horizontal force goes with the angle, which is read with `wander`
    [rad] of a slow random walk and white noise."""
    random, bend = np.random.default_rng(seed), swayed(seed=seed)
    walk = np.cumsum(random.standard_normal(len(bend))) * wander / np.sqrt(len(bend))
    read = bend + walk + 0.1 * wander * random.standard_normal(len(bend))
    one = made_recording(f"push_{seed}", read, STIFFNESS * bend, rate=np.gradient(bend, PERIOD))
    state = one.bushes[FOOT]
    wrench = state.wrench.copy()
    wrench[:, 0] = STIFFNESS / PUSHED * bend + 0.3 * swayed(seed=seed + 50) / 0.03
    own = {FOOT: replace(state, wrench=wrench)}
    noise = {FOOT: np.array([[0.1 * wander] * 2, [0.0] * 2]) ** 2}
    return replace(one, raw=own, bushes=own, noise=noise, imu_turns={FOOT: np.zeros((len(bend), 2, 3))})


@pytest.mark.parametrize("wander", [1e-3, 3e-4])
def test_a_push_does_not_turn_noise_of_the_angle_into_another_place(wander: float) -> None:
    """The noise takes 0.05 % off the spring by itself, and 1 % where a place beside it takes up the rest."""
    recordings = [pushed(seed, wander) for seed in range(4)]
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    placed = about_its_place(fit, recordings, PlaceSpread(0.003, 0.003, 0.0), shared=False)
    assert placed.values[0] == pytest.approx(STIFFNESS, rel=0.002)
    assert abs(placed.moment_arms[1]) < 0.001
    assert placed.std[0] < 0.005 * STIFFNESS


def shown(seed: int, wander: float) -> Recording:
    """Forces, the other torque and hips move by themselves, so that half a minute shows the place; the angle is read
    with `wander` [rad] of a random walk."""
    random, time = np.random.default_rng(seed), PERIOD * np.arange(3000)

    def moved(size: float) -> Array:
        tones = zip(random.uniform(0.05, 0.25, 2), random.uniform(0, 2 * np.pi, 2), strict=True)
        return np.asarray(size * sum(np.sin(2 * np.pi * rate * time + phase) for rate, phase in tones))

    bend = moved(0.03)
    walk = wander * np.cumsum(random.standard_normal(len(time))) / np.sqrt(len(time))
    one = made_recording(f"shown_{seed}", bend + walk, STIFFNESS * bend, rate=np.gradient(bend, PERIOD))
    state, turns = one.bushes[FOOT], np.zeros((len(time), 2, 3))
    wrench, torque = state.wrench.copy(), np.column_stack([STIFFNESS * bend, moved(8.0)])
    wrench[:, 0] = moved(10.0)
    wrench[:, 2] += moved(60.0)
    turns[:, 0] = np.column_stack([moved(0.1) for _ in range(3)])
    own = {FOOT: replace(state, wrench=wrench, torque=torque)}
    return replace(one, raw=own, bushes=own, imu_turns={FOOT: turns})


def test_a_spring_beside_places_is_as_unsure_as_an_attitude_that_wanders() -> None:
    """Eight columns take up much of a random walk, and what is left tells too little: errors were 1.8 deviations."""
    told = []
    for seed in range(24):
        fit = fit_axis([shown(seed, 3e-4)], FOOT, "pitch", LINEAR)
        assert fit is not None
        placed = about_its_place(fit, [shown(seed, 3e-4)], PlaceSpread(0.02, 0.02, 0.02), shared=False)
        told.append((placed.values[0] - STIFFNESS) / placed.std[0])
    assert 0.6 < np.sqrt(np.mean(np.square(told))) < 1.5


def test_what_noise_may_have_made_is_as_doubtful_as_it_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    """A correction of 100 mm may as well be none or twice as much: of that the robot file's 3 mm stay."""
    recordings = [pushed(seed, 3e-4) for seed in range(2)]
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None

    def taken(blocks: Any, values: Array, **_: Any) -> Array:
        return np.where(np.arange(len(values)) == 3, 0.1, 0.0)  # of the height

    monkeypatch.setattr(bush_place, "attenuation", taken)
    found = about_its_place(fit, recordings, PlaceSpread(0.003, 0.003, 0.0), shared=False)
    assert abs(found.moment_arms[1]) < 0.003


@pytest.mark.parametrize(("late", "height"), [(-0.004, 0.0), (0.004, 0.0), (-0.004, 0.03), (0.0, 0.03)])
def test_encoders_read_apart_from_the_imu_are_no_height(late: float, height: float) -> None:
    """Servos that lag push sideways with the joints' rate, 60 N for 0.4 rad/s: 4 ms of a bush of 400 N·m/rad are as
    much torque as a centre 10 mm higher; what else pushes tells them apart."""
    bent, hip = swayed(seed=1), 2.5 * swayed(seed=2)
    random = np.random.default_rng(4)
    joints, time = np.gradient(hip, PERIOD), PERIOD * np.arange(len(bent))
    pushes = 10.0 * np.sin(2 * np.pi * 0.17 * time) + 8.0 * np.sin(2 * np.pi * 0.53 * time + 1)
    across = 150.0 * joints + pushes
    torque = STIFFNESS * (bent + late * joints) + 8.0 * np.gradient(bent, PERIOD) - height * across
    torque += random.normal(0, 0.05, len(bent))
    recording = made_recording("sway", bent, torque)
    recording.bushes[FOOT].wrench[:, 0] = across
    rates = {FOOT: np.column_stack([joints, joints])}
    fits = []
    for told in ({}, rates):
        one = replace(recording, encoder_rates=told, imu_turns={FOOT: np.zeros((len(bent), 2, 3))})
        fit = fit_axis([one], FOOT, "pitch", LINEAR)
        assert fit is not None
        fits.append(about_its_place(fit, [one], PlaceSpread(0.005, 0.005, 0.0), shared=False))
    blind, found = (abs(abs(fit.moment_arms[1]) - height) for fit in fits)
    assert found < 0.002
    assert not late or blind > 2 * found

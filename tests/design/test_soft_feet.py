"""The robot on soft feet beside its equations of motion, integrated by another library."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import design_samples
from plantar.conventions import GRAVITY
from plantar.design.soft_feet import Pendulum, Softness, respond
from plantar.errors import MotionError
from plantar.motions.profile import window

PENDULUM = Pendulum(
    50.0, np.array([30.0, 28.0]), 0.7, {"left": np.array([0.0, 0.1]), "right": np.array([0.0, -0.1])}
)
BUSH = Softness(400.0, 16.0, 2e5, 1e3)
PERIOD = 0.01
TIME = np.arange(2000) * PERIOD
SWAY = window(TIME, 1.0, 15.0, 2.0) * np.sin(2 * np.pi * 0.4 * TIME)


def flat(size: int = TIME.size) -> dict[str, np.ndarray]:
    return {foot: np.zeros((2, size)) for foot in PENDULUM.places}


def test_pitch_is_that_of_a_pendulum_on_two_springs() -> None:
    """I α̈ + 2 C α̇ + (2 K - m g h) α = -moment, by Runge and Kutta."""
    moment = 5.0 * SWAY
    wrench = np.stack([0 * TIME, 0 * TIME, moment])
    found = respond(PENDULUM, BUSH, wrench, flat(), PERIOD, beside=(0.0, 0.0))
    stiff = 2 * BUSH.stiffness - PENDULUM.mass * GRAVITY * PENDULUM.height

    def rate(t: float, y: np.ndarray) -> list[float]:
        pushed = -np.interp(t, TIME, moment) - 2 * BUSH.damping * y[1] - stiff * y[0]
        return [y[1], pushed / PENDULUM.inertia[1]]

    lean = solve_ivp(rate, (0, TIME[-1]), [0, 0], t_eval=TIME, rtol=1e-8, atol=1e-10, max_step=PERIOD).y
    for foot in PENDULUM.places:
        assert found.deflection[foot][0] == pytest.approx(-lean[0], abs=2e-4 * np.abs(lean[0]).max())
        assert found.rate[foot][0] == pytest.approx(-lean[1], abs=2e-3 * np.abs(lean[1]).max())
        assert found.load[foot] == pytest.approx(0.0, abs=1e-9)


def test_ankles_against_one_another_bend_the_rubber_and_leave_the_body() -> None:
    tilts = flat()
    tilts["left"][1], tilts["right"][1] = 0.02 * SWAY, -0.02 * SWAY
    found = respond(PENDULUM, BUSH, np.zeros((3, TIME.size)), tilts, PERIOD, beside=(0.0, 0.0))
    assert found.deflection["left"][0] == pytest.approx(-0.02 * SWAY, abs=1e-9)
    quick = 0.02 * np.gradient(SWAY, PERIOD)
    assert found.rate["left"][0] == pytest.approx(-quick, abs=2e-3 * np.abs(quick).max())
    for moved in (found.deflection, found.rate):
        assert moved["right"][0] == pytest.approx(-moved["left"][0], abs=1e-9)


def test_a_sway_to_the_left_loads_the_left_foot() -> None:
    """A slow moment about x is carried by the loads, half the way apart each, but for what leaning and rubber take."""
    slow = window(TIME, 1.0, 18.0, 5.0)
    found = respond(
        PENDULUM, BUSH, np.stack([0 * TIME, 10.0 * slow, 0 * TIME]), flat(), PERIOD, beside=(0.0, 0.0)
    )
    row = TIME.size // 2
    assert found.load["left"][row] > 0
    assert found.load["left"][row] == pytest.approx(-found.load["right"][row], rel=1e-6)
    lean = -found.deflection["left"][1, row]
    torque = sum(
        BUSH.stiffness * found.deflection[foot][1, row] + BUSH.damping * found.rate[foot][1, row]
        for foot in PENDULUM.places
    )
    moment = 0.2 * found.load["left"][row] + torque + PENDULUM.mass * GRAVITY * PENDULUM.height * lean
    assert moment == pytest.approx(10.0, rel=1e-3)


def test_with_a_foot_ahead_the_lean_rolls_the_ankles_most_on_soft_feet() -> None:
    """About the line through the bushes, on which two springs stand against gravity; beside one another they do not."""
    slow, row = window(TIME, 1.0, 18.0, 5.0), TIME.size // 2
    ahead = {"left": np.array([-0.025, 0.1]), "right": np.array([0.025, -0.1])}
    line = (ahead["right"] - ahead["left"]) / np.linalg.norm(ahead["right"] - ahead["left"])
    stiff = replace(BUSH, vertical=1e9)  # soles do not sink: nothing but that lean is left
    weight = PENDULUM.mass * GRAVITY * PENDULUM.height
    asked = np.stack([0 * TIME, 2.0 * slow * line[0], 2.0 * slow * line[1]])
    for stiffness in (250.0, 1000.0):
        bush = replace(stiff, stiffness=stiffness)
        bent = respond(
            replace(PENDULUM, places=ahead), bush, asked, flat(), PERIOD, beside=(0.0, 0.0)
        ).deflection["left"]
        lean = 2.0 / (2 * stiffness - weight)
        assert bent[::-1, row] == pytest.approx(lean * line, rel=0.02)
        beside = respond(PENDULUM, bush, asked, flat(), PERIOD, beside=(0.0, 0.0)).deflection["left"]
        assert np.abs(beside[1]).max() < 1e-3 * np.abs(bent[1]).max()


@pytest.mark.parametrize("size", [2.0, -3.0])
def test_twice_the_motion_is_twice_the_response(size: float) -> None:
    wrench = np.stack([SWAY, SWAY**2, SWAY])
    one, other = (respond(PENDULUM, BUSH, k * wrench, flat(), PERIOD, beside=(0.0, 0.0)) for k in (1.0, size))
    assert other.rate["left"] == pytest.approx(size * one.rate["left"])


def test_feet_that_cannot_hold_the_robot_are_refused_with_what_would() -> None:
    least = 1.05 * PENDULUM.mass * GRAVITY * PENDULUM.height / 2
    PENDULUM.check_carried(least + 1e-6, "a robot")
    with pytest.raises(MotionError, match=rf"cannot hold the robot upright \(valid: at least {least:.4g} "):
        PENDULUM.check_carried(0.99 * least, "a robot")


def test_told_and_scaled() -> None:
    told = design_samples.told()
    assert told.damping == pytest.approx(0.04 * told.stiffness)
    assert told.times(2.0) == replace(told, stiffness=2 * told.stiffness, damping=2 * told.damping)


def test_what_presses_slowly_is_carried_by_both_feet_and_no_more() -> None:
    """All of it within a ten thousandth, by what the rubber gives way: no weight tips what only goes up and down."""
    force = 100.0 * window(TIME, 2.0, 14.0, 6.0)
    found = respond(PENDULUM, BUSH, np.stack([force, 0 * TIME, 0 * TIME]), flat(), PERIOD, beside=(0.0, 0.0))
    for load in found.load.values():
        assert load[800:1200] == pytest.approx(force[800:1200] / 2, rel=1e-4)

"""The state of an element at each landing, against the element followed through the air."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.model_selection.landing import Hysteresis, landing_states
from plantar.models import MODELS, BushMotion

K, SLIP_TORQUE, SLIP_ANGLE = 400.0, 3.0, 0.01
OFFSET = 1.5  # N.m: the attitude's zero times K


def followed(ends: list[tuple[float, float]], first: float) -> tuple[list[Array], Array]:
    """Stances from landing to lifting at these deflections, and the true state (stances,) at each landing.

    The whole path runs through the element, in the air to where spring, element and offset balance.
    """
    model, pieces, marks, path = MODELS["elastoplastic"], [], [], np.array([ends[0][0]])
    for place, (landing, lifting) in enumerate(ends):
        if place:
            path = np.concatenate([path, np.linspace(path[-1], air(path, first), 400)])
            path = np.concatenate([path, np.linspace(path[-1], landing, 400)])
        marks.append(len(path) - 1)
        stance = np.concatenate([np.linspace(landing, -0.02, 300), np.linspace(-0.02, lifting, 300)])
        pieces.append(stance)
        path = np.concatenate([path, stance])
    whole = BushMotion(path, np.zeros(len(path)), 0.001)
    return pieces, model.columns(whole, [SLIP_ANGLE], np.array([first]))[marks, 2]


def air(path: Array, first: float) -> float:
    """The deflection at which a lifted bush carries no torque, by bisection along the way back."""
    model = MODELS["elastoplastic"]

    def torque(there: float) -> float:
        way = np.concatenate([path, np.linspace(path[-1], there, 200)])
        motion = BushMotion(way, np.zeros(len(way)), 0.001)
        state = model.columns(motion, [SLIP_ANGLE], np.array([first]))[-1, 2]
        return K * there + SLIP_TORQUE * float(state) + OFFSET

    low, high = -0.05, 0.05
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if torque(middle) > 0 else (middle, high)
    return middle


@pytest.mark.parametrize("first", [-0.5, 0.8])
@pytest.mark.parametrize(
    "ends",
    [
        [(0.004, 0.015), (-0.002, 0.006), (0.006, -0.015), (0.001, 0.012)],
        # Landings near where the foot was lifted: in the air the element slipped, and turned.
        [(0.004, 0.03), (0.02, -0.03), (-0.018, 0.03), (0.022, 0.01)],
    ],
)
def test_the_state_at_a_landing_is_what_the_air_left(ends: list[tuple[float, float]], first: float) -> None:
    stances, truth = followed(ends, first)
    bush = Hysteresis(
        MODELS["elastoplastic"], np.array([K, 10.0, SLIP_TORQUE]), np.array([SLIP_ANGLE]), OFFSET
    )
    guess = np.array([first, 0.0, 0.0, 0.0])
    found = landing_states(bush, stances, guess)
    assert np.ptp(truth) > 0.5  # else any constant would do
    np.testing.assert_allclose(found, truth, atol=0.02)
    assert np.abs(guess - truth)[1:].max() > 0.3


def test_a_single_stance_keeps_its_guess() -> None:
    bush = Hysteresis(MODELS["elastoplastic"], np.array([K, 10.0, SLIP_TORQUE]), np.array([SLIP_ANGLE]), 0.0)
    np.testing.assert_array_equal(landing_states(bush, [np.linspace(0, 0.01, 50)], np.array([0.3])), [0.3])


def test_sensors_read_spring_element_and_offset() -> None:
    bush = Hysteresis(
        MODELS["elastoplastic"], np.array([K, 10.0, SLIP_TORQUE]), np.array([SLIP_ANGLE]), OFFSET
    )
    path, state = np.array([0.0, 0.01, -0.02]), np.array([0.5, 1.0, -1.0])
    np.testing.assert_allclose(bush.torque(path, state), K * path + SLIP_TORQUE * state + OFFSET)

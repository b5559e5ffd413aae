"""A low-pass on one side of Newton's law is told with its corner; noise, gains and delays are none."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from plantar.estimation.delays.delay import Pair
from plantar.sensors.bandwidth import FILTERED, Fading, fading, fading_notes, slow_filter

PERIOD, COUNT = 0.025, 2400


def first_order(frequency: np.ndarray, corner: float) -> np.ndarray:
    return 1 / (1 + 1j * frequency / corner)


def parabola(frequency: np.ndarray, corner: float) -> np.ndarray:
    """What a low-pass of first order does to slow motion, at any frequency."""
    return np.exp(-0.5 * (frequency / corner) ** 2)


def log(
    measured: float | None = None,
    predicted: float | None = None,
    gain: float = 1.0,
    noise: float = 0.01,
    fades: Callable[[np.ndarray, float], np.ndarray] = first_order,
) -> object:
    """Forces of a motion up to 5 Hz; either side behind a low-pass of first order with a corner [Hz]."""
    random = np.random.default_rng(0)
    frequency = np.fft.rfftfreq(COUNT, PERIOD)[:, None]
    motion = np.fft.rfft(random.standard_normal((COUNT, 6)), axis=0) * np.exp(-((frequency / 3.0) ** 2))

    def read(corner: float | None) -> np.ndarray:
        passed = 1.0 if corner is None else fades(frequency, corner)
        return np.fft.irfft(motion * passed, COUNT, axis=0)

    sides = [gain * read(measured), read(predicted)]
    sides = [side + noise * np.std(side) * random.standard_normal(side.shape) for side in sides]
    return SimpleNamespace(pair=Pair("sway", sides[0], 0 * sides[0], sides[1], PERIOD))


def told(*logs: object) -> list[str]:
    notes = fading_notes(slow_filter(fading(logs)))
    assert all((note.code, note.severity) == (FILTERED, "warning") for note in notes)
    return [note.text for note in notes]


@pytest.mark.parametrize("corner", [3.0, 6.0])
def test_a_low_pass_is_told_with_its_corner(corner: float) -> None:
    found = fading([log(measured=corner)])
    assert found is not None
    assert found.corner == pytest.approx(corner, rel=0.5)  # a parabola for its flank
    (text,) = told(log(measured=corner))
    assert text.startswith("forces and torques fade beside IMU and encoders")
    (text,) = told(log(predicted=corner))
    assert text.startswith("IMU and encoders fade beside forces and torques")


@pytest.mark.parametrize("corner", [4.0, 8.0])
def test_a_parabola_of_the_gains_logarithm_is_found_as_it_is(corner: float) -> None:
    for sign, sides in ((-1.0, {"measured": corner}), (1.0, {"predicted": corner})):
        found = fading([log(**sides, fades=parabola)])
        assert found is not None
        assert found.slope == pytest.approx(sign / (2 * corner**2), rel=0.05)
        assert found.corner == pytest.approx(corner, rel=0.03)


@pytest.mark.parametrize(
    "changes", [{}, {"gain": 1.3}, {"noise": 0.1}, {"measured": 15.0}, {"measured": 4.0, "predicted": 4.0}]
)
def test_what_makes_no_damping_wrong_is_not_told(changes: dict[str, float]) -> None:
    assert told(log(**changes)) == []


def test_what_is_not_coherent_tells_nothing() -> None:
    assert fading([log(measured=4.0, noise=2.0)]) is None
    assert fading([]) is None


def test_one_unsure_slope_is_no_filter() -> None:
    assert slow_filter(Fading(-0.02, 0.01)) is None
    assert slow_filter(Fading(-0.02, 0.001)) == Fading(-0.02, 0.001)

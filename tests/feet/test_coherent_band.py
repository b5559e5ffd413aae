"""The band in which angle and torque belong together, of made signals whose band is known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.contact.stances import Stances
from plantar.feet.coherent_band import _coherence, coherent_band
from plantar.signals.filters import low_pass

PERIOD, STANCES, ROWS = 0.01, 60, 160


def walk(edge: float) -> SimpleNamespace:
    """A recording whose torque follows the angle below `edge` [Hz] and is its own master above."""
    random = np.random.default_rng(3)
    count = STANCES * ROWS
    angle, other = random.normal(size=(2, count, 2))
    below = low_pass(angle, PERIOD, edge)
    torque = 400 * (below + (other - low_pass(other, PERIOD, edge)))
    number = np.repeat(np.arange(STANCES), ROWS)
    number[np.arange(count) % ROWS < 20] = -1
    bush = SimpleNamespace(deflection=angle, torque=torque)
    return SimpleNamespace(
        raw={"left": bush}, stances={"left": Stances(number, np.ones(count))}, period=PERIOD
    )


@pytest.mark.parametrize("edge", [3.0, 6.0, 12.0])
def test_the_edge_is_found(edge: float) -> None:
    assert coherent_band([walk(edge)]) == pytest.approx(edge, abs=1.0)


def test_what_follows_everywhere_has_no_edge() -> None:
    one = walk(5.0)
    one.raw["left"].torque = 400 * one.raw["left"].deflection
    assert coherent_band([one]) == np.inf


def test_a_foot_that_does_not_step_says_nothing() -> None:
    one = walk(3.0)
    one.stances["left"] = None
    assert coherent_band([one]) == np.inf


def test_few_stances_say_nothing() -> None:
    one = walk(3.0)
    one.stances["left"].number[one.stances["left"].number > 5] = -1
    assert coherent_band([one]) == np.inf


def test_the_unit_of_the_torque_does_not_matter() -> None:
    one, other = walk(4.0), walk(4.0)
    other.raw["left"].torque = 1e-3 * other.raw["left"].torque
    assert coherent_band([other]) == pytest.approx(coherent_band([one]))


def test_straight_lines_in_a_stance_do_not_matter() -> None:
    """Attitudes drift and zeros creep: each by its own line within a stance, far larger than what belongs together."""
    plain, drifting = walk(6.0), walk(6.0)
    place, random = np.arange(STANCES * ROWS) % ROWS, np.random.default_rng(5)
    for values in (drifting.raw["left"].deflection, drifting.raw["left"].torque):
        values += 20 * np.repeat(random.normal(size=(STANCES, 2)), ROWS, axis=0) * place[:, None]
    assert coherent_band([drifting]) == pytest.approx(coherent_band([plain]), rel=1e-9)


def test_chance_alone_is_no_coherence() -> None:
    """Of twelve windows without any relation the squared coherence is one twelfth on average: that is taken off."""
    random = np.random.default_rng(0)
    windows, frequencies = 12, 4000
    spectra = random.normal(size=(windows, 2, 2, frequencies)) + 1j * random.normal(
        size=(windows, 2, 2, frequencies)
    )
    assert abs(_coherence(spectra).mean()) < 0.01
    spectra[:, :, 1] = (3.0 - 1j) * spectra[:, :, 0]
    assert _coherence(spectra) == pytest.approx(np.ones(frequencies))

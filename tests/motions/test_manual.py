"""How far a hand leads the centre of mass, by hand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.conventions import GRAVITY
from plantar.motions.manual import ACROSS, ALONG, ROOM, STEADIED, _reach, hand_swing


def sole(long: float, wide: float) -> SimpleNamespace:
    """Half length and width [m], in front of the ankle."""
    corners = np.array([[long, wide], [-long, wide], [-long, -wide], [long, -wide]]) + [0.05, 0.0]
    return SimpleNamespace(sole=SimpleNamespace(polygon=corners))


@pytest.mark.parametrize(("mass", "share"), [(40.0, 1.0), (100.0, STEADIED / (100.0 * GRAVITY * 0.8))])
def test_the_smaller_sole_and_the_weight_say_how_far_a_hand_may_lead(mass: float, share: float) -> None:
    """At 1.2 m the hand goes farther than the centre of mass at 0.8 m; soles keep a rim."""
    feet = {"left": sole(0.10, 0.06), "right": sole(0.12, 0.03), "none": sole(0.01, 0.01)}
    body = SimpleNamespace(
        robot=SimpleNamespace(feet=feet, mass=mass), centre_of_mass=lambda q: np.array([0.0, 0.0, q[0]])
    )
    start = SimpleNamespace(standing=("left", "right"), configuration=np.array([0.8]))
    led = np.array([ALONG * 0.10, 0.03 - ROOM])
    assert 0.03 - ROOM < ACROSS * 0.03
    assert _reach(body, start, 1.2) == pytest.approx(share * led * 1.2 / 0.8)  # type: ignore[arg-type]
    alone = SimpleNamespace(standing=("left",), configuration=np.array([0.8]))
    assert _reach(body, alone, 0.8) == pytest.approx(share * np.array([ALONG * 0.10, 0.06 - ROOM]))  # type: ignore[arg-type]


def test_a_hand_swings_in_three_tempos_from_rest_to_rest() -> None:
    time = np.arange(0.0, 36.0, 0.01)
    swing = hand_swing(time, phase=0.7)
    middle = (time > 4.0) & (time < 32.0)
    expected = sum(
        share * np.sin(2 * np.pi * tempo * time + 0.3 * np.sin(2 * np.pi * time / slow + 0.7) + 0.7 * place)
        for share, tempo, slow, place in ((0.5, 0.23, 11.0, 1), (0.35, 0.41, 14.0, 2), (0.15, 0.67, 17.0, 3))
    )
    assert swing[middle] == pytest.approx(expected[middle])
    assert not swing[(time < 0.5) | (time > time[-1] - 0.5)].any()

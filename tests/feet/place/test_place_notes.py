"""What is said of a place that is not the robot file's, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.feet.place.place_notes import BUSH_TURNED, FAR, place_notes, turned_bush
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt

PRIOR = np.array([0.005, 0.003, 0.01, 0.01, 0.01, 0.01])
STD = np.full(6, 1e-3)
FIT = AxisFit(
    foot="left",
    axis="pitch",
    model=KelvinVoigt(),
    values=np.array([400.0, 10.0]),
    shape=np.zeros(0),
    covariance=np.eye(2),
    freedom=np.full(2, 10.0),
    white_std=np.ones(2),
    offset_std={},
    equivalent=(400.0, 10.0),
    choice=None,
    reason="asked for",
)


@pytest.mark.parametrize(
    ("row", "value", "said"),
    [
        (0, 0.02, "20.0 ± 2.0 mm forward or backward"),
        (1, -0.02, "20.0 ± 2.0 mm below"),
        (2, 0.05, "2.9 ± 0.1 deg beside feet.left.wrench.rpy"),
        (4, 0.05, "2.9 ± 0.1 deg about its y axis"),
    ],
)
def test_each_part_is_named_alone(row: int, value: float, said: str) -> None:
    place = np.zeros(6)
    place[row] = value
    (note,) = place_notes(FIT, place, STD, PRIOR)
    assert (note.code, note.severity) == ("bush_place", "warning")
    assert said in note.text
    assert ";" not in note.text.split("(95 %)")[0]


def test_what_the_robot_file_allows_is_not_said() -> None:
    assert place_notes(FIT, 2.5 * PRIOR, STD, PRIOR) == []
    assert place_notes(FIT, np.full(6, 0.004), STD / 10, PRIOR / 100) == [], "nor what drawings get wrong"


def test_far_from_its_place_is_no_oversight() -> None:
    (note,) = place_notes(FIT, np.array([0.06, 0, 0, 0, 0, 0]), STD, PRIOR)
    assert note.code == FAR


@pytest.mark.parametrize(
    ("pitch", "roll", "said"), [(0.05, 0.04, True), (0.05, -0.05, False), (0.01, 0.01, False)]
)
def test_a_turned_bush_shows_in_both_axes_alike(pitch: float, roll: float, said: bool) -> None:
    """A turned force sensor shows with opposite signs."""
    note = turned_bush("left", pitch, roll, 0.02)
    assert (note is not None and note.code == BUSH_TURNED) == said
    assert turned_bush("left", 0.01, 0.01, 0.005) is not None

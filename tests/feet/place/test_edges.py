"""How far a place may be off, and from where on it is said, by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.feet.place.place_notes import place_notes, turned_bush
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT

FIT = AxisFit(
    foot="left", axis="roll", model=KelvinVoigt(), values=np.array([400.0, 10.0]), shape=np.zeros(0),
    covariance=np.eye(2), freedom=np.full(2, 10.0), white_std=np.ones(2), offset_std={}, equivalent=(400.0, 10.0),
    choice=None, reason="",
)  # fmt: skip
NONE, STD = np.zeros(6), np.full(6, 1e-6)


def noted(row: int, value: float, prior: float = 0.0, std: float = 1e-6) -> list[Note]:
    place = NONE.copy()
    place[row] = value
    return place_notes(FIT, place, np.full(6, std), np.full(6, prior))


@pytest.mark.parametrize(
    ("row", "least", "far"),
    [(0, 0.005, 0.04), (1, 0.005, 0.04), (2, 0.02, 0.12), (3, 0.02, 0.12), (4, 0.02, 0.12), (5, 0.02, 0.12)],
)
def test_a_place_is_said_from_its_least_on_and_far_from_its_farthest(
    row: int, least: float, far: float
) -> None:
    for sign in (1.0, -1.0):
        assert noted(row, 0.98 * sign * least) == []
        assert [note.code for note in noted(row, 1.02 * sign * least)] == ["bush_place"]
        assert [note.code for note in noted(row, 0.98 * sign * far)] == ["bush_place"]
        assert [note.code for note in noted(row, 1.02 * sign * far)] == ["bush_place_far"]


@pytest.mark.parametrize(("value", "said"), [(0.0298, False), (0.0302, True)])
def test_a_place_is_clear_at_three_deviations_of_prior_and_data(value: float, said: bool) -> None:
    assert bool(noted(0, value, prior=0.006, std=0.008)) == said


def test_a_place_s_words() -> None:
    place = np.array([-0.0125, 0.0214, 0.05, 0.0, 0.03, 0.0])
    (note,) = place_notes(FIT, place, np.array([1e-3, 2e-3, 1e-3, 1e-3, 2e-3, 1e-3]), NONE)
    assert note.text == (
        "left roll: the torques turn about a point 12.5 ± 2.0 mm to the side of feet.left.bush and feet.left.wrench; "
        "about a point 21.4 ± 3.9 mm above feet.left.bush and feet.left.wrench; "
        "about an axis 2.9 ± 0.1 deg beside feet.left.wrench.rpy or imu.rpy; "
        "as if the IMU were turned by 1.7 ± 0.2 deg about its y axis, beside imu.rpy (95 %): corrected; "
        "check the robot file"
    )


@pytest.mark.parametrize(
    ("pitch", "roll", "least", "told"),
    [(0.036, 0.036, 0.035, True), (0.034, 0.034, 0.035, False), (-0.04, -0.04, 0.035, True), (0.1, 0.001, 0.01, True),
     (0.1, -0.001, 0.01, False)],
)  # fmt: skip
def test_a_bush_is_turned_where_the_mean_is_more_than_half_of_the_difference(
    pitch: float, roll: float, least: float, told: bool
) -> None:
    assert (turned_bush("left", pitch, roll, least) is not None) == told


def with_arm(above: float, *codes: str) -> AxisFit:
    return replace(FIT, moment_arms=(0.0, above), notes=tuple(Note(code, "warning", "") for code in codes))


SPREAD = PlaceSpread(0.004, 0.004, 0.01, between=0.002)


@pytest.mark.parametrize(
    ("other", "own", "height"),
    [(0.0059, 0.0, 0.0), (0.0061, 0.0, 0.0061), (-0.0061, 0.006, -0.0061), (0.0061, 0.0062, 0.0)],
)
def test_the_other_axis_tells_the_height_where_it_is_far_and_farther(
    other: float, own: float, height: float
) -> None:
    """Three times what both axes may differ by."""
    found = SPREAD.known_from({"pitch": with_arm(other), "roll": with_arm(own)}, "roll")
    assert (found.height if found else 0.0) == height
    if found:
        assert list(found.expected) == [0.004, 0.002, *[0.01] * 4]
    assert list(SPREAD.expected) == list(SPREAD.deviations) == [0.004, 0.004, *[0.01] * 4]


@pytest.mark.parametrize(
    ("other", "own", "above"), [(0.0119, 0.0, 0.004), (0.0121, 0.006, 0.0121), (0.0121, 0.0061, 0.004)]
)
def test_another_foot_s_height_makes_this_one_s_doubtful(other: float, own: float, above: float) -> None:
    """Three of the robot file's deviations, of which this foot's own motions show less than half."""
    told = [with_arm(other, "bush_place"), with_arm(0.5)]
    assert SPREAD.doubted_by(told, [with_arm(own), with_arm(0.3)]).above == above
    far = [with_arm(0.02, "bush_place_far")]
    assert SPREAD.doubted_by(far, [with_arm(0.0)]).above == 0.02
    assert SPREAD.doubted_by([with_arm(0.5)], [with_arm(0.0)]) == SPREAD


@pytest.mark.parametrize(
    ("guess", "expected"),
    [(None, (0.005, 0.01)), (("feet.left.bush.xyz", None), (np.hypot(0.02, 0.004), 0.01)),
     (("feet.left.wrench.xyz", 0.03), (np.hypot(0.03, 0.004), 0.01)), (("feet.right.bush.xyz", None), (0.005, 0.01)),
     (("imu", None), (0.005, 0.02)), (("feet.left.bush.xyz", 0.001), (0.005, 0.01))],
)  # fmt: skip
def test_what_is_guessed_may_be_farther_off(
    robot: RobotModel, guess: tuple[str, float | None] | None, expected: tuple[float, float]
) -> None:
    known = replace(EXACT, bush_position=0.003, imu_mount=0.01, wrench_crosstalk=0.004)
    guesses: Any = () if guess is None else (SimpleNamespace(key=guess[0], spread=guess[1]),)
    found = PlaceSpread.of(replace(robot, uncertainty=known, guesses=guesses), "left")
    assert (found.aside, found.above, found.turned, found.between) == pytest.approx(
        (expected[0], expected[0], expected[1], 0.005)
    )
    zeroed = replace(robot, feet={**robot.feet, "left": replace(robot.feet["left"], contact="always")})
    assert PlaceSpread.of(replace(zeroed, uncertainty=known), "left") == PlaceSpread(0.0, 0.0, 0.0)
    exact = PlaceSpread.of(replace(robot, uncertainty=EXACT, guesses=()), "left")
    assert (exact.aside, exact.turned, exact.between) == (0.0, 0.0, np.inf)

"""What a wrong gain of a force sensor does to numbers, and what is said of it, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.conventions import NORMAL95
from plantar.feet.interval_width.force_gain import (
    GainError,
    force_gain_causes,
    force_gain_notes,
    gain_reaches,
    torque_gain_causes,
)
from plantar.notes import Note

BAD, GOOD, LOW = (GainError(share, 0.003, 0.01, 0.02) for share in (0.123, 0.01, -0.078))
FIT: Any = SimpleNamespace(foot="left", axis="roll", values=np.array([400.0, 20.0, 3.0]))


def robot_of(weighed: float | None = None) -> Any:
    uncertainty = SimpleNamespace(wrench_gain=0.01)
    return SimpleNamespace(
        mass=61.26, weighed=weighed, uncertainty=uncertainty, feet=["left", "right", "third"]
    )


@pytest.mark.parametrize(
    ("weighed", "errors", "said"),
    [
        (None, {"left": BAD, "right": LOW},
         "the URDF's 61.3 kg: the left foot's +12 % and the right foot's -8 %. Either its masses are wrong, a load or "
         "a rope is not in it, or wrong are the force sensors' gains"),
        (None, {"left": GOOD, "right": LOW},
         "the URDF's 61.3 kg: the right foot's -8 %. Either its masses are wrong, a load or a rope is not in it, or "
         "wrong are the force sensors' gains"),
        (61.26, {"left": BAD}, "the weighed 61.3 kg: the left foot's +12 %. Wrong are the force sensors' gains"),
    ],
)  # fmt: skip
def test_feet_that_do_not_add_up_in_words(
    weighed: float | None, errors: dict[str, GainError], said: str
) -> None:
    text = (
        f"vertical forces do not add up to {said}, which stiffness and damping follow (their intervals hold both), or "
        "their zeros: read the sensors with the feet in the air"
    )
    assert force_gain_notes(robot_of(weighed), errors) == [Note("force_gain", "warning", text)]


def test_feet_that_add_up_are_not_told_of() -> None:
    assert force_gain_notes(robot_of(), {"left": GOOD}) == force_gain_notes(robot_of(), {}) == []


def test_an_error_is_sure_beyond_three_deviations_of_all_that_explains_it() -> None:
    """Three times the root of 3² and 4² hundredths."""
    for share in (0.149, -0.149):
        assert not GainError(share, 0.0, 0.03, 0.04).sure
    for share in (0.151, -0.151):
        assert GainError(share, 0.0, 0.03, 0.04).sure


def test_a_gain_moves_every_number_of_its_foot_by_its_share() -> None:
    """By what it reaches, of which a usual gain's part is there already."""
    (cause,) = force_gain_causes(FIT, {"left": BAD, "right": LOW})
    beyond = np.sqrt((BAD.reach / NORMAL95) ** 2 - 0.01**2)
    assert (cause.name, cause.std) == ("force gain", pytest.approx(beyond))
    np.testing.assert_allclose(cause.share, np.array([400.0, 20.0, 3.0]) * beyond)
    assert force_gain_causes(FIT, {"right": LOW}) == []
    exact = GainError(0.0, 0.0, 0.05, 0.02)
    assert exact.reach < NORMAL95 * 0.05
    assert force_gain_causes(FIT, {"left": exact}) == []


def test_a_torque_gain_moves_its_own_axis() -> None:
    gains: Any = {"roll": SimpleNamespace(reach=0.3), "pitch": SimpleNamespace(reach=0.5)}
    (cause,) = torque_gain_causes(FIT, gains)
    assert cause.name == "torque gain"
    np.testing.assert_allclose(cause.share, np.array([400.0, 20.0, 3.0]) * 0.3 / NORMAL95)
    del gains["roll"]
    assert torque_gain_causes(FIT, gains) == []


def test_a_sensor_reaches_at_least_as_far_as_a_usual_one() -> None:
    found = gain_reaches(robot_of(), {"left": BAD, "right": GainError(0.0, 0.0, 1e-4, 1e-4)})
    usual = NORMAL95 * 0.01
    assert found == {
        "left": pytest.approx(BAD.reach),
        "right": pytest.approx(usual),
        "third": pytest.approx(usual),
    }
    assert BAD.reach > 3 * usual

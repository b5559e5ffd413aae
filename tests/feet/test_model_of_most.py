"""What a result of several axes says in one word."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.feet.place.imu_mount import ImuTurn
from plantar.feet.result import _axis_model, _model


@pytest.mark.parametrize(
    ("models", "said"),
    [
        (("kelvin_voigt", "kelvin_voigt", "hardening"), "kelvin_voigt"),
        (("kelvin_voigt", "hardening", "hardening", "kelvin_voigt"), "hardening"),
        (("coulomb", "kelvin_voigt", "kelvin_voigt", "coulomb"), "coulomb"),
        ((), "kelvin_voigt"),
    ],
)
def test_the_model_of_most_axes_and_of_as_many_the_richer(models: tuple[str, ...], said: str) -> None:
    fits = [SimpleNamespace(model=SimpleNamespace(name=name)) for name in models]
    assert _model(fits) == said  # type: ignore[arg-type]


def test_the_imus_turn_is_told_beside_the_logs_as_they_were() -> None:
    """What was put right before the last fit, and what that one still found."""
    fit = SimpleNamespace(
        foot="left", axis="pitch", model=SimpleNamespace(name="kelvin_voigt"), reason="", equivalent=(400.0, 20.0),
        moment_arms=(0.01, 0.0), turned=0.02, leans=0.03, crosstalk=0.002, imu_turned=(0.001, 0.0, -0.002), choice=None,
    )  # fmt: skip
    told = _axis_model(fit, ImuTurn((0.01, 0.02, 0.03), np.eye(3)))  # type: ignore[arg-type]
    assert told.imu_turned == pytest.approx((0.011, 0.02, 0.028))
    assert (told.moment_arms, told.turned, told.leans, told.crosstalk) == ((0.01, 0.0), 0.02, 0.03, 0.002)
    assert (told.linear_equivalent.stiffness, told.linear_equivalent.damping) == (400.0, 20.0)

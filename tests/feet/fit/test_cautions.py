"""A model without a memory gets a caution where sensors may be late, or motions are too small to show one."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.feet.fit.hidden_memory import SMALL, UNTIMED, cautioned, may_hide_a_memory
from plantar.model_selection.selection import ModelChoice
from plantar.models import MODELS, BushMotion


def choice(model: str = "kelvin_voigt", reach: float = 2 * SMALL, caution: str | None = None) -> ModelChoice:
    fit = SimpleNamespace(model=MODELS[model])
    return ModelChoice(fit, fit, (), "", "", (), reach, caution)  # type: ignore[arg-type]


def test_sensors_that_may_be_late_leave_it_open() -> None:
    assert cautioned(choice(), timed=False, steps=True).caution == UNTIMED
    assert cautioned(choice(caution="another"), timed=False, steps=True).caution == "another"


@pytest.mark.parametrize(
    ("model", "reach", "steps", "told"),
    [
        ("kelvin_voigt", 0.9 * SMALL, False, True),
        ("kelvin_voigt", 1.1 * SMALL, False, False),
        ("kelvin_voigt", 0.9 * SMALL, True, False),
        ("elastoplastic", 0.9 * SMALL, False, False),
    ],
)
def test_small_motions_leave_it_open(model: str, reach: float, steps: bool, told: bool) -> None:
    found = cautioned(choice(model, reach), timed=True, steps=steps).caution
    assert (found is not None) == told
    if found is not None:
        assert "bent by 0.013 rad" in found


@pytest.mark.parametrize(("amplitude", "hidden"), [(1.2 * SMALL, True), (1.5 * SMALL, False)])
def test_a_spring_that_explains_small_motions_may_not_be_all(amplitude: float, hidden: bool) -> None:
    angle = amplitude * np.sin(np.linspace(0, 20, 2000))
    assert may_hide_a_memory([BushMotion(angle, 0 * angle, 0.01)]) == hidden

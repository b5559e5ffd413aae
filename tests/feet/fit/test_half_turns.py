"""A walk whose stances do not turn an element round leaves its numbers weak, and says why."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.feet.fit import half_turns
from plantar.feet.fit.half_turns import (
    cautioned_if_hardly_turned,
    slip_angles_spanned,
)
from plantar.feet.regression.axis import AxisFit
from plantar.model_selection.selection import ModelChoice
from plantar.models import MODELS, BushMotion

ROUND = 2.0

SLIP_ANGLE = 0.01


def fit_of(model: str = "elastoplastic", caution: str | None = None) -> AxisFit:
    own = MODELS[model]
    size = len(own.terms) + len(own.shape_terms)
    choice = ModelChoice(None, None, (), "", "", (), 0.02, caution)  # type: ignore[arg-type]
    return AxisFit(
        foot="left", axis="roll", model=own, values=np.ones(len(own.terms)),
        shape=np.full(len(own.shape_terms), SLIP_ANGLE), covariance=np.eye(size), freedom=np.full(size, 30.0),
        white_std=np.ones(size), offset_std={}, offsets={"walk": 0.0}, equivalent=(1.0, 1.0), choice=choice, reason="",
    )  # fmt: skip


@pytest.fixture
def walks(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A recording of stances that bend the foot by some slip angles from end to end."""

    def of(*spans: float, steps: bool = True) -> list[Any]:
        angle = np.concatenate([[*np.linspace(-0.5, 0.5, 20) * span * SLIP_ANGLE, np.nan] for span in spans])
        motion = BushMotion(angle, 0 * angle, 0.01)
        monkeypatch.setattr(half_turns, "path_of", lambda *_: motion)
        return [SimpleNamespace(name="walk", stances={"left": object() if steps else None})]

    return of


def test_the_usual_stance_counts(walks: Any) -> None:
    assert slip_angles_spanned(fit_of(), walks(1.0, 2.5, 9.0)) == pytest.approx(2.5)
    assert slip_angles_spanned(fit_of(), walks(2.5, steps=False)) is None
    assert slip_angles_spanned(fit_of("kelvin_voigt"), walks(2.5)) is None


def test_only_what_is_not_turned_round_gets_a_caution(walks: Any) -> None:
    less = cautioned_if_hardly_turned(fit_of(), walks(0.9 * ROUND))
    assert less.choice is not None
    assert less.choice.caution is not None
    assert "by 1.8 slip angles" in less.choice.caution
    more = fit_of()
    assert cautioned_if_hardly_turned(more, walks(1.1 * ROUND)) is more
    told = fit_of(caution="another one")
    assert cautioned_if_hardly_turned(told, walks(0.9 * ROUND)) is told
    asked = replace(fit_of(), choice=None)
    assert cautioned_if_hardly_turned(asked, walks(0.9 * ROUND)) is asked

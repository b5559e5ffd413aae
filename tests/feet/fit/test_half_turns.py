"""A walk whose stances do not turn an element round leaves its numbers weak, and says why."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.feet.fit import half_turns
from plantar.feet.fit.half_turns import cautioned_if_hardly_turned, slid_back, slip_angles_spanned
from plantar.feet.regression.axis import AxisFit
from plantar.model_selection.selection import ModelChoice
from plantar.models import MODELS, BushMotion

ROUND = 2.0

SLIP_ANGLE = 0.01


def fit_of(model: str = "elastoplastic", caution: str | None = None) -> AxisFit:
    own = MODELS[model]
    size = len(own.terms) + len(own.shape_terms)
    choice = ModelChoice(None, None, (), "", "", 0.02, caution)  # type: ignore[arg-type]
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


def test_a_spring_that_short_steps_show_may_hold_an_element(walks: Any) -> None:
    """Two slip angles of the rubber that slips soonest are 20 mrad; a foot that also stands and sways as far as shows
    one in other logs is told by these."""
    less = cautioned_if_hardly_turned(fit_of("kelvin_voigt"), walks(1.9))
    assert less.choice is not None
    assert "bend the foot by 0.019 rad from end to end" in str(less.choice.caution)
    more = fit_of("kelvin_voigt")
    assert cautioned_if_hardly_turned(more, walks(2.1)) is more
    assert cautioned_if_hardly_turned(more, walks(1.9, steps=False)) is more
    also = [*walks(1.9), *walks(1.9, steps=False)]
    assert cautioned_if_hardly_turned(more, also) is more
    assert more.choice is not None
    small = replace(more, choice=replace(more.choice, reach=0.014))
    assert cautioned_if_hardly_turned(small, also) is not small


def standing(monkeypatch: pytest.MonkeyPatch, *turns: float) -> list[Any]:
    """A recording of a foot that stands and turns at these angles, in slip angles."""
    ways = [np.linspace(*pair, 40)[:-1] for pair in pairwise(turns)]
    angle = SLIP_ANGLE * np.append(np.concatenate(ways), turns[-1])
    motion = BushMotion(angle, 0 * angle, 0.01)
    monkeypatch.setattr(half_turns, "path_of", lambda *_: motion)
    return [SimpleNamespace(name="walk", stances={"left": None})]


@pytest.mark.parametrize(("turns", "slid"), [
    ((0.0, 1.8), 0.0),  # one way alone
    ((0.0, 1.8, 0.0, 2.5, 0.6), 0.0),  # the same way again
    ((0.0, 1.8, -0.5), 0.3),
    ((0.0, 1.8, -0.5, 2.2), 0.7),
])  # fmt: skip
def test_an_element_is_seen_whole_where_it_slides_back(
    monkeypatch: pytest.MonkeyPatch, turns: tuple[float, ...], slid: float
) -> None:
    """It slides after one slip angle from rest, and after two from where it slid the other way."""
    recordings = standing(monkeypatch, *turns)
    fit = replace(fit_of(), initial_states={"walk": np.zeros(1)})
    assert slid_back(fit, recordings) == pytest.approx(slid, abs=1e-6)


def test_of_feet_that_step_and_springs_nothing_is_said_about_sliding_back(
    monkeypatch: pytest.MonkeyPatch, walks: Any
) -> None:
    stands = replace(fit_of(), initial_states={"walk": np.zeros(1)})
    assert slid_back(stands, walks(1.0)) == np.inf
    assert slid_back(stands, walks(1.0, steps=False)) == 0.0
    assert slid_back(fit_of("kelvin_voigt"), standing(monkeypatch, 0.0, 1.8)) == np.inf

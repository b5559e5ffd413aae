"""One value of what several axes tell, and what feet tell of each other."""

from __future__ import annotations

from collections.abc import Iterable
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

from plantar.feet import identify
from plantar.feet.assumptions import _together


def test_axes_weigh_by_their_variances_and_are_as_sure_as_the_surest() -> None:
    (found,) = _together("left", [(1.0, 0.1), (1.3, 0.2), (7.0, None)])
    assert (found.what, found.value) == ("left", pytest.approx((4 * 1.0 + 1.3) / 5))
    missed = np.sqrt((0.06 / 0.1) ** 2 + (0.24 / 0.2) ** 2)
    assert missed > 1, "they are further apart than they say"
    assert found.std == pytest.approx(0.1 * missed)
    (agreed,) = _together("left", [(1.0, 0.1), (1.01, 0.2)])
    assert agreed.std == pytest.approx(0.1), "four of them are no surer than one"


def test_what_has_no_deviation_is_a_plain_mean_and_of_none_nothing_is_known() -> None:
    assert _together("", [(1.0, None), (2.0, None)]) == [("", 1.5, None)]
    assert _together("", []) == []


def test_a_foot_is_put_in_doubt_by_the_others_alone_and_fitted_once_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The left foot stands elsewhere than its file says: as measured there, it is fitted again, and doubts the right
    one, which is fitted again, too."""

    class Place(NamedTuple):
        name: str

        def doubted_by(self, others: list[str], own: list[str]) -> Place:
            asked.append((self.name, others, own))
            return Place("doubted") if self.name == "right" else self

    asked: list[tuple[str, list[str], list[str]]] = []
    fitted: list[tuple[str, str]] = []

    def fit(call: object, ready: object, feet: Iterable[str], places: Iterable[Place]) -> list[object]:
        found = []
        for foot, place in zip(list(feet), list(places), strict=True):
            fitted.append((foot, place.name))
            elsewhere = "there" if (foot, place.name) == ("left", "left") else None
            fits = {"pitch": f"{foot} at {place.name}"}
            found.append(SimpleNamespace(fits=fits, elsewhere=elsewhere, told=lambda place: ("told", place)))
        return found

    monkeypatch.setattr(identify, "over_cores", fit)
    monkeypatch.setattr(identify, "PlaceSpread", SimpleNamespace(of=lambda robot, foot: Place(foot)))
    monkeypatch.setattr(identify, "as_measured", lambda robot, foot: Place("measured"))
    ready = SimpleNamespace(robot=SimpleNamespace(feet=["left", "right"]))
    found = identify._fitted_feet(ready, lambda _: None)  # type: ignore[arg-type]
    assert fitted == [("left", "left"), ("right", "right"), ("left", "measured"), ("right", "doubted")]
    assert asked == [
        ("measured", ["right at right"], ["left at measured"]),
        ("right", ["left at measured"], ["right at right"]),
    ]
    assert found["left"] == ("told", "there")
    assert found["right"].fits == {"pitch": "right at doubted"}

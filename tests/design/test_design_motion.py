"""What a design hands on: the range of stiffness, the damping, what is known, and the stance that is the best."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.design import story
from plantar.design.reach import KINDS
from plantar.design.rehearsals.attempt import LEFT
from plantar.design.soft_feet import CARRIED
from plantar.design.story import DesignSettings, design_motion
from plantar.twin.robots import hrp2

LEAST = 300.0  # N·m/rad


class Reached:
    """The limits of one stance, as they were asked for."""

    def __init__(self, *given: Any) -> None:
        self.given = given

    def held(self, shares: np.ndarray) -> tuple[Any, ...]:
        assert (shares == LEFT).all()
        assert shares.shape == (len(self.given[4]), len(KINDS))
        return self.given


def stance(name: str) -> Any:
    pendulum = SimpleNamespace(least_stiffness=LEAST, check_carried=lambda stiffness, robot: None)
    return SimpleNamespace(name=name, bushes={"left": 0, "right": 1}), SimpleNamespace(
        name=name, pendulum=pendulum
    )


@pytest.mark.parametrize(
    ("settings", "after", "stiffness", "factors", "damping"),
    [
        (DesignSettings(500.0), False, 500.0, (CARRIED * LEAST / 500, 2.0), 0.04 * 500),
        (DesignSettings(1000.0, damping=7.0), False, 1000.0, (0.5, 2.0), 7.0),
        (DesignSettings(), True, 600.0, (400 / 600, 900 / 600), 33.0),
        (DesignSettings(damping=7.0), True, 600.0, (400 / 600, 900 / 600), 7.0),
        (DesignSettings(1000.0), True, 1000.0, (0.5, 2.0), 33.0),
    ],
)
def test_range_damping_and_what_is_known_are_handed_on(
    settings: DesignSettings,
    after: bool,
    stiffness: float,
    factors: tuple[float, float],
    damping: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    known = SimpleNamespace(
        stiffness=600.0,
        damping=33.0,
        low=400.0,
        high=900.0,
        element="element",
        precision=lambda feet: ("known", *feet),
    )
    asked: dict[str, Any] = {}

    def best_motion(
        stances: Any, duration: float, criterion: str, seed: int, before: Any, progress: Any
    ) -> Any:
        asked.update(reaches=[one("lines of a search") for one in stances], before=before)
        assert (duration, criterion, seed) == (settings.duration, settings.criterion, settings.seed)
        return 1, "lines", "found"

    def until_it_holds(motion: Any, legs: Any, told: Any, progress: Any) -> Any:
        asked.update(motion=motion, legs=legs)
        return "coefficients", "trajectory", ["a rehearsal"], 3

    monkeypatch.setattr(story.Known, "of", lambda result: known)
    monkeypatch.setattr(story, "_stances", lambda robot: [stance("beside"), stance("ahead")])
    monkeypatch.setattr(story, "Reach", Reached)
    monkeypatch.setattr(story, "best_motion", best_motion)
    monkeypatch.setattr(story, "better_motion", lambda *given: given)
    monkeypatch.setattr(story, "Attempt", lambda *given: given)
    monkeypatch.setattr(story, "until_it_holds", until_it_holds)
    found = design_motion(hrp2.robot(), settings, "an earlier result" if after else None)  # type: ignore[arg-type]
    assert found.told.stiffness == stiffness
    assert found.told.damping == pytest.approx(damping)
    assert found.factors == pytest.approx(factors)
    assert found.least_stiffness == pytest.approx(CARRIED * LEAST)
    before, element = (("known", "left", "right"), "element") if after else (0.0, None)
    assert asked["before"] == before
    low, high = factors
    rehearsed = sorted({low, low**0.5, 1.0, high**0.5, high**0.75, high})
    for name, (legs, linear, lines, told, bushes, of) in zip(
        ("beside", "ahead"), asked["reaches"], strict=True
    ):
        assert (legs.name, linear.name, lines, of) == (name, name, "lines of a search", element)
        assert told == found.told
        assert [bush.stiffness for bush in bushes] == pytest.approx(
            [factor * stiffness for factor in rehearsed]
        )
    reach, better, start, at = asked["motion"]
    assert (reach.given[0].name, reach.given[2], start) == ("ahead", "lines", "found")
    assert at == pytest.approx(rehearsed)
    assert better("limits", "start") == ("limits", settings.criterion, "start", before)
    assert (asked["legs"].name, found.legs.name, found.coefficients) == ("ahead", "ahead", "coefficients")
    assert (found.trajectory, found.rehearsals, found.pairs) == ("trajectory", ("a rehearsal",), 3)
    assert found.known is (known if after else None)

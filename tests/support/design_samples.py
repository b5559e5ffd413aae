"""A designed motion that took seconds: few tries, twenty seconds, the built-in twin's robot."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any
from unittest.mock import patch

import numpy as np

from plantar import cores
from plantar.design import search, story
from plantar.design.family import Lines
from plantar.design.information import Criterion
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot
from plantar.design.reach import Reach
from plantar.design.rehearsals import attempt, rehearsal
from plantar.design.rehearsals.rehearsal import Rehearsal, rehearse
from plantar.design.search import better_motion
from plantar.design.soft_feet import Softness
from plantar.design.story import Design, DesignSettings, design_motion
from plantar.motions.plan import Plan
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin import cache as twin_cache
from plantar.twin.robots import hrp2

STIFFNESS = 500.0
TRIES = 5


@cache
def legs() -> Legs:
    return Legs.of(hrp2.robot(), hrp2.postures().standing)


@cache
def linear() -> LinearRobot:
    return LinearRobot.of(legs())


@cache
def told() -> Softness:
    return Softness.told(hrp2.robot(), STIFFNESS, None)


@cache
def reach() -> Reach:
    lines = Lines.drawn(20.0, np.random.default_rng(1))
    return Reach(
        legs(), linear(), lines, told(), [told().times(0.6), told(), told().times(1.5)], element=None
    )


@cache
def coefficients() -> np.ndarray:
    """Of a motion within the limits of `reach`."""
    return from_one_beginning(reach(), "widest", 2)


def from_one_beginning(reach: Reach, criterion: Criterion, seed: int) -> np.ndarray:
    """Coefficients of a motion that took a few tries."""
    start = 0.1 * np.random.default_rng(seed).standard_normal(reach.lines.size)
    with patch.object(search, "TRIED", TRIES):
        return better_motion(reach, criterion, start, known=0.0)


_searched: dict[bytes, np.ndarray] = {}


def gentle_motion(
    stances: Sequence[Callable[[Lines], Reach]], duration: float, criterion: Criterion, seed: int, *_: object
) -> tuple[int, Lines, np.ndarray]:
    """Side by side and well within its limits, so that the first rehearsal holds; what comes from one seed is searched
    for once."""
    lines = Lines.drawn(duration, np.random.default_rng(seed))
    reach = stances[0](lines)
    key = pickle.dumps((lines, reach.bushes, criterion))
    if key not in _searched:
        _searched[key] = 0.4 * from_one_beginning(reach, criterion, seed)
    return 0, lines, _searched[key]


class RehearsedOnce:
    """On the stiffness told; the others of the range are taken to be like it."""

    def __init__(self) -> None:
        self.one: Rehearsal | None = None

    def __call__(
        self, robot: RobotModel, plan: Plan, told: Softness, factors: Sequence[float], *_: object
    ) -> list[Rehearsal]:
        if self.one is None:
            (self.one,) = rehearse(robot, plan, told, [1.0], progress=lambda _: None)
        return [replace(self.one, factor=factor) for factor in factors]


def identified_once(name: str) -> Callable[[Rehearsal, RobotModel, int], tuple[FeetResult | None, ...]]:
    """Rehearsals with one rollout have one result, which is kept under `name` for all processes of this session."""
    feet_found = Rehearsal.feet_found
    found: dict[int, tuple[FeetResult | None, ...]] = {}

    def identify(own: Rehearsal, robot: RobotModel, draws: int) -> tuple[FeetResult | None, ...]:
        def made() -> dict[str, np.ndarray]:
            return {"results": np.frombuffer(pickle.dumps(feet_found(own, robot, draws)), np.uint8)}

        key = id(own.rollout)
        if key not in found:
            found[key] = pickle.loads(twin_cache.kept(f"{name}{len(found)}", made)["results"].tobytes())
        return found[key]

    return identify


def unplayed() -> Design:
    """Of a motion what it was made for: nothing was searched or played."""
    nothing: Any = None
    return Design(
        settings=DesignSettings(STIFFNESS), robot=hrp2.robot(), told=told(), factors=(0.5, 2.0),
        least_stiffness=240.0, legs=nothing, lines=nothing, coefficients=np.zeros(0), trajectory=nothing,
        rehearsals=(), pairs=0, known=None,
    )  # fmt: skip


@cache
def designed() -> Design:
    """Rehearsed on the twin, too."""
    with (
        patch.object(story, "best_motion", gentle_motion),
        patch.object(attempt, "rehearse", RehearsedOnce()),
        patch.object(Rehearsal, "feet_found", identified_once("designed")),
        patch.object(rehearsal, "DRAWS", 1),
        patch.object(cores, "usable_cores", lambda: 1),  # copies would identify it again
    ):
        return design_motion(hrp2.robot(), DesignSettings(STIFFNESS, duration=20.0, seed=1))


def designed_again() -> Design:
    """The same, with the rehearsals of the first and what was identified from them."""
    with (
        patch.object(story, "best_motion", gentle_motion),
        patch.object(attempt, "rehearse", lambda *_: list(designed().rehearsals)),
        patch.object(Rehearsal, "feet_found", lambda own, *_: own.results),
        patch.object(cores, "usable_cores", lambda: 1),
    ):
        return design_motion(hrp2.robot(), DesignSettings(STIFFNESS, duration=20.0, seed=1))

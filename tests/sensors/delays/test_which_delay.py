"""Which of the delays that were looked for are taken: those near none, those that a search led to, or none at all."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.robot.model import RobotModel
from plantar.sensors.delays import sensor_delay as room
from plantar.sensors.delays.sensor_delay import ELSEWHERE, KNOWN_STD, _surer, estimate_wrench_delay


def delays(
    value: float = 0.0,
    *,
    std: float = KNOWN_STD,
    suspect: bool = False,
    closed: int = 2,
    differ: bool = False,
) -> Any:
    return SimpleNamespace(
        values=np.array([value, value, 0.0]), std=std, suspect=suspect, closed=np.arange(2) < closed,
        feet_differ=differ, encoders_differ=False,
    )  # fmt: skip


NEAR = delays(0.001)
UNSURE = delays(0.001, std=2 * KNOWN_STD)
SUSPECT = delays(0.001, suspect=True)
FAR = delays(2 * ELSEWHERE)
FAR_UNSURE = delays(2 * ELSEWHERE, std=2 * KNOWN_STD)


class Asked:
    """Stands for what looks for delays: gives what it is told to, in turn, and keeps what it was asked."""

    def __init__(
        self, patch: pytest.MonkeyPatch, found: list[Any], lag: float, *, doubt: bool, moves: bool
    ) -> None:
        self.found, self.starts, self.known, self.doubt = iter(found), list[Any](), list[Any](), doubt
        self.looked: tuple[Any, ...] = ()
        lags = SimpleNamespace(values=np.array([lag, lag, 0.0]))
        for name, act in {
            "on_force_cells": lambda *_: False, "refined_delays": self.refined, "return_freed": lambda: None,
            "lagged_log": lambda robot, log: f"lags of {log}" if moves and log == "sway" else None,
            "search_lags": lambda shown: lags if shown == ["lags of sway"] else None,
            "_accelerated": lambda robot, log: log != "blind", "_in_doubt": self.in_doubt,
            "held_for_a_while": lambda robot, log: np.array([log == "held", False]),
            "_unseen": lambda robot, logs: ("unseen", tuple(logs)), "_told": lambda robot, found: ("told", found),
            "_doubtful": lambda robot, lags: ("doubtful", lags.values[0]),
        }.items():  # fmt: skip
            patch.setattr(room, name, act)

    def refined(self, robot: Any, logs: Any, each: Any, start: Any, known: Any = None) -> Any:
        self.starts.append(start.tolist())
        self.known.append(known)
        return next(self.found)

    def in_doubt(self, *given: Any) -> bool:
        self.looked = given[1:]
        return self.doubt


LOGS: Any = ["sway", "held", "blind"]


@pytest.mark.parametrize(
    ("found", "lag", "doubt", "moves", "taken", "searches"),
    [
        ([NEAR], 0.0, True, True, NEAR, 1),
        ([UNSURE], 0.0, False, True, UNSURE, 1),
        ([SUSPECT], 0.0, False, True, SUSPECT, 1),
        ([SUSPECT], 0.0, False, False, SUSPECT, 1),
        ([None], 0.0, False, False, None, 1),
        ([None], 0.0, False, True, None, 1),
        ([None, FAR], 2 * ELSEWHERE, False, True, FAR, 2),
        ([UNSURE, FAR], 2 * ELSEWHERE, False, True, FAR, 2),
        ([UNSURE, SUSPECT], 2 * ELSEWHERE, False, True, UNSURE, 2),
        ([UNSURE, None], 2 * ELSEWHERE, False, True, UNSURE, 2),
        ([FAR_UNSURE], 2 * ELSEWHERE, False, True, FAR_UNSURE, 1),
    ],
)
def test_the_surest_delays_are_taken(
    found: list[Any], lag: float, doubt: bool, moves: bool, taken: Any, searches: int, robot: RobotModel,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    asked = Asked(monkeypatch, found, lag, doubt=doubt, moves=moves)
    came: Any = estimate_wrench_delay(robot, LOGS)
    assert came == (("unseen", tuple(LOGS)) if taken is None else ("told", taken))
    assert asked.starts == [[0.0] * 3, [lag, lag, 0.0]][:searches]


def test_logs_that_contradict_the_delays_put_them_in_doubt(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only those tell alone that hold an accelerometer and that nobody held."""
    asked = Asked(monkeypatch, [UNSURE], 0.0, doubt=True, moves=True)
    came: Any = estimate_wrench_delay(robot, LOGS)
    assert came == ("doubtful", 0.0)
    found, searched, alone = asked.looked
    assert found is UNSURE
    assert searched.tolist() == [True, False, False]
    assert alone.tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("told", "known"), [((), None), (("a", None, "c"), None), (("a", "b", "c"), ["a", "b", "c"])]
)
def test_residuals_that_are_known_of_all_logs_are_handed_on(
    told: tuple[Any, ...], known: Any, robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Asked(monkeypatch, [NEAR], 0.0, doubt=False, moves=True)
    estimate_wrench_delay(robot, LOGS, map, told)
    assert asked.known == [known]
    monkeypatch.setattr(room, "on_force_cells", lambda *_: True)
    came: Any = estimate_wrench_delay(robot, LOGS)
    assert came == ("unseen", tuple(LOGS)), "cells read no horizontal force"


def test_what_makes_delays_surer() -> None:
    """In this order: nothing suspect, more logs that close, sensors that differ, the smaller deviation."""
    order = [
        delays(std=0.1), delays(std=0.2), delays(std=0.3, differ=True), delays(std=0.4, closed=1),
        delays(std=0.01, closed=2, suspect=True),
    ]  # fmt: skip
    order[1], order[2] = order[2], order[1]
    order[0], order[1] = order[1], order[0]
    for better, one in enumerate(order):
        for worse, other in enumerate(order):
            assert _surer(one, other) == (better < worse)

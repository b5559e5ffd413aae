"""One motion that is played is one of many: with its robot, feet, preset and seed."""

from __future__ import annotations

import importlib
import threading
from concurrent.futures import CancelledError
from types import SimpleNamespace
from typing import Any

import pytest

from plantar.errors import MotionError
from plantar.twin.bush import PAPER

room: Any = importlib.import_module("plantar.twin.play")  # the package has a function of that name


def test_one_motion_is_played_as_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[Any, ...]] = []

    def play_all(*given: Any) -> list[list[str]]:
        asked.append(given)
        return [["first", "second"], ["third", "fourth"]]

    monkeypatch.setattr(room, "play_all", play_all)
    assert room.play("Tilt1", "robot", None, "ideal", 7) == "first"
    assert room.play("Tilt2") == "first"
    assert asked == [(["Tilt1"], "robot", None, "ideal", [7]), (["Tilt2"], None, PAPER, room.DEFAULT, [0])]


def test_after_an_error_the_others_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rollout that would go on for ever ends when another robot has fallen; until then both tell how far they are."""
    monkeypatch.setattr(room.os, "cpu_count", lambda: 2)
    stopped, begun, told = threading.Event(), threading.Event(), list[tuple[str, float]]()

    def way(plan: Any, robot: Any, physics: Any, report: Any) -> None:
        if plan.name == "falls":
            assert begun.wait(5.0)
            raise MotionError("falls")
        try:
            for _ in range(5000):
                report(0.25)
                begun.set()
                stopped.wait(1e-3)
        except CancelledError:
            stopped.set()
            raise

    jobs = [(SimpleNamespace(name=name), None) for name in ("falls", "goes on")]
    with pytest.raises(MotionError, match="falls"):
        room._rolled_on_cores(jobs, None, lambda name, share: told.append((name, share)), way)
    assert stopped.wait(3.0)
    assert set(told) == {("goes on", 0.25)}

"""One motion that is played is one of many: with its robot, feet, preset and seed."""

from __future__ import annotations

import importlib
from typing import Any

import pytest

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

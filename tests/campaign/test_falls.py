"""A motion in which the robot falls: left out where it was to be unseen, an error where the fit needs it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

import plantar.campaign.run as campaign
from plantar.errors import MotionError
from plantar.twin import PAPER


def test_a_fall_leaves_out_what_was_to_stay_unseen(monkeypatch: pytest.MonkeyPatch) -> None:
    def play_all(motions: Any, *_: Any) -> Any:
        raise MotionError("the robot falls in Squat", fell=3.0)

    def play(name: str, robot: object, twin: object, preset: str, seed: int) -> Any:
        assert (robot, twin, preset, seed) == (None, PAPER, "clean", 7)
        if name in falls:
            raise MotionError(f"the robot falls in {name}")
        return SimpleNamespace(name=name)

    monkeypatch.setattr(campaign, "play_all", play_all)
    monkeypatch.setattr(campaign, "play", play)
    course = campaign.Course(("Tilt3",), ("Squat", "Tilt1"), ("Squat",), ())
    falls = {"Squat"}
    recordings, notes = campaign._played(course, "clean", 7, lambda _: None)
    assert [one.name for one in recordings] == ["Tilt3", "Tilt1"]  # type: ignore[attr-defined]
    assert [(note.code, note.severity, note.text) for note in notes] == [
        ("motion_left_out", "warning", "left out: the robot falls in Squat")
    ]
    falls = {"Tilt3"}
    with pytest.raises(MotionError, match=r"^the robot falls in Tilt3$"):
        campaign._played(course, "clean", 7, lambda _: None)

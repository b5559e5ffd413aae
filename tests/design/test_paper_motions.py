"""The best of the paper's motions on another robot: what it cannot do is told, what a hand leads is not chosen."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from plantar.design import paper_motions as room
from plantar.errors import MotionError
from plantar.twin.presets import DEFAULT

NAMES = ("Tilt1", "Squat", "Manual", "Sweep", "Tilt2")
BUSH = object()


def played(
    monkeypatch: pytest.MonkeyPatch, *, hands: tuple[str, ...] = ("Manual",)
) -> tuple[Any, list[str], list[Any]]:
    """The squat is out of reach, the sweep falls; ranked by the name's end: Manual before Tilt2 before Tilt1."""
    asked: list[Any] = []
    robot: Any = SimpleNamespace(name="biped", feet=("left", "right"))

    def planned(name: str, _: object) -> Any:
        if name == "Squat":
            raise MotionError("out of reach")
        return SimpleNamespace(name=name, hand="hand" if name in hands else None)

    def roll_each(jobs: list[Any], _: object, progress: Any) -> list[Any]:
        asked.extend(jobs)
        progress("Tilt1", 0.25)
        return [MotionError("it falls") if plan.name == "Sweep" else plan.name for plan, _ in jobs]

    def select_motions(_: object, logs: list[str], progress: Any) -> Any:
        assert logs == ["log of Tilt1", "log of Manual", "log of Tilt2"]
        return SimpleNamespace(
            alone=[SimpleNamespace(motions=(name,)) for name in ("Manual", "Tilt2", "Tilt1")]
        )

    def preset_named(name: str) -> Any:
        assert name == DEFAULT
        return SimpleNamespace(physics=lambda bushes, of: (bushes, of))

    monkeypatch.setattr(room, "CAMPAIGN", NAMES)
    monkeypatch.setattr(room, "planned", planned)
    monkeypatch.setattr(room, "roll_each", roll_each)
    monkeypatch.setattr(room, "bush_of", lambda told: (BUSH, told))
    monkeypatch.setattr(room, "preset_named", preset_named)
    monkeypatch.setattr(room, "record", lambda rollout, *_: SimpleNamespace(log=f"log of {rollout}"))
    monkeypatch.setattr(room, "select_motions", select_motions)
    said: list[str] = []
    return room.paper_motions(robot, "told", said.append), said, asked  # type: ignore[arg-type]


def test_the_most_informative_motion_without_a_hand_is_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    found, said, asked = played(monkeypatch)
    assert found.best.name == "Tilt2"
    assert found.refused == {"Squat": "out of reach", "Sweep": "it falls"}
    assert [plan.name for plan, _ in asked] == ["Tilt1", "Manual", "Sweep", "Tilt2"]
    for _, (bushes, robot) in asked:
        assert bushes == dict.fromkeys(("left", "right"), (BUSH, "told")), "each foot as it was told"
        assert robot.name == "biped"
    assert said == [*(f"plan {name}" for name in NAMES), "play Tilt1 25 %"]


def test_a_robot_that_needs_a_hand_for_all_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(
        MotionError,
        match=r"^biped: can do none of the paper's motions without a hand \(valid: a design without "
        r"--like\)$",
    ):
        played(monkeypatch, hands=("Tilt1", "Manual", "Tilt2"))

"""The best of the paper's motions on another robot: what it cannot do is told, what a hand leads is not chosen."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.design import paper_motions as room
from plantar.errors import MotionError
from plantar.motions.select_motions import Choice, Selection
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

    def recorded(rollout: str, given: tuple[Any, ...]) -> Any:
        assert given[0] is robot
        assert given[-1] == 0, "sensors as they are drawn first"
        return SimpleNamespace(log=f"log of {rollout}")

    def preset_named(name: str) -> Any:
        assert name == DEFAULT
        return SimpleNamespace(physics=lambda bushes, of: (bushes, of))

    monkeypatch.setattr(room, "CAMPAIGN", NAMES)
    monkeypatch.setattr(room, "planned", planned)
    monkeypatch.setattr(room, "roll_each", roll_each)
    monkeypatch.setattr(room, "bush_of", lambda told: (BUSH, told))
    monkeypatch.setattr(room, "preset_named", preset_named)
    monkeypatch.setattr(room, "record", lambda rollout, *given: recorded(rollout, given))
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


def test_the_best_motion_is_told_with_its_own_half_widths_and_those_of_the_largest_set() -> None:
    """At 5 Hz a motion that was planned at 10 Hz, each joint by its own name, to its last sample."""
    time = np.arange(31) / 10.0
    positions = np.column_stack([time, -2 * time**2, 0 * time + 5])
    plan: Any = SimpleNamespace(name="Tilt2", time=time, positions=positions, joints=("hip", "knee", "toe"))
    keys = [(foot, axis, term) for foot in ("right", "left") for axis in ("pitch", "roll") for term in
            ("stiffness", "damping")]  # fmt: skip

    def choice(first: float, *motions: str) -> Choice:
        return Choice(motions, {key: first + place for place, key in enumerate(keys)}, 1.0)

    alone = (choice(100.0, "Tilt1"), choice(200.0, "Tilt2"))
    best = (choice(300.0, "Tilt1"), choice(400.0, "Tilt1", "Tilt2"))
    found = room.PaperMotions(Selection(alone, best, best[1], None), {}, plan)
    log = found.log(5.0)
    assert log.name == "Tilt2"
    np.testing.assert_allclose(log.time, np.arange(16) / 5)
    for place, name in enumerate(plan.joints):
        np.testing.assert_allclose(log.column(f"joint.{name}.position"), positions[::2, place])
    rows = found.half_widths()
    assert [(row["foot"], row["axis"], row["name"]) for row in rows] == [*keys[4:], *keys[:4]]
    assert [row["percent"] for row in rows] == [*range(204, 208), *range(200, 204)]
    assert [row["best_set_percent"] for row in rows] == [*range(404, 408), *range(400, 404)]

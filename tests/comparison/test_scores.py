"""What is scored of motions in which robots fall or tip: up to when, and of whom, without a simulation."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.comparison import compare as room
from plantar.comparison.compare import KindScore, compare, pooled
from plantar.comparison.scenes import CONTACT, JOINTS
from plantar.errors import MotionError
from plantar.motions.plan import Plan

RATE = 100.0


class Played:
    """A robot whose chest errs by 3 and 4 mrad, half of that as long as the soles lie flat, and 6 and 2 N·m."""

    torque = (("left", "pitch"), ("right", "pitch"))

    def __init__(self, plan: Plan, kind: str) -> None:
        self.motion, self.feet, self.seconds = plan.name, kind, float(plan.time[-1])

    def chest_error(self, until: float | None = None) -> tuple[float, float]:
        self.flat = until
        share = 1.0 if until is None else 0.5
        return 0.003 * share, 0.004 * share

    def torque_error(self, foot: str, axis: str) -> float:
        return {"left": 6.0, "right": 2.0}[foot]


def compared(
    monkeypatch: pytest.MonkeyPatch,
    falls: dict[str, float | None],
    tips: float | None = None,
    length: float = 20.0,
) -> tuple[tuple[KindScore, ...], list[float], tuple[Any, ...]]:
    """The scores, how long each round of playing was [s], and what is given back of it."""
    played: list[float] = []

    def plan_of(robot: Any, log: Any) -> Plan:
        time = np.arange(round(length * RATE) + 1) / RATE
        return Plan(
            log.name, time, ("a",), time[:, None], np.tile(np.eye(4), (time.size, 1, 1)), frozenset(), {}
        )

    def play(robot: Any, plan: Plan, made: Any) -> dict[str, Any]:
        played.append(float(plan.time[-1]))
        assert len(plan.time) == len(plan.positions) == len(plan.base)
        return {
            kind: "stood" if fell is None or plan.time[-1] < fell else MotionError("falls", fell=fell)
            for kind, fell in falls.items()
        }

    monkeypatch.setattr(room, "on_an_edge", lambda *_: tips)
    monkeypatch.setattr(room, "plan_of", plan_of)
    monkeypatch.setattr(room, "record_of", lambda *_: None)
    monkeypatch.setattr(room, "scenes", lambda *_: falls)
    monkeypatch.setattr(room, "_played", play)
    monkeypatch.setattr(room, "beside", lambda robot, plan, kind, one, record: Played(plan, kind))
    robot = SimpleNamespace(
        joint_names=("a", "not logged"),
        feet={"left": None, "right": None},
        base="floating",
        path="biped.yaml",
    )
    result = SimpleNamespace(parameters=[SimpleNamespace(foot="left")], joint_compliance={})
    log = SimpleNamespace(name="sway", source="sway.csv", has=lambda name: name == "joint.a.position")
    scores, found = compare(result, robot, [log])  # type: ignore[arg-type, list-item]
    return scores, played, found


def test_who_stands_is_scored_to_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    scores, played, found = compared(monkeypatch, {"rigid": None, "joints": None})
    assert played == [20.0]
    assert [one.feet for one in found] == ["rigid", "joints"]
    assert scores[0] == KindScore("sway", "rigid", 0.003, 0.004, 4.0, 20.0, None, None, pytest.approx(0.0025))
    assert scores[0].chest == pytest.approx(0.005)


def test_one_second_before_the_first_falls_the_score_ends_for_all(monkeypatch: pytest.MonkeyPatch) -> None:
    scores, played, _ = compared(monkeypatch, {"rigid": 8.0, "joints": None, "contact": 12.0})
    assert played == [20.0, 7.0]
    assert [(one.feet, one.until, one.fell) for one in scores] == [
        ("rigid", 7.0, 8.0), ("joints", 7.0, None), ("contact", 7.0, 12.0),
    ]  # fmt: skip


def test_a_fall_at_the_beginning_leaves_no_score(monkeypatch: pytest.MonkeyPatch) -> None:
    scores, played, found = compared(monkeypatch, {"rigid": 2.9, "joints": None})
    assert played == [20.0], "less than two seconds are left: not played again"
    assert scores[0] == KindScore("sway", "rigid", None, None, None, 0.0, 2.9)
    assert (scores[0].chest, scores[1].until, scores[1].fell) == (None, 20.0, None)
    assert [one.feet for one in found] == ["joints"]
    assert pooled(scores, "rigid") is None
    assert pooled(scores, "joints") == pytest.approx(0.005)


@pytest.mark.parametrize(
    ("tips", "flat", "told"),
    [(6.0, 0.0025, 6.0), (1.9, None, 1.9), (20.0, 0.0025, None), (25.0, 0.0025, None)],
)
def test_as_long_as_soles_lie_flat(
    tips: float, flat: float | None, told: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    (score,), _, _ = compared(monkeypatch, {"rigid": None}, tips)
    assert (score.tips, score.until) == (told, 20.0)
    assert score.flat_chest == (None if flat is None else pytest.approx(flat))
    if flat is not None:
        assert pooled([score], "rigid", flat=True) == pytest.approx(flat)


def test_all_motions_weigh_alike() -> None:
    rows = [
        KindScore(name, "rigid", chest, 0.0, 1.0, 9.0, fell=None)
        for name, chest in (("a", 0.003), ("b", 0.004))
    ]
    assert pooled(rows, "rigid") == pytest.approx(0.005 / np.sqrt(2))
    assert pooled(rows, "other") is None


def test_a_kind_that_falls_has_no_score_over_all_motions() -> None:
    stood = KindScore("a", CONTACT, 3e-3, 4e-3, 1.0, 20.0, fell=None)
    fell = KindScore("b", CONTACT, None, None, None, 0.0, 0.4)
    assert stood.chest == pytest.approx(5e-3)
    assert pooled([stood, stood], CONTACT) == pytest.approx(5e-3)
    assert pooled([stood, fell], CONTACT) is None
    assert pooled([stood], JOINTS) is None
    flat = replace(stood, tips=2.5, flat_chest=1e-3)
    assert pooled([flat, flat], CONTACT, flat=True) == pytest.approx(1e-3)
    assert pooled([flat, stood], CONTACT, flat=True) is None

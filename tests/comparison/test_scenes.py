"""Which feet are asked of which exporter, how they stand in the scene, and which kinds there are."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.comparison import scenes as room
from plantar.comparison.scenes import AS_IT_WAS, CONTACT, JOINTS, WITH_LOOP, Played, _on_twin, scenes
from plantar.conventions import rotation_from_rpy
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.hysteresis import FootHysteresis
from plantar.exporters.job import USUAL, Stance

DEPTHS = {"left": 0.03, "right": 0.02}  # m, of the soles below their bushes


@dataclass
class Asked:
    """What the exporters were told; the text that they write says of which feet."""

    slips: bool
    feet: list[tuple[bool, float | None]] = field(default_factory=list)
    stances: list[Stance] = field(default_factory=list)

    def feet_of_result(self, data: Any, base: Any, **told: Any) -> tuple[Any, Any]:
        assert not told["with_offset"]
        self.feet.append((told["hysteresis"], told["swing"]))
        spring = SimpleNamespace(slip="slip" if told["hysteresis"] and self.slips else None)
        feet = [
            SimpleNamespace(name=name, sole_depth=depth, springs=[SimpleNamespace(slip=None), spring])
            for name, depth in DEPTHS.items()
        ]
        return feet, ()

    def write(self, job: Any, notes: Any) -> str:
        assert job.model.read_text() == "the scene"
        self.stances.append(job.stance)
        return f"hysteresis {job.hysteresis}"


@pytest.mark.parametrize("pivot", ["ground", "bush"])
@pytest.mark.parametrize(("slips", "tips"), [(False, False), (False, True), (True, False)])
def test_each_exporter_is_asked_for_its_feet(
    pivot: str, slips: bool, tips: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A swing is the contact's alone: the joints keep the slip, and so does the loop."""
    asked, stance = Asked(slips), Stance(pivot, 0.3)
    monkeypatch.setattr(room, "open_result", lambda result: ({}, Path()))
    monkeypatch.setattr(room, "scene_xml", lambda *_: "the scene")
    monkeypatch.setattr(room, "feet_of_result", asked.feet_of_result)
    monkeypatch.setattr(room, "_on_twin", lambda foot, robot: foot)
    monkeypatch.setattr(room.contact, "write", asked.write)
    monkeypatch.setattr(room.joints, "write", asked.write)
    made = scenes(None, None, None, 0.02, stance, tips)  # type: ignore[arg-type]
    lower = 0.02 if pivot == "bush" else 0.0
    expected = {
        AS_IT_WAS: Played("the scene"),
        JOINTS: Played("hysteresis True"),
        CONTACT: Played("hysteresis False", lower),
    }
    if slips or tips:
        expected[WITH_LOOP] = Played("hysteresis True", lower, FootHysteresis)
    assert made == expected
    assert asked.feet == [(False, 0.02), (True, None), (True, None)]
    assert asked.stances == [USUAL, stance, stance][: len(made) - 1]


def test_a_foot_stands_on_the_scenes_body_with_its_sole_there(monkeypatch: pytest.MonkeyPatch) -> None:
    bush = np.eye(4)
    bush[:3, :3], bush[:3, 3] = rotation_from_rpy(np.array([0.1, -0.2, 1.5])), [0.01, 0.02, -0.08]
    corners = np.array([[0.1, 0.05, -0.02], [-0.08, 0.04, -0.02], [0.0, -0.05, -0.03]])  # in the bush's axes
    cut = SimpleNamespace(bush=bush, corners=corners, place=1)
    bodies = [SimpleNamespace(name="root"), SimpleNamespace(name="foot of the twin")]
    monkeypatch.setattr(room, "describe", lambda robot: SimpleNamespace(bodies=bodies))
    monkeypatch.setattr(room, "cut_feet", lambda description, robot: {"right": None, "left": cut})
    foot = FootBush("left", "l_ankle", (), np.zeros(3), np.eye(3), np.zeros((4, 3)))
    found = _on_twin(foot, None)  # type: ignore[arg-type]
    assert (found.name, found.ankle) == ("left", "foot of the twin")
    np.testing.assert_array_equal(found.centre, bush[:3, 3])
    np.testing.assert_array_equal(found.rotation, bush[:3, :3])
    for corner, place in zip(corners, found.sole, strict=True):
        assert place == pytest.approx((bush @ [*corner, 1.0])[:3])

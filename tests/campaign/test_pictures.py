"""Pictures of postures: the robot stands on the floor, the raised leg is raised; what is drawn of which motions."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.campaign import pictures
from plantar.campaign.pictures import boxes, look_of, side_of
from plantar.twin.play import planned
from plantar.twin.robots import hrp2


def test_postures_stand_on_the_floor() -> None:
    robot = hrp2.robot()
    drawn = boxes(look_of(robot), planned("Manual_left_roll", robot))
    corners = np.vstack([box.corners for box in drawn])
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert 1.4 < corners[:, 2].max() < 1.6
    feet = {
        box.side: box.corners[:, 2].min()
        for box in drawn
        if np.ptp(box.corners[:, 0]) == pytest.approx(0.2172, abs=0.01)
    }
    assert feet["right"] > 0.05 > feet["left"]  # the right leg is raised


def test_figures_are_drawn_of_the_motions_that_were_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    def postures(robot: object, named: list[tuple[str, str]], number: int, title: str) -> tuple[object, ...]:
        return number, [motion for motion, _ in named]

    monkeypatch.setattr(pictures, "_postures", postures)
    monkeypatch.setattr(pictures, "_locus", lambda campaign, motion, number, letter: (number, letter, motion))
    monkeypatch.setattr(pictures, "_simulated", lambda replays, guess: ("simulator", replays))

    def plates(logs: list[str], replays: list[str]) -> list[object]:
        return pictures.plates(  # type: ignore[return-value]
            SimpleNamespace(robot=None, logs=dict.fromkeys(logs), replays=replays, replayed={})  # type: ignore[arg-type]
        )

    assert plates([], []) == []
    assert plates(["Tilt3", "Tilt1", "Squat"], []) == [
        (3, ["Tilt1", "Tilt3"]),
        (4, "a", "Tilt1"),
        (4, "b", "Tilt3"),
    ]
    monkeypatch.setattr(pictures, "best_guess", lambda replayed: "soft")
    sways = plates(["Manual_left_roll"], ["one"])
    assert sways == [(5, ["Manual_left_roll"]), (6, "b", "Manual_left_roll"), ("simulator", ["one"])]


@pytest.mark.parametrize(
    ("body", "side"),
    [
        ("RLEG_LINK5", "right"),
        ("LARM_LINK2", "left"),
        ("WAIST", ""),
        ("ROOT", ""),
        ("LIDAR", ""),
        ("HEAD", ""),
    ],
)
def test_limbs_have_a_side_and_the_trunk_has_none(body: str, side: str) -> None:
    assert side_of(body) == side


@pytest.mark.parametrize("hand", [None, "chest"])
def test_a_locus_says_how_near_it_came_and_who_measured(
    hand: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The margin in millimetres, not its time; where an operator's hand moves the robot nothing was planned."""
    measured = SimpleNamespace(
        worst=lambda: (31.0, 0.0124), outlines={"left": 1}, zmp="measured", polygon="both"
    )
    asked: dict[str, object] = {}

    def balance(robot: object, log: object, stance: object) -> object:
        asked.update(log=log, stance=stance)
        return measured

    monkeypatch.setattr(
        pictures, "planned", lambda motion, robot: SimpleNamespace(hand=hand, stance="stance")
    )
    monkeypatch.setattr(pictures, "measured_balance", balance)
    monkeypatch.setattr(pictures, "planned_balance", lambda robot, plan: SimpleNamespace(zmp="planned"))
    monkeypatch.setattr(pictures, "zmp", lambda *given: given)
    monkeypatch.setattr(pictures, "zmp_planned", lambda *given: given)
    campaign = SimpleNamespace(robot=None, logs={"Tilt1": "log", "Tilt3": "other"})
    plate = pictures._locus(campaign, "Tilt1", 4, "a")  # type: ignore[arg-type]
    assert asked == {"log": "log", "stance": "stance"}
    who = (
        "Measured by the foot's force sensor; the robot keeps still, the operator's hand moves it."
        if hand
        else "Measured by the feet's force sensors; planned by inverse dynamics on rigid feet."
    )
    assert plate.caption == f"At least 12 mm inside the support polygon. {who}"
    assert plate.name == "figure04a_zmp_Tilt1"
    assert plate.title == "Figure 4a. Zero-moment point of Tilt1."
    planned_too = () if hand else ("planned",)
    assert plate.drawing == ("measured", *planned_too, {"left": 1}, "both")


def test_each_picture_says_what_it_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pictures, "stances", lambda drawn: [name for name, _ in drawn])
    monkeypatch.setattr(pictures, "boxes", lambda look, plan: plan)
    monkeypatch.setattr(pictures, "look_of", lambda robot: None)
    monkeypatch.setattr(pictures, "planned", lambda motion, robot: motion)
    monkeypatch.setattr(pictures, "replays", lambda found, first: ([one.feet for one in found], first))
    monkeypatch.setattr(pictures, "best_guess", lambda replayed: "LAAS")
    monkeypatch.setattr(pictures, "LOCI", ())
    replayed = [SimpleNamespace(feet=feet) for feet in ("rigid", "LAAS", "JRL", "identified")]
    logs = dict.fromkeys(("Tilt1", "Tilt2", "Tilt3", *(f"Manual_{side}" for side in (
        "right_roll", "right_pitch", "left_roll", "left_pitch", "both_pitch"
    ))))  # fmt: skip
    campaign = SimpleNamespace(robot=None, logs=logs, replays=replayed, replayed=())
    tilts, sways, simulator = pictures.plates(campaign)  # type: ignore[arg-type]
    assert (tilts.name, tilts.number, tilts.title) == (
        "figure03_postures", 3, "Figure 3. Initial states of the tilting motions.",
    )  # fmt: skip
    assert (sways.name, sways.title) == ("figure05_postures", "Figure 5. Initial states of the manual sways.")
    assert tilts.caption == sways.caption == "As planned, on rigid feet; right limbs red, left limbs blue."
    assert tilts.drawing == ["Tilt1\nA: regular", "Tilt2\nB: right leg aside", "Tilt3\nC: right leg forward"]
    assert sways.drawing == [
        "Manual_right_roll\nD and G", "Manual_right_pitch\nE and G", "Manual_left_roll\nD and F",
        "Manual_left_pitch\nE and F", "Manual_both_pitch\nE and A",
    ]  # fmt: skip
    assert (simulator.name, simulator.number, simulator.title) == (
        "simulator", None, "The campaign in a simulator.",
    )  # fmt: skip
    assert simulator.drawing == (["rigid", "LAAS", "identified"], "identified")
    assert simulator.caption == (
        "Recorded, and the same joint motion in the simulator on identified feet, rigid feet and the best of the "
        "guesses "
        "(LAAS). A recorded attitude's bias and slow drift, a straight line in time, are taken out of each; "
        "zeros of the "
        "torques from the first second."
    )

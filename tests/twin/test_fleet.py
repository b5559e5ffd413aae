"""A made fleet: what was put in is found again, and one rollout on other rubber is the rollout on it."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped_robot import make_robot
from plantar.errors import PlantarError, RobotError
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.twin import fleet
from plantar.twin.bush import PAPER
from plantar.twin.fleet import AGEING, DRIFT, NEW_SOLE, STEP, stories, write_fleet
from plantar.twin.other_rubber import ankle_joints, on_other_rubber
from plantar.twin.play import rolled
from plantar.twin.presets import preset_named
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from twin_samples import planned_part

MOTION = "Tilt3"
SETTINGS = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)


def test_softer_rubber_is_found_softer() -> None:
    robot, preset = hrp2.robot(), preset_named("ideal")
    physics = preset.physics(PAPER)
    rollout = rolled(planned_part(MOTION, robot), robot, physics)
    shares = {"left": 0.92, "right": 1.05}
    log = record(on_other_rubber(rollout, robot, shares), robot, physics, preset, 0).log
    found = identify_feet(robot, log, settings=SETTINGS)
    for foot, share in shares.items():
        for axis, stiffness in (("pitch", PAPER[foot].pitch_stiffness), ("roll", PAPER[foot].roll_stiffness)):
            assert found.parameter(foot, axis, "stiffness").value == pytest.approx(
                share * stiffness, rel=0.012
            )


def test_the_same_rubber_is_the_same_rollout() -> None:
    robot = hrp2.robot()
    rollout = rolled(planned_part(MOTION, robot), robot, preset_named("ideal").physics(PAPER))
    same = on_other_rubber(rollout, robot, {"left": 1.0})
    assert np.array_equal(same.positions, rollout.positions)
    assert np.array_equal(same.bush["left"], rollout.bush["left"])
    assert ankle_joints(robot, "left") == ("LLEG_JOINT4", "LLEG_JOINT5")


def test_each_robot_has_its_story() -> None:
    told = stories(5, 100, 0, 0.02)
    assert [story.event for story in told] == [AGEING, NEW_SOLE, DRIFT, "", ""]
    ageing = np.polyfit(np.arange(100) / 30.44, np.log(told[0].shares["right"]), 1)[0]
    assert ageing == pytest.approx(0.02, abs=0.002)
    left = told[1].shares["left"]
    assert left[50:].mean() / left[:50].mean() == pytest.approx(1 + STEP, abs=0.005)
    assert told[2].gain[-1] == pytest.approx(1.02 ** (99 / 30.44), rel=1e-3)
    assert (told[3].gain == 1).all()


def test_the_files_are_a_manifest_with_its_truth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fleet, "planned", planned_part)
    asked: list[object] = []
    monkeypatch.setattr(fleet, "stories", lambda *given: asked.append(given) or stories(*given))
    monkeypatch.setattr(fleet, "record", lambda *given: asked.append(given[-1]) or record(*given))
    manifest = write_fleet(
        tmp_path, 1, 2, motion=MOTION, preset="sensors", seed=3, ageing=0.03, progress=lambda _: None
    )
    assert asked == [(1, 2, 3, 0.03), 3, 3], "robots, days, seed and ageing; the sensors' seed"
    rows = list(csv.DictReader(manifest.open()))
    assert [row["time"] for row in rows] == ["2026-01-01T09:00:00Z", "2026-01-02T09:00:00Z"]
    truth = list(csv.DictReader((tmp_path / "truth.csv").open()))
    assert len(truth) == 2 * 4
    found = identify_feet(tmp_path / rows[0]["robot"], tmp_path / rows[0]["log"], settings=SETTINGS)
    for row in truth[:4]:
        value = found.parameter(row["foot"], row["axis"], "stiffness").value
        allowed = 0.01 if row["axis"] == "pitch" else 0.1  # the motion sways in pitch
        assert value == pytest.approx(float(row["stiffness"]), rel=allowed)


@pytest.mark.parametrize("preset", ["plain_log", "imperfect"])
def test_a_preset_with_robots_or_logs_of_its_own_is_refused(tmp_path: Path, preset: str) -> None:
    with pytest.raises(PlantarError, match=f"value '{preset}': has robots or logs of its own"):
        write_fleet(tmp_path, 1, 1, motion=MOTION, preset=preset, seed=0, progress=lambda _: None)
    assert not list(tmp_path.iterdir())


def test_a_fleet_is_no_more_than_a_hundred_thousand_logs(tmp_path: Path) -> None:
    with pytest.raises(PlantarError, match=r"^value 100100: are too many logs \(valid: at most 100000\)$"):
        write_fleet(tmp_path, 1001, 100, motion=MOTION, preset="sensors", seed=0, progress=lambda _: None)


def test_an_ankle_that_turns_otherwise_is_refused(tmp_path: Path) -> None:
    """The twin's rubber is exchanged through an ankle that turns in pitch and then in roll."""
    robot = make_robot(tmp_path)
    assert ankle_joints(robot, "left") == ("left_ankle_pitch", "left_ankle_roll")
    feet = {**robot.feet, "left": replace(robot.feet["left"], ankle="left_ankle")}
    said = r": the left ankle does not turn in pitch, then in roll \(valid: the built-in robot\)$"
    with pytest.raises(RobotError, match=said):
        ankle_joints(replace(robot, feet=feet), "left")

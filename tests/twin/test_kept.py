"""The twin as it is kept: its scenes, robots drawn about their file, and what sensors read of a motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record as record_of_feet
from biped import sway
from biped_robot import make_robot
from feet_trials import noisy, without
from kept_texts import assert_as_kept, described
from plantar.twin.bush import PAPER
from plantar.twin.other_rubber import on_other_rubber
from plantar.twin.presets import PRESETS
from plantar.twin.recording import record
from plantar.twin.replay import Record, beside, moved_onto, pitch_and_roll, plan_of, record_of
from plantar.twin.robots import hrp2
from plantar.twin.robots.from_robot import describe
from plantar.twin.robots.true_robot import RobotSpread, true_robot
from plantar.twin.robots.urdf import urdf_text
from plantar.twin.simulation.mjcf import Scene, mjcf_text
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout
from twin_samples import plan, short

KEPT = Path(__file__).parent / "kept"
HEIGHT = 0.65  # m, of the root
SIZES = {
    "imu": {"orientation": 4, "angular_velocity": 3, "linear_acceleration": 3},
    **{side: {"force": 3, "torque": 3, "sole": 4, "place": 3} for side in ("right", "left")},
}


def imagined() -> Rollout:
    """Two seconds of a motion that no engine has played: everything goes up and down in its own way."""
    robot, part = hrp2.robot(), short(plan("Tilt3"), 4.0, 6.0)
    time = part.time

    def waves(count: int, size: float, first: int = 0) -> np.ndarray:
        return size * np.sin(time[:, None] * (1 + 0.3 * np.arange(count)) + first + np.arange(count))

    turn = np.column_stack([np.ones_like(time), waves(3, 0.05)])
    base = np.column_stack(
        [waves(2, 0.02), HEIGHT + waves(1, 0.01), turn / np.linalg.norm(turn, axis=1)[:, None]]
    )
    sensors = {}
    for device, kinds in SIZES.items():
        for place, (kind, size) in enumerate(kinds.items()):
            values = waves(size, 0.1, place) + (np.arange(size) == (0 if size == 4 else 2)) * (
                300 if kind == "force" else 1
            )
            sensors[f"{device}.{kind}"] = values / (
                np.linalg.norm(values, axis=1)[:, None] if size == 4 else 1
            )
    feet = robot.feet
    return Rollout(
        "Tilt3", time, part.joints, base, part.positions, np.gradient(part.positions, time, axis=0),
        waves(len(part.joints), 5.0), sensors, {foot: waves(3, 0.01, 2) for foot in feet},
        {foot: waves(3, 0.05, 3) for foot in feet}, {foot: waves(2, 1.0, 4) for foot in feet}, np.zeros((time.size, 0)),
    )  # fmt: skip


@pytest.mark.parametrize("name", PRESETS)
def test_what_sensors_read_is_as_it_is_kept(name: str) -> None:
    robot, physics = hrp2.robot(), Physics().stiffened(0.1)
    rollout = on_other_rubber(imagined(), robot, {"left": 1.2})
    made = record(rollout, robot, physics, PRESETS[name], 3, {"drawn": 1})
    told = {
        "log": made.log.columns,
        "time": made.log.time,
        "truth": made.truth.columns,
        "facts": made.truth.facts,
    }
    assert_as_kept(described(told), KEPT / f"{name}.txt", share=1e-5, least=1e-8)


def test_the_scene_is_as_it_is_kept(tmp_path: Path) -> None:
    for name, robot in (("hrp2", hrp2.robot()), ("biped", make_robot(tmp_path))):
        for kind, bushes in (("soft", PAPER), ("rigid", None)):
            scene = Scene(held=next(iter(robot.feet.values())).sole.placement if kind == "soft" else None)
            text = mjcf_text(robot, bushes, scene).replace("><", ">\n<")
            assert_as_kept(text, KEPT / f"{name}_{kind}.txt", share=1e-5)
        assert_as_kept(
            urdf_text(describe(robot)).replace("><", ">\n<"), KEPT / f"{name}_urdf.txt", share=1e-5
        )


@pytest.mark.parametrize("efforts", [True, False])
def test_what_is_played_again_is_as_it_is_kept(efforts: bool, tmp_path: Path) -> None:
    """A recorded motion as a plan, led by a hand or not, and a rollout beside the record."""
    robot = make_robot(tmp_path)
    log = without(noisy(record_of_feet(sway("sway", 3, 8.0)), 3), *(() if efforts else (".effort",)))
    made = plan_of(robot, log)
    record = record_of(robot, log, made)
    turned = record_of(robot, noisy(record_of_feet(sway("bow", 4, 8.0)), 4), made)
    played = hrp2.robot(), imagined()
    told = {
        "plan": made,
        "record": record,
        "moved": pitch_and_roll(moved_onto(record.attitude, turned.attitude)),
    }
    if efforts:
        plan_there, time = plan("Tilt3"), played[1].time
        there = replace(short(plan_there, 4.0, 6.0), time=time)
        taken = beside(
            played[0], there, "soft", played[1], Record(torques(time), turned.attitude[: time.size])
        )
        errors = [taken.torque_error(*place) for place in taken.torque]
        told |= {"beside": taken, "errors": errors, "chest": [taken.chest_error(), taken.chest_error(1.0)]}
    assert_as_kept(described(told), KEPT / f"played_again_{efforts}.txt", share=1e-4, least=1e-7)


def torques(time: np.ndarray) -> dict[tuple[str, str], np.ndarray]:
    places = [(foot, axis) for foot in ("left", "right") for axis in ("pitch", "roll")]
    return {place: np.sin((1 + number) * time) for number, place in enumerate(places)}


def test_a_robot_that_is_drawn_is_as_it_is_kept() -> None:
    found, drawn = true_robot(hrp2.robot(), RobotSpread(), 5)
    assert_as_kept(
        described({"drawn": drawn, "feet": found.feet, "imu": found.imu}), KEPT / "drawn.txt", share=1e-6
    )

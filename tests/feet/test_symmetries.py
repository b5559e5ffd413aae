"""Laws that the whole identification obeys: a robot seen in a mirror, and one that is twice as heavy and as stiff."""

from __future__ import annotations

import re
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import biped_robot
from biped import SLIPPING, record, sway
from biped_robot import Frame, Mounting, make_robot
from feet_trials import noisy
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty

OTHER = {"left": "right", "right": "left"}
# A mirror at the robot's middle plane turns these over: what points to the side, and turns about what does not.
TURNED = re.compile(
    r"(leg_y|ankle_roll|neck)\.(position|velocity)|(acceleration|force)\.y|(velocity|torque|orientation)\.[xz]"
)
KINDS = ("parameters", "offsets", "validation", "phases", "diagnosis")
SETTINGS = FeetSettings(wrench_delay=0.004, model="elastoplastic")
UNSURE = replace(Uncertainty(), wrench_gain=0.001, between_recordings=0.001)


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    """Two to fit, of which one lifts a foot and drifts, and one to score."""
    lifted = noisy(
        record(sway("lifted", seed=1, duration=20.0, lifts=(("right", 6.0, 8.0),), truth=SLIPPING)), 1
    )
    spoiled = {
        "wrench.right.torque.x": lifted.column("wrench.right.torque.x") + 0.03 * lifted.time,
    }
    return [
        lifted.with_columns(spoiled),
        *(
            noisy(record(sway(name, seed, 12.0, truth=SLIPPING)), seed)
            for seed, name in ((2, "plain"), (3, "unseen"))
        ),
    ]


def robot_of(folder: Path, aside: float = 0.02) -> RobotModel:
    """The biped whose file may be wrong in all that it may be wrong in; its IMU is `aside` of its middle [m]."""
    return replace(make_robot(folder, Mounting(imu=Frame((-0.05, aside, 0.3)))), uncertainty=UNSURE)


def identified(robot: RobotModel, logs: list[MotionLog]) -> dict[str, Any]:
    return identify_feet(robot, logs[:2], logs[2:], SETTINGS).to_dict()


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory, logs: list[MotionLog]) -> dict[str, Any]:
    return identified(robot_of(tmp_path_factory.mktemp("robot")), logs)


def test_a_robot_in_a_mirror_has_its_feet_the_other_way_round(
    tmp_path: Path, logs: list[MotionLog], found: dict[str, Any]
) -> None:
    """Every number, reason and phase of one foot is the other's; only what points to the side changes its sign."""
    seen = identified(robot_of(tmp_path, -0.02), [mirrored(log) for log in logs])
    expected = {kind: [swapped(row) for row in found[kind]] for kind in KINDS}
    for row in expected["offsets"]:
        row["value"] *= -1 if row["axis"] == "roll" else 1
    for kind in KINDS:
        assert_alike(in_order(seen[kind]), in_order(expected[kind]))


def mirrored(log: MotionLog) -> MotionLog:
    columns = {
        swapped(name): -values if TURNED.search(name) else values for name, values in log.columns.items()
    }
    return MotionLog(log.name, log.time, columns)


def swapped(told: Any) -> Any:
    """The same of the other foot: texts that name it, alone and in rows."""
    if isinstance(told, dict):
        return {key: swapped(value) for key, value in told.items()}
    return (
        re.sub("(?<!was )(left|right)", lambda side: OTHER[side.group()], told)
        if isinstance(told, str)
        else told
    )


def test_twice_the_masses_and_forces_are_twice_the_numbers_and_their_intervals(
    tmp_path: Path, logs: list[MotionLog], found: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    heavier = re.sub(
        r'((?:mass value|i[xyz]{2})=")([^"]+)', lambda one: f"{one[1]}{2 * float(one[2])}", biped_robot.URDF
    )
    monkeypatch.setattr(biped_robot, "URDF", heavier)
    twice = [
        log.with_columns({name: 2 * log.column(name) for name in log.columns if name.startswith("wrench.")})
        for log in logs
    ]
    seen, expected = identified(robot_of(tmp_path), twice), deepcopy(found)
    for row in expected["parameters"]:
        double(row, *(() if row["name"] == "slip_angle" else ("value", "std", "interval95")))
    for row in expected["offsets"]:
        double(row, "value", "std")
    for row in expected["validation"]:
        double(row, "mean_abs_error", "rms_error", "max_abs", "zero_mean_abs")
    for kind in ("parameters", "offsets", "validation", "phases"):
        assert_alike(seen[kind], expected[kind])


def double(row: dict[str, Any], *keys: str) -> None:
    for key in keys:
        row[key] = (2 * np.asarray(row[key])).tolist()


def in_order(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows in an order that does not depend on which foot comes first."""
    keys = ("foot", "axis", "name", "motion", "kind", "start")
    return sorted(rows, key=lambda row: [str(row[key]) for key in keys if key in row])


def assert_alike(seen: Any, expected: Any, where: str = "") -> None:
    """The same texts, and numbers that agree to 1e-6."""
    if isinstance(expected, dict):
        assert seen.keys() == expected.keys(), where
        named = " ".join(str(expected[key]) for key in ("foot", "axis", "name") if key in expected)
        for key, value in expected.items():
            assert_alike(seen[key], value, f"{where} {named} {key}")
    elif isinstance(expected, list):
        assert len(seen) == len(expected), where
        for one, other in zip(seen, expected, strict=True):
            assert_alike(one, other, where)
    elif isinstance(expected, float):
        assert seen == pytest.approx(expected, rel=1e-6, abs=1e-9), where
    else:
        assert seen == expected, where

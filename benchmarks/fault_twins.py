"""Healthy logs of four robots on the twin, for the fault matrix: simulated once, kept in a folder."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import yaml

import talos
from fault_case import Case, case_of
from plantar.robot.model import RobotModel, load_robot
from plantar.robot_guess import guess_robot_file
from plantar.twin import PAPER, Bush, play_all
from plantar.twin.bush import Feet
from plantar.twin.play import write_campaign
from plantar.twin.robots import hrp2

PRESET = "sensors"  # springs and dampers, with sensors as they are: the truth is two numbers an axis
CAMPAIGN = ("Tilt3", "Manual_left_pitch", "Manual_right_roll", "Myrand5")
WALKS = ("Walk8_1", "Walk12_1", "Walk16_1")
MODELS = talos.URDF.parents[2]

Truth = Mapping[
    str, Mapping[str, float]
]  # by foot: pitch_stiffness [N·m/rad], pitch_damping [N·m·s/rad], ...


def _guessed(urdf: str) -> Callable[[Path], RobotModel]:
    """A robot whose file `plantar init` writes; its twin is built by that file, which is true of it then."""

    def make(folder: Path) -> RobotModel:
        file = folder / "robot.yaml"
        entry = yaml.safe_load(guess_robot_file(MODELS / urdf, [], file))
        file.write_text(yaml.safe_dump(entry))  # without the comments that call its numbers guesses
        return load_robot(file)

    return make


ROBOTS: Mapping[str, tuple[Callable[[Path], RobotModel], Feet]] = {
    "hrp2": (lambda folder: load_robot(hrp2.write(folder)), PAPER),
    "talos": (talos.robot, talos.BUSHES),
    "g1": (
        _guessed("g1_description/urdf/g1_29dof_rev_1_0.urdf"),
        {
            "left": Bush(300.0, 6.0, 220.0, 5.0, 200e3, 800.0),
            "right": Bush(270.0, 5.0, 240.0, 6.0, 180e3, 800.0),
        },
    ),
    "icub": (
        _guessed("icub_description/robots/icub.urdf"),
        {
            "left": Bush(260.0, 5.0, 200.0, 4.0, 150e3, 700.0),
            "right": Bush(240.0, 4.5, 210.0, 4.5, 160e3, 700.0),
        },
    ),
}


def healthy(name: str, motions: Sequence[str], seeds: Sequence[int], base: Path) -> list[tuple[Case, Truth]]:
    """A case for each seed of the sensors, with the truth; simulated where `base` does not hold it yet."""
    folders = [base / name / f"seed{seed}" for seed in seeds]
    absent = [
        seed
        for seed, folder in zip(seeds, folders, strict=True)
        if not all((folder / f"{motion}.truth.json").exists() for motion in motions)
    ]
    if absent:
        make, bushes = ROBOTS[name]
        (base / name).mkdir(parents=True, exist_ok=True)
        robot = make(base / name)
        campaigns = play_all(motions, robot, bushes, PRESET, absent)
        for seed, recordings in zip(absent, campaigns, strict=True):
            write_campaign(base / name / f"seed{seed}", recordings, robot, PRESET)
    file = next(path for path in sorted((base / name).glob("*.yaml")))
    return [read_case(file, [folder / f"{motion}.parquet" for motion in motions]) for folder in folders]


def read_case(robot_file: Path, logs: Sequence[Path]) -> tuple[Case, Truth]:
    """A case from files of the twin: a robot file, and logs with their `.truth.json` beside them."""
    tables = {}
    for path in logs:
        table = pq.read_table(path)
        tables[path.stem] = {name: table[name].to_numpy() for name in table.column_names}
    facts: dict[str, Any] = json.loads(logs[0].with_suffix(".truth.json").read_text())
    return case_of(load_robot(robot_file), tables), facts["bushes"]


def other_robot(name: str, base: Path) -> RobotModel:
    """A robot that is not `name`."""
    folder = base / "other"
    folder.mkdir(parents=True, exist_ok=True)
    return load_robot(hrp2.write(folder)) if name != "hrp2" else talos.robot(folder)

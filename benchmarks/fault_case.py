"""A case of the fault matrix: what a user hands over, and the changes that a fault makes to it.

Columns are chosen by patterns that hold for any robot: they are made from its robot file and its legs. Nothing is drawn
at random, so that a fault is the same each time.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import yaml

from plantar.conventions import Array
from plantar.robot.model import RobotModel

Table = dict[str, Array]
FEET = ("left", "right")


@dataclass(frozen=True)
class Case:
    """A robot file as YAML holds it, its URDF's text, and logs as tables: columns (N,) by name, `time` among them.

    legs: by foot, the joints from the trunk down to the ankle; the last three are knee, ankle pitch, ankle roll.
    """

    robot: dict[str, Any]
    urdf: str
    tables: dict[str, Table]
    legs: Mapping[str, tuple[str, ...]]

    def with_tables(self, change: Callable[[Table], Table]) -> Case:
        """The case with each log changed."""
        return replace(self, tables={name: change(table) for name, table in self.tables.items()})

    def with_robot(self, change: Callable[[dict[str, Any]], None]) -> Case:
        """The case with a copy of the robot file, which `change` writes into."""
        robot = copy.deepcopy(self.robot)
        change(robot)
        return replace(self, robot=robot)

    def write(self, folder: Path) -> tuple[Path, list[Path]]:
        """Write robot file, URDF and logs as a user has them; their paths."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "robot.urdf").write_text(self.urdf)
        (folder / "robot.yaml").write_text(yaml.safe_dump({**self.robot, "urdf": "robot.urdf"}))
        paths = []
        for name, table in self.tables.items():
            paths.append(folder / f"{name}.parquet")
            pq.write_table(pa.table(table), paths[-1])
        return folder / "robot.yaml", paths


Change = Callable[[Case], Case]
Columns = Callable[[Case], str]  # a pattern that a column's whole name matches


@dataclass(frozen=True)
class Fault:
    """One fault: `words` are patterns, one of which an error or warning that names the right reason holds.

    The kind `healthy` is no fault: nothing may be said and no verdict lost.
    """

    name: str
    kind: str
    change: Change
    words: tuple[str, ...] = ()


def case_of(robot: RobotModel, tables: dict[str, Table]) -> Case:
    """The case of a healthy robot and its logs."""
    model = robot.model
    legs = {}
    for name, foot in robot.feet.items():
        chain = model.supports[robot.frame(foot.bush)[0]]
        legs[name] = tuple(model.names[joint] for joint in chain if joint)
    entry = yaml.safe_load(robot.path.read_text())
    return Case(entry, robot.urdf, tables, legs)


def imu(quantity: str = ".*") -> Columns:
    return lambda case: rf"imu\.{re.escape(case.robot['imu']['name'])}\.{quantity}"


def wrench(*feet: str, quantity: str = ".*") -> Columns:
    def pattern(case: Case) -> str:
        names = "|".join(re.escape(case.robot["feet"][foot]["wrench"]["name"]) for foot in feet or FEET)
        return rf"wrench\.({names})\.{quantity}"

    return pattern


def encoder(*feet: str, place: int, quantity: str = "(position|velocity)") -> Columns:
    """A joint of these legs, counted from the foot: -1 is the last one, mostly the ankle's roll."""

    def pattern(case: Case) -> str:
        names = "|".join(re.escape(case.legs[foot][place]) for foot in feet or FEET)
        return rf"joint\.({names})\.{quantity}"

    return pattern


def encoders(quantity: str = "(position|velocity)") -> Columns:
    return lambda _: rf"joint\..*\.{quantity}"


def chosen(case: Case, columns: Columns) -> set[str]:
    """The columns of the case's logs that a pattern means."""
    pattern = re.compile(columns(case))
    return {name for table in case.tables.values() for name in table if pattern.fullmatch(name)}

"""A recording of the twin: the log a robot would have written, and the truth beside it."""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from plantar.conventions import Array
from plantar.files import atomic_write, write_text
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.twin.presets import Preset
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import exact_columns, truth_columns
from plantar.twin.sensing.logger import with_base_attitude
from plantar.twin.sensing.sensor_errors import with_sensor_errors
from plantar.twin.sensing.sensors import sense
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout


@dataclass(frozen=True)
class Truth:
    """What the twin knows and no sensor saw: `columns` (N,) each, and `facts` about what was put in."""

    time: Array
    columns: Mapping[str, Array] = field(repr=False)
    facts: Mapping[str, Any]


@dataclass(frozen=True)
class TwinRecording:
    """One motion as recorded (`log`) and as it was (`truth`)."""

    log: MotionLog
    truth: Truth

    @property
    def name(self) -> str:
        return self.log.name

    def write(self, directory: str | os.PathLike[str]) -> Path:
        """Write `<motion>.parquet`, `<motion>.truth.parquet` and `<motion>.truth.json`; returns the log's path."""
        directory = Path(directory)
        path = directory / f"{self.name}.parquet"
        _write_parquet(path, self.log.time, self.log.columns)
        _write_parquet(directory / f"{self.name}.truth.parquet", self.truth.time, self.truth.columns)
        write_text(directory / f"{self.name}.truth.json", json.dumps(self.truth.facts, indent=1) + "\n")
        return path


def record(
    rollout: Rollout,
    robot: RobotModel,
    physics: Physics,
    preset: Preset,
    seed: int,
    of_robot: Mapping[str, Any] | None = None,
) -> TwinRecording:
    """Sensors of `preset` on a rollout; cheap, so many seeds need one rollout.

    `of_robot`: by what the robot differs from its file, for the truth.
    """
    feet = cut_feet(describe(robot), robot)
    exact = exact_columns(rollout, robot, feet)
    time, logged = rollout.time, dict[str, float]()
    if preset.logger is not None:
        random = np.random.default_rng([seed, zlib.crc32(rollout.name.encode()), 1])
        time, exact, logged = preset.logger.logged(exact, rollout, robot, random)
        robot = with_base_attitude(robot)
    errors: Mapping[str, Any] = {}
    if preset.sensor_errors is not None:
        exact, errors = with_sensor_errors(exact, time, robot, preset.sensor_errors, seed)
    columns, drawn = sense(exact, time, robot, preset.sensors, seed, rollout.name)
    facts = {
        "motion": rollout.name,
        "preset": preset.name,
        "seed": seed,
        "bushes": {foot: vars(bush) for foot, bush in (physics.bushes or {}).items()},
        "slips": [vars(slip) for slip in physics.slips],
        "floor": list(physics.floor),
        "friction": physics.friction,
        "sensors": vars(preset.sensors),
        "logger": None if preset.logger is None else vars(preset.logger),
        "drawn": drawn | logged,
        "sensor_errors": errors,
        "robot": of_robot or {},
    }
    truth = Truth(rollout.time, truth_columns(rollout, feet), facts)
    return TwinRecording(MotionLog(rollout.name, time, columns), truth)


def _write_parquet(path: Path, time: Array, columns: Mapping[str, Array]) -> None:
    table = pa.table({"time": time, **columns})
    with atomic_write(path) as handle:
        pq.write_table(table, handle, compression="zstd")

"""One group fitted, as `plantar identify feet` fits it, in whatever process; finished work is not done again."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pyarrow as pa

from plantar.errors import MissingExtra, NoRoom, PlantarError
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.fleet.manifest import Log
from plantar.fleet.places import Store, brought, content_sha256, name_of, stamp_of
from plantar.fleet.robots import FleetRobot, robot_model
from plantar.fleet.unit import (
    Failure,
    Unit,
    UnitInput,
    UnitRow,
    readable_unit,
    result_file,
    rows_of_result,
    unit_file,
    unit_key,
)
from plantar.logs.inputs import open_together
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.results.io import dump_json
from plantar.robot.model import RobotModel

# Errors of the machine, not of the logs: another run may not have them.
Passing: Final = (MissingExtra, NoRoom)
ONE_THREAD: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Task:
    """What a worker is asked for: a group's logs, robot, settings, where results go; `memory` [bytes] for the logs."""

    robot: FleetRobot
    logs: tuple[Log, ...]
    settings: FeetSettings
    store: Store
    memory: int | None


@dataclass(frozen=True)
class Done:
    """What the driver is told: the unit's key (None where not even the logs could be hashed), whether it was there
    already, and what failed without being kept, since another run may succeed."""

    key: str | None
    reused: bool
    failures: tuple[Failure, ...]
    failed: bool
    seconds: float


@dataclass(frozen=True)
class _Fetched:
    """A log on this machine."""

    log: Log
    path: Path
    entry: UnitInput


def compute(task: Task) -> Done:
    """Fit a task's group, unless the store holds it. Raises PlaceError where the store cannot be used."""
    begun = time.monotonic()
    one_thread()
    with tempfile.TemporaryDirectory(prefix="plantar-") as folder:
        fetched, missing = _fetched(task, Path(folder))
        if missing:
            return Done(None, False, tuple(missing), True, time.monotonic() - begun)
        key = task_key(task, [one.entry for one in fetched])
        found = kept(task.store, key)
        if found is not None:
            return Done(key, True, (), not found.rows, time.monotonic() - begun)
        try:
            rows, failures = _fitted(task, key, fetched)
        except Passing as error:
            return Done(None, False, (_failure(fetched, error),), True, time.monotonic() - begun)
    unit = Unit(key, tuple(one.entry for one in fetched), rows, tuple(failures), time.monotonic() - begun)
    task.store.write(unit_file(key), unit.dump())
    return Done(key, False, (), not rows, unit.seconds)


def task_key(task: Task, inputs: Sequence[UnitInput]) -> str:
    """The key of the unit that a task makes of logs with these contents."""
    content = [(entry.role, entry.name, entry.sha256) for entry in inputs]
    return unit_key(task.robot.sha256, content, task.settings)


def kept(store: Store, key: str) -> Unit | None:
    """A finished unit in the store; None where there is none that can be read."""
    return readable_unit(store.read(unit_file(key)), unit_file(key))


def one_thread() -> None:
    """One core for each worker: several workers with threads of their own only wait for one another."""
    for name in ONE_THREAD:
        os.environ.setdefault(name, "1")
    pa.set_cpu_count(1)


def _fetched(task: Task, folder: Path) -> tuple[list[_Fetched], list[Failure]]:
    """The group's logs on this machine, and those that are not there: the next run may find them."""
    found: list[_Fetched] = []
    missing: list[Failure] = []
    for place, log in enumerate(task.logs):
        own = folder / str(place)
        own.mkdir()
        try:
            stamp = stamp_of(log.place)
            path = brought(log.place, own)
            content = content_sha256(path)
        except PlantarError as error:
            missing.append(Failure(log.place, str(error).replace(str(own / name_of(log.place)), log.place)))
            continue
        found.append(_Fetched(log, path, UnitInput(log.place, name_of(log.place), log.role, content, stamp)))
    return found, missing


def _fitted(task: Task, key: str, fetched: Sequence[_Fetched]) -> tuple[tuple[UnitRow, ...], list[Failure]]:
    """The group's parameters and the logs that could not be used; a result is kept before its unit says that it is.

    Raises `Passing` errors.
    """
    robot = robot_model(task.robot)
    logs, failures = _opened(robot, fetched, task.memory)
    result = _identified(robot, logs, task.settings, failures)
    if result is None:
        return (), failures
    content = dump_json(result.to_dict())
    for one in fetched:
        content = content.replace(str(one.path), one.log.place)
    task.store.write(result_file(key), content.encode())
    return rows_of_result(result), failures


def _opened(
    robot: RobotModel, fetched: Sequence[_Fetched], memory: int | None
) -> tuple[list[tuple[_Fetched, MotionLog]], list[Failure]]:
    """Every log that can be read beside those before it. Raises `Passing` errors."""
    logs: list[tuple[_Fetched, MotionLog]] = []
    failures: list[Failure] = []
    for one in fetched:
        left = None if memory is None else memory - sum(log.size for _, log in logs)
        try:
            logs += [(one, log) for log in open_together([one.path], robot, left)]
        except Passing:
            raise
        except PlantarError as error:
            failures.append(_failure([one], error))
    return logs, failures


def _identified(
    robot: RobotModel, logs: list[tuple[_Fetched, MotionLog]], settings: FeetSettings, failures: list[Failure]
) -> FeetResult | None:
    """The result of the logs without those that `identify_feet` refuses by name, which join the `failures`."""
    while any(one.log.role == "fit" for one, _ in logs):
        fit, validate = ([log for one, log in logs if one.log.role == role] for role in ("fit", "validate"))
        try:
            return identify_feet(robot, fit, validate, settings)
        except PlantarError as error:
            failures.append(_failure([one for one, _ in logs], error))
            blamed = failures[-1].log
            if not blamed:
                return None
            logs = [(one, log) for one, log in logs if one.log.place != blamed]
    return None


def _failure(fetched: Sequence[_Fetched], error: PlantarError) -> Failure:
    """An error with the places of the logs that it names; of the one log that it is about, where it is about one."""
    text = str(error)
    named = [one.log.place for one in fetched if str(one.path) in text or len(fetched) == 1]
    for one in fetched:
        text = text.replace(str(one.path), one.log.place)
    return Failure(named[0] if len(named) == 1 else "", text)

"""Robots and logs as a caller may give them: loaded ones, or paths of their files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from plantar.errors import DataError, LogError, NoRoom, RobotError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import of_robot, open_log, reads_alike
from plantar.logs.readers.read_limit import NUMBER, shown, usual_memory
from plantar.logs.readers.urdf_names import with_following_joints
from plantar.logs.same_recording import same_noise, same_samples
from plantar.logs.stretches import LONGEST

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

PathInput = str | os.PathLike[str]
RobotInput: TypeAlias = "RobotModel | PathInput"
LogInput = MotionLog | PathInput
LogInputs = LogInput | Iterable[LogInput]
AHEAD = 2**26  # bytes of text: read by the time that what works on logs is imported
FEWER_LOGS = "fewer logs at a time, or more with --memory (memory= in Python)"


def robot_of(robot: RobotInput) -> RobotModel:
    """The robot itself, or read from its file. Raises RobotError for anything else."""
    from plantar.robot.model import RobotModel, load_robot  # they cost start-up, which logs need not wait for

    if isinstance(robot, RobotModel):
        return robot
    if isinstance(robot, str | os.PathLike):
        return load_robot(robot)
    kind = type(robot).__name__
    raise RobotError("is not a robot", value=kind, valid="a RobotModel or the path of a robot file")


@dataclass(frozen=True)
class WaitingLogs:
    """Logs that are read when their turns come, each by one of `openers`; these raise LogError.

    `bounded`: all of them are known to fit in memory whatever they hold, so that any of them may come first.
    """

    openers: Sequence[Callable[[], MotionLog]]
    bounded: bool

    def __iter__(self) -> Iterator[MotionLog]:
        return (opened() for opened in self.openers)

    def __getitem__(self, some: slice) -> WaitingLogs:
        return replace(self, openers=self.openers[some])


def logs_of(logs: LogInputs, robot: RobotModel, longest: float = np.inf) -> Iterable[MotionLog]:
    """One log or several, each itself or read from its file when its turn comes; longest: as in `open_log`. Raises
    LogError for anything else."""
    if isinstance(logs, MotionLog | str | os.PathLike):
        logs = (logs,)
    if isinstance(logs, WaitingLogs):
        return logs
    if isinstance(logs, Sequence):
        openers = [partial(_log_of, log, robot, longest) for log in logs]
        return WaitingLogs(openers, _bounded(logs, usual_memory()))
    if not isinstance(logs, Iterable):
        raise _no_log(logs)
    return (_log_of(log, robot, longest) for log in logs)


@dataclass(frozen=True)
class _AheadLog:
    """A log that was read before its turn, and before the robot was known."""

    log: MotionLog
    robot: RobotModel

    def __call__(self) -> MotionLog:
        return of_robot(self.log, self.robot)


def read_ahead(paths: Sequence[Path], memory: int | None = None) -> dict[Path, MotionLog]:
    """The first few tables in text, before the robot is known; one that cannot be read has its turn later."""
    if not _bounded(paths, usual_memory() if memory is None else memory):
        return {}
    found, left = dict[Path, MotionLog](), AHEAD
    for path in paths:
        left -= path.stat().st_size
        if left < 0:
            break
        with suppress(LogError):
            found[path] = open_log(path, memory=memory)
    return found


def open_in_turn(
    paths: Sequence[Path],
    robot: RobotModel,
    kept: Callable[[MotionLog], int],
    memory: int | None,
    ahead: Mapping[Path, MotionLog],
) -> WaitingLogs:
    """Logs read when their turns come, of long ones what moves most: each must fit in `memory` bytes beside those that
    are `kept` of the ones before.

    If left out, the usual memory. ahead: those that were read before. Raises LogError as `open_log`.
    """
    whole = usual_memory() if memory is None else memory
    left = whole

    def read(path: Path) -> MotionLog:
        nonlocal left
        try:
            log = open_log(path, robot, memory=left, longest=LONGEST)
        except NoRoom as error:
            if left == whole:
                raise
            message = f"does not fit beside the other logs, which leave {shown(left)}"
            raise NoRoom(message, path=path, valid=FEWER_LOGS) from error
        left = max(0, left - kept(log))
        return log

    def opener(path: Path) -> Callable[[], MotionLog]:
        known = path in ahead and reads_alike(path, robot)
        return _AheadLog(ahead[path], robot) if known else partial(read, path)

    return WaitingLogs([opener(path) for path in paths], _bounded(paths, whole))


def open_together(paths: Sequence[Path], robot: RobotModel, memory: int | None = None) -> list[MotionLog]:
    """Several logs, read on all cores, that must fit in `memory` bytes together; if left out, the usual memory.

    Raises LogError as `open_log`, and where a log does not fit beside those that were read before.
    """
    left = usual_memory() if memory is None else memory
    lock = Lock()

    def opened(path: Path) -> MotionLog:
        nonlocal left
        log = open_log(path, robot, memory=left)
        with lock:
            left -= log.size
            if left < 0:
                message = f"does not fit beside the other logs: {shown(-left)} too much"
                raise NoRoom(message, path=path, valid=FEWER_LOGS)
        return log

    if all(path.suffix.lower() == ".csv" for path in paths):  # each is parsed on all cores
        return list(map(opened, paths))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(opened, paths))


def check_names(logs: Sequence[MotionLog]) -> None:
    """DataError where two logs have one name, which results name motions by, or are one recording, told twice."""
    once = "valid: each once; told twice, intervals come out too narrow, and a log that was fitted validates nothing"
    seen: dict[str, MotionLog] = {}
    for log in logs:
        if log.name in seen and log.path is not None and log.path == seen[log.name].path:
            raise DataError(f"{log.source} is given twice ({once})")
        if log.name in seen:
            message = f"two logs are called '{log.name}': {seen[log.name].source} and {log.source}"
            raise DataError(f"{message} (valid: file names that differ, since results name motions by them)")
        for other in seen.values():
            if same_samples(log, other):
                message = f"{other.source} and {log.source} hold the same recording, or a part of one"
                raise DataError(f"{message} ({once})")
        seen[log.name] = log
    for other, log in same_noise(logs):
        message = f"{other.source} and {log.source} hold the same recording, or a part of one"
        raise DataError(
            f"{message}, resampled or written otherwise: their sensors have the same noise ({once})"
        )


def _bounded(logs: Sequence[LogInput], memory: int) -> bool:
    """Whether logs that are still files fit in `memory` bytes together, as far as their sizes tell."""
    sizes = (_largest(Path(log)) for log in logs if isinstance(log, str | os.PathLike))
    return sum(sizes) <= memory


def _largest(path: Path) -> float:
    """Bytes that the numbers of a file may take: a plain text has a character or more for each."""
    plain = path.suffix.lower() == ".csv" and path.is_file()
    return NUMBER * path.stat().st_size if plain else np.inf


def _log_of(log: LogInput, robot: RobotModel, longest: float) -> MotionLog:
    if isinstance(log, MotionLog):
        return with_following_joints(log.without_empty_joints(), robot.following_joints)
    if isinstance(log, str | os.PathLike):
        return open_log(log, robot, longest=longest)
    raise _no_log(log)


def _no_log(given: object) -> LogError:
    kind = type(given).__name__
    return LogError("is not a log", value=kind, valid="a MotionLog, the path of a log, or a list of them")

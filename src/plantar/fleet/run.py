"""A fleet's groups through a Dask cluster: only what is not finished yet, a few at a time, in any order."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from plantar.errors import PlantarError
from plantar.feet.settings import FeetSettings
from plantar.fleet.cluster import worker_count
from plantar.fleet.manifest import Group
from plantar.fleet.places import PlaceError, Stamp, Store, name_of, stamp_of
from plantar.fleet.robots import FleetRobot, robot_at
from plantar.fleet.tables import Written, write_tables
from plantar.fleet.unit import UNITS, Failure, contents_of, readable_unit, unit_file, unit_key
from plantar.fleet.work import Done, Task, compute

# Groups in the cluster for each that it works on: workers never wait, the driver stays small.
QUEUED: Final = 3
RECENT: Final = 200  # finished groups from which the time left is told


@dataclass(frozen=True)
class Progress:
    """How far a run is: groups in all, there before it, done by it, failed; seconds left, None while unknown."""

    total: int
    reused: int
    done: int
    failed: int
    seconds_left: float | None


@dataclass(frozen=True)
class Outcome:
    """What a run came to; `reused` groups were finished before it, `done` by it. `seconds`: of the whole run; `worked`:
    of the workers, all together."""

    groups: int
    reused: int
    done: int
    written: Written
    seconds: float
    worked: float


@dataclass
class _State:
    """What the driver keeps of each group: a key, or why there is none."""

    total: int
    keys: dict[str, str] = field(default_factory=dict)
    lost: dict[str, tuple[Failure, ...]] = field(default_factory=dict)
    reused: int = 0
    done: int = 0
    failed: int = 0
    worked: float = 0.0
    ends: deque[float] = field(default_factory=lambda: deque(maxlen=RECENT))

    def progress(self) -> Progress:
        left = self.total - self.reused - self.done - len(self.lost)
        span = self.ends[-1] - self.ends[0] if len(self.ends) > 1 else 0.0
        seconds = left * span / (len(self.ends) - 1) if span > 0 else None
        return Progress(self.total, self.reused, self.done, self.failed + len(self.lost), seconds)


def run_fleet(
    groups: Sequence[Group],
    store: Store,
    settings: FeetSettings,
    client: Any,
    progress: Callable[[Progress], None] = lambda _: None,
    memory: int | None = None,
) -> Outcome:
    """Fit every group that the store does not hold yet, and write both tables.

    Args:
        groups: of the manifest. store: where units and tables go. settings: as for `identify feet`.
        client: a `distributed.Client`. progress: called after each group.
        memory: bytes for the numbers of a group's logs.

    Raises:
        PlaceError: the store cannot be used; what is finished stays. PlantarError: the cluster is gone.
    """
    begun = time.monotonic()
    state = _State(len(groups))
    unfinished = _unfinished(groups, store, settings, state, memory)
    _work(client, unfinished, state, progress)
    written = write_tables(store, groups, state.keys, state.lost)
    return Outcome(len(groups), state.reused, state.done, written, time.monotonic() - begun, state.worked)


def _unfinished(
    groups: Sequence[Group], store: Store, settings: FeetSettings, state: _State, memory: int | None
) -> Iterator[tuple[str, Task]]:
    """A task for each group that the store does not hold; the others are noted in the state."""
    finished, contents = _stored(store)
    robots: dict[str, FleetRobot | PlantarError] = {}
    for group in groups:
        if group.robot not in robots:
            robots[group.robot] = _robot(group.robot)
        robot = robots[group.robot]
        if isinstance(robot, PlantarError):
            state.lost[group.name] = (Failure("", str(robot)),)
            continue
        key = _known_key(group, robot, settings, contents) if finished else None
        if key in finished:
            state.keys[group.name] = key
            state.reused += 1
            continue
        yield group.name, Task(robot, group.logs, settings, store, memory)


def _stored(store: Store) -> tuple[dict[str, None], dict[tuple[str, Stamp], str]]:
    """Keys of finished units, and the contents of the logs that were read for them. Damaged units are made again."""
    finished: dict[str, None] = {}
    contents: dict[tuple[str, Stamp], str] = {}
    names = [name for name in store.names(UNITS) if name.endswith(".json")]
    for name, content in zip(names, store.read_each(names), strict=True):
        unit = readable_unit(content, name)
        if unit is not None and name == unit_file(unit.key):
            finished[unit.key] = None
            contents |= contents_of(unit)
    return finished, contents


def _robot(place: str) -> FleetRobot | PlantarError:
    try:
        return robot_at(place)
    except PlantarError as error:
        return error


def _known_key(
    group: Group, robot: FleetRobot, settings: FeetSettings, contents: dict[tuple[str, Stamp], str]
) -> str | None:
    """The key of a group whose logs have not changed since they were read; None where one has to be read."""
    entries = []
    for log in group.logs:
        try:
            content = contents.get((log.place, stamp_of(log.place)))
        except PlantarError:
            return None  # the worker says what is wrong with it
        if content is None:
            return None
        entries.append((log.role, name_of(log.place), content))
    return unit_key(robot.sha256, entries, settings)


def _work(
    client: Any, unfinished: Iterator[tuple[str, Task]], state: _State, progress: Callable[[Progress], None]
) -> None:
    """Every task through the cluster, never more than a few for each worker at a time."""
    from distributed import as_completed

    names: dict[str, str] = {}

    def submit() -> Any:
        name, task = next(unfinished, (None, None))
        if name is None:
            return None
        future = client.submit(compute, task, pure=False)
        names[future.key] = name
        return future

    active = as_completed(loop=client.loop)
    for _ in range(QUEUED * worker_count(client)):
        if (future := submit()) is not None:
            active.add(future)
    for future in active:
        _take(names.pop(future.key), future, state)
        progress(state.progress())
        if (following := submit()) is not None:
            active.add(following)


def _take(name: str, future: Any, state: _State) -> None:
    """Note what became of one group."""
    if future.status == "cancelled":
        raise PlantarError("the scheduler is gone; what is finished stays (valid: the same command again)")
    error = future.exception()
    if isinstance(error, PlaceError):
        raise error
    if error is not None:
        state.lost[name] = (Failure("", _said(error)),)
        return
    done: Done = future.result()
    state.ends.append(time.monotonic())
    if done.key is None:
        state.lost[name] = done.failures
        return
    state.keys[name] = done.key
    state.reused += done.reused
    state.done += not done.reused
    state.failed += done.failed
    state.worked += done.seconds


def _said(error: BaseException) -> str:
    """One line for what stopped a group without being its logs' fault, or for what nobody thought of."""
    if isinstance(error, PlantarError):
        return str(error)
    if type(error).__name__ == "KilledWorker":
        return "its workers died, one after the other (valid: more memory for each with --memory, or shorter logs)"
    if isinstance(error, MemoryError):
        return "not enough memory for these logs (valid: more for each worker with --memory, or shorter logs)"
    text = " ".join(str(error).split())
    return f"internal error, please report it: {type(error).__name__}: {text}"

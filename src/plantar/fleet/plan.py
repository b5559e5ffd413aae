"""A manifest from files: logs of one robot and day are one group, with the time that log, name or file says."""

from __future__ import annotations

import glob
import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Final, Literal

from plantar.errors import PlantarError
from plantar.fleet.manifest import Group, Log
from plantar.fleet.places import found_at, is_remote, name_of, time_of
from plantar.logs.readers import FORMATS, TRUTH, motion_name, open_log
from plantar.robot.model import RobotModel

Source = Literal["log", "name", "file"]

FIRST: Final = datetime(2000, 1, 1, tzinfo=UTC)  # before it, a time that begins anywhere but at an epoch
BAG: Final = "metadata.yaml"  # stands in the folder of a ROS 2 bag
LAST: Final = datetime(2100, 1, 1, tzinfo=UTC)
STAMP = re.compile(
    r"(?<!\d)(20\d\d)[-_.]?(0[1-9]|1[0-2])[-_.]?(0[1-9]|[12]\d|3[01])"
    r"(?:[-_.T ]?([01]\d|2[0-3])[-_.:h]?([0-5]\d)(?:[-_.:m]?([0-5]\d))?)?(?!\d)"
)
"""A date, or a date and a time, in a file's name, such as rosbag2_2026_05_04-09_30_00."""


@dataclass(frozen=True)
class PlannedLog:
    """A log that was found: its place, its unit, when it was recorded (UTC) and what says so."""

    place: str
    unit: str
    time: datetime
    source: Source


def find_logs(patterns: Sequence[str]) -> tuple[str, ...]:
    """The logs that paths, glob patterns and URLs name, each once, in order.

    Raises PlantarError for a pattern that names none. Files beside logs, such as a twin's truth, are left out.
    """
    found: dict[str, None] = {}
    for pattern in patterns:
        places = found_at(pattern) if is_remote(pattern) else sorted(glob.glob(pattern, recursive=True))
        logs = [place for place in places if _is_log(place)]
        if not logs:
            valid = "a path, or a pattern in quotes such as 'logs/**/*.mcap'"
            raise PlantarError("names no log", value=pattern, valid=valid)
        found |= dict.fromkeys(place if is_remote(place) else str(Path(place).resolve()) for place in logs)
    return tuple(found)


def plan_logs(
    places: Iterable[str],
    robot: RobotModel,
    unit_of: Callable[[str], str],
    progress: Callable[[str], None],
) -> list[PlannedLog]:
    """When each log was recorded: by its first stamp where that is a date, else by its name, else by its file.

    Remote logs are not read. A log that cannot be read is planned as well: the run says what is wrong with it.
    """
    planned = []
    for place in places:
        progress(f"read {name_of(place)}")
        time, source = _recorded(place, robot)
        planned.append(PlannedLog(place, unit_of(place), time, source))
    return planned


def groups_of(planned: Iterable[PlannedLog], robot: str) -> tuple[Group, ...]:
    """A group for each unit and day (UTC), in time's order within each unit."""
    found: dict[tuple[str, str], list[PlannedLog]] = {}
    for one in sorted(planned, key=lambda log: (log.unit, log.time, log.place)):
        found.setdefault((one.unit, str(one.time.date())), []).append(one)
    return tuple(
        Group(f"{unit} {day}", robot, tuple(Log(log.place, "fit") for log in own), own[0].time, unit)
        for (unit, day), own in found.items()
    )


def sources_of(planned: Iterable[PlannedLog]) -> str:
    """How many times come from where, in one line."""
    words: dict[Source, str] = {
        "log": "logs' stamps", "name": "files' names", "file": "files' dates of change"
    }  # fmt: skip
    counts = Counter(one.source for one in planned)
    return "times from " + ", ".join(
        f"{words[source]}: {counts[source]}" for source in words if counts[source]
    )


def stamp_in(name: str) -> datetime | None:
    """The last date, with its time where there is one, in a file's name; None where there is none."""
    for year, month, day, hour, minute, second in reversed(STAMP.findall(name)):
        try:
            return datetime(
                int(year), int(month), int(day), int(hour or 0), int(minute or 0), int(second or 0), tzinfo=UTC
            )  # fmt: skip
        except ValueError:
            continue  # a 31st of February
    return None


def _is_log(place: str) -> bool:
    """A file with the ending of a log, or the folder of a ROS 2 bag, whose parts are no logs of their own."""
    name = name_of(place)
    known = TRUTH not in name and any(name.lower().endswith(ending) for ending in FORMATS)
    path = Path(place)
    return (path / BAG).is_file() if path.is_dir() else known and not (path.parent / BAG).is_file()


def _recorded(place: str, robot: RobotModel) -> tuple[datetime, Source]:
    if not is_remote(place) and (time := _first_stamp(place, robot)) is not None:
        return time, "log"
    if (time := stamp_in(motion_name(Path(name_of(place))))) is not None:
        return time, "name"
    return time_of(place), "file"


def _first_stamp(place: str, robot: RobotModel) -> datetime | None:
    """The log's first sample as a date; None where its clock starts with the log, or it cannot be read."""
    try:
        first = float(open_log(place, robot).time[0])
    except PlantarError:
        return None
    if not FIRST.timestamp() < first < LAST.timestamp():
        return None
    return datetime.fromtimestamp(first, UTC).replace(microsecond=0)

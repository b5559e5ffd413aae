"""A made fleet: robots on rubber that ages, a sole that is changed, a sensor that drifts; days from one rollout.

One motion is rolled out once. Every robot and day has rubber of its own stiffness through `on_other_rubber`, and
sensors drawn anew. Logs hold every second sample and no efforts, which `identify feet` does not read.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

import numpy as np

from plantar.conventions import MONTH
from plantar.errors import PlantarError
from plantar.files import write_text
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log
from plantar.twin.bush import PAPER
from plantar.twin.other_rubber import on_other_rubber
from plantar.twin.play import planned, rolled
from plantar.twin.presets import preset_named
from plantar.twin.recording import record
from plantar.twin.robots import hrp2

FIRST_DAY: Final = datetime(2026, 1, 1, 9, tzinfo=UTC)
BETWEEN_ROBOTS: Final = 0.03  # shares by which stiffness differs
BETWEEN_DAYS: Final = 0.005
STEP: Final = 0.08  # of a new sole
EVERY: Final = 2  # samples: 100 Hz
MOST: Final = 100_000  # logs

AGEING, NEW_SOLE, DRIFT = "ageing", "new sole", "drifting sensor"


@dataclass(frozen=True)
class Story:
    """What happens to one robot: `shares` of stiffness by foot on each day (n,), and the gain of the right force
    sensor (n,); `event` names it, empty where nothing happens."""

    unit: str
    event: str
    shares: Mapping[str, np.ndarray]
    gain: np.ndarray


def stories(robots: int, days: int, seed: int, ageing: float) -> list[Story]:
    """The first robot's rubber hardens by `ageing` a month, the second gets a new left sole after half of the days, the
    right force sensor of the third gains `ageing` a month; the others stay as they are."""
    random = np.random.default_rng([seed, 16])
    told = []
    months = np.arange(days) / MONTH
    for number in range(robots):
        event = {0: AGEING, 1: NEW_SOLE, 2: DRIFT}.get(number, "")
        shares = {
            foot: (1 + BETWEEN_ROBOTS * random.standard_normal())
            * (1 + BETWEEN_DAYS * random.standard_normal(days))
            for foot in PAPER
        }
        if event == AGEING:
            shares = {foot: own * (1 + ageing) ** months for foot, own in shares.items()}
        if event == NEW_SOLE:
            shares["left"] = shares["left"] * np.where(np.arange(days) >= days // 2, 1 + STEP, 1.0)
        gain = (1 + ageing) ** months if event == DRIFT else np.ones(days)
        told.append(Story(f"robot_{number + 1:02d}", event, shares, gain))
    return told


def write_fleet(
    folder: Path,
    robots: int,
    days: int,
    *,
    motion: str,
    preset: str,
    seed: int,
    ageing: float = 0.015,
    progress: Callable[[str], None],
) -> Path:
    """Write `robot.yaml`, a log a robot and day, `truth.csv` and the manifest, whose path is returned.

    motion: a name; it is played once. preset: of sensors, with plain rubber. Raises MotionError where the motion cannot
    be played, PlantarError for a preset that draws robots or for more than 100,000 logs.
    """
    chosen = preset_named(preset)
    if chosen.robot is not None or chosen.logger is not None:
        raise PlantarError("has robots or logs of its own", value=preset, valid="sensors, realistic")
    if robots * days > MOST:
        raise PlantarError("are too many logs", value=robots * days, valid=f"at most {MOST}")
    robot = hrp2.robot()
    robot_file = hrp2.write(folder)
    physics = chosen.physics(PAPER)
    rollout = rolled(planned(motion, robot), robot, physics)
    rows: list[tuple[str, ...]] = []
    truth: list[tuple[str, ...]] = []
    for story in stories(robots, days, seed, ageing):
        for day in range(days):
            shares = {foot: float(own[day]) for foot, own in story.shares.items()}
            date = FIRST_DAY + timedelta(days=day)
            name = f"{story.unit}_{date:%Y-%m-%d}"
            progress(name)
            other = replace(on_other_rubber(rollout, robot, shares), name=name)
            log = record(other, robot, physics, chosen, seed).log
            place = Path(story.unit) / f"{name}.parquet"
            save_log(_thinned(log, float(story.gain[day])), folder / place)
            head = (name, robot_file.name, place.as_posix(), "fit", f"{date:%Y-%m-%dT%H:%M:%SZ}", story.unit)
            rows.append(head)
            truth += _truth(name, story, shares)
    write_text(folder / "truth.csv", _text(("group", "unit", "event", "foot", "axis", "stiffness"), truth))
    manifest = folder / "fleet.csv"
    write_text(manifest, _text(("group", "robot", "log", "role", "time", "unit"), rows))
    return manifest


def _truth(group: str, story: Story, shares: Mapping[str, float]) -> Iterator[tuple[str, ...]]:
    for foot, bush in PAPER.items():
        for axis, stiffness in (("pitch", bush.pitch_stiffness), ("roll", bush.roll_stiffness)):
            yield group, story.unit, story.event, foot, axis, f"{stiffness * shares[foot]:.6g}"


def _thinned(log: MotionLog, gain: float) -> MotionLog:
    """Every second sample, no efforts, the right force sensor's readings times a gain."""
    columns = {
        name: values[::EVERY] * (gain if name.startswith("wrench.right.") else 1.0)
        for name, values in log.columns.items()
        if not name.endswith(".effort")
    }
    return MotionLog(log.name, log.time[::EVERY], columns)


def _text(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([head, *rows])
    return out.getvalue()

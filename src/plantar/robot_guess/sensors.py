"""Sensors as logs show them: names, frames of messages, topics, and which way a force sensor reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.readers.ros.bag import bag_topics

BAGS = (".mcap", ".db3", ".bag")


@dataclass
class Sensors:
    """What the logs hold: names of IMUs and wrench sensors, the frames of their messages, topics of bags."""

    imus: dict[str, str] = field(default_factory=dict)
    wrenches: dict[str, str] = field(default_factory=dict)
    upward: dict[str, float] = field(default_factory=dict)
    topics: dict[str, str] = field(default_factory=dict)


def look_at(logs: Sequence[Path]) -> Sensors:
    """Sensors in logs, the frames that bags give, and each wrench's mean force.z while it carries load."""
    sensors = Sensors()
    for path in logs:
        if path.suffix.lower() in BAGS or path.is_dir():
            _look_at_bag(path, sensors)
        log = open_log(path)
        for name in log.columns:
            kind, _, rest = name.partition(".")
            if kind in ("imu", "wrench"):
                found = sensors.imus if kind == "imu" else sensors.wrenches
                found.setdefault(rest.rsplit(".", 2)[0], "")
        for sensor in sensors.wrenches:
            if sensor not in sensors.upward and log.has(f"wrench.{sensor}.force.z"):
                sensors.upward[sensor] = _loaded(log, sensor)
    return sensors


def _look_at_bag(path: Path, sensors: Sensors) -> None:
    for key, topics in bag_topics(path).items():
        kind, _, name = key.partition(".")
        frame = next((frame for topic in topics for frame in topic.frames if frame), "")
        if kind == "joints":
            sensors.topics.setdefault("joints", topics[0].name)
            if len(topics) > 1:
                sensors.topics.pop("joints")  # several topics together hold the joints: all are read
        elif kind in ("imu", "wrench"):
            (sensors.imus if kind == "imu" else sensors.wrenches)[name] = frame
            sensors.topics.setdefault(name, topics[0].name)


def _loaded(log: MotionLog, sensor: str) -> float:
    force = log.column(f"wrench.{sensor}.force.z")
    force = force[np.isfinite(force)]
    return float(force[np.abs(force) >= np.quantile(np.abs(force), 0.75)].mean()) if force.size else 0.0

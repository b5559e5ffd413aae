"""Sensors as logs show them: names, frames of messages, topics; and which of them belongs to which foot."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import TRUTH, open_log
from plantar.logs.readers.ros.bag import bag_topics
from plantar.robot.joint_names import words_of
from plantar.robot.model import RobotModel
from plantar.robot_guess.biped import LEFT, RIGHT

BAGS = (".mcap", ".db3", ".bag")


@dataclass
class Sensors:
    """What the logs hold: IMUs and wrench sensors, each with the frame of its messages, topics of bags; the logs
    themselves, and the files that are none."""

    imus: dict[str, str] = field(default_factory=dict)
    wrenches: dict[str, str] = field(default_factory=dict)
    topics: dict[str, str] = field(default_factory=dict)
    logs: list[MotionLog] = field(default_factory=list)
    left_out: list[Path] = field(default_factory=list)


def look_at(paths: Sequence[Path], robot: RobotModel | None = None) -> Sensors:
    """Open logs and list their sensors; a file of the twin's truth is left out. `robot` has a map of their columns.

    Raises LogError.
    """
    sensors = Sensors()
    for path in paths:
        if TRUTH in path.name:
            sensors.left_out.append(path)
            continue
        if path.suffix.lower() in BAGS or path.is_dir():
            _look_at_bag(path, sensors)
        log = open_log(path, robot)
        for kind, found in (("imu", sensors.imus), ("wrench", sensors.wrenches)):
            for device in log.devices(kind):
                found.setdefault(device.partition(".")[2], "")
        sensors.logs.append(log)
    return sensors


def sensor_of(side: str, sensors: Sensors, on_foot: Sequence[str]) -> str | None:
    """The force sensor of a foot: by the frame of its messages, one of `on_foot`, else by the side in its name."""
    framed = [name for name, frame in sensors.wrenches.items() if frame in on_foot]
    if framed:
        return framed[0]
    own, other = (LEFT, RIGHT) if side == "left" else (RIGHT, LEFT)
    free = [name for name, frame in sensors.wrenches.items() if not other.search(name) or own.search(name)]
    free = [name for name in free if not re.search("hand|arm|wrist|elbow", name, re.I)] or free
    initial = side[0]
    patterns = (rf"{side}.*(foot|ankle|sole|leg)|(foot|ankle|sole|leg).*{side}", side,
                rf"^{initial}_?(foot|leg|ankle|sole)|^{initial}f|{initial}leg")  # fmt: skip
    for pattern in patterns:
        for name in free:
            if re.search(pattern, name, re.I):
                return name
    worded = [name for name in free if side in words_of(name)]
    if worded:
        return worded[0]
    return free[0] if len(free) == 1 and len(sensors.wrenches) == 1 else None


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

"""Which topics of a bag a robot's sensors are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.errors import LogError
from plantar.logs.readers.ros.joint_topics import joint_rank
from plantar.logs.readers.ros.layouts import IMU, JOINT_STATE, WRENCH
from plantar.logs.readers.ros.topics import Topic
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.robot.model import Placement, RobotModel

SAME_PLACE, SAME_AXES = 1.0, 0.01  # mm, rad: two frames of one sensor
GENERIC = {
    "", "imu", "data", "data_raw", "wrench", "ft", "ft_sensor", "force_torque", "force_torque_sensor", "raw",
}  # fmt: skip


def assign(
    topics: Iterable[Topic], robot: RobotModel | None, path: Path, notes: list[Note]
) -> dict[str, list[Topic]]:
    """Which topic is which sensor: keys `joints`, and `imu.<name>`, `wrench.<name>`.

    The robot file's `topics:` (joints, or a sensor's name, to a topic) goes first; then a topic called like
    the sensor, the frame of its link, its name in a topic's. Without a robot topics keep their own names.
    Raises LogError when `topics:` names one that the bag has not.
    """
    known = {topic.name: topic for topic in topics}
    wanted = {} if robot is None else dict(robot.topics)
    for name in wanted.values():
        if name not in known:
            message = f"has no topic '{name}' (topics in the robot file)"
            raise LogError(message, path=path, valid=", ".join(sorted(known)[:8]))
    joints = [t for t in known.values() if t.kind == JOINT_STATE]
    if "joints" in wanted:
        joints = [known[wanted["joints"]]]
    chosen: dict[str, list[Topic]] = (
        {"joints": sorted(joints, key=lambda topic: joint_rank(topic, robot))} if joints else {}
    )
    for kind, prefix, sensors in ((IMU, "imu", _imus(robot)), (WRENCH, "wrench", _wrenches(robot))):
        free = [topic for topic in known.values() if topic.kind == kind]
        for sensor, placement in sensors.items():
            guess = _guess(sensor, placement.link, free, only=len(sensors) == 1)
            topic = known[wanted[sensor]] if sensor in wanted else guess
            if topic is not None and topic.kind != kind:
                message = f"topic '{topic.name}' (topics in the robot file) is no {kind}, but {topic.kind}"
                raise LogError(message, path=path, valid=", ".join(other.name for other in free[:8]))
            if topic is None and free:
                names = ", ".join(other.name for other in free[:6])
                message = f"which topic is the {prefix} '{sensor}'?"
                valid = f"topics: {{{sensor}: TOPIC}} in the robot file, TOPIC one of {names}"
                raise LogError(message, path=path, valid=valid)
            if topic is None:
                continue
            if sensor not in wanted:
                text = f"{prefix} '{sensor}' is taken from {topic.name}"
                notes.append(Note("topic_guessed", "info", f"{path.name}: {text}"))
            chosen[f"{prefix}.{sensor}"] = [topic]
            if robot is not None:
                notes += _frame_elsewhere(f"{prefix} '{sensor}'", placement, topic, robot, path)
            free = [other for other in free if other is not topic]
        if robot is None:
            for topic in free:
                chosen.setdefault(f"{prefix}.{_own_name(topic, prefix)}", []).append(topic)
        elif free:
            text = f"topics of no sensor in the robot file, not used: {', '.join(topic.name for topic in free[:8])}"
            notes.append(Note("topics_ignored", "info", f"{path.name}: {text}"))
    return chosen


def _imus(robot: RobotModel | None) -> Mapping[str, Placement]:
    return {} if robot is None or robot.imu is None else {robot.imu.name: robot.imu.placement}


def _wrenches(robot: RobotModel | None) -> Mapping[str, Placement]:
    return {} if robot is None else {foot.wrench.name: foot.wrench.placement for foot in robot.feet.values()}


def _frame_elsewhere(
    sensor: str, placement: Placement, topic: Topic, robot: RobotModel, path: Path
) -> list[Note]:
    """A warning where messages carry a frame of the URDF that is not where the robot file puts their sensor."""
    frame = next((name.lstrip("/") for name in topic.frames if name), placement.link)
    if frame == placement.link or not robot.model.existFrame(frame):
        return []
    joint, mine = robot.frame(placement)
    other, theirs = robot.frame(replace(placement, link=frame, xyz=np.zeros(3), rpy=np.zeros(3)))
    between = mine.actInv(theirs)
    apart = 1e3 * float(np.linalg.norm(between.translation))
    turned = float(np.arccos(np.clip((np.trace(between.rotation) - 1) / 2, -1, 1)))
    if joint == other and apart < SAME_PLACE and turned < SAME_AXES:
        return []
    where = f"{apart:.0f} mm and {np.degrees(turned):.0f} deg away" if joint == other else "on another link"
    text = (
        f"{path.name}: messages of {sensor} say that they are in frame {frame}, which is {where} from where "
        f"{robot.path.name} puts the sensor (link: {placement.link}); the robot file is followed"
    )
    return [Note("sensor_frame", "warning", text)]


def _guess(sensor: str, link: str, free: list[Topic], *, only: bool) -> Topic | None:
    rules: tuple[Callable[[Topic], bool], ...] = (
        lambda topic: _own_name(topic, "imu" if topic.kind == IMU else "wrench") == sensor,
        lambda topic: link in topic.frames,
        lambda topic: sensor.lower() in topic.name.lower(),
        lambda topic: any(sensor.lower() in frame.lower() for frame in topic.frames),
    )
    for rule in rules:
        found = [topic for topic in free if rule(topic)]
        if len(found) == 1:
            return found[0]
    return free[0] if only and len(free) == 1 else None


def _own_name(topic: Topic, prefix: str) -> str:
    """A sensor's name from its topic: `/imu/chest` is chest, `/left_foot/wrench` is left_foot."""
    parts = [part for part in topic.name.split("/") if part.lower() not in GENERIC]
    return "_".join(parts) or (topic.frames[0] if topic.frames and topic.frames[0] else prefix)

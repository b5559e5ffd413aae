"""Joints of a bag: which JointState topic is the measured one, and a joint's values from all messages that name it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array
from plantar.logs.readers.ros.topics import Series, Stamps, Topic
from plantar.notes import Note, Severity

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

QUANTITIES = ("position", "velocity", "effort")
WANTED = re.compile(r"desired|command|cmd|reference|target|goal|setpoint|wanted|planned", re.IGNORECASE)


@dataclass(frozen=True)
class Messages:
    """Messages of one topic with one list of names or several, in the order in which they came."""

    series: tuple[Series, ...]

    def clock(self, received: bool) -> Stamps:
        """Their stamps (n,) [ns]: of their headers, or of their receipt."""
        return self._in_order([one.clock(received) for one in self.series])

    def column(self, quantity: str, joint: str) -> Array:
        """A joint's values (n,); NaN where a message did not hold it."""
        return self._in_order([one.column(quantity, one.names.index(joint)) for one in self.series])

    def _in_order(self, parts: list[Array] | list[Stamps]) -> np.ndarray:
        if len(parts) == 1:
            return parts[0]
        came = np.concatenate([one.clock(received=True) for one in self.series])
        return np.concatenate(parts)[np.argsort(came, kind="stable")]


def joint_rank(topic: Topic, robot: RobotModel | None) -> tuple[int, bool, bool, str]:
    """Best first: the topic with most of the robot's joints, then none that is called a command, then joint_states."""
    names = {name for series in topic.series.values() for name in series.names}
    if robot is not None:
        names &= {robot.joint_names_in_logs.in_log(joint) for joint in robot.joint_names}
    other = topic.name.split("/")[-1] != "joint_states"
    return -len(names), bool(WANTED.search(topic.name)), other, topic.name


def joint_columns(
    topic: Topic, owners: dict[str, str], notes: list[Note], path: Path
) -> Iterator[tuple[Messages, dict[str, Array]]]:
    """Columns of the joints, those together that the same messages name: lists of names may change on the way.

    A joint belongs to the best topic that names it, its owner: a command must not fill in for a measurement.
    """
    holders: dict[str, list[Series]] = {}
    for series in topic.series.values():
        for joint in dict.fromkeys(series.names):
            holders.setdefault(joint, []).append(series)
            if series.names.count(joint) > 1:
                text = f"{path.name}: {topic.name} names '{joint}' twice; the first is used"
                if (note := Note("joint_twice", "warning", text)) not in notes:
                    notes.append(note)
    if other := next((owners[joint] for joint in holders if joint in owners), None):
        text = f"{topic.name} names joints that {other} holds; they are taken from {other}"
        severity: Severity = "info" if WANTED.search(topic.name) else "warning"
        notes.append(Note("joint_topics", severity, f"{path.name}: {text}"))
    together: dict[tuple[int, ...], list[str]] = {}
    for joint, held in holders.items():
        if joint not in owners:
            together.setdefault(tuple(map(id, held)), []).append(joint)
            owners[joint] = topic.name
    for joints in together.values():
        messages = Messages(tuple(holders[joints[0]]))
        recorded = [q for q in QUANTITIES if any(q in series.values for series in messages.series)]
        yield messages, {f"joint.{j}.{q}": messages.column(q, j) for q in recorded for j in joints}

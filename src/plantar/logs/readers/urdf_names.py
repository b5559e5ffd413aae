"""A log's joints as the URDF has them: under its names, and those that mimic others as far as these are recorded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from plantar.errors import LogError
from plantar.notes import Note, listing
from plantar.robot.joint_names import JointNames

if TYPE_CHECKING:
    from plantar.logs.motion_log import MotionLog


def with_urdf_names(log: MotionLog, names: JointNames, joints: Iterable[str]) -> MotionLog:
    """The same log; columns of the URDF's `joints` that `names` calls otherwise have the URDF's names.

    A joint that is already recorded under the URDF's name keeps it. Raises LogError where a log holds both names.
    """
    to_urdf = {names.in_log(joint): joint for joint in joints if names.in_log(joint) != joint}
    if not to_urdf:
        return log
    columns = {}
    for column, values in log.columns.items():
        kind, _, rest = column.partition(".")
        joint, _, quantity = rest.rpartition(".")
        known = kind == "joint" and joint in to_urdf
        renamed = f"joint.{to_urdf[joint]}.{quantity}" if known else column
        if known and renamed in log.columns and to_urdf[joint] not in to_urdf:
            message = f"is '{renamed}' by the robot file's joint_names, which the log also holds"
            raise LogError(message, path=log.source, column=column, valid="one of the two")
        columns[renamed] = values
    return replace(log, columns=columns)


def with_following_joints(log: MotionLog, follows: Mapping[str, tuple[str, float, float]]) -> MotionLog:
    """The same log with positions of joints that it does not hold and that follow others that it holds, and a note.

    follows: of each such joint of the URDF the one that it mimics, which follows none, the factor and the offset [rad].
    """
    positions = {joint: f"joint.{joint}.position" for joint in follows}
    columns = {
        positions[joint]: factor * log.columns[f"joint.{leader}.position"] + offset
        for joint, (leader, factor, offset) in follows.items()
        if not log.has(positions[joint]) and log.has(f"joint.{leader}.position")
    }
    if not columns:
        return log
    told = listing([f"{joint} from {follows[joint][0]}" for joint in follows if positions[joint] in columns])
    text = f"{log.name}: not recorded, computed by the URDF's <mimic>: {told}"
    return log.with_columns(columns, Note("joint_mimics", "info", text))

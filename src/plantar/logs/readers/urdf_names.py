"""A log's joints under the URDF's names, where the robot file says that the log calls them otherwise."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from plantar.errors import LogError
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

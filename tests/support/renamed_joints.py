"""Logs whose joints are not called as the URDF calls them."""

from __future__ import annotations

from plantar.logs.motion_log import MotionLog


def renamed(log: MotionLog, new: dict[str, str] | None = None, prefix: str = "") -> MotionLog:
    """The log with its joints called otherwise."""
    columns = {}
    for column, values in log.columns.items():
        kind, _, rest = column.partition(".")
        joint, _, quantity = rest.rpartition(".")
        name = (new or {}).get(joint, prefix + joint)
        columns[f"joint.{name}.{quantity}" if kind == "joint" else column] = values
    return MotionLog(log.name, log.time, columns)

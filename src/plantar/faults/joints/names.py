"""Joints of a log that are not the URDF's: without them every angle would be wrong, so nothing may be fitted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.notes import NAMED, Finding, listing
from plantar.robot.joint_names import propose_names, propose_order
from plantar.robot.model import RobotModel


def check_joint_names(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A fatal finding where the log holds no joint of the URDF, or none of a leg; it proposes the naming that would."""
    recorded = recorded_joints(log)
    needed = {
        f"any joint between IMU and {foot} foot": own
        for foot, own in legs(robot).items()
        if own and not recorded.intersection(own)
    }
    every = set(robot.joint_names)
    if not every or (not needed and (every & recorded or robot.imu is not None)):
        return
    what, missing = next(iter(needed.items())) if every & recorded else ("any joint", every)
    text = f"columns 'joint.*.position': do not hold {what} of the URDF ({_listing(missing)})"
    names = propose_names(robot.joint_names, sorted(recorded))
    strangers = recorded - every
    if names is not None:
        valid = f"valid: '{names}' in the robot file"
        text += f"; the log's {_listing(strangers)} look like them"
    elif (order := propose_order(robot.joint_names, sorted(recorded))) is not None:
        valid = f"valid: '{order}' in the robot file, if the log has the URDF's order; plantar init writes it whole"
        text += f"; the log only numbers them: {_listing(strangers)}"
    elif strangers:
        valid = "valid: a log of this robot, or 'joint_names: {renamed: {URDF joint: log joint}}' in the robot file"
        text += f"; it holds {_listing(strangers)}"
    else:
        if not recorded:
            text = f"columns 'joint.*.position': the log holds no joint positions, such as of {_listing(missing)}"
        valid = "valid: columns joint.<joint>.position; for other names a map, `columns` in the robot file"
    yield Finding("joint_names", f"{text} ({valid})", True)


def check_path_joints(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A fatal finding where some joints between IMU and feet are not recorded: asked where nothing else adds up."""
    missing = set().union(*legs(robot).values()) - recorded_joints(log)
    if missing:
        where = f"columns 'joint.*.position': {_listing(missing)} not recorded, and with them at 0"
        text = f"{where} the feet's wrenches do not balance gravity"
        yield Finding("joint_names", f"{text} (valid: a position of every joint between IMU and feet)", True)


def recorded_joints(log: MotionLog) -> set[str]:
    """The joints of which a log holds positions."""
    parts = [name.removeprefix("joint.").rpartition(".") for name in log.columns if name.startswith("joint.")]
    return {
        joint
        for joint, _, quantity in parts
        if quantity == "position" and np.isfinite(log.column(f"joint.{joint}.position")).any()
    }


def legs(robot: RobotModel) -> dict[str, list[str]]:
    """Of each foot, the joints between it and the IMU that no other foot has there, in the URDF's order; none without
    IMU."""
    if robot.imu is None:
        return {}
    paths = {name: robot.joints_between(robot.imu.placement, foot.bush) for name, foot in robot.feet.items()}
    uses = Counter(joint for path in paths.values() for joint in path)
    return {
        name: [joint for joint in robot.joint_names if joint in path and uses[joint] == 1]
        for name, path in paths.items()
    }


def _listing(names: Collection[str]) -> str:
    return listing(sorted(names), NAMED)

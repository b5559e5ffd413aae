"""A first robot file from a URDF and logs: what can be seen is written, what is guessed says so.

Legs and soles come from the URDF; sensors from the logs' names and message frames; the logs of a standing robot then
check and turn what gravity, weight and balance show. Without a log the URDF has to do.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY, Array
from plantar.errors import LogError, RobotError
from plantar.exporters.urdf.tree import UrdfTree
from plantar.faults.channels import named
from plantar.faults.joints.names import check_joint_names, recorded_joints
from plantar.faults.log_faults import check_log
from plantar.files import write_text
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.readers.urdf_names import with_following_joints, with_urdf_names
from plantar.notes import Finding
from plantar.robot.joint_names import JointNames, propose_names, propose_order
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.urdf import following_joints, from_trunk, parse_urdf, read_urdf
from plantar.robot_guess.biped import find_biped, without_toes
from plantar.robot_guess.bush import bush_shift
from plantar.robot_guess.column_map import read_column_map
from plantar.robot_guess.evidence import Remark, check_stance, widen_outline
from plantar.robot_guess.feet import Sole, find_sole, fixed_links
from plantar.robot_guess.imu import find_frame, turned_to_gravity
from plantar.robot_guess.seat import urdf_seat
from plantar.robot_guess.sensors import Sensors, look_at, sensor_of
from plantar.robot_guess.stance import find_stance
from plantar.robot_guess.text import BushHeight, Draft
from plantar.robot_guess.wrench import seats_by_log
from plantar.robot_guess.zeros import without_zeros

THIN = 0.02  # m: rubber bushes sit about so far above the sole
WITHOUT_LOG = "imu"  # what an IMU is called before there is a log


def guess_robot_file(urdf: Path, logs: Sequence[Path], out: Path, columns: Path | None = None) -> str:
    """The robot file's text, for a file at `out`; `columns` is a file with the map of the logs' columns, taken over.

    Raises RobotError where the URDF is unreadable or no biped, LogError where a log is, or is of another robot.
    """
    text = read_urdf(urdf)
    model = parse_urdf(
        from_trunk(text, "fixed"), urdf, floating=False
    )  # its root is not where the world's is
    tree = UrdfTree.load(urdf)
    biped = find_biped(tree, model)
    soles = [find_sole(tree, model, biped, leg) for leg in biped.legs]
    mapped, reading = "", None
    if columns is not None:
        mapped = read_column_map(columns)
        blind = _first_draft(tree, soles, Sensors(), urdf)
        # What is wrong with the map names its file.
        reading = replace(_loaded(blind, urdf, mapped), path=columns)
    sensors = look_at(logs, reading)
    named = (name for log in sensors.logs for name in log.columns)
    recorded = {name.split(".")[1] for name in named if name.startswith("joint.")}
    biped = without_toes(biped, tree, model, recorded | following_joints(text).keys())
    soles = [find_sole(tree, model, biped, leg) for leg in biped.legs]
    draft = _first_draft(tree, soles, sensors, urdf)
    draft, recordings = _with_names(draft, tuple(model.names)[1:], sensors.logs)
    recordings = [with_following_joints(log, following_joints(text)) for log in recordings]
    if recordings:
        _refuse_other_robot(draft, urdf, recordings)
        whole = [log for log in recordings if not _missing(draft, log)]
        if whole:
            draft = _seen_standing(draft, tree, model, whole)
            draft = _with_bush_by_log(draft, urdf, whole)
        draft = replace(draft, remarks=[*draft.remarks, *_findings(draft, urdf, recordings)])
    return draft.text(_relative(urdf, out)) + mapped


def _first_draft(tree: UrdfTree, soles: Sequence[Sole], sensors: Sensors, urdf: Path) -> Draft:
    """What the URDF and the sensors' names tell."""
    found = dict[str, str]()
    for sole in soles:
        name = sensor_of(sole.limb.side, sensors, fixed_links(tree, sole.limb.link))
        if name is not None and name not in found.values():
            found[sole.limb.side] = name
    seats = {
        sole.limb.side: urdf_seat(
            tree, sole, name := found.get(sole.limb.side), sensors.wrenches.get(name or "", "")
        )
        for sole in soles
    }
    name = next(iter(sensors.imus), None if sensors.logs else WITHOUT_LOG)
    imu = None if name is None else (name, find_frame(tree, name, sensors.imus.get(name, "")))
    if imu is not None and len(sensors.imus) > 1:
        others = ", ".join(other for other in sensors.imus if other != name)
        imu = (imu[0], replace(imu[1], reason=f"{imu[1].reason}; the logs also hold {others}"))
    bushes = {sole.limb.side: _usual_bush(sole) for sole in soles}
    left_out = [Remark(f"{path.name} is what the twin knows, no log: left out") for path in sensors.left_out]
    count = {0: "no log", 1: "1 log"}.get(len(sensors.logs), f"{len(sensors.logs)} logs")
    source = f"{urdf.name} and {count}"
    robot = tree.root.get("name") or urdf.stem
    return Draft(robot, source, imu, soles, found, seats, bushes, JointNames(), sensors.topics, left_out)


def _usual_bush(sole: Sole) -> BushHeight:
    above = min(THIN, abs(sole.depth) / 2)
    return BushHeight(sole.depth + above, above, f"{1e3 * above:.0f} mm above the sole; the URDF cannot know")


def _with_names(
    draft: Draft, joints: Sequence[str], logs: Sequence[MotionLog]
) -> tuple[Draft, list[MotionLog]]:
    """The draft with the logs' names of joints where they are not the URDF's, and the logs under the URDF's names."""
    recorded = set().union(*(recorded_joints(log) for log in logs)) if logs else set()
    names = propose_names(joints, sorted(recorded))
    numbered = names is None
    names = names or propose_order(joints, sorted(recorded))
    if names is None:
        return draft, list(logs)
    return replace(draft, names=names, numbered=numbered), [
        with_urdf_names(log, names, joints) for log in logs
    ]


def _refuse_other_robot(draft: Draft, urdf: Path, logs: Sequence[MotionLog]) -> None:
    robot = _loaded(draft, urdf)
    for log in logs:
        problem = next((one for one in _checked(draft, robot, log) if one.code == "joint_names"), None)
        if problem is not None:
            raise LogError(problem.text, path=log.source)


def _seen_standing(draft: Draft, tree: UrdfTree, model: pin.Model, logs: Sequence[MotionLog]) -> Draft:
    """The draft after a look at gravity, balance, weight and centre of pressure."""
    name, mount = draft.imu or (None, None)
    links = [mount.link, *mount.others] if mount is not None else []
    weight = GRAVITY * float(sum(inertia.mass for inertia in model.inertias))
    tared, seen = without_zeros(logs, draft.sensors, weight)
    stance = find_stance(model, draft.soles, draft.sensors, name, links, tared)
    if stance is None:
        remark = Remark("the feet never carry the robot's weight: nothing could be checked", True)
        return replace(draft, remarks=[*draft.remarks, remark])
    poses = _seat_poses(draft, tree)
    imu = None if mount is None or name is None else (name, turned_to_gravity(mount, stance))
    seats, left = seats_by_log(draft.seats, draft.soles, stance, imu and imu[1], poses)
    soles, remarks = list[Sole](), [*draft.remarks, *seen]
    for sole in draft.soles:
        side = sole.limb.side
        wider, doubts = widen_outline(sole, seats[side], stance, poses[side], weight)
        soles.append(wider)
        remarks += doubts
    remarks += check_stance(soles, seats, stance, poses, weight, left)
    return replace(draft, imu=imu, seats=seats, soles=soles, remarks=remarks)


def _seat_poses(draft: Draft, tree: UrdfTree) -> Mapping[str, Array]:
    """Pose of each sensor's link in its ankle link, (4, 4)."""
    return {
        sole.limb.side: np.array(tree.fixed_pose(sole.limb.link, draft.seats[sole.limb.side].link))
        for sole in draft.soles
    }


def _with_bush_by_log(draft: Draft, urdf: Path, logs: Sequence[MotionLog]) -> Draft:
    """The draft with bushes as high as torque and force agree that they are, if that is between sole and ankle.

    What shows is the height over the sensor: a sensor at the ankle's origin by a guess goes to the sole where only then
    the bush lies between both.
    """
    if draft.imu is None:
        return draft
    shift = bush_shift(_loaded(draft, urdf), logs)
    seats, bushes = dict(draft.seats), dict(draft.bushes)
    for sole in draft.soles:
        side = sole.limb.side
        seat, bush = seats[side], bushes[side]
        lowered = replace(
            seat,
            xyz=sole.upright @ [0.0, 0.0, sole.depth],
            height=sole.depth,
            reason=f"at the sole, below the bush as torque and force show, {seat.reason.partition(', ')[2]}",
        )
        tried = [seat, lowered] if seat.at_origin else [seat]
        rise = None if shift is None else bush.height + shift[0] - seat.height
        heights = [] if rise is None else [one.height + rise for one in tried]
        best = int(np.argmin([abs(height - bush.height) for height in heights])) if heights else 0
        if rise is None or shift is None or not sole.depth - shift[1] < heights[best] < shift[1]:
            bushes[side] = replace(bush, reason=f"{bush.reason}, and the logs do not show it")
            continue
        seats[side] = tried[best]
        if best == 1:
            seats[side] = replace(lowered, spread=shift[1] + bush.spread)
        height, within = heights[best], f"± {1e3 * shift[1]:.0f} mm"
        if shift[1] < bush.spread and sole.depth < height < 0:
            reason = f"{1e3 * rise:+.0f} mm over the sensor, where torque and force of both feet agree within {within}"
            bushes[side] = BushHeight(height, shift[1], reason)
        else:
            bushes[side] = replace(bush, reason=f"{bush.reason}; torque and force agree within {within}")
    return replace(draft, seats=seats, bushes=bushes)


def _findings(draft: Draft, urdf: Path, logs: Sequence[MotionLog]) -> list[Remark]:
    """What is odd about the logs, seen with the file as it will be written."""
    robot = _loaded(draft, urdf)
    return [
        Remark(f"{log.name}: {finding.text}", True)
        for log in logs
        for finding in _checked(draft, robot, log)
        if finding.severity == "warning"
    ]


def _checked(draft: Draft, robot: RobotModel, log: MotionLog) -> list[Finding]:
    """What is odd about a log; without every reading of the feet only its joints' names can be, and what it lacks."""
    missing = _missing(draft, log)
    if not missing:
        return check_log(robot, log)
    valid = "valid: force and torque of both feet; what the log calls them goes to `wrench` or `columns`"
    text = f"{' and '.join(missing)} missing: nothing of the feet could be checked ({valid})"
    return [*check_joint_names(robot, log), Finding("missing_columns", text)]


def _missing(draft: Draft, log: MotionLog) -> list[str]:
    """The columns of the feet's force sensors that a log lacks."""
    missing = list[str]()
    for sole in draft.soles:
        name = draft.sensor(sole)
        needed = wrench_columns(name)
        lacking = [column for column in needed if not log.has(column)]
        missing += [named(lacking, f"wrench.{name}.", len(needed))] if lacking else []
    return missing


def _loaded(draft: Draft, urdf: Path, mapped: str = "") -> RobotModel:
    """The draft as the rest of plantar reads it, with a map of columns."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.yaml"
        write_text(path, draft.text(str(urdf.resolve())) + mapped)
        try:
            return load_robot(path)
        except RobotError as error:  # the file is gone when the line is read
            raise RobotError(str(error).replace(str(path), str(urdf))) from error


def _relative(path: Path, out: Path) -> str:
    try:
        return str(path.resolve().relative_to(out.resolve().parent))
    except ValueError:
        return str(path.resolve())

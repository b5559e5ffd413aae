"""A first robot file from a URDF and logs: what can be seen is written, what is guessed says so.

Feet are the two lowest ends of the URDF's chains; soles come from the lowest shapes; sensors from the logs'
names and message frames. Nothing here is certain: every line that was guessed says so, with its reason.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pinocchio as pin
import yaml

from plantar.errors import PlantarError, RobotError, located
from plantar.exporters.urdf.tree import UrdfTree
from plantar.files import read_bounded
from plantar.robot_guess.feet import Ankle, find_ankles, vector
from plantar.robot_guess.sensors import Sensors, look_at

BUSH_HEIGHT = 0.02  # m above the sole: rubber bushes are thin
URDF_LIMIT = 64 * 2**20  # bytes


def guess_robot_file(urdf: Path, logs: Sequence[Path], out: Path) -> str:
    """The robot file's text. Raises RobotError (URDF), LogError (logs)."""
    model = _model(urdf)
    tree = UrdfTree.load(urdf)
    sensors = look_at(logs)
    ankles = find_ankles(tree, model)
    count = "1 log" if len(logs) == 1 else f"{len(logs)} logs"
    lines = [
        f"# Written by plantar init from {urdf.name} and {count}. Lines marked GUESS want a look.",
        f"name: {_text(tree.root.get('name') or urdf.stem)}",
        f"urdf: {_text(_relative(urdf, out))}",
        *_imu_lines(sensors, tree),
        "feet:",
    ]
    taken: set[str] = set()
    for ankle in ankles:
        lines += _foot_lines(ankle, tree, sensors, taken)
    if sensors.topics:
        lines.append("topics:")
        lines += [f"  {_text(key)}: {_text(topic)}" for key, topic in sensors.topics.items()]
    return "\n".join(lines) + "\n"


def _model(urdf: Path) -> pin.Model:
    text = read_bounded(urdf, URDF_LIMIT, RobotError).decode("utf-8", "replace")
    if re.search("<!(doctype|entity)", text, re.IGNORECASE):
        raise RobotError(located("declares a DOCTYPE or an entity", path=urdf, valid="plain URDF"))
    try:
        return pin.buildModelFromXML(text)
    except (ValueError, RuntimeError, IndexError) as error:
        reason = str(error).splitlines()[0] if str(error) else "unreadable"
        raise RobotError(located(f"is not a readable URDF: {reason}", path=urdf)) from error


def _imu_lines(sensors: Sensors, tree: UrdfTree) -> list[str]:
    if not sensors.imus:
        return ["# imu: no IMU was found in the logs"]
    name = next(iter(sensors.imus))
    frame = sensors.imus[name]
    if frame in tree.links:
        return [f"imu: {{name: {_text(name)}, link: {_text(frame)}}}  # link: the frame of its messages"]
    words = [name.lower(), "imu", "chest", "torso", "trunk", "pelvis", "waist", "base"]
    link, reason = next(
        (
            (link, f"its name holds '{word}'")
            for word in words
            for link in reversed(tree.links)
            if word in link.lower()
        ),
        (next(iter(tree.links)), "the first link"),
    )
    others = [other for other in sensors.imus if other != name]
    also = f"; the logs also hold {', '.join(others)}" if others else ""
    place = f"{{name: {_text(name)}, link: {_text(link)}, xyz: [0, 0, 0], rpy: [0, 0, 0]}}"
    return [f"imu: {place}  # GUESS: {reason}{also}"]


def _foot_lines(ankle: Ankle, tree: UrdfTree, sensors: Sensors, taken: set[str]) -> list[str]:
    bush, sole = ankle.place(ankle.depth + BUSH_HEIGHT), ankle.place(ankle.depth)
    corners = ", ".join(vector(corner) for corner in ankle.sole)
    name = _wrench_for(ankle, tree, sensors, taken)
    key = ankle.side if name is None else name
    frame = "" if name is None else sensors.wrenches[name]
    sign = ", sign: -1" if name is not None and sensors.upward.get(name, 0.0) < 0 else ""
    why = "; sign: its force.z is negative under load" if sign else ""
    taken.add(key)
    if frame in tree.links:
        wrench = f"{{name: {_text(key)}, link: {_text(frame)}{sign}}}  # link: the frame of its messages{why}"
    else:
        reason = "no force sensor in the logs" if name is None else f"measured at the sole{why}"
        wrench = f"{{name: {_text(key)}, {sole}{sign}}}  # GUESS: {reason}"
    height = f"{1e3 * BUSH_HEIGHT:.0f} mm above the sole; the URDF cannot know"
    return [
        f"  {ankle.side}:",
        f"    ankle: {_text(ankle.link)}  # GUESS: one of the lowest ends of the URDF",
        f"    bush: {{{bush}}}  # GUESS: {height}",
        f"    wrench: {wrench}",
        f"    # GUESS: {ankle.reason}",
        f"    sole: {{{sole}, polygon: [{corners}]}}",
    ]


def _wrench_for(ankle: Ankle, tree: UrdfTree, sensors: Sensors, taken: set[str]) -> str | None:
    """The force sensor of a foot: by the frame fixed to its ankle, else by side in its name."""
    free = [name for name in sensors.wrenches if name not in taken]
    for name in free:
        frame = sensors.wrenches[name]
        if frame in tree.links and _fixed(tree, ankle.link, frame):
            return name
    initial = ankle.side[0]
    patterns = (rf"{ankle.side}.*(foot|ankle|sole|leg)|(foot|ankle|sole|leg).*{ankle.side}", ankle.side,
                rf"^{initial}_?(foot|leg|ankle|sole)|^{initial}f|{initial}leg")  # fmt: skip
    for pattern in patterns:
        for name in free:
            if re.search(pattern, name, re.IGNORECASE):
                return name
    return free[0] if len(free) == 1 and len(sensors.wrenches) == 1 else None


def _fixed(tree: UrdfTree, ankle: str, frame: str) -> bool:
    try:
        tree.fixed_pose(ankle, frame)
    except PlantarError:
        return False
    return True


def _relative(path: Path, out: Path) -> str:
    try:
        return str(path.resolve().relative_to(out.resolve().parent))
    except ValueError:
        return str(path.resolve())


def _text(value: str) -> str:
    """A scalar as YAML, quoted where it must be."""
    return (
        yaml.safe_dump(value, default_flow_style=True, width=10_000)
        .removesuffix("\n")
        .removesuffix("...")
        .strip()
    )

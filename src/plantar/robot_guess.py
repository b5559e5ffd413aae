"""A first robot file from a URDF and logs: what can be seen is written, what is guessed says so.

Feet are the two lowest ends of the URDF's chains; soles come from the lowest shapes; sensors from the logs'
names and message frames. Nothing here is certain: every line that was guessed says so, with its reason.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import yaml

from plantar.conventions import Array, rotation_from_rpy
from plantar.errors import PlantarError, RobotError, located
from plantar.export.poses import pose, rpy_of
from plantar.export.urdf_tree import UrdfTree
from plantar.files import read_bounded
from plantar.log import MotionLog
from plantar.readers import open_log
from plantar.readers.ros_bag import bag_topics

BUSH_HEIGHT = 0.02  # m above the sole: rubber bushes are thin
LEVEL = 0.02  # m: feet stand this level at the reference pose
BOTTOM = 0.01  # m above the lowest point: what still belongs to the sole
DEFAULT_SOLE = ((0.1, 0.06), (-0.1, 0.06), (-0.1, -0.06), (0.1, -0.06))
URDF_LIMIT = 64 * 2**20  # bytes
BAGS = (".mcap", ".db3", ".bag")


@dataclass
class Sensors:
    """What the logs hold: names of IMUs and wrench sensors, the frames of their messages, topics of bags."""

    imus: dict[str, str] = field(default_factory=dict)
    wrenches: dict[str, str] = field(default_factory=dict)
    upward: dict[str, float] = field(default_factory=dict)
    topics: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Ankle:
    """The last moving link of a leg. `upright` turns the foot's axes (x to the toes, z up) to the link's;
    `sole` holds the corners (4, 2) in those axes, `depth` its height there [m], negative."""

    link: str
    side: str
    upright: Array
    sole: Array
    depth: float
    reason: str

    def place(self, height: float) -> str:
        """A point over the ankle's origin in the link's frame, and the foot's axes where they differ."""
        xyz = self.upright @ [0.0, 0.0, height]
        turn = rpy_of(pose(np.zeros(3), rotation=self.upright))
        rpy = f", rpy: {_vector(turn)}" if np.abs(turn).max() > 1e-3 else ""
        return f"xyz: {_vector(xyz)}{rpy}"


def guess_robot_file(urdf: Path, logs: Sequence[Path], out: Path) -> str:
    """The robot file's text. Raises RobotError (URDF), LogError (logs)."""
    model = _model(urdf)
    tree = UrdfTree.load(urdf)
    sensors = look_at(logs)
    ankles = find_ankles(tree, model)
    lines = [
        f"# Written by plantar init from {urdf.name} and {len(logs)} logs. Lines marked GUESS want a look.",
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


def _model(urdf: Path) -> pin.Model:
    text = read_bounded(urdf, URDF_LIMIT, RobotError).decode("utf-8", "replace")
    if re.search("<!(doctype|entity)", text, re.IGNORECASE):
        raise RobotError(located("declares a DOCTYPE or an entity", path=urdf, valid="plain URDF"))
    try:
        return pin.buildModelFromXML(text)
    except (ValueError, RuntimeError, IndexError) as error:
        reason = str(error).splitlines()[0] if str(error) else "unreadable"
        raise RobotError(located(f"is not a readable URDF: {reason}", path=urdf)) from error


def find_ankles(tree: UrdfTree, model: pin.Model) -> list[Ankle]:
    """The feet: ends of chains, lowest first, at most two; the root link where the URDF has no joints."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    ends = [model.names[joint] for joint in range(1, model.njoints) if len(model.subtrees[joint]) == 1]
    links = [tree.ends(tree.joints[name])[1] for name in ends if name in tree.joints]
    if not links:
        children = {tree.ends(joint)[1] for joint in tree.joints.values()}
        links = [next(name for name in tree.links if name not in children)]
    feet: list[tuple[float, float, Ankle]] = []
    for link in links:
        frame = data.oMf[model.getFrameId(link)].homogeneous
        ankle = _ankle(tree, link, np.array(frame[:3, :3]))
        feet.append((float(frame[2, 3]) + ankle.depth, float(frame[1, 3]), ankle))
    lowest = min(height for height, _, _ in feet)
    low = sorted((entry for entry in feet if entry[0] <= lowest + LEVEL), key=lambda entry: -entry[1])[:2]
    sides = [_side(ankle.link) for _, _, ankle in low]
    if len(low) == 2 and set(sides) != {"left", "right"}:
        sides = ["left", "right"]  # by where they stand: y points to the left
    return [replace(ankle, side=side or "right") for (_, _, ankle), side in zip(low, sides, strict=True)]


def _side(link: str) -> str:
    if re.search(r"(^|_)(l|left)(_|$)|^LLEG|left", link, re.IGNORECASE):
        return "left"
    return "right" if re.search(r"(^|_)(r|right)(_|$)|^RLEG|right", link, re.IGNORECASE) else ""


def _ankle(tree: UrdfTree, link: str, rotation: Array) -> Ankle:
    """A foot's sole, seen in the root link's axes: there the robot stands upright with all joints at 0."""
    clouds, height = _shapes(tree, link, rotation)
    for tag in ("collision", "visual"):
        if not clouds[tag]:
            continue
        points = np.concatenate(clouds[tag])
        bottom = float(points[:, 2].min())
        low = points[points[:, 2] < bottom + BOTTOM]
        (x0, y0), (x1, y1) = low[:, :2].min(axis=0), low[:, :2].max(axis=0)
        if min(x1 - x0, y1 - y0) > 0.02:
            reason = f"the lowest points of the {tag} shapes"
            yaw = _toes((x0, x1), (y0, y1))
            if yaw:
                reason += ", toes taken to be where the foot is longer"
            turn = rotation_from_rpy(np.array([0.0, 0.0, yaw]))
            corners = np.array([[x, y, 0.0] for x in (x0, x1) for y in (y0, y1)]) @ turn
            (x0, y0), (x1, y1) = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
            corners, upright = np.array([[x1, y1], [x0, y1], [x0, y0], [x1, y0]]), rotation.T @ turn
            return Ankle(link, "", upright, corners, bottom if height is None else height, reason)
    depth = -0.1 if height is None else height
    return Ankle(
        link, "", rotation.T, np.array(DEFAULT_SOLE), depth, "no shape was found; size of a usual foot"
    )


def _toes(x: tuple[float, float], y: tuple[float, float]) -> float:
    """The yaw from the root's x axis to the toes [rad]: 0 unless the sole's outline clearly says otherwise."""
    if y[1] - y[0] > 1.2 * (x[1] - x[0]):
        return float(np.pi / 2 if sum(y) >= 0 else -np.pi / 2)
    return float(np.pi) if sum(x) < -0.02 else 0.0


def _shapes(tree: UrdfTree, ankle: str, rotation: Array) -> tuple[dict[str, list[Array]], float | None]:
    """Points of what is fixed to a link, by kind, and the height of a frame that is called sole."""
    clouds: dict[str, list[Array]] = {"collision": [], "visual": []}
    height = None
    queue = [ankle]
    while queue:
        link = queue.pop()
        place = tree.fixed_pose(ankle, link)
        if "sole" in link.lower() and height is None:
            height = float((rotation @ place[:3, 3])[2])
        for tag, shapes in clouds.items():
            for shape in tree.links[link].findall(tag):
                points = tree.points(shape)
                if points is not None:
                    shapes.append((points @ place[:3, :3].T + place[:3, 3]) @ rotation.T)
        queue += [child for _, child in tree.fixed_children(link)]
    return clouds, height


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
    corners = ", ".join(_vector(corner) for corner in ankle.sole)
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


def _vector(values: Array) -> str:
    return "[" + ", ".join(f"{0.0 if abs(value) < 1e-9 else value:.6g}" for value in values) + "]"


def _text(value: str) -> str:
    """A scalar as YAML, quoted where it must be."""
    return (
        yaml.safe_dump(value, default_flow_style=True, width=10_000)
        .removesuffix("\n")
        .removesuffix("...")
        .strip()
    )

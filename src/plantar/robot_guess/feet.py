"""Feet as a URDF shows them: the lowest ends of its chains, and the soles under them."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from plantar.conventions import Array, rotation_from_rpy
from plantar.exporters.poses import pose, rpy_of
from plantar.exporters.urdf.tree import UrdfTree

LEVEL = 0.02  # m: feet stand this level at the reference pose
BOTTOM = 0.01  # m above the lowest point: what still belongs to the sole
DEFAULT_SOLE = ((0.1, 0.06), (-0.1, 0.06), (-0.1, -0.06), (0.1, -0.06))


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
        rpy = f", rpy: {vector(turn)}" if np.abs(turn).max() > 1e-3 else ""
        return f"xyz: {vector(xyz)}{rpy}"


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


def vector(values: Array) -> str:
    """Numbers as a YAML list."""
    return "[" + ", ".join(f"{0.0 if abs(value) < 1e-9 else value:.6g}" for value in values) + "]"

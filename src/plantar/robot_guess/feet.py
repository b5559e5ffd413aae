"""Soles as a URDF shows them: the lowest shapes of a foot, a frame called sole, or the foot's mass and inertia."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.exporters.poses import pose, rpy_of
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot_guess.biped import Biped, Limb

BOTTOM = 0.01  # m above the lowest point: what still belongs to the sole
THINNEST = 0.02  # m: an outline that is narrower is no sole but an edge

# Of a leg's reach, where nothing else is known: heel, toes, half width and height of the feet of six humanoids, which
# differ by a third.
USUAL = {"heel": -0.10, "toes": 0.15, "side": 0.065, "depth": 0.10}
# Feet of seven humanoids whose shapes and inertia are both known: the sole lies 2.0 times as deep as the centre of mass
# (1.4 to 2.5 times), and is 1.2 times as long and 1.35 times as wide as a solid box of the same mass and inertia.
DEEPER, LONGER, WIDER = 2.0, 1.2, 1.35
# Of a leg's reach: those of six humanoids are a quarter, some a third; more is a made-up inertia.
LONGEST = 0.45
INERTIA_SHARE, USUAL_SHARE = 0.25, 0.4  # by which the depth by inertia, and the usual one, may be off
OUTLINE_SHARE = 0.2  # of its length by which an outline that is not drawn may be off
SHAPE_SPREAD, FRAME_SPREAD = 0.005, 0.005  # m: rubber and covers that a drawing leaves out
# A foot wider than long by this ratio is drawn in other axes; its outline may then be off by this [m].
TURNED, TURNED_SPREAD = 1.2, 0.01


@dataclass(frozen=True)
class Sole:
    """The sole of a leg. `upright` turns the foot's axes (x to the toes, z up) to the ankle link's; `corners` (4, 2) in
    those axes about the ankle link's origin, `depth` its height there [m], negative; what they may be off by [m];
    `drawn`: the outline is that of shapes."""

    limb: Limb
    upright: Array
    corners: Array
    depth: float
    spread: float
    outline_spread: float
    reason: str
    drawn: bool

    def place(self, height: float) -> str:
        """A point over the ankle's origin in the link's frame, and the foot's axes where they differ, as YAML."""
        return placement(self.upright @ [0.0, 0.0, height], self.upright)


def find_sole(tree: UrdfTree, model: pin.Model, biped: Biped, limb: Limb) -> Sole:
    """A foot's sole in the axes in which the robot stands with all joints at 0.

    From the shapes where there are any; the height from a frame called sole before that.
    """
    rotation = biped.axes.T @ limb.rotation
    clouds, height = _shapes(tree, limb.link, rotation)
    named = ", its height from the frame called sole" if height is not None else ""
    for tag in ("collision", "visual"):
        if not clouds[tag]:
            continue
        points = np.concatenate(clouds[tag])
        bottom = float(points[:, 2].min())
        low = points[points[:, 2] < bottom + BOTTOM]
        (x0, y0), (x1, y1) = low[:, :2].min(axis=0), low[:, :2].max(axis=0)
        if min(x1 - x0, y1 - y0) > THINNEST:
            reason = f"the lowest points of the {tag} shapes{named}"
            depth, outline = (bottom if height is None else height), SHAPE_SPREAD
            if y1 - y0 > TURNED * (x1 - x0):  # meshes are stored in other axes than they are meant in
                # More foot before the ankle than behind.
                (x0, x1), (y0, y1) = (-min(y1, -y0), max(y1, -y0)), (x0, x1)
                reason, outline = f"{reason}, which lie across, turned along the foot", TURNED_SPREAD
            return Sole(limb, rotation.T, box(x0, x1, y0, y1), depth, SHAPE_SPREAD, outline, reason, True)
    depth, spread, corners, reason = _by_inertia(model, limb, rotation, biped.reach) or _usual(biped.reach)
    if height is not None:
        depth, spread = height, FRAME_SPREAD
    outline = OUTLINE_SHARE * float(np.ptp(corners[:, 0]))
    return Sole(limb, rotation.T, corners, depth, spread, outline, reason + named, False)


def box(x0: float, x1: float, y0: float, y1: float) -> Array:
    """Corners of a rectangle, (4, 2)."""
    return np.array([[x1, y1], [x0, y1], [x0, y0], [x1, y0]])


def _by_inertia(
    model: pin.Model, limb: Limb, rotation: Array, reach: float
) -> tuple[float, float, Array, str] | None:
    """Depth, its spread, outline and reason from a box of the foot's mass and inertia; None where that is no foot's."""
    joint = model.getJointId(limb.joints[-1]) if limb.joints else 0
    inertia = model.inertias[joint]
    if inertia.mass <= 0:
        return None
    centre = rotation @ inertia.lever
    moments = np.diag(rotation @ inertia.inertia @ rotation.T)
    square = 6 * (moments.sum() - 2 * moments) / inertia.mass
    depth = DEEPER * float(centre[2])
    if (square <= 0).any() or not -0.25 * reach < depth < -0.02 * reach:
        return None
    if LONGER * np.sqrt(square[0]) > LONGEST * reach:
        return None
    length, width = LONGER * np.sqrt(square[0]), WIDER * np.sqrt(square[1])
    corners = box(centre[0] - length / 2, centre[0] + length / 2, -width / 2, width / 2)
    reason = "no shape was found; as deep and large as a box with the foot's mass and inertia would be"
    return depth, INERTIA_SHARE * abs(depth), corners, reason


def _usual(reach: float) -> tuple[float, float, Array, str]:
    side = USUAL["side"] * reach
    corners = box(USUAL["heel"] * reach, USUAL["toes"] * reach, -side, side)
    depth = USUAL["depth"] * reach
    return -depth, USUAL_SHARE * depth, corners, "no shape was found; size of a usual foot under such a leg"


def _shapes(tree: UrdfTree, ankle: str, rotation: Array) -> tuple[dict[str, list[Array]], float | None]:
    """Points of what is fixed to a link, by kind, and the height of a frame that is called sole."""
    clouds: dict[str, list[Array]] = {"collision": [], "visual": []}
    height = None
    for link in fixed_links(tree, ankle):
        place = tree.fixed_pose(ankle, link)
        if "sole" in link.lower() and height is None:
            height = float((rotation @ place[:3, 3])[2])
        for tag, shapes in clouds.items():
            for shape in tree.links[link].findall(tag):
                points = tree.points(shape)
                if points is not None:
                    shapes.append((points @ place[:3, :3].T + place[:3, 3]) @ rotation.T)
    return clouds, height


def fixed_links(tree: UrdfTree, ankle: str) -> list[str]:
    """The link itself and all that hang on it by fixed joints."""
    found, queue = list[str](), [ankle]
    while queue:
        link = queue.pop()
        found.append(link)
        queue += [child for _, child in tree.fixed_children(link) if child in tree.links]
    return found


def placement(xyz: Array, rotation: Array) -> str:
    """A point and axes as YAML, the axes left out where they are the link's."""
    turn = rpy_of(pose(np.zeros(3), rotation=rotation))
    rpy = f", rpy: {vector(turn)}" if np.abs(turn).max() > 1e-3 else ""
    return f"xyz: {vector(xyz)}{rpy}"


def vector(values: Array) -> str:
    """Numbers as a YAML list."""
    return "[" + ", ".join(f"{0.0 if abs(value) < 1e-9 else value:.6g}" for value in values) + "]"

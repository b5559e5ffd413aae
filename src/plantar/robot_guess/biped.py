"""The two legs of a biped as a URDF shows them, or one line that says why it is none.

Legs are two chains that are alike: as many joints, ends as far from the root link, no hands, fingers or wheels. From
where the ends and the root link are with all joints at 0 follow the axes in which the robot stands.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.errors import RobotError
from plantar.exporters.urdf.tree import UrdfTree

ALIKE = 0.03  # share of a leg's reach by which the ends of two legs may be nearer or farther
FEWEST_JOINTS = 4  # of a leg with a flat sole: hip roll, hip pitch, knee, ankle
NO_FEET = re.compile(
    r"hand|grip|finger|thumb|index|middle|ring|little|pinky|palm|wrist|wheel|caster|head|rotor", re.I
)
FEET = re.compile(r"foot|feet|ankle|sole|leg|toe|calf|shank", re.I)
LEFT = re.compile(r"(^|[_/\-.])(l|left)([_/\-.]|$)|^LLEG|left|^L(?=[A-Z][a-z])")
RIGHT = re.compile(r"(^|[_/\-.])(r|right)([_/\-.]|$)|^RLEG|right|^R(?=[A-Z][a-z])")
SLANTED = np.cos(np.radians(30))  # how far the line from feet to root may be off an axis of the root link
SLENDER = 3.0  # times as long as the ankles are apart: no legs are stouter
USUAL_REACH = 0.8  # m, of a foot that hangs on no leg
ROUNDING = 1e-4  # of a rotation's elements: URDFs write pi with four digits or more
LOWEST = 0.05  # share of the feet's depth by which another part of the robot may be deeper


@dataclass(frozen=True)
class Limb:
    """The end of a chain: its link, the names of the joints from the root link to it, and in the root link's axes, with
    all joints at 0, its pose: `place` (3,) [m] and `rotation` link to root (3, 3)."""

    link: str
    joints: tuple[str, ...]
    place: Array
    rotation: Array
    side: str = ""


@dataclass(frozen=True)
class Biped:
    """Its legs, left first, and `axes` (3, 3): forward, left, up as columns in the root link's axes."""

    legs: tuple[Limb, ...]
    axes: Array
    others: tuple[str, ...]

    @property
    def reach(self) -> float:
        """Length of its legs [m]: from root link to ankle with all joints at 0, unless they are folded there."""
        places = [leg.place for leg in self.legs]
        if len(places) < 2:
            return USUAL_REACH
        apart = float(np.linalg.norm(places[0] - places[1]))
        return max(float(np.linalg.norm(places[0])), SLENDER * apart)


def find_biped(tree: UrdfTree, model: pin.Model) -> Biped:
    """The legs of a URDF; of one without joints, a foot on a test rig, the root link is the only one.

    Raises RobotError where the chains are no two legs: an arm, four legs, wheels, hands.
    """
    limbs = _limbs(tree, model)
    if not limbs:
        links = list(tree.links)
        if not links:
            raise RobotError("has no links", path=tree.path, valid="a biped")
        children = {tree.ends(joint)[1] for joint in tree.joints.values()}
        root = next((name for name in links if name not in children), links[0])
        if not FEET.search(root):
            message = f"is no biped: it has no joints, and '{root}' is not called a foot"
            raise RobotError(message, path=tree.path, valid="two legs, or one foot")
        foot = Limb(root, (), np.zeros(3), np.eye(3))
        return Biped((replace(foot, side=_side(foot) or "right"),), np.eye(3), ())
    ends = _pair(tree, limbs)
    up = _up(ends)
    pair, axes = _sides(ends, up)
    _nothing_below(tree, model, pair, up)
    others = tuple(limb.link for limb in limbs if limb.link not in {leg.link for leg in pair})
    return Biped(pair, axes, others)


def _limbs(tree: UrdfTree, model: pin.Model) -> list[Limb]:
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    found = []
    for joint in range(1, model.njoints):
        name = model.names[joint]
        if len(model.subtrees[joint]) > 1 or name not in tree.joints:
            continue
        found.append(_limb(tree, model, data, joint))
    return found


def _limb(tree: UrdfTree, model: pin.Model, data: pin.Data, joint: int) -> Limb:
    """The chain from the root link to the link that a joint carries; `data` with the frames' poses."""
    link = tree.ends(tree.joints[model.names[joint]])[1]
    pose = data.oMf[model.getFrameId(link)]
    chain = tuple(model.names[k] for k in model.supports[joint] if k)
    return Limb(link, chain, np.array(pose.translation), _exact(np.array(pose.rotation)))


def without_toes(biped: Biped, tree: UrdfTree, model: pin.Model, recorded: Collection[str]) -> Biped:
    """Legs that end above the joints at their ends which are not `recorded` while all the leg's others are: toes that
    nothing drives, which give way to the floor."""
    data, legs = model.createData(), list[Limb]()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    for leg in biped.legs:
        held = tuple(name for name in leg.joints if name in recorded)
        toes = FEWEST_JOINTS <= len(held) < len(leg.joints) and leg.joints[: len(held)] == held
        whole = replace(_limb(tree, model, data, model.getJointId(held[-1])), side=leg.side) if toes else leg
        legs.append(whole)
    return replace(biped, legs=tuple(legs))


def _exact(rotation: Array) -> Array:
    """A turn by right angles without what rounding in a URDF left on it."""
    whole = np.round(rotation)
    return whole + 0.0 if np.abs(rotation - whole).max() < ROUNDING else rotation


def _pair(tree: UrdfTree, limbs: Sequence[Limb]) -> tuple[Limb, Limb]:
    ends = ", ".join(limb.link for limb in limbs[:6])
    able = [limb for limb in limbs if not NO_FEET.search(limb.link + " " + limb.joints[-1])]
    groups = [[one for one in able if _alike(one, limb)] for limb in able]
    many = max((group for group in groups if len(group) > 2), key=len, default=None)
    pairs = [pair for pair in combinations(able, 2) if _alike(*pair)]
    if many is not None:
        names = ", ".join(limb.link for limb in many)
        raise RobotError(f"is no biped: {len(many)} legs alike ({names})", path=tree.path, valid="two legs")
    if not pairs:
        message = f"is no biped: no two of its chains' ends ({ends}) are alike as two feet are"
        raise RobotError(message, path=tree.path, valid="two legs; hands and wheels do not count")
    # What is called a leg comes before what is not; then the farther from the root link.
    best = max(pairs, key=lambda pair: (_called_leg(pair[0]), float(np.linalg.norm(pair[0].place))))
    if len(best[0].joints) < FEWEST_JOINTS:
        names = " and ".join(f"{limb.link} ({len(limb.joints)})" for limb in best)
        message = f"has no flat feet: {names} joints from the root link, where an ankle needs more"
        raise RobotError(message, path=tree.path, valid=f"{FEWEST_JOINTS} joints a leg or more")
    return best


def _alike(one: Limb, other: Limb) -> bool:
    reach = float(np.linalg.norm(one.place)), float(np.linalg.norm(other.place))
    return len(one.joints) == len(other.joints) and abs(reach[0] - reach[1]) <= ALIKE * max(reach)


def _called_leg(limb: Limb) -> bool:
    return any(FEET.search(name) for name in (limb.link, *limb.joints))


def _up(pair: tuple[Limb, Limb]) -> Array:
    """The root link's axis that points from what is called a leg's end to it; else its z axis."""
    rise = -(pair[0].place + pair[1].place) / 2
    rise = rise / max(float(np.linalg.norm(rise)), 1e-9)
    axis = int(np.argmax(np.abs(rise)))
    if abs(rise[axis]) < SLANTED or not all(_called_leg(limb) for limb in pair):
        return np.array([0.0, 0.0, 1.0])
    return np.asarray(np.sign(rise[axis]) * np.eye(3)[axis])


def _sides(pair: tuple[Limb, Limb], up: Array) -> tuple[tuple[Limb, ...], Array]:
    """The legs, left first, by their names or else by where y points; the axes forward, left, up."""
    first, second = (replace(limb, side=_side(limb)) for limb in pair)
    if {first.side, second.side} != {"left", "right"}:
        ahead = np.array([1.0, 0.0, 0.0])
        left = np.cross(up, ahead) if abs(up[0]) < 0.5 else np.array([0.0, 1.0, 0.0])
        swap = float(left @ (first.place - second.place)) < 0
        first, second = (second, first) if swap else (first, second)
        first, second = replace(first, side="left"), replace(second, side="right")
    elif first.side == "right":
        first, second = second, first
    across = first.place - second.place
    across = across - (across @ up) * up
    axis = int(np.argmax(np.abs(across)))
    left = np.sign(across[axis]) * np.eye(3)[axis]
    return (first, second), np.column_stack([np.cross(left, up), left, up])


def _side(limb: Limb) -> str:
    for name in (limb.link, *reversed(limb.joints)):
        found = [side for side, pattern in (("left", LEFT), ("right", RIGHT)) if pattern.search(name)]
        if len(found) == 1:
            return found[0]
    return ""


def _nothing_below(tree: UrdfTree, model: pin.Model, pair: tuple[Limb, ...], up: Array) -> None:
    """A pedestal under the robot, or a part that hangs lower than the ends, says that the ends are no feet."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    feet = {tree.joints[name].get("name") for leg in pair for name in leg.joints[-2:]}  # a foot, and its toes
    carried = {k for k in range(1, model.njoints) if model.names[k] in feet}
    depth = float(np.mean([leg.place @ up for leg in pair]))
    others = [frame for frame in range(model.nframes) if model.frames[frame].parentJoint not in carried]
    lowest = min(others, key=lambda frame: float(data.oMf[frame].translation @ up))
    if data.oMf[lowest].translation @ up < depth - LOWEST * max(abs(depth), 0.1) or depth > 0:
        names = " and ".join(leg.link for leg in pair)
        message = f"is no biped: {names} are not the lowest, '{model.frames[lowest].name}' is"
        raise RobotError(message, path=tree.path, valid="two legs on which it stands")

"""Where an IMU sits: the URDF's frame that its name or its messages tell, and how it is turned there, by gravity."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from plantar.conventions import Array
from plantar.export.poses import pose, rpy_of
from plantar.export.urdf_tree import UrdfTree
from plantar.robot_guess.stance import Stance

WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[0-9]+")
BODY = {"torso", "chest", "trunk", "body", "pelvis", "waist", "base", "root", "hip"}
NOT_IT = {
    "skin",
    "hand",
    "arm",
    "leg",
    "foot",
    "camera",
    "head",
    "neck",
    "lidar",
    "l",
    "r",
    "left",
    "right",
    "wrist",
}
MOST_NAMED = 4  # other frames in a comment

UPRIGHT = np.radians(
    15
)  # between up by the IMU and by the soles: more is no mounting tolerance and no soft foot
MOVES = np.radians(
    0.3
)  # rms of the soles' tilt seen from the IMU: less tells nothing of its turn about the vertical
CLEARLY = 0.5  # a turn about the vertical is believed where it leaves this share of the tilt that the frame's leaves


@dataclass(frozen=True)
class Mount:
    """A link, the IMU's axes in it (3, 3), whether that is a guess, its reason, and other frames that it may be."""

    link: str
    rotation: Array
    guess: bool
    reason: str
    others: tuple[str, ...] = ()

    @property
    def rpy(self) -> Array:
        """Fixed-axis roll, pitch and yaw [rad], (3,)."""
        return rpy_of(pose(np.zeros(3), rotation=self.rotation))


def find_frame(tree: UrdfTree, name: str, frame: str) -> Mount:
    """The link of an IMU called `name`: the frame of its messages, else the one whose name comes nearest."""
    if frame in tree.links:
        return Mount(frame, np.eye(3), False, "the frame of its messages")
    links = list(tree.links)
    said = _words(name) - {"imu"}
    ranked = sorted(links, key=lambda link: (-_score(_words(link), said), links.index(link)))
    best = ranked[0] if ranked and _score(_words(ranked[0]), said) > 0 else links[0]
    others = tuple(link for link in ranked if "imu" in _words(link) and link != best)[:MOST_NAMED]
    if "imu" in _words(best):
        reason = "a frame called imu"
    elif _words(best) & (said | BODY):
        reason = f"its name holds {' and '.join(sorted(_words(best) & (said | BODY)))}"
    else:
        reason = "the first link"
    return Mount(best, np.eye(3), True, reason, others)


def _score(words: set[str], said: set[str]) -> float:
    return (
        6.0 * ("imu" in words)
        + 4.0 * bool(words & said)
        + 1.0 * bool(words & BODY)
        - 5.0 * bool((words - said) & NOT_IT)
    )


def _words(name: str) -> set[str]:
    return {word.lower() for word in WORD.findall(name)}


def turned_to_gravity(mount: Mount, stance: Stance) -> Mount:
    """The mount with the axes that gravity shows: up by the IMU must be up by the loaded soles, while tilting too.

    A frame that agrees stays as it is. One that does not is turned by right angles; where none of these agree, by the
    smallest turn that does.
    """
    if stance.felt is None:
        return mount
    link = stance.carriers[mount.link][:, :3, :3]
    soles = np.einsum("nji,nj->ni", link, stance.up)  # up in the link's axes
    turns = [mount.rotation @ turn for turn in right_angles()]  # as it is comes first
    apart = [_apart(soles, stance.felt @ turn.T) for turn in turns]
    tilts = [_tilts(soles, stance.felt @ turn.T) for turn in turns]
    level = [k for k in range(len(turns)) if apart[k] < UPRIGHT]
    if not level:
        return _least_turn(mount, soles, stance.felt, apart[0])
    best = min(level, key=tilts.__getitem__)
    first = 0 if 0 in level else level[int(np.argmin([_size(turns[k] @ mount.rotation.T) for k in level]))]
    moves = float(np.sqrt(np.mean(np.sum((soles - soles.mean(axis=0)) ** 2, axis=1)))) > MOVES
    sure = moves and tilts[best] < CLEARLY * tilts[first]
    chosen = best if sure else first
    if chosen == 0:
        reason = f"{mount.reason}; up by the IMU and by the soles are {np.degrees(apart[0]):.1f} deg apart"
        return Mount(mount.link, mount.rotation, mount.guess, reason, mount.others)
    yaw = "as its tilts show" if sure else "its turn about the vertical is not seen in the logs"
    against = (
        f"as it is in the URDF, {np.degrees(apart[0]):.0f} deg off gravity"
        if apart[0] >= UPRIGHT
        else "tilts another way"
    )
    reason = f"{mount.reason}; turned by right angles, {yaw} ({against})"
    return Mount(mount.link, turns[chosen], True, reason, mount.others)


def right_angles() -> list[Array]:
    """The 24 rotations that turn axes into axes, (3, 3) each, smaller turns first."""
    found = []
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        turn = np.zeros((3, 3))
        turn[range(3), order] = signs
        if np.linalg.det(turn) > 0:
            found.append(turn)
    return sorted(found, key=lambda turn: -float(np.trace(turn)))


def _least_turn(mount: Mount, soles: Array, felt: Array, apart: float) -> Mount:
    """The smallest turn that brings the usual up of the IMU to that of the soles."""
    start, goal = (np.median(each, axis=0) for each in (felt @ mount.rotation.T, soles))
    start, goal = start / np.linalg.norm(start), goal / np.linalg.norm(goal)
    axis, cosine = np.cross(start, goal), float(start @ goal)
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + cross + cross @ cross / (1 + cosine)
    how = f"turned by {np.degrees(apart):.0f} deg to agree with gravity, its turn about the vertical unknown"
    reason = f"{mount.reason}; {how}"
    return Mount(mount.link, turn @ mount.rotation, True, reason, mount.others)


def _apart(soles: Array, felt: Array) -> float:
    """Usual angle between two directions, (n, 3) each [rad]."""
    return float(np.median(np.arccos(np.clip(np.sum(soles * felt, axis=1), -1, 1))))


def _tilts(soles: Array, felt: Array) -> float:
    """Rms of the difference of their changes."""
    apart = soles - felt
    return float(np.sqrt(np.mean(np.sum((apart - apart.mean(axis=0)) ** 2, axis=1))))


def _size(turn: Array) -> float:
    return float(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))

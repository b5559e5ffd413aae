"""Where an IMU sits: the URDF's frame that its name or its messages tell, and how it is turned there, by gravity."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import permutations, product

import numpy as np

from plantar.conventions import Array
from plantar.exporters.poses import pose, rpy_of
from plantar.exporters.urdf.tree import UrdfTree
from plantar.notes import NAMED
from plantar.robot_guess.stance import Stance

WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[0-9]+")
BODY = {"torso", "chest", "trunk", "body", "pelvis", "waist", "base", "root", "hip"}
UPPER = {"torso", "chest", "trunk"}  # names of one part
EMPTY = {"imu", "link", "frame", "sensor"}  # say nothing of where
NOT_IT = {
    "skin", "hand", "arm", "leg", "foot", "camera", "head", "neck", "lidar", "l", "r", "left", "right", "wrist",
}  # fmt: skip
TRUNK = 0.1  # m: an IMU sits so far from the origin of the link that carries it

# Between up by the IMU and by the soles: more is no mounting tolerance and no soft foot.
UPRIGHT = np.radians(15)
# Rms of the soles' tilt seen from the IMU: less tells nothing of its turn about the vertical.
MOVES = np.radians(0.3)
CLEARLY = 0.5  # a turn about the vertical is believed where it leaves this share of the tilt that the frame's leaves


@dataclass(frozen=True)
class Mount:
    """A link, the IMU's axes in it (3, 3), whether that is a guess, its reason, other frames that it may be, and by how
    much its place may be off [m]."""

    link: str
    rotation: Array
    guess: bool
    reason: str
    others: tuple[str, ...] = ()
    spread: float = 0.0

    @property
    def rpy(self) -> Array:
        """Fixed-axis roll, pitch and yaw [rad], (3,)."""
        return rpy_of(pose(np.zeros(3), rotation=self.rotation))


def find_frame(tree: UrdfTree, name: str, frame: str) -> Mount:
    """The link of an IMU called `name`: the frame of its messages, else the one whose name comes nearest."""
    if frame in tree.links:
        return Mount(frame, np.eye(3), False, "the frame of its messages")
    links = list(tree.links)
    said = (_words(name) | _words(frame)) - EMPTY
    if said & UPPER:
        said |= UPPER
    ranked = sorted(links, key=lambda link: (-_score(_words(link), said), links.index(link)))
    best = ranked[0] if ranked and _score(_words(ranked[0]), said) > 0 else links[0]
    top = _score(_words(best), said)
    others = [
        link
        for link in ranked
        if link != best and ("imu" in _words(link) or _score(_words(link), said) == top > 0)
    ]
    if "imu" in _words(best):
        reason = "a frame called imu"
    elif _words(best) & (said | BODY):
        reason = f"its name holds {' and '.join(sorted(_words(best) & (said | BODY)))}"
    else:
        reason = "the first link"
    spread = 0.0 if "imu" in _words(best) else TRUNK
    return Mount(best, np.eye(3), True, reason, tuple(others[:NAMED]), spread)


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
    smallest turn that does. Another link that a guess may have meant is taken where it tilts far more alike.
    """
    if stance.felt is None:
        return mount
    own, left = _turned(mount, stance, stance.felt)
    if not mount.guess:
        return own
    apart = {mount.link: left}
    for link in mount.others:
        other, remains = _turned(replace(mount, link=link), stance, stance.felt)
        apart[link] = remains
        if remains < CLEARLY * left:
            reason = f"{other.reason}; {link} tilts as the IMU does, {own.link} does not"
            own, left = replace(other, reason=reason), remains
    alike = tuple(
        link for link, remains in apart.items() if link != own.link and not left < CLEARLY * remains
    )
    return replace(own, others=alike)


def _turned(mount: Mount, stance: Stance, felt: Array) -> tuple[Mount, float]:
    """One link's mount, turned where it must be, and how much the tilts still differ [rad]."""
    link = stance.carriers[mount.link][:, :3, :3]
    soles = np.einsum("nji,nj->ni", link, stance.up)  # up in the link's axes
    turns = [mount.rotation @ turn for turn in right_angles()]  # as it is comes first
    apart = [_apart(soles, felt @ turn.T) for turn in turns]
    tilts = [_tilts(soles, felt @ turn.T) for turn in turns]
    level = [k for k in range(len(turns)) if apart[k] < UPRIGHT]
    if not level:
        return _least_turn(mount, soles, felt, apart[0]), np.inf
    best = min(level, key=tilts.__getitem__)
    rival = tilts[level[0]] if best != level[0] else min((tilts[k] for k in level[1:]), default=np.inf)
    moves = float(np.sqrt(np.mean(np.sum((soles - soles.mean(axis=0)) ** 2, axis=1)))) > MOVES
    sure = moves and tilts[best] < CLEARLY * rival
    chosen = best if sure else level[0]  # smaller turns come first
    off = f"{np.degrees(apart[0]):.1f} deg"
    if chosen == 0:
        reason = f"{mount.reason}; up by the IMU and by the soles are {off} apart"
        return replace(mount, reason=reason), tilts[0]
    yaw = "as its tilts show" if sure else "its turn about the vertical is not seen in the logs"
    against = f"as it is, {off} off gravity" if apart[0] >= UPRIGHT else "as it is, tilts another way"
    reason = f"{mount.reason}; turned by right angles, {yaw} ({against})"
    return replace(mount, rotation=turns[chosen], guess=True, reason=reason), tilts[chosen]


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
    return replace(mount, rotation=turn @ mount.rotation, guess=True, reason=f"{mount.reason}; {how}")


def _apart(soles: Array, felt: Array) -> float:
    """Usual angle between two directions, (n, 3) each [rad]."""
    return float(np.median(np.arccos(np.clip(np.sum(soles * felt, axis=1), -1, 1))))


def _tilts(soles: Array, felt: Array) -> float:
    """Rms of the difference of their changes."""
    apart = soles - felt
    return float(np.sqrt(np.mean(np.sum((apart - apart.mean(axis=0)) ** 2, axis=1))))

"""Where and how a foot's force sensor sits by the URDF alone: its frames, or the ankle's origin."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from plantar.conventions import FORCE, TORQUE, Array
from plantar.errors import PlantarError
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot.joint_names import words_of
from plantar.robot_guess.feet import Sole, fixed_links

SENSOR = re.compile(r"(^|[_/])(ft|fts|f_?t|wrench)([_/]|$)|force.?(torque|sensor)|ft.?sensor", re.I)
ORIGIN = "the ankle link's axes"


@dataclass(frozen=True)
class Seat:
    """A sensor's pose in its link: `xyz` (3,) [m], `rotation` (3, 3); its sign, its reason, whether it is a guess.

    height: over the ankle's origin in the foot's axes [m]; spread: by which the place may be off [m].
    """

    link: str
    xyz: Array
    rotation: Array
    reason: str
    guess: bool
    height: float
    spread: float = 0.0
    sign: int = 1

    @property
    def at_origin(self) -> bool:
        """Whether only the ankle's origin was known."""
        return self.guess and self.spread > 0 and not self.height and not self.xyz.any()


def urdf_seat(tree: UrdfTree, sole: Sole, name: str | None, frame: str) -> Seat:
    """The pose of the sensor `name` by the URDF alone: the frame of its messages, a frame of its name, one called force
    sensor, or the ankle's origin."""
    ankle = sole.limb.link
    if frame in tree.links and is_fixed(tree, ankle, frame):
        height = _height(tree, sole, frame)
        return Seat(frame, np.zeros(3), np.eye(3), "the frame of its messages", False, height)
    links = [link for link in fixed_links(tree, ankle) if link != ankle]
    alike = [link for link in links if name is not None and words_of(link) == words_of(name)]
    called = [link for link in links if SENSOR.search(link)]
    for found, reason in ((alike, "the frame of its name"), (called, "a frame called force sensor")):
        if found:
            height = _height(tree, sole, found[0])
            return Seat(found[0], np.zeros(3), np.eye(3), reason, True, height, abs(sole.depth) / 2)
    reason = f"at the ankle's origin, in {ORIGIN}"
    return Seat(ankle, np.zeros(3), np.eye(3), reason, True, 0.0, abs(sole.depth))


def pressure(seat: Seat, sole: Sole, wrench: Array, pose: Array) -> Array:
    """Centre of pressure (n, 2) [m] on the sole's plane in the foot's axes about the ankle's origin, and load (n,)."""
    place, turn = sensor_pose(seat, pose)
    into_foot = sole.upright.T @ turn
    force = seat.sign * wrench[:, FORCE] @ into_foot.T
    torque = seat.sign * wrench[:, TORQUE] @ into_foot.T
    arm = sole.upright.T @ place - np.array([0.0, 0.0, sole.depth])
    moment = np.cross(arm, force) + torque
    load = np.where(np.abs(force[:, 2]) > 1.0, force[:, 2], np.nan)
    return np.column_stack([-moment[:, 1] / load, moment[:, 0] / load, force[:, 2]])


def sensor_pose(seat: Seat, pose: Array) -> tuple[Array, Array]:
    """Place (3,) and axes (3, 3) of a sensor in the ankle link; `pose` (4, 4) is the seat's link's there."""
    return pose[:3, :3] @ seat.xyz + pose[:3, 3], pose[:3, :3] @ seat.rotation


def is_fixed(tree: UrdfTree, ankle: str, frame: str) -> bool:
    try:
        tree.fixed_pose(ankle, frame)
    except PlantarError:
        return False
    return True


def _height(tree: UrdfTree, sole: Sole, link: str) -> float:
    return float(sole.upright[:, 2] @ tree.fixed_pose(sole.limb.link, link)[:3, 3])

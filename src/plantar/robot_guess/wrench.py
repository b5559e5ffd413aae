"""Where and how a foot's force sensor sits: the URDF's frames first, then what the logs show of its axes and its sign.

Under a standing robot the force points up, and the feet's wrenches balance gravity: their moment about the centre of
mass, over the load, is a short moment arm that hardly changes. A sensor's zero makes it longer, wrong axes make it
change with every sway. How high a sensor sits hardly shows.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import FORCE, TORQUE, Array
from plantar.errors import PlantarError
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot.joint_names import words_of
from plantar.robot_guess.feet import Sole, fixed_links
from plantar.robot_guess.imu import right_angles
from plantar.robot_guess.stance import FEWEST, Stance

SENSOR = re.compile(r"(^|[_/])(ft|fts|f_?t|wrench)([_/]|$)|force.?(torque|sensor)|ft.?sensor", re.I)
STEEP = np.cos(
    np.radians(25)
)  # under load the usual force is nearer to up than this, in the sensor's right axes
CLEARLY, SMALL = (
    0.5,
    0.01,
)  # other axes are believed where they halve a change of the moment arm of 1 cm or more
ORIGIN, SOLE_AXES = "the ankle link's axes", "the foot's axes: x to the toes, z up"


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


def seats_by_log(
    seats: Mapping[str, Seat], soles: Sequence[Sole], stance: Stance, poses: Mapping[str, Array]
) -> tuple[dict[str, Seat], float]:
    """The seats with the signs and axes that the logs show, alike on all feet; and the moment arm that is left [m].

    poses: of each seat's link in its ankle link, (4, 4). Axes given by messages keep; only their sign is looked at.
    """
    options = [seats]
    if all(seat.guess for seat in seats.values()):
        feet = {sole.limb.side: sole for sole in soles}
        options += [_turned(seats, feet, poses, turn) for turn in right_angles()]
    signed = [_with_signs(option, soles, stance, poses) for option in options]
    steep = [option for option in signed if option is not None]
    # The link's axes or the foot's before any others; of these two, those that need fewer signs turned.
    plain = [option for option in signed[:2] if option is not None] or steep
    if not plain:
        return dict(seats), _usual(moment_arms(seats, stance, poses))
    usual = min(plain, key=lambda option: sum(seat.sign < 0 for seat in option.values()))
    changes = [_change(moment_arms(option, stance, poses)) for option in (usual, *steep)]
    best = int(np.argmin(changes))
    chosen = [usual, *steep][best] if changes[best] < CLEARLY * changes[0] and changes[0] > SMALL else usual
    return chosen, _usual(moment_arms(chosen, stance, poses))


def moment_arms(seats: Mapping[str, Seat], stance: Stance, poses: Mapping[str, Array]) -> Array:
    """Level moment of the feet's wrenches about the centre of mass, over the load, while all feet stand, (n, 3) [m]."""
    moment, total = np.zeros_like(stance.centre), np.zeros_like(stance.centre)
    for side, seat in seats.items():
        place, turn = sensor_pose(seat, poses[side])
        axes = stance.rotations[side] @ turn
        force = seat.sign * np.einsum("nij,nj->ni", axes, stance.wrenches[side][:, FORCE])
        torque = seat.sign * np.einsum("nij,nj->ni", axes, stance.wrenches[side][:, TORQUE])
        arm = stance.places[side] + stance.rotations[side] @ place - stance.centre
        moment += np.cross(arm, force) + torque
        total += force
    level = moment - np.sum(moment * stance.up, axis=1)[:, None] * stance.up
    load = np.maximum(np.abs(np.sum(total * stance.up, axis=1)), 1.0)
    found = level / load[:, None]
    return np.asarray(found[stance.double] if stance.double.sum() >= FEWEST else found)


def _usual(found: Array) -> float:
    return float(np.median(np.linalg.norm(found, axis=1)))


def _change(found: Array) -> float:
    """Rms of what changes."""
    return float(np.sqrt(np.mean(np.sum((found - found.mean(axis=0)) ** 2, axis=1))))


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


def _turned(
    seats: Mapping[str, Seat], feet: Mapping[str, Sole], poses: Mapping[str, Array], turn: Array
) -> dict[str, Seat]:
    """The seats with axes turned by right angles from the feet's."""
    name = SOLE_AXES if np.allclose(turn, np.eye(3)) else "axes turned by right angles"
    return {
        side: replace(
            seat,
            rotation=poses[side][:3, :3].T @ feet[side].upright @ turn,
            reason=f"{seat.reason.removesuffix(f', in {ORIGIN}')}, in {name}",
        )
        for side, seat in seats.items()
    }


def _with_signs(
    seats: Mapping[str, Seat], soles: Sequence[Sole], stance: Stance, poses: Mapping[str, Array]
) -> dict[str, Seat] | None:
    """The seats with the sign by which each force points up; None where one does not point along up at all."""
    found = {}
    for sole in soles:
        seat, rows = seats[sole.limb.side], stance.loaded[sole.limb.side]
        if not rows.any():
            found[sole.limb.side] = seat
            continue
        axes = sensor_pose(seat, poses[sole.limb.side])[1]
        force = np.median(stance.wrenches[sole.limb.side][rows][:, FORCE], axis=0)
        up = sole.upright[:, 2] @ (axes @ force) / max(float(np.linalg.norm(force)), 1e-9)
        if abs(up) < STEEP and seat.guess:
            return None
        found[sole.limb.side] = replace(seat, sign=1 if up > 0 else -1)
    return found

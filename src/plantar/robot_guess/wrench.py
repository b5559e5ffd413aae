"""What the logs show of the axes and the sign of a foot's force sensor, where the URDF does not tell.

Under a standing robot the force points up, and the feet's wrenches balance gravity: their moment about the centre of
mass, over the load, is a short moment arm that hardly changes. A sensor's zero makes it longer, wrong axes make it
change with every sway. How high a sensor sits hardly shows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import FORCE, TORQUE, Array
from plantar.faults.stance import usual as usual_length
from plantar.robot_guess.feet import Sole
from plantar.robot_guess.imu import Mount, right_angles
from plantar.robot_guess.passive import that_push_back
from plantar.robot_guess.seat import ORIGIN, Seat, sensor_pose
from plantar.robot_guess.stance import FEWEST, Stance

# Under load the usual force is nearer to up than this, in the sensor's right axes.
STEEP = np.cos(np.radians(25))
# Other axes are believed where they halve a change of the moment arm of 1 cm or more.
CLEARLY, SMALL = 0.5, 0.01
SOLE_AXES = "the foot's axes: x to the toes, z up"


def seats_by_log(
    seats: Mapping[str, Seat],
    soles: Sequence[Sole],
    stance: Stance,
    mount: Mount | None,
    poses: Mapping[str, Array],
) -> tuple[Mapping[str, Seat], float]:
    """The seats with the signs and axes that the logs show, alike on all feet; and the moment arm that is left [m].

    mount: of the IMU; poses: of each seat's link in its ankle link, (4, 4). Axes given by messages keep; only their
    sign is looked at.
    """
    options = [seats]
    if all(seat.guess for seat in seats.values()):
        feet = {sole.limb.side: sole for sole in soles}
        options += [_turned(seats, feet, poses, turn) for turn in right_angles()]
    signed = [_with_signs(option, soles, stance, poses) for option in options]
    steep = that_push_back([option for option in signed if option is not None], soles, stance, mount, poses)
    # The link's axes or the foot's before any others; of these two, those that need fewer signs turned.
    plain = [option for option in steep if any(option is first for first in signed[:2])] or steep
    if not plain:
        return seats, usual_length(moment_arms(seats, stance, poses))
    usual = min(plain, key=lambda option: sum(seat.sign < 0 for seat in option.values()))
    changes = [_change(moment_arms(option, stance, poses)) for option in (usual, *steep)]
    best = int(np.argmin(changes))
    chosen = [usual, *steep][best] if changes[best] < CLEARLY * changes[0] and changes[0] > SMALL else usual
    return chosen, usual_length(moment_arms(chosen, stance, poses))


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


def _change(found: Array) -> float:
    """Rms of what changes."""
    return float(np.sqrt(np.mean(np.sum((found - found.mean(axis=0)) ** 2, axis=1))))


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

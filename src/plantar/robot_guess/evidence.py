"""What a standing robot's logs say for or against a first robot file, one remark each, and outlines that they widen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import FORCE, GRAVITY, Array
from plantar.faults.standing import UNEXPLAINED
from plantar.robot_guess.feet import SHAPE_SPREAD, Sole, box
from plantar.robot_guess.seat import Seat, pressure, sensor_pose
from plantar.robot_guess.stance import FEWEST, Stance
from plantar.sensors.moments.torque_gains import WORTH_SAYING

LOADED = 0.3  # of the weight on a foot whose centre of pressure is looked at
RARE = 1.0  # % of the samples at either end that are left aside
EDGE = 0.01  # m: no robot stands on the very edge of its soles
OUTSIDE = 0.05  # share of the samples that may lie an EDGE or more outside an outline
MOSTLY = 0.5  # share beyond which even a guessed outline contradicts the centre of pressure
OFF_WEIGHT = 0.1  # share by which the feet may carry more or less than the URDF weighs: twice `link_mass`
UNEVEN = 0.02  # m between the planes of two soles


@dataclass(frozen=True)
class Remark:
    """One line about the logs; `doubt` where something contradicts the robot file."""

    text: str
    doubt: bool = False


def widen_outline(
    sole: Sole, seat: Seat, stance: Stance, pose: Array, weight: float
) -> tuple[Sole, list[Remark]]:
    """The sole with an outline that holds the centre of pressure; one from shapes stays, and is doubted instead."""
    side = sole.limb.side
    points = pressure(seat, sole, stance.wrenches[side], pose)
    points = points[points[:, 2] > LOADED * weight, :2]
    if len(points) < FEWEST:
        return sole, []
    low, high = np.percentile(points, [RARE, 100 - RARE], axis=0)
    heel, toes = sole.corners[:, 0].min(), sole.corners[:, 0].max()
    right, left = sole.corners[:, 1].min(), sole.corners[:, 1].max()
    beyond = np.maximum(
        np.maximum(points[:, 0] - toes, heel - points[:, 0]),
        np.maximum(points[:, 1] - left, right - points[:, 1]),
    )
    share = float(np.mean(beyond > EDGE))
    # A range that would fit and lies elsewhere tells of a torque's zero, not of a larger sole.
    fits = share > MOSTLY and bool((high - low <= np.ptp(sole.corners, axis=0)).all())
    doubts = list[Remark]()
    if share > (OUTSIDE if sole.drawn else MOSTLY):
        text = (
            f"the {side} foot's centre of pressure leaves its outline in {100 * share:.0f} % of the samples, by "
            f"{1e3 * np.percentile(beyond, 95):.0f} mm: check pose, zero and sign of its wrench"
        )
        doubts = [Remark(text, True)]
    if share == 0 or fits or sole.drawn:
        return sole, doubts
    x0, x1 = min(heel, low[0] - EDGE), max(toes, high[0] + EDGE)
    y0, y1 = min(right, low[1] - EDGE), max(left, high[1] + EDGE)
    reason = f"{sole.reason}; widened to hold the centre of pressure"
    return replace(sole, corners=box(x0, x1, y0, y1), reason=reason), doubts


def check_stance(
    soles: Sequence[Sole],
    seats: Mapping[str, Seat],
    stance: Stance,
    poses: Mapping[str, Array],
    weight: float,
    left: float,
) -> list[Remark]:
    """Weight, balance and level soles; `left` is the moment arm about the centre of mass [m]."""
    total = np.zeros(len(stance.up))
    for side, seat in seats.items():
        axes = stance.rotations[side] @ sensor_pose(seat, poses[side])[1]
        force = seat.sign * np.einsum("nij,nj->ni", axes, stance.wrenches[side][:, FORCE])
        total += np.sum(force * stance.up, axis=1)
    carried = float(np.median(total))
    text = f"the feet carry {carried / GRAVITY:.1f} kg, the URDF weighs {weight / GRAVITY:.1f} kg"
    if abs(carried - weight) > WORTH_SAYING * weight:
        text += ": other masses, a gain, or somebody who holds the robot or leans on it"
    found = [Remark(text, abs(carried - weight) > OFF_WEIGHT * weight)]
    unbalanced = left > UNEXPLAINED
    text = f"the feet's wrenches balance gravity to {100 * left:.1f} cm about the URDF's centre of mass"
    text += ": check how the force sensors are turned, and their signs" if unbalanced else ""
    found.append(Remark(text, unbalanced))
    both = stance.double
    if len(soles) == 2 and both.sum() >= FEWEST:
        heights = [
            np.sum(
                (stance.places[s.limb.side] + stance.rotations[s.limb.side] @ s.upright[:, 2] * s.depth)
                * stance.up,
                axis=1,
            )
            for s in soles
        ]
        apart = float(np.median(np.abs(heights[0] - heights[1])[both]))
        text = f"in double support both soles lie on one plane within {1e3 * apart:.0f} mm"
        found.append(Remark(text, apart > UNEVEN))
    return found + unlike_soles(soles)


def unlike_soles(soles: Sequence[Sole]) -> list[Remark]:
    """A doubt where two feet have other outlines: a foot that tips moves its centre of pressure past its own edge."""
    if len(soles) != 2:
        return []
    sides = [(sole.corners.min(axis=0), sole.corners.max(axis=0)) for sole in soles]
    (low, high), (other_low, other_high) = sides
    mirrored = np.array([other_low[0], -other_high[1]]), np.array([other_high[0], -other_low[1]])
    apart = max(np.abs(low - mirrored[0]).max(), np.abs(high - mirrored[1]).max())
    if apart <= SHAPE_SPREAD:
        return []
    text = (
        f"the soles' outlines differ by {1e3 * apart:.0f} mm, and feet are usually alike: measure them; where one was "
        "widened, its foot may have tipped"
    )
    return [Remark(text, True)]

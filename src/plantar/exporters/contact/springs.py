"""Points for engines in which a contact is a spring and a damper of its own, in N/m and N·s/m.

There nothing has to be tried: N points with springs k at (x, y) turn about the bush centre with

    K_pitch = Σ k x² - Σ N (depth + lower - RADIUS),    C_pitch = Σ c x²

and roll with y for x, where N is what each point carries. The last sum is the ground's push, which leans with the sole:
each push goes through its sphere's centre.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import Array, Axis
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.fit import LOADS, NEAR
from plantar.exporters.contact.points import Point, PointFoot, points_for, sides_of
from plantar.exporters.job import LEAST_LOAD
from plantar.notes import Note, Notes

RADIUS: Final = 0.01  # m, of the sphere that is a point: more than any point sinks in
ROUNDS: Final = 5  # each takes a tenth or less of the error over
FRICTION: Final = 1.0  # of the points, where the model does not say
# Of the robot's weight: where points that slide freely leave the others the friction that all had together.
MIDWAY: Final = 0.8


@dataclass(frozen=True)
class Placed:
    """A point of an exported foot: `centre` of its sphere in the ankle's frame, (3,) [m], `push` on it at the smallest
    of `LOADS` [N], and whether it is the `middle` one, which stands higher than the others."""

    name: str
    point: Point
    centre: Array
    push: float
    middle: bool


def spring_foot(foot: FootBush, weight: float) -> PointFoot:
    """Points that turn as the bush does on a robot of this weight [N] that stands on two feet.

    Raises ExportError where the bush does not stand over the sole.
    """
    stiffness: dict[Axis, float] = {spring.axis: spring.stiffness for spring in foot.springs}
    damping: dict[Axis, float] = {spring.axis: spring.damping for spring in foot.springs}
    axes: list[Axis] = [axis for axis in ("pitch", "roll") if axis in stiffness]
    sole, wanted = sides_of(foot), dict(stiffness)
    for _ in range(ROUNDS):
        made = points_for(wanted, damping, sole, foot.sole_depth, weight, LEAST_LOAD)
        for axis in axes:
            wanted[axis] += stiffness[axis] - stiffness_under(made, axis, LOADS[0] * weight)
    return points_for(wanted, damping, sole, foot.sole_depth, weight, LEAST_LOAD)


def stiffness_under(foot: PointFoot, axis: Axis, load: float) -> float:
    """K of pitch or roll about the bush centre under a load [N]; in N·m/rad."""
    carried = zip(pushes(foot, load), foot.points, strict=True)
    return foot.turning(axis)[0] - sum(push * (foot.depth + p.lower - RADIUS) for push, p in carried)


def pushes(foot: PointFoot, load: float) -> list[float]:
    """What each point carries of a load [N], the sole flat."""
    sink = foot.sink(load)
    return [p.stiffness * max(sink + p.lower, 0.0) for p in foot.points]


def placed(bush: FootBush, foot: PointFoot, weight: float) -> list[Placed]:
    """The points in the ankle's frame, turned by the springs' rest angles."""
    turn = bush.rotation @ bush.turn_at_rest
    low = max(p.lower for p in foot.points)
    found = []
    for place, (p, push) in enumerate(zip(foot.points, pushes(foot, LOADS[0] * weight), strict=True)):
        centre = turn @ np.array([p.x, p.y, RADIUS - foot.depth - p.lower]) + bush.centre
        found.append(Placed(f"{bush.name}_contact_{place}", p, centre, push, p.lower < low))
    return found


def share_of_friction(points: Sequence[Placed]) -> float:
    """How much more friction the outer points need where the middle one slides, to hold as all would at `MIDWAY`."""
    held = [p for p in points if not p.middle]
    if len(held) == len(points):
        return 1.0
    return MIDWAY / (sum(p.push for p in held) / sum(p.push for p in points) * LOADS[0])


def said(bush: FootBush, foot: PointFoot, weight: float) -> list[Note]:
    """How far K holds over loads and angles, and what comes along z."""
    notes = Notes()
    for axis in ("pitch", "roll"):
        spring = bush.spring(axis)
        if spring is None:
            continue
        errors = [stiffness_under(foot, axis, share * weight) / spring.stiffness - 1 for share in LOADS]
        worst = max(errors, key=abs)
        angle = foot.touching_angle(axis, LOADS[0] * weight)
        text = f"{bush.name} {axis}: K at {LOADS[0]:g} to {LOADS[-1]:g} of the weight is off by {100 * worst:+.1f} % "
        text += f"at most, up to {angle:.3f} rad ({spring.stiffness * angle:.0f} N·m); then points leave the ground "
        text += "and the foot is softer"
        notes.append(Note("export_contact", "info" if abs(worst) <= NEAR[0] else "warning", text))
    notes.append(vertical_note(bush, foot))
    text = "points hold no hysteresis, no hardening and do not pull; a spring and damper is written"
    notes.info("export_points", text)
    return notes


def vertical_note(bush: FootBush, foot: PointFoot) -> Note:
    """Stiffness and damping along z, and the load below which the middle point does not touch."""
    stiffness, damping = foot.vertical
    text = f"{bush.name} z: {stiffness:.4g} N/m and {damping:.4g} N·s/m"
    lower = max(point.lower for point in foot.points)
    if lower > 0:
        edges = sum(point.stiffness for point in foot.points if point.lower > 0)
        text += f", once the load is more than {edges * lower:.3g} N; below that {edges:.4g} N/m, of the edges alone"
        text += f", which stand {1e3 * lower:.1f} mm lower than the sole"
    spring = bush.spring("z")
    apart = spring is not None and abs(stiffness / spring.stiffness - 1) > NEAR[0]
    if apart and spring is not None:
        text += (
            f"; the identified {spring.stiffness:.4g} N/m cannot be had with K of pitch and roll on this sole"
        )
    return Note("export_vertical", "warning" if apart else "info", text)


def sliding_note(bush: FootBush, points: Sequence[Placed]) -> list[Note]:
    """For engines that rub each point where it is: why the middle one slides, and what that makes of friction."""
    share = share_of_friction(points)
    if share == 1.0:
        return []
    low, high = (share * sum(p.push for p in points if not p.middle) / sum(p.push for p in points) * LOADS[0] / load
                 for load in (LOADS[-1], LOADS[0]))  # fmt: skip
    text = f"{bush.name}: the middle point slides freely, for it stands higher than the others and rubbing would damp "
    text += (
        f"the foot; the others have {share:.2g} times the friction, so the foot slips at {high:.2g} times "
    )
    text += f"({LOADS[0]:g} of the weight) to {low:.2g} times ({LOADS[-1]:g}) the force that it did"
    return [Note("export_friction", "info", text)]

"""Points fitted until the foot alone gives the identified K and C back, and how far that holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import Axis
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.alone import MARKED, Measured, measured, standing_stiffness
from plantar.exporters.contact.points import PointFoot, points_for, sides_of
from plantar.exporters.job import LEAST_LOAD

LOADS: Final = (0.5, 0.8, 1.1)  # of the robot's weight: two feet, on the way, one foot that is pushed
STEPS: Final = (0.0005, 0.001, 0.002, 0.004)  # s
ROUNDS: Final = 4  # each takes a tenth or less of the error over
FIT_STEP: Final = STEPS[1]
NEAR: Final = (0.05, 0.15)  # errors of K and of C with which a step or an angle is said to hold
SHARES: Final = (0.5, 0.75, 0.95, 1.2)  # of the angle at which a point leaves the ground


@dataclass(frozen=True)
class Check:
    """One axis of a foot alone: what stands in the export's comment.

    `stiffness_error` and `damping_error`: the worst over `LOADS`, as a share, at the step of `FIT_STEP`; `steps`: those
    of `STEPS` [s] at which both stay within `NEAR` at every load; `angle`: up to which K stays within `NEAR` at the
    smallest and the largest of `LOADS` [rad], and `torque` there [N·m].
    """

    axis: Axis
    stiffness_error: float
    damping_error: float
    steps: tuple[float, ...]
    angle: float
    torque: float


@dataclass(frozen=True)
class Fitted:
    """A foot on points with the checks of pitch and roll."""

    foot: PointFoot
    checks: tuple[Check, ...]


def fitted(bush: FootBush, weight: float, edges: float = LEAST_LOAD) -> Fitted:
    """Points of a foot that turn as its bush does, found by turning the foot alone in MuJoCo.

    About the bush centre the ground's push, which stands under the points, turns with the sole: that takes load times
    depth off K. The points are made as much stiffer, for the smallest of `LOADS`: that of a robot on two feet.

    Args:
        bush: the foot. weight: of the robot [N]. edges: of the weight, as of `points_for`.

    Raises ExportError where the bush does not stand over the sole, or the foot does not stand in MuJoCo.
    """
    stiffness: dict[Axis, float] = {spring.axis: spring.stiffness for spring in bush.springs}
    damping: dict[Axis, float] = {spring.axis: spring.damping for spring in bush.springs}
    sole, load = sides_of(bush), LOADS[0] * weight
    axes: list[Axis] = [axis for axis in ("pitch", "roll") if axis in stiffness]
    wanted_k, wanted_c = dict(stiffness), dict(damping)
    for axis in axes:
        wanted_k[axis] += load * bush.sole_depth
    foot = points_for(wanted_k, wanted_c, sole, bush.sole_depth, weight, edges)
    for _ in range(ROUNDS):
        for axis in axes:
            seen = measured(foot, axis, load, FIT_STEP)
            if not np.isfinite(seen.stiffness) or seen.stiffness <= 0:
                message = f"the foot '{bush.name}' falls over in MuJoCo on {axis} K = {stiffness[axis]:.4g}"
                raise ExportError(message, valid="a result whose stiffness carries the robot")
            wanted_k[axis] *= stiffness[axis] / seen.stiffness
            if damping[axis] > 0 and seen.damping > 0:
                wanted_c[axis] *= damping[axis] / seen.damping
        foot = points_for(wanted_k, wanted_c, sole, bush.sole_depth, weight, edges)
    # Second points touch nothing near flat, where the fit turns the foot.
    foot = foot.taking_over(load, LOADS[-1] * weight)
    checks = [_check(foot, axis, stiffness[axis], damping[axis], weight) for axis in axes]
    return Fitted(foot, tuple(checks))


def _check(foot: PointFoot, axis: Axis, stiffness: float, damping: float, weight: float) -> Check:
    def errors(seen: Measured) -> tuple[float, float]:
        c = seen.damping / damping - 1 if damping > 0 else 0.0
        return abs(seen.stiffness / stiffness - 1), abs(c)

    worst = {
        step: np.max([errors(measured(foot, axis, share * weight, step)) for share in LOADS], axis=0)
        for step in STEPS
    }
    least = LOADS[0] * weight
    held = 0.0
    for share in (MARKED, *SHARES):
        angle = share * foot.touching_angle(axis, least)
        seen = [
            standing_stiffness(foot, axis, load, FIT_STEP, angle / foot.touching_angle(axis, load))
            for load in (least, LOADS[-1] * weight)
        ]
        if not all(abs(one / stiffness - 1) <= NEAR[0] for one in seen):
            break
        held = angle
    steps = tuple(step for step, error in worst.items() if bool(np.all(error <= NEAR)))
    return Check(axis, float(worst[FIT_STEP][0]), float(worst[FIT_STEP][1]), steps, held, stiffness * held)

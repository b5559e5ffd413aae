"""Walks: footsteps, the pendulum over them, and every joint by whole-body inverse kinematics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
from scipy.interpolate import CubicSpline

from plantar.contact.balance import planned_wrench, zero_moment_point
from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.motions.body import CHEST, Body
from plantar.motions.feasible import LEAST, configurations
from plantar.motions.footsteps import Footsteps, footsteps
from plantar.motions.gait import Gait
from plantar.motions.plan import Plan, Walk
from plantar.motions.preview import centre_over
from plantar.motions.stance import Stance, check_reached
from plantar.motions.track import splined

KNOTS = 50.0  # Hz: a swing of 0.5 s has 25
ITERATIONS = 2  # Gauss-Newton steps a knot
# Of them before the first: in a posture of its own a robot stands with its pelvis as it came.
SETTLED = 60
CORRECTIONS = 2  # times the pendulum is corrected for the limbs that it does not know


def walk_plan(body: Body, name: str, start: Stance, gait: Gait) -> Plan:
    """A walk of `gait` from two soles that stand level.

    The centre of mass keeps its height, the root link is level, and it and the chest face the way. Raises MotionError
    when a foot cannot reach its place or the robot would leave the floor.
    """
    middles = {foot: _middle(body, foot) for foot in start.soles}
    steps = footsteps(gait, start.soles, middles)
    knots = np.arange(round(steps.duration * KNOTS) + 1) / KNOTS
    height = float(body.centre_of_mass(start.configuration)[2])
    zmp = steps.zmp(knots)
    centre = np.column_stack([centre_over(zmp, height, 1 / KNOTS), np.full(knots.size, height)])
    found = _follow(body, name, start, steps, knots, centre, None)
    for _ in range(CORRECTIONS):
        # Kajita's second stage: the whole body's ZMP misses the planned one, the pendulum makes it up
        missed = zmp - _zmp(body, splined(body, name, start, knots, found), knots)
        if not np.isfinite(missed).all():
            time = float(knots[~np.isfinite(missed).all(axis=1)][0])
            message = (
                f"{name}: the robot would leave the floor, since its legs jump from one posture to another"
            )
            raise MotionError(message, path=body.robot.name, time=time, valid="a smaller or slower walk")
        centre[:, :2] += centre_over(missed, height, 1 / KNOTS)
        found = _follow(body, name, start, steps, knots, centre, found)
    plan = splined(body, name, start, knots, found)
    fine = plan.time
    course = np.asarray(CubicSpline(knots, centre, bc_type="clamped")(fine))
    walk = Walk(steps.soles(fine), steps.stands(fine), steps.zmp(fine), course)
    return replace(plan, walk=walk)


def _follow(
    body: Body, name: str, start: Stance, steps: Footsteps, knots: Array, centre: Array, near: Array | None
) -> Array:
    """Configurations (K, nq) at the knots; from those `near` where there are some."""
    soles, heading = steps.soles(knots), steps.heading(knots)
    chest = body.pose(start.configuration, CHEST)
    root = pin.XYZQUATToSE3(start.configuration[:7]).rotation
    level = pin.exp3(np.array([0.0, 0.0, np.arctan2(root[1, 0], root[0, 0])]))
    q, found = start.configuration, np.empty((knots.size, start.configuration.size))
    rest = start.configuration if near is None else near[0]
    for place, time in enumerate(knots):
        targets = {foot: pin.SE3(poses[place]) for foot, poses in soles.items()}
        facing = pin.exp3(np.array([0.0, 0.0, heading[place] - heading[0]]))
        upright = body.chest_task(pin.SE3(facing @ chest.rotation, chest.translation), position=False)
        pelvis = body.root_task(pin.SE3(facing @ level, np.zeros(3)))
        tasks = [*body.foot_tasks(targets), upright, pelvis, body.centre_task(centre[place], height=10.0)]
        q = q if near is None else near[place]
        q = body.solve(q, tasks, rest, ITERATIONS if place or near is not None else SETTLED)
        rest = rest if place else q
        check_reached(body, q, targets, name, float(time))
        found[place] = q
    return found


def _zmp(body: Body, plan: Plan, knots: Array) -> Array:
    """The whole body's ZMP (K, 2) at the knots, by inverse dynamics; at rest over the ends."""
    q, v, a, time = configurations(body, plan)
    zmp = zero_moment_point(planned_wrench(body.model, q, v, a), LEAST)
    return np.column_stack([np.interp(knots, time, zmp[:, axis]) for axis in range(2)])


def _middle(body: Body, foot: str) -> Array:
    """Middle of a sole's outline in the sole's frame, x and y, and half its length and width, (4,)."""
    polygon = body.robot.feet[foot].sole.polygon
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    return np.array([*(high + low) / 2, *(high - low) / 2])

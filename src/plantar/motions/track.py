"""From displacements of the body to a plan of every joint."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio as pin
from pink.tasks import FrameTask, Task
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.motions.body import CHEST, REACHED, STEPS, Body
from plantar.motions.plan import RATE, Hand, Plan
from plantar.motions.stance import Stance, check_reached

KNOTS = 20.0  # Hz: the motions are slow, a spline through fewer points is as exact


def track(
    body: Body,
    name: str,
    start: Stance,
    duration: float,
    displacement: Callable[[Array], Array],
    tasks: Callable[[Array], list[Task]],
) -> Plan:
    """Solve for every joint at knots of `displacement(time)` (N, 3) [m] and spline through them.

    `tasks(offset)` gives the tasks of one knot beside the feet. Raises MotionError when a foot or the body
    cannot follow, with the time and how far it falls short.
    """
    knots = np.linspace(0.0, duration, round(duration * KNOTS) + 1)
    offsets = displacement(knots)
    q = start.configuration
    found = np.empty((knots.size, q.size))
    for place, offset in enumerate(offsets):
        wanted = tasks(offset)
        if place and np.array_equal(offset, offsets[place - 1]):
            found[place] = q
            continue
        q = body.solve(q, [*body.foot_tasks(start.soles), *wanted], start.configuration, STEPS)
        check_reached(body, q, start.soles, name, float(knots[place]))
        _check_body(body, q, wanted, name, float(knots[place]))
        found[place] = q
    return splined(body, name, start, knots, found)


def still(body: Body, name: str, start: Stance, duration: float, hand: Hand | None) -> Plan:
    """No joint moves; the operator may."""
    found = np.tile(start.configuration, (2, 1))
    return splined(body, name, start, np.array([0.0, duration]), found, hand)


def splined(
    body: Body, name: str, start: Stance, knots: Array, found: Array, hand: Hand | None = None
) -> Plan:
    """The plan through configurations (K, nq) at `knots` (K,) [s]."""
    time = np.arange(round(knots[-1] * RATE) + 1) / RATE
    positions = np.unwrap(np.array([body.positions(q) for q in found]), axis=0)
    joints = _through(knots, positions, time)
    base = base_poses(knots, found, time)
    return Plan(name, time, body.joints, joints, base, start.standing, start.outline, hand)


def base_poses(knots: Array, found: Array, time: Array) -> Array:
    """Poses of the floating base, (N, 4, 4), at `time` (N,) [s], between configurations (K, nq) at `knots` (K,) [s]."""
    if np.ptp(found[:, :7], axis=0).max() < 1e-12:
        return np.tile(pin.XYZQUATToSE3(found[0, :7]).homogeneous, (time.size, 1, 1))
    alike = np.sign(np.sum(found[1:, 3:7] * found[:-1, 3:7], axis=1))  # q and -q are one attitude
    quaternions = found[:, 3:7] * np.cumprod([1.0, *alike])[:, None]
    floating = _through(knots, np.column_stack([found[:, :3], quaternions]), time)
    floating[:, 3:] /= np.linalg.norm(floating[:, 3:], axis=1, keepdims=True)
    return np.array([pin.XYZQUATToSE3(row).homogeneous for row in floating])


def _through(knots: Array, values: Array, time: Array) -> Array:
    return np.asarray(CubicSpline(knots, values, bc_type="clamped")(time))


def _check_body(body: Body, q: Array, tasks: list[Task], name: str, time: float) -> None:
    for task in tasks:
        if not isinstance(task, FrameTask):
            continue
        miss = body.pose(q, CHEST).translation - task.transform_target_to_world.translation
        asked = np.asarray(task.cost)[:3] > 0
        short = float(np.linalg.norm(miss[asked]))
        if short > REACHED:
            message = f"{name}: the chest cannot reach its place, it falls short by {1e3 * short:.1f} mm"
            message += body.at_limits(q)
            valid = "a smaller motion, or one that moves the arms only, such as Myrand5"
            raise MotionError(message, path=body.robot.name, time=time, valid=valid)

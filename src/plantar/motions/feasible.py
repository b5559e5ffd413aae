"""May a plan be played? Joint limits, torques and balance, before anything moves."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from scipy.interpolate import CubicSpline

from plantar.contact.balance import Balance, planned_wrench, require_balance, sole_outlines, zero_moment_point
from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.motions.body import Body
from plantar.motions.plan import Plan

CHECK_RATE = 50.0  # Hz
ROOM = 1e-3  # rad: how far a position may pass its limit before it counts
LEAST = 10.0  # N: with less on the ground there is no zero-moment point


def check(body: Body, plan: Plan) -> Balance:
    """The plan's balance; MotionError where a joint's limits, its torque or the balance does not hold.

    The operator's hand is a help that is not counted on: with one, the robot is led without haste (no inertia). Of a
    walk it is the balance of the support that comes nearest to falling.
    """
    _check_limits(body, plan)
    motion = configurations(body, plan)
    balance = min(_supports(body, plan, *motion), key=lambda support: support.worst()[1])
    require_balance(balance)
    _check_torques(body, plan, *motion)
    return balance


def planned_zmp(body: Body, plan: Plan) -> Balance:
    """The plan's balance by inverse dynamics, whether or not it holds."""
    return _balance(body, plan, *configurations(body, plan))


def _balance(body: Body, plan: Plan, q: Array, v: Array, a: Array, time: Array) -> Balance:
    zmp = zero_moment_point(planned_wrench(body.model, q, v, a), LEAST)
    return Balance(plan.name, time, zmp, sole_outlines(body.robot, plan.stance))


def _supports(body: Body, plan: Plan, q: Array, v: Array, a: Array, time: Array) -> list[Balance]:
    """The balance over each support in turn: one, but for a walk."""
    whole = _balance(body, plan, q, v, a, time)
    if plan.walk is None:
        return [whole]
    rows = _rows(plan, time)
    stands = np.array([plan.walk.stands[foot][rows] for foot in sorted(plan.walk.stands)])
    changes = np.flatnonzero(np.diff(stands, axis=1).any(axis=0)) + 1
    found = []
    for part in np.split(np.arange(time.size), changes):
        soles = {
            foot: plan.walk.soles[foot][rows[part[0]]]
            for foot, on_floor in zip(sorted(plan.walk.stands), stands[:, part[0]], strict=True)
            if on_floor
        }
        found.append(Balance(plan.name, time[part], whole.zmp[part], sole_outlines(body.robot, soles)))
    return found


def _rows(plan: Plan, time: Array) -> Array:
    """The plan's rows nearest to `time` (N,) [s]."""
    rows = np.round(time * (len(plan.time) - 1) / plan.time[-1]).astype(int)
    return np.asarray(np.minimum(rows, len(plan.time) - 1))


def configurations(body: Body, plan: Plan) -> tuple[Array, Array, Array, Array]:
    """q (N, nq), v and a (N, nv) of the plan and their time (N,), at 50 Hz.

    Where an operator leads the robot, it turns as a whole about the middle of the soles that stand, so that the
    held point follows the hand; the speed of that is left out.
    """
    time = np.arange(0.0, plan.time[-1] + 1e-9, 1 / CHECK_RATE)
    rows = _rows(plan, time)
    spline = CubicSpline(plan.time, plan.positions)
    positions, speeds, accelerations = (spline(time, derivative) for derivative in range(3))
    q = np.tile(pin.neutral(body.model), (time.size, 1))
    v, a = np.zeros((time.size, body.model.nv)), np.zeros((time.size, body.model.nv))
    for place, name in enumerate(plan.joints):
        joint = body.model.joints[body.model.getJointId(name)]
        values = positions[:, place]
        q[:, joint.idx_q : joint.idx_q + joint.nq] = (
            values[:, None] if joint.nq == 1 else np.column_stack([np.cos(values), np.sin(values)])
        )
        v[:, joint.idx_v], a[:, joint.idx_v] = speeds[:, place], accelerations[:, place]
    bases = [pin.SE3(pose) for pose in plan.base[rows]]
    if plan.hand is not None:
        bases = _led(plan, plan.hand.path[rows], bases)
    q[:, :7] = [pin.SE3ToXYZQUAT(base) for base in bases]
    if plan.hand is None:
        twist = np.zeros((time.size, 6))
        for row in range(1, time.size - 1):
            twist[row] = pin.log6(bases[row - 1].actInv(bases[row + 1])).vector * CHECK_RATE / 2
        twist[0], twist[-1] = twist[1], twist[-2]
        v[:, :6], a[:, :6] = twist, np.gradient(twist, 1 / CHECK_RATE, axis=0)
    return q, v, a, time


def _led(plan: Plan, hand: Array, bases: list[pin.SE3]) -> list[pin.SE3]:
    """The bases of a robot that leans as a whole after the hand, (N, 3) [m]."""
    assert plan.hand is not None
    pivot = np.mean([pose[:3, 3] for pose in plan.stance.values()], axis=0)
    start, points = plan.hand.path[0] - pivot, hand - pivot
    lengths = np.linalg.norm(start) * np.linalg.norm(points, axis=1)
    leans = [pin.exp3(turn) for turn in np.cross(start, points) / lengths[:, None]]
    return [pin.SE3(lean, pivot - lean @ pivot) * base for lean, base in zip(leans, bases, strict=True)]


def _check_limits(body: Body, plan: Plan) -> None:
    speeds = CubicSpline(plan.time, plan.positions)(plan.time, 1)
    for place, name in enumerate(plan.joints):
        joint = body.model.joints[body.model.getJointId(name)]
        if joint.nq == 1:
            low, high = body.model.lowerPositionLimit[joint.idx_q], body.model.upperPositionLimit[joint.idx_q]
            past = np.maximum(low - plan.positions[:, place], plan.positions[:, place] - high)
            if low < high and past.max() > ROOM:
                _refuse(plan, name, "position", past, f"{low:.4g} to {high:.4g} rad")
        fastest = body.model.upperVelocityLimit[joint.idx_v]
        if fastest > 0:
            past = np.abs(speeds[:, place]) - fastest
            if past.max() > 0:
                _refuse(plan, name, "speed", past, f"at most {fastest:.4g} rad/s")


def _refuse(plan: Plan, joint: str, quantity: str, past: Array, valid: str) -> None:
    row = int(past.argmax())
    message = f"{plan.name}: joint '{joint}' passes its {quantity} limit by {past[row]:.3g}"
    raise MotionError(message, time=float(plan.time[row]), valid=valid)


def _check_torques(body: Body, plan: Plan, q: Array, v: Array, a: Array, time: Array) -> None:
    """Joint torques with the ground's wrench shared among the feet by least effort, ten times a second."""
    model, data = body.model, body.data
    limits = model.upperEffortLimit[6:]
    rows = _rows(plan, time)
    for row in range(0, len(time), int(CHECK_RATE / 10)):
        frames = [model.getFrameId(body.sole(name)) for name in plan.standing_at(int(rows[row]))]
        tau = pin.rnea(model, data, q[row], v[row], a[row])
        pin.computeJointJacobians(model, data, q[row])
        pin.updateFramePlacements(model, data)
        jacobian = np.vstack([pin.getFrameJacobian(model, data, f, pin.LOCAL_WORLD_ALIGNED) for f in frames])
        share = np.linalg.lstsq(jacobian[:, :6].T, tau[:6], rcond=None)[0]
        torque = tau[6:] - jacobian[:, 6:].T @ share
        past = np.where(limits > 0, np.abs(torque) - limits, -1.0)
        if past.max() > 0:
            joint = int(past.argmax())
            message = f"{plan.name}: joint '{body.joints[joint]}' needs {abs(torque[joint]):.4g} N·m"
            raise MotionError(message, time=float(time[row]), valid=f"at most {limits[joint]:.4g} N·m")

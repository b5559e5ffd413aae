"""Where a robot starts: regular standing, stepped aside, stepped forward, on one leg; arms as in the paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.contact.balance import sole_outlines
from plantar.contact.polygon import separation
from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.motions.body import CHEST, REACHED, Body

# Of the straight leg's height, where no posture is given: tried in this order.
KNEE_BENDS = (0.94, 0.96, 0.98)
LIFTED = 0.45  # rad, by which the joints of a leg bend further while its foot is lifted with a level sole
STEP_ASIDE = 0.05  # m, the right leg to the right (B)
STEP_FORWARD = 0.10  # m, the right leg forward (C)
RAISED = 0.08  # m, the free foot above the floor (F, G)


@dataclass(frozen=True)
class Stance:
    """A configuration with the soles at known places, the floor at z = 0 and the world between the feet."""

    configuration: Array
    soles: dict[str, pin.SE3]
    standing: frozenset[str]

    @property
    def outline(self) -> dict[str, Array]:
        """Poses of the soles that stand, (4, 4)."""
        return {name: np.array(self.soles[name].homogeneous) for name in sorted(self.standing)}


def stand(
    body: Body,
    posture: Mapping[str, float] | None,
    steps: Mapping[str, tuple[float, float]],
    apart: float | None = None,
) -> Stance:
    """Both feet flat on the floor, each displaced by `steps` (x, y) [m], the chest upright over their middle.

    Without a posture the knees bend a little from the neutral position, and the pelvis is level. `apart` [m] between
    the soles' frames: as in the posture where None. Raises MotionError when the soles overlap or one is out of reach.
    """
    q = body.neutral(posture)
    q[3:7] = _facing_forward(body, q)
    soles = {name: body.pose(q, body.sole(name)).translation for name in body.robot.feet}
    middle = sum(soles.values(), start=np.zeros(3)) / len(soles)
    targets = {}
    for name, place in soles.items():
        aside = place[1] - middle[1] if apart is None else np.sign(place[1] - middle[1]) * apart / 2
        step = np.array([*steps.get(name, (0.0, 0.0)), 0.0])
        targets[name] = pin.SE3(np.eye(3), np.array([0.0, aside, 0.0]) + step)
    _check_apart(body, targets)
    centre = sum((target.translation for target in targets.values()), start=np.zeros(3)) / len(targets)
    over = np.mean([target.act(_middle(body, name)) for name, target in targets.items()], axis=0)
    if posture is None:
        q[:3] = centre - [0.0, 0.0, middle[2]]
        q = _with_bent_knees(body, q, targets, over)
    else:
        q[:3] = centre - [middle[0], 0.0, middle[2]]
        q = body.solve(q, [*body.foot_tasks(targets), body.chest_task(body.pose(q, CHEST))], q, steps=60)
    check_reached(body, q, targets, "standing")
    return Stance(q, targets, frozenset(targets))


def _with_bent_knees(body: Body, straight: Array, targets: Mapping[str, pin.SE3], over: Array) -> Array:
    """The robot that stands `straight` with the pelvis lower and the centre of mass `over` (3,) [m] the feet, as low as
    leaves the joints of its legs room to lift a foot."""
    upright = body.chest_task(pin.SE3.Identity(), position=False)
    q = straight
    for bend in KNEE_BENDS:
        low = straight * np.r_[1.0, 1.0, bend, np.ones(straight.size - 3)]
        # Of the pelvis, not of the chest: what bends between them would lower the chest, and legs stay straight.
        lowered = body.root_task(pin.SE3(pin.Quaternion(low[3:7]), low[:3]))
        lowered.set_position_cost([0.0, 0.0, 10.0])
        tasks = [*body.foot_tasks(targets), upright, lowered, body.centre_task(over)]
        q = body.solve(body.bent(low), tasks, low, steps=60)
        if body.room(q, q - straight) > LIFTED:
            break
    return q


def on_one_leg(body: Body, start: Stance, foot: str, arms: Mapping[str, float]) -> Stance:
    """The centre of mass over one sole, the other foot raised, arms as given, chest upright."""
    q = body.shifted(start.configuration, arms)
    soles = dict(start.soles)
    for name in soles:
        if name != foot:
            soles[name] = soles[name] * pin.SE3(np.eye(3), np.array([0.0, 0.0, RAISED]))
    centre = np.array(start.soles[foot].act(_middle(body, foot)))  # of the sole's outline, in the world
    rest = q
    for share in np.linspace(0.1, 1.0, 10):
        moved = {
            name: pin.SE3.Interpolate(start.soles[name], target, float(share))
            for name, target in soles.items()
        }
        over = (1 - share) * body.centre_of_mass(rest) + share * centre
        upright = body.chest_task(body.pose(q, CHEST), position=False)
        tasks = [*body.foot_tasks(moved), upright, body.centre_task(over)]
        q = body.solve(q, tasks, rest, steps=6)
    q = body.solve(q, tasks, rest, steps=40)
    check_reached(body, q, soles, f"standing on the {foot} foot")
    return Stance(q, soles, frozenset({foot}))


def with_arms(body: Body, start: Stance, arms: Mapping[str, float]) -> Stance:
    """The same stance with the arms moved, and the chest led back until the centre of mass is where it was."""
    goal = body.centre_of_mass(start.configuration)
    q = body.shifted(start.configuration, arms)
    chest = body.chest_task(body.pose(q, CHEST), position=False)
    q = body.solve(q, [*body.foot_tasks(start.soles), chest, body.centre_task(goal, height=1.0)], q, steps=60)
    check_reached(body, q, start.soles, "standing with the arms moved")
    return Stance(q, start.soles, start.standing)


def check_reached(
    body: Body, q: Array, soles: Mapping[str, pin.SE3], what: str, time: float | None = None
) -> None:
    """MotionError when a foot is not where it should be."""
    for name, target in soles.items():
        miss = float(np.linalg.norm(body.pose(q, body.sole(name)).translation - target.translation))
        if miss > REACHED:
            message = f"{what}: the {name} foot cannot reach its place, it misses by {1e3 * miss:.1f} mm"
            message += body.at_limits(q)
            raise MotionError(message, path=body.robot.name, time=time, valid="a smaller motion")


def _facing_forward(body: Body, q: Array) -> Array:
    """Quaternion x y z w of the root that lets the soles' x axes point forward."""
    yaw = -body.heading(q)
    return np.array([0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)])


def _check_apart(body: Body, targets: Mapping[str, pin.SE3]) -> None:
    """MotionError where two soles would stand on each other."""
    soles = sole_outlines(body.robot, {n: np.array(t.homogeneous) for n, t in targets.items()})
    gap = separation(*soles.values())
    if gap <= 0:
        message = f"the soles would stand on each other, {-1e3 * gap:.0f} mm deep"
        raise MotionError(message, path=body.robot.name, valid="feet farther apart")


def _middle(body: Body, foot: str) -> Array:
    """Middle of a sole's outline in the sole's frame, (3,)."""
    polygon = body.robot.feet[foot].sole.polygon
    return np.array([*(polygon.max(axis=0) + polygon.min(axis=0)) / 2, 0.0])

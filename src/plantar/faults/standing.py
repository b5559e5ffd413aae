"""Do the feet's wrenches balance gravity, and if not: what exchanged or reversed makes them do it?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from plantar.faults.joints.names import legs
from plantar.faults.stance import Stance, StanceSides, stance_of, usual
from plantar.faults.torque_unit import torque_unit
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel

BETTER = 0.5  # share of the misfit that must be left after the change
FAR_BETTER = 0.35  # after the best of nine turns: a wrong mass is undone by half of its misfit by chance
NOTABLE = 0.02  # m: a moment arm below it is within the model's own error
SHIFTED = 0.005  # of a sole's length: what moves by less may be noise of the forces
LEANT = 0.006  # m: what moves by less with the soles' lean may be mounts that are turned by a degree
ROUNDING = 1e-9  # m
ALIKE = 0.1  # of the misfit: changes that do as well as the best are named with it
CERTAIN_MOMENT_ARM = 0.05  # m: an operator's hand adds less, and one of many joints undoes that by chance
CERTAIN = 0.1  # share left: no larger error of masses or mounting is undone so well by chance
UNEXPLAINED = 0.12  # m: beyond any sole; masses, encoder zeros or the sensors' places are off
FARTHEST = 1.5  # m: no posture and no mass is that far off
# Between the ground's usual force and the IMU's up: more than zeros of sensors make.
LEANING = np.radians(3.5)
PUSHED = 2.0  # times LEANING: more than who holds a robot leans on it
TURNED = np.radians(10)  # accelerations turn the force by some degrees too
IMPOSSIBLE = np.radians(30)  # no mounting, zero or push is that far off
MOST_NAMED = 3  # ways to mount it that one line tells
QUARTERS = (90, 180, -90)  # deg: how a sensor is mounted wrongly, or its axes named
LEANS, LEANS_LITTLE = "force_leans", "force_leans_little"  # codes
COMPONENTS = ("force.x", "force.y", None, "torque.x", "torque.y", None)  # force.z is judged by its own sign


class _TurnedWrench(NamedTuple):
    """What is left of the misfit [m] with force sensors turned about their own z axes, and of what moves of it;
    `columns` names which."""

    misfit: float
    moving: float
    degrees: int
    columns: str


def check_balance(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """Wrenches exchanged or turned, reversed signs of a component or a joint, or a misfit that none of them explains.

    The moment of the feet's wrenches about the centre of mass, over the load, is a moment arm [m] that stays small
    while the robot stands or sways; an operator's push adds centimetres.
    """
    stance = stance_of(robot, log)
    if stance is None:
        return
    sides = stance.sides()
    as_is, other = sides.misfit, stance.exchanged_wrenches().sides()
    world = stance.world_wrenches().sides()
    # Wrenches in other axes look like torques of another size. No rubber bends so far that soles explain more.
    below = stance.sole_wrenches().sides().moving if as_is < CERTAIN_MOMENT_ARM else np.inf
    turning = min(world.moving, below) < BETTER * sides.moving
    if not turning and (found := list(torque_unit(robot, log, sides))):
        # Moments of exchanged forces are so large that right torques look too small.
        unit = list(torque_unit(robot, log, other)) or other.misfit > BETTER * as_is
        yield from found if unit else [_swapped()]
        return
    soles = [float(np.ptp(foot.sole.polygon, axis=0).max()) for foot in stance.robot.feet.values()]
    shifted = SHIFTED * max(soles)
    turned = _turned_wrench(stance, sides) if max(as_is, sides.moving) > shifted else None
    # No wrong mass or place moves with the load: exchanged feet and turned sensors show in a small sway too.
    far = FAR_BETTER * sides.moving if sides.moving > shifted else 0.0
    quarter = np.inf if turned is None else turned.moving
    swapped, follows = other.moving < min(far, quarter), quarter < far
    in_world = (
        as_is > NOTABLE and world.moving * BETTER < below
    )  # of a robot that faces along the world's x alike
    if sides.moving > LEANT and below < min(far, other.moving, quarter) and not in_world:
        text = "columns 'wrench.*': read as in axes that turn with the soles, the wrenches balance gravity far better"
        yield Finding("wrench_turned", f"{text} (valid: in axes that turn with the ankles, above the rubber)")
        return
    if as_is <= NOTABLE and sides.lean <= LEANING and not (swapped or follows):
        yield from _turned(stance, sides)
        return
    in_metres = sides.moment_arms.copy()
    in_metres[:, :, 3:] /= 1000
    if as_is > FARTHEST:
        text = f"columns 'wrench.*': balance gravity only to {as_is:.3g} m about the centre of mass"
        millimetres = usual(in_metres.sum(axis=(1, 2))) < 0.1 * as_is
        valid = "valid: torques in N·m; these look like N·mm" if millimetres else "valid: below 0.02 m"
        yield Finding("torque_unit" if millimetres else "balance", f"{text} ({valid})", True)
        return
    exchanged = other.misfit
    # A load in one hand is undone by feet that are exchanged, but not what moves.
    explains = as_is > NOTABLE and exchanged < BETTER * as_is and other.moving < sides.moving + shifted
    certain = as_is > CERTAIN_MOMENT_ARM
    joints = _reversed_joints(stance, sides) if certain or sides.lean > LEANING else {}
    left = {**joints, **_reversed_components(stance, sides)}
    best = min(left.values(), default=np.inf)
    least = min(best, exchanged)
    if certain and (pair := _exchanged_joints(stance, sides, min(least, world.misfit))) is not None:
        text = f"columns {pair}: exchanged, the wrenches balance gravity far better"
        yield Finding("joint_names", f"{text} (check the joints' names and order)", True)
    elif as_is > NOTABLE and _in_world(sides, world, least if turned is None else min(least, turned.misfit)):
        text = "columns 'wrench.*': read as in the world's axes, they balance gravity to "
        text += f"{100 * world.misfit:.1f} cm instead of {100 * as_is:.1f} cm"
        valid = "valid: in the sensors' own axes; check also their rpy in the robot file"
        yield Finding("wrench_turned", f"{text} ({valid})")
    elif (swapped and as_is <= NOTABLE) or ((swapped or explains) and exchanged < best + ALIKE * as_is):
        yield _swapped(f"; or {_alike(left, as_is)} is reversed" if best < exchanged + ALIKE * as_is else "")
    elif (
        turned is not None
        and (follows or as_is > NOTABLE)
        and turned.misfit < min(FAR_BETTER * as_is, best - ALIKE * as_is)
    ):
        text = f"{turned.columns}: turned by {turned.degrees:+d} deg about the sensors' z axes, the wrenches balance"
        text += f" gravity to {100 * turned.misfit:.1f} cm instead of {100 * as_is:.1f} cm"
        yield Finding("wrench_turned", f"{text} (check the sensors' rpy in the robot file)")
    elif as_is > NOTABLE and best < BETTER * as_is:
        alike = _alike(left, as_is)
        text = f"{alike}: reversed, the wrenches balance gravity to {100 * best:.1f} cm"
        certain = (certain and best < CERTAIN * as_is) or sides.lean > IMPOSSIBLE
        joint = "'joint." in min(left, key=left.__getitem__)
        valid = "valid: the signs of URDF and robot file"
        valid += ", and the URDF's joints, not the motors of a parallel linkage" * joint
        yield Finding("sign", f"{text} instead of {100 * as_is:.1f} cm ({valid})", joint and certain)
    elif sides.lean > LEANING:
        text = f"columns 'imu.{stance.imu.name}.*': the ground's force leans {np.degrees(sides.lean):.1f} deg from up"
        where = "check the IMU's rpy, the joints above the feet, the wrenches' zeros"
        valid = f"valid: below {np.degrees(LEANING):.1f} deg; {where}"
        code = LEANS if sides.lean > PUSHED * LEANING else LEANS_LITTLE
        yield Finding(code, f"{text} ({valid})", bool(sides.lean > IMPOSSIBLE))
    elif as_is > UNEXPLAINED:
        text = f"columns 'wrench.*': balance gravity only to {100 * as_is:.1f} cm about the URDF's centre of mass"
        where = "check the encoders' zeros, where the wrenches are measured, and the masses"
        yield Finding("balance", f"{text} (valid: below {100 * NOTABLE:.0f} cm; {where})")
    else:
        yield from _turned(stance, sides)


def _in_world(sides: StanceSides, world: StanceSides, least: float) -> bool:
    """Whether wrenches in the world's axes explain the misfit, what is constant of it and what moves, and clearly
    better than all else, which leaves the `least` [m]: of a robot that faces along the world's x sensors that are
    turned in the robot file may look alike."""
    left = world.misfit / sides.misfit, world.moving / max(sides.moving, ROUNDING)
    return max(left) < 1.0 and sum(left) < 2 * BETTER and left[0] < least / sides.misfit - ALIKE


def _swapped(or_else: str = "") -> Finding:
    text = f"the feet's wrenches look swapped: exchanged, they balance gravity far better{or_else}"
    return Finding("swapped_feet", f"{text} (check the sensors' names)", True)


def _alike(left: Mapping[str, float], as_is: float) -> str:
    """The changes that leave about as little of the misfit as the best one."""
    most = min(left.values()) + ALIKE * as_is
    alike = sorted((name for name in left if left[name] < most), key=left.__getitem__)
    return " or ".join(alike[:MOST_NAMED])


def _turned(stance: Stance, sides: StanceSides) -> Iterator[Finding]:
    """An IMU that is turned about the vertical: its tilts are not those that the ground's force shows."""
    turn, spread = sides.turn
    if abs(turn) > max(TURNED, 3 * spread):
        text = f"columns 'imu.{stance.imu.name}.*': the tilts and the ground's force say directions that are "
        valid = f"valid: within {np.degrees(TURNED):.0f} deg; check the IMU's link and rpy in the robot file"
        yield Finding("imu_turned", f"{text}{np.degrees(turn):.0f} deg apart about the vertical ({valid})")


def _turned_wrench(stance: Stance, sides: StanceSides) -> _TurnedWrench | None:
    """The quarter turn that leaves least of the misfit; None where none also follows the motion far better."""
    if not all(wrench[:, :2].any() for wrench in stance.wrenches):
        return None  # vertical force cells have no x and y that could be turned
    moving = sides.moving
    sensors = [foot.wrench.name for foot in stance.robot.feet.values()]
    ways = {f"columns 'wrench.{sensor}.*'": [place] for place, sensor in enumerate(sensors)}
    found = []
    for columns, places in {**ways, "columns 'wrench.*'": [*range(len(sensors))]}.items():
        for degrees in QUARTERS:
            trial = stance.turned_wrenches(places, degrees).sides()
            if trial.moving < BETTER * moving:
                found.append(_TurnedWrench(trial.misfit, trial.moving, degrees, columns))
    return min(found, default=None)


def _reversed_joints(stance: Stance, sides: StanceSides) -> dict[str, float]:
    """What is left of the misfit [m] with a joint between IMU and feet reversed, or with its mirror image, by column.

    Where the force then leans from up still, the joint does not explain what is wrong.
    """
    robot = stance.robot
    tried = {
        f"column 'joint.{name}.position'": stance.reversed_joint(k).sides()
        for k, name in enumerate(robot.joint_names)
        if name in robot.path_joints and np.any(stance.positions[:, k])
    }
    for first, second in _mirrored(stance):
        names = (f"'joint.{robot.joint_names[place]}.position'" for place in (first, second))
        tried[f"columns {' and '.join(names)}"] = stance.reversed_joint(first).reversed_joint(second).sides()
    allowed = max(LEANING, BETTER * sides.lean)
    return {name: trial.misfit for name, trial in tried.items() if trial.lean < allowed}


def _mirrored(stance: Stance) -> list[tuple[int, int]]:
    """Joints of both legs that have the same place in their leg; none where the legs are not alike."""
    left, right = (
        [stance.robot.joint_names.index(name) for name in leg] for leg in legs(stance.robot).values()
    )
    return list(zip(left, right, strict=True)) if len(left) == len(right) else []


def _exchanged_joints(stance: Stance, sides: StanceSides, best: float) -> str | None:
    """Neighbours in a leg that, exchanged, explain a misfit far better than the `best` [m] of other changes."""
    robot, allowed = stance.robot, max(LEANING, BETTER * sides.lean)
    left: dict[str, float] = {}
    for foot in robot.feet.values():
        path = robot.joints_between(stance.imu.placement, foot.bush)
        leg = [place for place, name in enumerate(robot.joint_names) if name in path]
        for first, second in pairwise(leg):
            if np.any(stance.positions[:, [first, second]]):
                trial = stance.exchanged_joints(first, second).sides()
                names = (f"'joint.{robot.joint_names[place]}.position'" for place in (first, second))
                left |= {" and ".join(names): trial.misfit} if trial.lean < allowed else {}
    pair = min(left, key=left.__getitem__, default=None)
    return pair if pair is not None and left[pair] < min(NOTABLE, BETTER * best) else None


def _reversed_components(stance: Stance, sides: StanceSides) -> dict[str, float]:
    """The same with a component of one or both wrenches reversed, where it also follows the motion far better: a
    sensor's zero or a mass in the wrong place is no reversed sign."""
    moment_arms = sides.moment_arms
    total = moment_arms.sum(axis=(1, 2))
    moving = usual(total - np.median(total, axis=0))
    left: dict[str, float] = {}
    sensors = [foot.wrench.name for foot in stance.robot.feet.values()]
    for component, part in enumerate(COMPONENTS):
        if part is None:
            continue
        each = [total - 2 * moment_arms[:, k, component] for k in range(len(sensors))]
        both = total - 2 * moment_arms[:, :, component].sum(axis=1)
        names = [f"column 'wrench.{sensor}.{part}'" for sensor in sensors]
        trials = dict(zip(names, each, strict=True))
        # A foot without load has nothing to reverse: the pair counts only where both take part.
        if usual(both) < 0.8 * min(usual(one) for one in each):
            trials[f"columns 'wrench.*.{part}'"] = both
        for name, trial in trials.items():
            if usual(trial - np.median(trial, axis=0)) < BETTER * moving:
                left[name] = usual(trial)
    # As by software that gives what the robot does to the ground.
    trial = total - 2 * moment_arms[:, :, 3:].sum(axis=(1, 2))
    if usual(trial - np.median(trial, axis=0)) < BETTER * moving:
        left["columns 'wrench.*.torque.*'"] = usual(trial)
    return left

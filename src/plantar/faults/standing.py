"""Do the feet's wrenches balance gravity, and if not: what exchanged or reversed makes them do it?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from plantar.faults.stance import stance_of, usual
from plantar.faults.stance_changes import (
    BETTER,
    CERTAIN_MOMENT_ARM,
    EXCHANGED,
    EXCHANGED_MOVES,
    FAR_BETTER,
    LEANING,
    NOTABLE,
    StanceChanges,
)
from plantar.faults.torque_unit import ROUNDING, torque_unit
from plantar.logs.motion_log import MotionLog
from plantar.notes import NAMED, Finding
from plantar.robot.model import RobotModel

LEANT = 0.006  # m: what moves by less with the soles' lean may be mounts that are turned by a degree
ALIKE = 0.1  # of the misfit: changes that do as well as the best are named with it
CERTAIN = 0.1  # share left: no larger error of masses or mounting is undone so well by chance
UNEXPLAINED = 0.12  # m: beyond any sole; masses, encoder zeros or the sensors' places are off
FARTHEST = 1.5  # m: no posture and no mass is that far off
PUSHED = 2.0  # times LEANING: more than who holds a robot leans on it
TURNED = np.radians(10)  # accelerations turn the force by some degrees too
IMPOSSIBLE = np.radians(30)  # no mounting, zero or push is that far off
LEANS, LEANS_LITTLE = "force_leans", "force_leans_little"  # codes


def check_balance(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """Wrenches exchanged or turned, reversed signs of a component or a joint, or a misfit that none of them explains.

    The moment of the feet's wrenches about the centre of mass, over the load, is a moment arm [m] that stays small
    while the robot stands or sways; an operator's push adds centimetres.
    """
    stance = stance_of(robot, log)
    if stance is None:
        return
    changes = StanceChanges(stance)
    # Wrenches in other axes look like torques of another size.
    if not min(changes.world_axes.moving, changes.sole_axes) < BETTER * changes.as_is.moving and (
        found := list(torque_unit(robot, log, changes.as_is))
    ):
        # Moments of exchanged forces are so large that right torques look too small.
        other = changes.exchanged_feet
        unit = list(torque_unit(robot, log, other)) or other.misfit > BETTER * changes.misfit
        yield from found if unit else [_swapped()]
    elif finding := _in_sole_axes(changes):
        yield finding
    elif _balances(changes):
        yield from _turned_imu(changes)
    else:
        finding = next(filter(None, (explained(changes) for explained in EXPLANATIONS)), None)
        yield from _turned_imu(changes) if finding is None else [finding]


def _swapped(or_else: str = "") -> Finding:
    text = f"the feet's wrenches look swapped: exchanged, they balance gravity far better{or_else}"
    return Finding("swapped_feet", f"{text} (check the sensors' names)", True)


def _in_sole_axes(changes: StanceChanges) -> Finding | None:
    """Wrenches that turn with the soles, which explain what moves of the misfit better than any other change."""
    quarter = np.inf if changes.quarter_turn is None else changes.quarter_turn.moving
    sides, world, left = changes.as_is, changes.world_axes, changes.sole_axes
    # Of a robot that faces along the world's x these are alike.
    in_world = changes.misfit > NOTABLE and world.moving * BETTER < left
    least = min(changes.far, changes.exchanged_feet.moving, quarter)
    if sides.moving <= LEANT or left >= least or in_world:
        return None
    text = "columns 'wrench.*': read as in axes that turn with the soles, the wrenches balance gravity far better"
    return Finding("wrench_turned", f"{text} (valid: in axes that turn with the ankles, above the rubber)")


def _balances(changes: StanceChanges) -> bool:
    """Whether the misfit is within the model's own error, and no change of the sensors follows the motion better."""
    small = changes.misfit <= NOTABLE and changes.as_is.lean <= LEANING
    return small and not (_feet_follow(changes) or _quarter_follows(changes))


def _feet_follow(changes: StanceChanges) -> bool:
    """Whether exchanged feet follow the motion far better, and better than a sensor that is turned."""
    quarter = np.inf if changes.quarter_turn is None else changes.quarter_turn.moving
    moves = changes.as_is.moving > EXCHANGED_MOVES * changes.longest
    return moves and changes.exchanged_feet.moving < min(changes.far, quarter)


def _quarter_follows(changes: StanceChanges) -> bool:
    """Whether a sensor that is turned by quarters follows the motion far better."""
    return changes.quarter_turn is not None and changes.quarter_turn.moving < changes.far


def _too_far(changes: StanceChanges) -> Finding | None:
    """A misfit that only another unit can make."""
    if changes.misfit <= FARTHEST:
        return None
    in_metres = changes.as_is.moment_arms.copy()
    in_metres[:, :, 3:] /= 1000
    text = f"columns 'wrench.*': balance gravity only to {changes.misfit:.3g} m about the centre of mass"
    millimetres = usual(in_metres.sum(axis=(1, 2))) < 0.1 * changes.misfit
    valid = "valid: torques in N·m; these look like N·mm" if millimetres else "valid: below 0.02 m"
    return Finding("torque_unit" if millimetres else "balance", f"{text} ({valid})", True)


def _misread_joints(changes: StanceChanges) -> Finding | None:
    if changes.misfit <= CERTAIN_MOMENT_ARM:
        return None
    others = (changes.best_sign, changes.exchanged_feet.misfit, changes.world_axes.misfit)
    found = changes.misread_joints(min(others))
    if not found:
        return None
    ways = ", or ".join(f"{columns}: {how}" for how, columns in found.items())
    code, check = ("joint_names", "names, order and unit") if EXCHANGED in found else ("degrees", "unit")
    text = f"{ways}, the wrenches balance gravity far better"
    return Finding(code, f"{text} (check the joints' {check})", True)


def _in_world_axes(changes: StanceChanges) -> Finding | None:
    """Wrenches in the world's axes, which explain the misfit, what is constant of it and what moves, and clearly
    better than all else: of a robot that faces along the world's x sensors that are turned in the robot file may look
    alike."""
    if changes.misfit <= NOTABLE:
        return None
    sides, world, turned = changes.as_is, changes.world_axes, changes.quarter_turn
    least = min(changes.best_sign, changes.exchanged_feet.misfit, np.inf if turned is None else turned.misfit)
    left = world.misfit / sides.misfit, world.moving / max(sides.moving, ROUNDING)
    explains = max(left) < 1.0 and sum(left) < 2 * BETTER and left[0] < least / sides.misfit - ALIKE
    if not explains:
        return None
    text = "columns 'wrench.*': read as in the world's axes, they balance gravity to "
    text += f"{100 * world.misfit:.1f} cm instead of {100 * changes.misfit:.1f} cm"
    valid = "valid: in the sensors' own axes; check also their rpy in the robot file"
    return Finding("wrench_turned", f"{text} ({valid})")


def _exchanged_feet(changes: StanceChanges) -> Finding | None:
    exchanged, best, alike = changes.exchanged_feet.misfit, changes.best_sign, ALIKE * changes.misfit
    small, follows = changes.misfit <= NOTABLE, _feet_follow(changes)
    # A load in one hand is undone by feet that are exchanged, but not what moves.
    steady = changes.exchanged_feet.moving < changes.as_is.moving + changes.shifted
    explains = not small and exchanged < BETTER * changes.misfit and steady
    if not (small and follows) and (not (follows or explains) or exchanged >= best + alike):
        return None
    return _swapped(f"; or {_alike(changes)} is reversed" if best < exchanged + alike else "")


def _quarter_turn(changes: StanceChanges) -> Finding | None:
    turned, misfit = changes.quarter_turn, changes.misfit
    if turned is None or not (_quarter_follows(changes) or misfit > NOTABLE):
        return None
    if turned.misfit >= min(FAR_BETTER * misfit, changes.best_sign - ALIKE * misfit):
        return None
    text = (
        f"{turned.columns}: turned by {turned.degrees:+d} deg about the sensors' z axes, the wrenches balance"
    )
    text += f" gravity to {100 * turned.misfit:.1f} cm instead of {100 * misfit:.1f} cm"
    return Finding("wrench_turned", f"{text} (check the sensors' rpy in the robot file)")


def _reversed_sign(changes: StanceChanges) -> Finding | None:
    misfit, best, signs = changes.misfit, changes.best_sign, changes.reversed_signs
    if misfit <= NOTABLE or best >= BETTER * misfit:
        return None
    text = f"{_alike(changes)}: reversed, the wrenches balance gravity to {100 * best:.1f} cm"
    sure = misfit > CERTAIN_MOMENT_ARM and best < CERTAIN * misfit
    joint = "'joint." in min(signs, key=signs.__getitem__)
    valid = "valid: the signs of URDF and robot file"
    valid += ", and the URDF's joints, not the motors of a parallel linkage" * joint
    certain = joint and (sure or changes.as_is.lean > IMPOSSIBLE)
    return Finding("sign", f"{text} instead of {100 * misfit:.1f} cm ({valid})", bool(certain))


def _alike(changes: StanceChanges) -> str:
    """The signs that leave about as little of the misfit as the best one."""
    left, most = changes.reversed_signs, changes.best_sign + ALIKE * changes.misfit
    alike = sorted((name for name in left if left[name] < most), key=left.__getitem__)
    return " or ".join(alike[:NAMED])


def _leaning(changes: StanceChanges) -> Finding | None:
    lean = changes.as_is.lean
    if lean <= LEANING:
        return None
    imu = changes.stance.imu.name
    text = f"columns 'imu.{imu}.*': the ground's force leans {np.degrees(lean):.1f} deg from up"
    where = "check the IMU's rpy, the joints above the feet, the wrenches' zeros"
    valid = f"valid: below {np.degrees(LEANING):.1f} deg; {where}"
    code = LEANS if lean > PUSHED * LEANING else LEANS_LITTLE
    return Finding(code, f"{text} ({valid})", bool(lean > IMPOSSIBLE))


def _unexplained(changes: StanceChanges) -> Finding | None:
    if changes.misfit <= UNEXPLAINED:
        return None
    text = f"columns 'wrench.*': balance gravity only to {100 * changes.misfit:.1f} cm about the URDF's centre of mass"
    where = "check the encoders' zeros, where the wrenches are measured, and the masses"
    return Finding("balance", f"{text} (valid: below {100 * NOTABLE:.0f} cm; {where})")


# Of a misfit, in this order: the first that explains it is told.
EXPLANATIONS: Final[tuple[Callable[[StanceChanges], Finding | None], ...]] = (
    _too_far,
    _misread_joints,
    _in_world_axes,
    _exchanged_feet,
    _quarter_turn,
    _reversed_sign,
    _leaning,
    _unexplained,
)


def _turned_imu(changes: StanceChanges) -> Iterator[Finding]:
    """An IMU that is turned about the vertical: its tilts are not those that the ground's force shows."""
    turn, spread = changes.as_is.turn
    if abs(turn) > max(TURNED, 3 * spread):
        text = f"columns 'imu.{changes.stance.imu.name}.*': the tilts and the ground's force say directions that are "
        valid = f"valid: within {np.degrees(TURNED):.0f} deg; check the IMU's link and rpy in the robot file"
        yield Finding("imu_turned", f"{text}{np.degrees(turn):.0f} deg apart about the vertical ({valid})")

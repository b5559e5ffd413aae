"""`plantar design`: from a robot and a guess of its stiffness to a motion that was rehearsed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from plantar.choices import number_in, one_of
from plantar.conventions import Array
from plantar.cores import blas_on_one_core
from plantar.design.collision import free_swing
from plantar.design.family import Lines
from plantar.design.information import CRITERIA, Criterion
from plantar.design.known import Known
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot
from plantar.design.reach import KINDS, Reach
from plantar.design.rehearsals.attempt import LEFT, Attempt, until_it_holds
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.design.search import best_motion, better_motion
from plantar.design.soft_feet import CARRIED, Softness
from plantar.design.trajectory import Trajectory
from plantar.errors import MotionError, SettingsError
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.play import postures_of

SOFTEST, STIFFEST = 0.5, 2.0  # times the stiffness told, over which a motion holds
SHORTEST, LONGEST = 20.0, 600.0  # s
# Times the distance between the feet by which the right one may stand ahead. Side by side, legs alone roll the ankles:
# all feet bend alike, so the stiffest limit all. A foot ahead lets the body's lean roll them, too, most on soft feet;
# much farther ahead it costs pitch more than it brings roll.
AHEAD: Final = 0.25


@dataclass(frozen=True)
class DesignSettings:
    """What a user tells `design_motion`.

    Args:
        stiffness: of each foot in pitch and roll, as far as it is known [N·m/rad]; the motion holds for half of it
            to twice it, where the feet can carry the robot. None takes an earlier result's, and its range.
        damping: [N·m·s/rad], for the prediction only; None takes 0.04 s times the stiffness.
        duration: of the motion [s], 20 to 600.
        criterion: what is made small: the "widest" relative interval, the volume of all ("D"), their mean square ("A").
        seed: draws frequencies and the search; the same seed gives the same motion.

    Raises:
        SettingsError: a value that is not one of the choices or out of its range.
    """

    stiffness: float | None = None
    damping: float | None = None
    duration: float = 60.0
    criterion: Criterion = "widest"
    seed: int = 0

    def __post_init__(self) -> None:
        number_in("stiffness", self.stiffness, 1.0, 1e6, "N·m/rad", optional="the earlier result's")
        number_in("damping", self.damping, 0.0, 1e6, "N·m·s/rad", optional="0.04 s times the stiffness")
        number_in("duration", self.duration, SHORTEST, LONGEST, "s")
        one_of("criterion", self.criterion, CRITERIA)


@dataclass(frozen=True)
class Design:
    """A motion and what it promises.

    `told`: the bush it was made for; `factors`: the range of stiffness it holds for; `rehearsals`: by factor, the told
    stiffness among them; `pairs` of links that were watched for touching, 0 where the URDF brings no geometry; `known`:
    what an earlier result knows.
    """

    settings: DesignSettings
    robot: RobotModel
    told: Softness
    factors: tuple[float, float]
    least_stiffness: float
    legs: Legs = field(repr=False)
    lines: Lines = field(repr=False)
    coefficients: Array = field(repr=False)
    trajectory: Trajectory = field(repr=False)
    rehearsals: tuple[Rehearsal, ...] = field(repr=False)
    pairs: int
    known: Known | None

    def gentler(self, share: float) -> Trajectory:
        """The motion with a share of its amplitude."""
        return Trajectory.of("design", self.legs, self.lines, share * self.coefficients)

    @property
    def nominal(self) -> Rehearsal:
        """The rehearsal at the stiffness that was told."""
        return next(one for one in self.rehearsals if one.factor == 1.0)


@blas_on_one_core()
def design_motion(
    robot: RobotModel,
    settings: DesignSettings,
    after: FeetResult | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Design:
    """A motion that shows stiffness and damping of both feet in pitch and roll, from standing still to standing still.

    Args:
        robot: with a left and a right foot and an IMU.
        settings: the stiffness as far as it is known, and more.
        after: what is known from an earlier motion: it gives the stiffness, its range and the damping where the
            settings have none, and what is weak in it comes first.
        progress: called with a line for each step.

    Returns:
        The motion of every joint, with the intervals, margins and limits of its rehearsals.

    Raises:
        MotionError: feet of this stiffness cannot carry the robot, or its legs cannot move.

    Example:
        >>> import plantar
        >>> from plantar.design.story import DesignSettings, design_motion
        >>> found = design_motion(plantar.load_robot("robot.yaml"), DesignSettings(stiffness=500))  # doctest: +SKIP
    """
    known = None if after is None else Known.of(after)
    if settings.stiffness is None and known is None:
        raise SettingsError("the stiffness is not told (valid: a stiffness, or an earlier result)")
    progress("stand")
    stances = _stances(robot)
    legs, linear = stances[0]
    stiffness, low, high = _range(settings, known)
    linear.pendulum.check_carried(stiffness, robot.name)
    least = CARRIED * linear.pendulum.least_stiffness
    factors = (max(low, least) / stiffness, high / stiffness)
    damping = settings.damping if settings.damping is not None or known is None else known.damping
    told = Softness.told(robot, stiffness, damping)
    bushes = [told.times(factor) for factor in _rehearsed_at(*factors)]
    before = 0.0 if known is None else known.precision(tuple(legs.bushes))
    element = None if known is None else known.element
    left = np.full((len(bushes), len(KINDS)), LEFT)

    def reach_of(legs: Legs, linear: LinearRobot) -> Callable[[Lines], Reach]:
        return lambda lines: Reach(legs, linear, lines, told, bushes, element).held(left)

    place, lines, found = best_motion(
        [reach_of(*each) for each in stances], settings.duration, settings.criterion, settings.seed, before, progress
    )  # fmt: skip
    legs, linear = stances[place]
    motion = Attempt(
        Reach(legs, linear, lines, told, bushes, element),
        lambda limits, start: better_motion(limits, settings.criterion, start, before),
        found,
        _rehearsed_at(*factors),
    )
    coefficients, trajectory, rehearsals, pairs = until_it_holds(motion, legs, told, progress)
    return Design(
        settings, robot, told, factors, least, legs, lines, coefficients, trajectory, tuple(rehearsals), pairs, known
    )  # fmt: skip


def _stances(robot: RobotModel) -> list[tuple[Legs, LinearRobot]]:
    """The robot with its feet side by side, and with the right one ahead where its legs reach so far.

    Raises MotionError where it cannot stand side by side.
    """

    def standing(ahead: float) -> tuple[Legs, LinearRobot]:
        legs = Legs.of(robot, postures_of(robot).standing, ahead)
        legs = replace(legs, arms=free_swing(robot, legs.rest[0], legs.arms) * legs.arms)
        return legs, LinearRobot.of(legs)

    beside = standing(0.0)
    left, right = beside[1].pendulum.places.values()
    try:
        return [beside, standing(AHEAD * float(np.linalg.norm(left - right)))]
    except MotionError:
        return [beside]


def _range(settings: DesignSettings, known: Known | None) -> tuple[float, float, float]:
    """The stiffness that is designed for, and the range over which the motion must hold [N·m/rad]."""
    if settings.stiffness is not None:
        return settings.stiffness, SOFTEST * settings.stiffness, STIFFEST * settings.stiffness
    assert known is not None, "one of the two is told"
    return known.stiffness, known.low, known.high


def _rehearsed_at(low: float, high: float) -> tuple[float, ...]:
    """Times the stiffness told: that, both ends, and between them, where a robot may resonate.

    Twice towards the stiff end: there quick motions of a small robot resonate within a few tenths of the stiffness.
    """
    return tuple(sorted({low, low**0.5, 1.0, high**0.5, high**0.75, high}))

"""`plantar design`: from a robot and a guess of its stiffness to a motion that was rehearsed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from plantar.choices import number_in, one_of
from plantar.conventions import Array
from plantar.cores import blas_on_one_core, over_cores
from plantar.design.collision import free_swing, self_collision
from plantar.design.family import Lines
from plantar.design.information import CRITERIA, LEFT, Criterion
from plantar.design.known import Known
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot
from plantar.design.reach import FRICTION, Reach
from plantar.design.rehearsal import Rehearsal, rehearse
from plantar.design.search import best_motion
from plantar.design.soft_feet import CARRIED, Softness
from plantar.design.trajectory import Trajectory
from plantar.errors import MotionError, SettingsError
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.play import postures_of

SOFTEST, STIFFEST = 0.5, 2.0  # times the stiffness told, over which a motion holds
# m of every centre of pressure to its sole's border in rehearsals: `identify feet` drops 5 mm.
KEPT: Final = 0.0055
# A motion that does not hold is tried again, smaller by half of what it is too large, as centres of pressure run ahead
# where a sole begins to roll; at most so much smaller.
SMALLER: Final = 0.85
# m: a centre of pressure never leaves a sole. One at the border, to what its computation misses by, does not say how
# much too large a motion is: it is made as much smaller as it may.
TIPS: Final = 0.0005
SPARE: Final = 0.005  # smaller than what is just allowed
# One that leaves room where it was tightest is made larger once, at most so much: small soles need all of it.
LARGER: Final = 1.2
WORTH: Final = 1.02  # and at least so much: less is not worth two rehearsals
BESIDE: Final = 2  # rehearsals at once at least: on two cores they take as long as one
ROUNDS: Final = 8
EFFORT: Final = 0.9  # of a joint's torque limit
SHORTEST, LONGEST = 20.0, 600.0  # s


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
    stiffness among them; `pairs` of links that were watched for touching, 0 where the URDF brings no geometry.
    """

    settings: DesignSettings
    robot: RobotModel
    told: Softness
    factors: tuple[float, float]
    least_stiffness: float
    legs: Legs = field(repr=False)
    lines: Lines = field(repr=False)
    coefficients: Array = field(repr=False)
    rehearsals: tuple[Rehearsal, ...] = field(repr=False)
    pairs: int

    def trajectory(self, share: float = 1.0) -> Trajectory:
        """The motion with a share of its amplitude."""
        return Trajectory.of("design", self.legs, self.lines, share * self.coefficients)

    def half_widths(self, foot: str, axis: str, name: str) -> dict[float, float | None]:
        """By factor, the 95 % half width of a parameter that is promised [% of its value]; None where it is not
        identified: the widest of a rehearsal's own and its neighbours', whose sensors have other zeros and noise, as
        the robot's will have."""
        found = [one.percent(foot, axis, name) for one in self.rehearsals]
        near = [found[max(place - 1, 0) : place + 2] for place in range(len(found))]
        return {
            one.factor: own and max(each for each in beside if each is not None)
            for one, own, beside in zip(self.rehearsals, found, near, strict=True)
        }

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
    legs = Legs.of(robot, postures_of(robot).standing)
    legs = replace(legs, arms=free_swing(robot, legs.rest[0], legs.arms) * legs.arms)
    linear = LinearRobot.of(legs)
    stiffness, low, high = _range(settings, known)
    linear.pendulum.check_carried(stiffness, robot.name)
    least = CARRIED * linear.pendulum.least_stiffness
    factors = (max(low, least) / stiffness, high / stiffness)
    damping = settings.damping if settings.damping is not None or known is None else known.damping
    told = Softness.told(robot, stiffness, damping)
    random = np.random.default_rng(settings.seed)
    lines = Lines.drawn(settings.duration, random)
    bushes = [told.times(factor) for factor in _rehearsed_at(*factors)]
    reach = Reach(legs, linear, lines, told, bushes)
    before = 0.0 if known is None else known.precision(reach.feet)
    # What rehearsals would leave of it comes first: most motions were made smaller by as much.
    coefficients = LEFT * best_motion(reach, settings.criterion, random, before, progress)
    coefficients, rehearsals, pairs = _rehearsed(
        robot, legs, lines, coefficients, told, _rehearsed_at(*factors), progress
    )
    return Design(settings, robot, told, factors, least, legs, lines, coefficients, tuple(rehearsals), pairs)


def _range(settings: DesignSettings, known: Known | None) -> tuple[float, float, float]:
    """The stiffness that is designed for, and the range over which the motion must hold [N·m/rad]."""
    if settings.stiffness is not None:
        return settings.stiffness, SOFTEST * settings.stiffness, STIFFEST * settings.stiffness
    assert known is not None, "one of the two is told"
    return known.stiffness, known.low, known.high


@dataclass
class _Attempt:
    """A motion while its size is sought: larger once where there is room, smaller until it holds."""

    coefficients: Array
    first: list[float]  # factors of the stiffness at which it is rehearsed before the others
    rehearsals: dict[float, Rehearsal] = field(default_factory=dict)  # of the motion as it is, by factor
    share: float = 1.0  # the last one by which it was made smaller
    may_grow: bool = True
    fallback: tuple[Array, dict[float, Rehearsal]] | None = (
        None  # motion and rehearsals before it was made larger
    )

    def shrink(self, share: float) -> None:
        """A smaller motion. One that was made larger is as before: near the least stiffness all grows steeply."""
        if self.fallback is None:
            self.coefficients, self.rehearsals = share * self.coefficients, {}
        else:
            self.coefficients, self.rehearsals = self.fallback
        self.fallback, self.share = None, share

    def shrink_by_use(self, used: float) -> None:
        """Smaller after rehearsals, by half of what is used too much; the next start where it did not hold."""
        if self.fallback is None:
            self.first = [factor for factor, one in self.rehearsals.items() if _used(one)[0] > 1.0]
        self.shrink(max((1 - SPARE) / np.sqrt(used), SMALLER))

    def grow(self, used: float, progress: Callable[[str], None]) -> None:
        """Larger, once, where that is worth its rehearsals; after one made smaller only half of the way back."""
        self.may_grow = False
        grown = min((1 - SPARE) / np.sqrt(used), LARGER if self.share == 1.0 else self.share**-0.5)
        if grown > WORTH:
            progress(f"larger by {100 * (grown - 1):.0f} %: there is room")
            self.fallback = self.coefficients, self.rehearsals
            self.coefficients, self.rehearsals = grown * self.coefficients, {}

    def lower_arms(self, lines: Lines) -> bool:
        """Leave the arms out, where they move and the motion was not just made larger. False: nothing changed."""
        still = lines.without(self.coefficients, "arms")
        if self.fallback is not None or np.array_equal(still, self.coefficients):
            return False
        self.coefficients, self.rehearsals = still, {}
        return True

    def next_factors(self, factors: tuple[float, ...]) -> list[float]:
        """At which stiffness to rehearse next: none are left, or before it grows the first ones tell enough."""
        if self.may_grow and self.rehearsals:
            return []
        left = sorted(
            (each for each in factors if each not in self.rehearsals), key=lambda each: each not in self.first
        )
        urgent = sum(each in self.first for each in left)
        return left[: max(urgent, BESIDE)] if urgent else left


def _rehearsed(
    robot: RobotModel,
    legs: Legs,
    lines: Lines,
    coefficients: Array,
    told: Softness,
    factors: tuple[float, ...],
    progress: Callable[[str], None],
) -> tuple[Array, list[Rehearsal], int]:
    """The motion, larger where there is room and smaller until it holds at every stiffness. Raises MotionError where
    none does.

    A rehearsal takes seconds: the ends of the range come first, and after a motion was made smaller those at which it
    did not hold. In the end all hold with the motion as it is.
    """
    motion, reason = _Attempt(coefficients, [factors[0], factors[-1]]), ""
    for _ in range(ROUNDS):
        try:
            trajectory = Trajectory.of("design", legs, lines, motion.coefficients)
        except MotionError as error:
            reason = str(error)
            progress(f"smaller: {reason}")
            motion.shrink(SMALLER)
            continue
        watched = self_collision(robot, trajectory.configurations)
        if watched.touching is not None:
            first, second, row = watched.touching
            reason = f"'{first}' touches '{second}' at {trajectory.knots[row]:.1f} s"
            quiet = motion.lower_arms(lines)
            progress(f"{'without arms' if quiet else 'smaller'}: {reason}")
            if not quiet:
                motion.shrink(SMALLER)
            continue
        plan, used = trajectory.plan(), 0.0
        while used <= 1.0 and (asked := motion.next_factors(factors)):
            found = rehearse(robot, plan, told, asked, progress)
            used, reason = max(map(_used, found), key=lambda each: each[0])
            motion.rehearsals |= {one.factor: one for one in found}
        if used > 1.0:
            progress(f"smaller: {reason}")
            motion.shrink_by_use(used)
        elif motion.may_grow:
            motion.grow(used, progress)
        else:
            progress("identify the feet from the rehearsals")
            rehearsals = _with_results(robot, [motion.rehearsals[factor] for factor in factors])
            return motion.coefficients, rehearsals, watched.pairs
    raise MotionError(f"no motion holds over the range of stiffness: {reason}", path=robot.name)


def _with_results(robot: RobotModel, rehearsals: list[Rehearsal]) -> list[Rehearsal]:
    """The rehearsals with the feet identified from their recordings, as far as they can be."""
    results = over_cores(lambda one: one.feet_found(robot), rehearsals)
    return [replace(one, result=result) for one, result in zip(rehearsals, results, strict=True)]


def _rehearsed_at(low: float, high: float) -> tuple[float, ...]:
    """Times the stiffness told: that, both ends, and between them, where a robot may resonate.

    Twice towards the stiff end: there quick motions of a small robot resonate within a few tenths of the stiffness.
    """
    return tuple(sorted({low, low**0.5, 1.0, high**0.5, high**0.75, high}))


def _used(one: Rehearsal) -> tuple[float, str]:
    """How much of the tightest limit a rehearsal took up, above 1 where it does not hold, and what that limit is."""
    at = f"at {one.factor:.3g} times the stiffness"
    if one.fell is not None:
        return np.inf, f"{at}: {one.fell}"
    room = one.standing_margin - KEPT
    told = room > 0 and one.sole_margin > TIPS
    share = (one.standing_margin - one.sole_margin) / room if told else np.inf
    close = f"{at} a centre of pressure comes within {1e3 * one.sole_margin:.1f} mm of a sole's border"
    return max(
        (share, close),
        (one.friction / FRICTION, f"{at} a foot needs a friction of {one.friction:.2f}"),
        (one.effort / EFFORT, f"{at} a joint needs {100 * one.effort:.0f} % of its torque limit"),
    )

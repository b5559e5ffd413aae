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
from plantar.design.information import CRITERIA, Criterion
from plantar.design.known import Known
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot
from plantar.design.reach import BEND, FRICTION, KINDS, LIFT, Reach
from plantar.design.rehearsal import Rehearsal, rehearse
from plantar.design.search import best_motion, better_motion
from plantar.design.soft_feet import CARRIED, Softness
from plantar.design.trajectory import Trajectory
from plantar.errors import MotionError, SettingsError
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.play import postures_of

SOFTEST, STIFFEST = 0.5, 2.0  # times the stiffness told, over which a motion holds
# m of every centre of pressure to its sole's border in rehearsals: `identify feet` drops 5 mm.
KEPT: Final = 0.0055
# Share of their limits that motions may use before any is rehearsed: joints give way under load, of which limits that
# are linear know nothing.
LEFT: Final = 0.87
# A limit that a rehearsal passes is held to half of what that is too much, as centres of pressure run ahead where a
# sole begins to roll; at most so much less.
SMALLER: Final = 0.85
# m: a centre of pressure never leaves a sole. One at the border, to what its computation misses by, does not say how
# much too large a motion is: its limit is held to as much less as it may.
TIPS: Final = 0.0005
SPARE: Final = 0.005  # less than what is just allowed
BESIDE: Final = 2  # rehearsals at once at least: on two cores they take as long as one
ROUNDS: Final = 12
EFFORT: Final = 0.9  # of a joint's torque limit
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
    left = np.full((len(bushes), len(KINDS)), LEFT)

    def reach_of(legs: Legs, linear: LinearRobot) -> Callable[[Lines], Reach]:
        return lambda lines: Reach(legs, linear, lines, told, bushes).held(left)

    place, lines, found = best_motion(
        [reach_of(*each) for each in stances], settings.duration, settings.criterion, settings.seed, before, progress
    )  # fmt: skip
    legs, linear = stances[place]
    motion = _Attempt(
        Reach(legs, linear, lines, told, bushes),
        lambda limits, start: better_motion(limits, settings.criterion, start, before),
        found,
        _rehearsed_at(*factors),
    )
    coefficients, rehearsals, pairs = _rehearsed(motion, legs, told, progress)
    return Design(settings, robot, told, factors, least, legs, lines, coefficients, tuple(rehearsals), pairs)


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


@dataclass
class _Attempt:
    """A motion while rehearsals show how much of each limit it may use.

    Where it uses more of one than holds, that limit is held to less, at that stiffness alone, and the search goes on. A
    stiffness that amplifies does not make the motion small at others.
    """

    reach: Reach
    better: Callable[[Reach, Array], Array]  # a motion that is better, or within other limits, than one
    coefficients: Array
    factors: tuple[float, ...]
    shares: Array = field(init=False)  # (S, KINDS) of the limits over each bush
    others: float = 1.0  # share of the limits over no bush
    still: tuple[str, ...] = ()
    first: list[float] = field(
        init=False
    )  # factors of the stiffness at which it is rehearsed before the others
    rehearsals: dict[float, Rehearsal] = field(default_factory=dict)  # of the motion as it is, by factor

    def __post_init__(self) -> None:
        self.shares = np.full((len(self.factors), len(KINDS)), LEFT)
        self.first = [self.factors[0], self.factors[-1]]

    def search_on(self) -> None:
        """Within the limits as they are now."""
        within = self.reach.held(self.shares, self.others, self.still)
        self.coefficients, self.rehearsals = self.better(within, self.coefficients), {}

    def shrink(self) -> None:
        """Smaller in all."""
        self.shares, self.others = SMALLER * self.shares, SMALLER * self.others
        self.search_on()

    def lower_arms(self) -> bool:
        """Leave the arms out, where they move. False: nothing changed."""
        still = self.reach.lines.without(self.coefficients, "arms")
        if self.still or np.array_equal(still, self.coefficients):
            return False
        self.coefficients, self.still = still, ("arms",)
        self.search_on()
        return True

    def adapt(self) -> None:
        """Search on within limits as rehearsals found them: what used too much may use less."""
        rows = [self.factors.index(factor) for factor in self.rehearsals]
        used = np.array([_used(one)[0] for one in self.rehearsals.values()])
        foretold, shares = self.reach.used_by_kind(self.coefficients)[rows], self.shares[rows]
        change = np.clip((1 - SPARE) / np.sqrt(np.maximum(used, 1.0)), SMALLER, 1.0)
        change[used <= 1] = 1.0
        self.first = [factor for factor, own in zip(self.rehearsals, used, strict=True) if own.max() > 1]
        # What lies between is held to shares between; what failed far from its limit is held to less than it used.
        order = np.argsort(rows)
        places = np.log(self.factors)
        for kind, own in enumerate(np.log(change[order]).T):
            self.shares[:, kind] *= np.exp(np.interp(places, places[np.array(rows)[order]], own))
        self.shares[rows] = np.where(used > 1, change * np.minimum(shares, foretold), shares)
        self.search_on()

    def next_factors(self) -> list[float]:
        """At which stiffness to rehearse next."""
        left = sorted(
            (each for each in self.factors if each not in self.rehearsals),
            key=lambda each: each not in self.first,
        )
        urgent = sum(each in self.first for each in left)
        return left[: max(urgent, BESIDE)] if urgent else left


def _rehearsed(
    motion: _Attempt, legs: Legs, told: Softness, progress: Callable[[str], None]
) -> tuple[Array, list[Rehearsal], int]:
    """The motion within limits at which it holds at every stiffness. Raises MotionError where none does.

    A rehearsal takes seconds: the ends of the range come first, and after a change those at which it did not hold. In
    the end all hold with the motion as it is.
    """
    robot, reason = legs.body.robot, ""
    for _ in range(ROUNDS):
        try:
            trajectory = Trajectory.of("design", legs, motion.reach.lines, motion.coefficients)
        except MotionError as error:
            reason = str(error)
            progress(f"smaller: {reason}")
            motion.shrink()
            continue
        watched = self_collision(robot, trajectory.configurations)
        if watched.touching is not None:
            first, second, row = watched.touching
            reason = f"'{first}' touches '{second}' at {trajectory.knots[row]:.1f} s"
            quiet = motion.lower_arms()
            progress(f"{'without arms' if quiet else 'smaller'}: {reason}")
            if not quiet:
                motion.shrink()
            continue
        plan, used = trajectory.plan(), 0.0
        while used <= 1.0 and (asked := motion.next_factors()):
            found = rehearse(robot, plan, told, asked, progress)
            used, reason = max(((float(each.max()), why) for each, why in map(_used, found)))
            motion.rehearsals |= {one.factor: one for one in found}
        if used > 1.0:
            progress(f"smaller: {reason}")
            motion.adapt()
            continue
        progress("identify the feet from the rehearsals")
        rehearsals = _with_results(robot, [motion.rehearsals[factor] for factor in motion.factors])
        return motion.coefficients, rehearsals, watched.pairs
    raise MotionError(f"no motion holds over the range of stiffness: {reason}", path=robot.name)


def _with_results(robot: RobotModel, rehearsals: list[Rehearsal]) -> list[Rehearsal]:
    """The rehearsals with the feet identified from their recordings, as far as they can be."""
    results = over_cores(lambda one: one.feet_found(robot), rehearsals)
    return [replace(one, results=found) for one, found in zip(rehearsals, results, strict=True)]


def _rehearsed_at(low: float, high: float) -> tuple[float, ...]:
    """Times the stiffness told: that, both ends, and between them, where a robot may resonate.

    Twice towards the stiff end: there quick motions of a small robot resonate within a few tenths of the stiffness.
    """
    return tuple(sorted({low, low**0.5, 1.0, high**0.5, high**0.75, high}))


def _used(one: Rehearsal) -> tuple[Array, str]:
    """How much of each of the KINDS of limits a rehearsal took up, above 1 where it does not hold, and the tightest.
    What falls or asks too much of a joint takes up too much of all."""
    at = f"at {one.factor:.3g} times the stiffness"
    if one.fell is not None:
        return np.full(len(KINDS), np.inf), f"{at}: {one.fell}"
    soles = [
        (rest - near) / (rest - KEPT) if rest > KEPT and near > TIPS else np.inf
        for near, rest in zip(one.sole_margins, one.standing_margins, strict=True)
    ]
    used = np.array([*soles, one.friction / FRICTION, (1 - one.least_load) / (1 - LIFT), one.bend / BEND])
    close = f"{at} a centre of pressure comes within {1e3 * one.sole_margin:.1f} mm of a sole's border"
    said = [
        close,
        close,
        f"{at} a foot needs a friction of {one.friction:.2f}",
        f"{at} a foot keeps {100 * one.least_load:.0f} % of its load",
        f"{at} a foot is bent by {one.bend:.2f} rad",
        f"{at} a joint needs {100 * one.effort:.0f} % of its torque limit",
    ]
    effort = one.effort / EFFORT
    tightest = said[int(np.append(used, effort).argmax())]
    return np.maximum(used, effort if effort > 1 else 0.0), tightest

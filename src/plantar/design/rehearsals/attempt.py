"""How much of its limits a motion may use: rehearsed, and made smaller where it does not hold, until it holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.cores import over_cores
from plantar.design.collision import self_collision
from plantar.design.legs import Legs
from plantar.design.reach import BEND, FRICTION, KINDS, LIFT, Reach
from plantar.design.rehearsals.rehearsal import DRAWS, Rehearsal, rehearse
from plantar.design.soft_feet import Softness
from plantar.design.trajectory import Trajectory
from plantar.errors import MotionError
from plantar.robot.model import RobotModel

# m of every centre of pressure to its sole's border in rehearsals: `identify feet` drops 5 mm.
KEPT: Final = 0.0055
# Share of their limits that motions may use before any is rehearsed: joints give way under load, of which limits that
# are linear know nothing.
LEFT: Final = 0.87
# A limit that a rehearsal passes is held to less by what that is too much; at most so much less, as centres of pressure
# run ahead where a sole begins to roll.
SMALLER: Final = 0.85
# m: a centre of pressure never leaves a sole. One at the border, to what its computation misses by, does not say how
# much too large a motion is: its limit is held to as much less as it may.
TIPS: Final = 0.0005
SPARE: Final = 0.005  # less than what is just allowed
BESIDE: Final = 2  # rehearsals at once at least: on two cores they take as long as one
ROUNDS: Final = 12
EFFORT: Final = 0.9  # of a joint's torque limit


@dataclass
class Attempt:
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
    first: list[float] = field(init=False)  # factors of stiffness that are rehearsed before the others
    rehearsals: dict[float, Rehearsal] = field(default_factory=dict)  # of the motion as it is, by factor

    def __post_init__(self) -> None:
        self.shares = np.full((len(self.factors), len(KINDS)), LEFT)
        self.first = [self.factors[0], self.factors[-1]]

    def search_on(self) -> None:
        """Within the limits as they are now."""
        within = self.reach.held(self.shares, self.others, self.still)
        self.coefficients, self.rehearsals = self.better(within, self.coefficients), {}

    def shrink(self) -> None:
        """Joints that move less: what legs do not reach and links that touch are no matter of what soles hold."""
        self.others = SMALLER * min(self.others, self.reach.used_over_none(self.coefficients))
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
        used = np.array([used_by(one)[0] for one in self.rehearsals.values()])
        foretold, shares = self.reach.used_by_kind(self.coefficients)[rows], self.shares[rows]
        change = np.clip((1 - SPARE) / np.maximum(used, 1.0), SMALLER, 1.0)
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


def until_it_holds(
    motion: Attempt, legs: Legs, told: Softness, progress: Callable[[str], None]
) -> tuple[Array, Trajectory, list[Rehearsal], int]:
    """The motion within limits at which it holds at every stiffness, its joints, rehearsals, and pairs of links that
    were watched. Raises MotionError where none does.

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
            used, reason = max(((float(each.max()), why) for each, why in map(used_by, found)))
            motion.rehearsals |= {one.factor: one for one in found}
        if used > 1.0:
            progress(f"smaller: {reason}")
            motion.adapt()
            continue
        progress("identify the feet from the rehearsals")
        rehearsals = _with_results(robot, [motion.rehearsals[factor] for factor in motion.factors])
        return motion.coefficients, trajectory, rehearsals, watched.pairs
    raise MotionError(f"no motion holds over the range of stiffness: {reason}", path=robot.name)


def _with_results(robot: RobotModel, rehearsals: list[Rehearsal]) -> list[Rehearsal]:
    """The rehearsals with the feet identified from their recordings, as far as they can be.

    Half as often between the ends and the stiffness told: widths there are never less than their neighbours'.
    """
    whole = (rehearsals[0].factor, 1.0, rehearsals[-1].factor)
    results = over_cores(
        lambda one: one.feet_found(robot, DRAWS if one.factor in whole else DRAWS // 2), rehearsals
    )
    return [replace(one, results=found) for one, found in zip(rehearsals, results, strict=True)]


def used_by(one: Rehearsal) -> tuple[Array, str]:
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

"""What is left of a stance's misfit once something in it is exchanged, turned or reversed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.faults.joints.names import legs
from plantar.faults.stance import Stance, StanceSides, usual

BETTER = 0.5  # share of the misfit that must be left after the change
FAR_BETTER = 0.35  # after the best of nine turns: a wrong mass is undone by half of its misfit by chance
NOTABLE = 0.02  # m: a moment arm below it is within the model's own error
CERTAIN_MOMENT_ARM = 0.05  # m: an operator's hand adds less, and one of many joints undoes that by chance
SHIFTED = 0.005  # of a sole's length: what moves by less may be noise of the forces
# Likewise: sound robots move by 0.014 with arms and trunk, which exchanged feet on unlike levels may undo by chance.
EXCHANGED_MOVES = 0.015
# Between the ground's usual force and the IMU's up: more than zeros of sensors make.
LEANING = np.radians(3.5)
QUARTERS = (90, 180, -90)  # deg: how a sensor is mounted wrongly, or its axes named
AS_DEGREES = 0.3  # rad: degrees that read less are a joint that stands still
EXCHANGED = "exchanged"
COMPONENTS = ("force.x", "force.y", None, "torque.x", "torque.y", None)  # force.z is judged by its own sign


class TurnedWrench(NamedTuple):
    """What is left of the misfit [m] with force sensors turned about their own z axes, and of what moves of it;
    `columns` names which."""

    misfit: float
    moving: float
    degrees: int
    columns: str


@dataclass(frozen=True)
class StanceChanges:
    """A stance as it is and after each change; a change is tried when it is first asked for."""

    stance: Stance

    @cached_property
    def as_is(self) -> StanceSides:
        return self.stance.sides()

    @property
    def misfit(self) -> float:
        """As it is [m]."""
        return self.as_is.misfit

    @property
    def far(self) -> float:
        """What must be left of what moves of the misfit [m] by a change that follows the motion far better. No wrong
        mass or place moves with the load: exchanged feet and turned sensors show in a small sway too."""
        return FAR_BETTER * self.as_is.moving if self.as_is.moving > self.shifted else 0.0

    @property
    def shifted(self) -> float:
        """What moves by less [m] may be noise of the forces."""
        return SHIFTED * self.longest

    @property
    def longest(self) -> float:
        """Of the soles' lengths and widths [m]."""
        soles = (foot.sole.polygon for foot in self.stance.robot.feet.values())
        return max(float(np.ptp(polygon, axis=0).max()) for polygon in soles)

    @cached_property
    def exchanged_feet(self) -> StanceSides:
        return self.stance.exchanged_wrenches().sides()

    @cached_property
    def world_axes(self) -> StanceSides:
        return self.stance.world_wrenches().sides()

    @cached_property
    def sole_axes(self) -> float:
        """What is left of what moves of the misfit [m] in axes that turn with the soles. No rubber bends so far that
        they explain more than CERTAIN_MOMENT_ARM."""
        return self.stance.sole_wrenches().sides().moving if self.misfit < CERTAIN_MOMENT_ARM else np.inf

    @cached_property
    def quarter_turn(self) -> TurnedWrench | None:
        """The one that leaves least of the misfit; None where none also follows the motion far better."""
        moving = self.as_is.moving
        # Vertical force cells have no x and y that could be turned.
        flat = all(wrench[:, :2].any() for wrench in self.stance.wrenches)
        if max(self.misfit, moving) <= self.shifted or not flat:
            return None
        sensors = [foot.wrench.name for foot in self.stance.robot.feet.values()]
        ways = {f"columns 'wrench.{sensor}.*'": [place] for place, sensor in enumerate(sensors)}
        found = []
        for columns, places in {**ways, "columns 'wrench.*'": [*range(len(sensors))]}.items():
            for degrees in QUARTERS:
                trial = self.stance.turned_wrenches(places, degrees).sides()
                if trial.moving < BETTER * moving:
                    found.append(TurnedWrench(trial.misfit, trial.moving, degrees, columns))
        return min(found, default=None)

    @cached_property
    def reversed_signs(self) -> Mapping[str, float]:
        """What is left of the misfit [m] with a joint or a component of a wrench reversed, by column."""
        sides = self.as_is
        joints = self.misfit > CERTAIN_MOMENT_ARM or sides.lean > LEANING
        return {**(self._reversed_joints() if joints else {}), **self._reversed_components()}

    @property
    def best_sign(self) -> float:
        """The least of them [m]."""
        return min(self.reversed_signs.values(), default=np.inf)

    def _reversed_joints(self) -> dict[str, float]:
        """Of a joint between IMU and feet, alone or with its mirror image. Where the force then leans from up still,
        the joint does not explain what is wrong."""
        stance, robot = self.stance, self.stance.robot
        tried = {
            f"column 'joint.{name}.position'": stance.scaled_joint(k, -1.0).sides()
            for k, name in enumerate(robot.joint_names)
            if name in robot.path_joints and np.any(stance.positions[:, k])
        }
        for first, second in self._mirrored():
            names = (f"'joint.{robot.joint_names[place]}.position'" for place in (first, second))
            both = stance.scaled_joint(first, -1.0).scaled_joint(second, -1.0)
            tried[f"columns {' and '.join(names)}"] = both.sides()
        return {name: trial.misfit for name, trial in tried.items() if trial.lean < self._upright}

    @property
    def _upright(self) -> float:
        """How far the force may lean after a change of joints [rad]."""
        return float(max(LEANING, BETTER * self.as_is.lean))

    def _mirrored(self) -> list[tuple[int, int]]:
        """Joints of both legs that have the same place in their leg; none where the legs are not alike."""
        robot = self.stance.robot
        left, right = ([robot.joint_names.index(name) for name in leg] for leg in legs(robot).values())
        return list(zip(left, right, strict=True)) if len(left) == len(right) else []

    def _reversed_components(self) -> dict[str, float]:
        """Of a component of one or both wrenches, where it also follows the motion far better: a sensor's zero or a
        mass in the wrong place is no reversed sign."""
        moment_arms = self.as_is.moment_arms
        total = moment_arms.sum(axis=(1, 2))
        trials: dict[str, Array] = {}
        sensors = [foot.wrench.name for foot in self.stance.robot.feet.values()]
        for component, part in enumerate(COMPONENTS):
            if part is None:
                continue
            each = [total - 2 * moment_arms[:, k, component] for k in range(len(sensors))]
            both = total - 2 * moment_arms[:, :, component].sum(axis=1)
            trials |= {
                f"column 'wrench.{sensor}.{part}'": one for sensor, one in zip(sensors, each, strict=True)
            }
            # A foot without load has nothing to reverse: the pair counts only where both take part.
            if usual(both) < 0.8 * min(usual(one) for one in each):
                trials[f"columns 'wrench.*.{part}'"] = both
        # As by software that gives what the robot does to the ground.
        trials["columns 'wrench.*.torque.*'"] = total - 2 * moment_arms[:, :, 3:].sum(axis=(1, 2))
        moving = usual(total - np.median(total, axis=0))
        return {
            name: usual(trial)
            for name, trial in trials.items()
            if usual(trial - np.median(trial, axis=0)) < BETTER * moving
        }

    def misread_joints(self, best: float) -> dict[str, str]:
        """Columns that explain the misfit far better than the `best` [m] of other changes, by how they are misread.

        A joint in degrees, or neighbours in a leg that are exchanged: both do where one of the two stands at zero.
        """
        stance, robot = self.stance, self.stance.robot
        degrees, exchanged = dict[str, StanceSides](), dict[str, StanceSides]()
        column = "'joint.{}.position'".format
        for foot in robot.feet.values():
            path = robot.joints_between(stance.imu.placement, foot.bush)
            leg = [place for place, name in enumerate(robot.joint_names) if name in path]
            for joint in leg:
                if np.abs(stance.positions[:, joint]).max() > AS_DEGREES:
                    trial = stance.scaled_joint(joint, np.pi / 180).sides()
                    degrees[f"column {column(robot.joint_names[joint])}"] = trial
            for first, second in pairwise(leg):
                if np.any(stance.positions[:, [first, second]]):
                    names = (column(robot.joint_names[place]) for place in (first, second))
                    exchanged[f"columns {' and '.join(names)}"] = stance.exchanged_joints(
                        first, second
                    ).sides()
        found = dict[str, str]()
        for tried, what in ((degrees, "read as degrees"), (exchanged, EXCHANGED)):
            left = {name: trial.misfit for name, trial in tried.items() if trial.lean < self._upright}
            least = min(left, key=left.__getitem__, default=None)
            if least is not None and left[least] < min(NOTABLE, BETTER * best):
                found[what] = least
        return found

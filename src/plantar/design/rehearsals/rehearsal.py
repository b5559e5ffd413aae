"""A motion played on the twin, at the stiffness that is told and at the ends of the range: what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from plantar.contact.polygon import edge_distances, edge_normals
from plantar.conventions import GRAVITY, ROTATIONAL_AXES, Array
from plantar.design.soft_feet import Softness
from plantar.design.soles import ends
from plantar.errors import MotionError, PlantarError
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import Plan
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.bush import Bush
from plantar.twin.play import roll_each
from plantar.twin.presets import DEFAULT, preset_named
from plantar.twin.recording import TwinRecording, record
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout

SEEDS: Final = 1000  # in a unit of the stiffness' factor: each rehearsal has its own draws of the sensors
DRAWS: Final = 4  # of each rehearsal: with other zeros and noise widths differ by up to twice
# s: a rehearsal steps twice as far as the twin, in half the time.
TIMESTEP: Final = 0.0005
# Such steps need a softer floor, as contacts last longer than one step.
FLOOR: Final = (1e6, 2e3, 0.95)


@dataclass(frozen=True)
class Rehearsal:
    """One rehearsal at `factor` times the stiffness that was told.

    `sole_margins`: least distance of a foot's centre of pressure from its sole's ends and from its sides [m], and
    `standing_margins` before it moves; `least_load`: of a
    foot, as a share of its load at rest; `friction`: largest share of horizontal to vertical force of a foot;
    `effort`: largest share of a joint's torque limit; `bend`: largest deflection [rad]. `fell`: why it could not be
    played; then the others are 0. `bushes`: by foot, pitch and roll (N, 2) [rad] at the plan's times. `yields`: by foot
    and axis, how far the floor tilts for each radian that the bush's spring bends: no robot's floor is so soft.
    `rollout`: how the robot moved in its `world`; `results`: what `identify feet` finds in recordings of it.
    """

    factor: float
    sole_margins: tuple[float, float] = (0.0, 0.0)
    standing_margins: tuple[float, float] = (0.0, 0.0)
    least_load: float = 0.0
    friction: float = 0.0
    effort: float = 0.0
    bend: float = 0.0
    fell: str | None = None
    bushes: Mapping[str, Array] = field(default_factory=dict, repr=False)
    yields: Mapping[tuple[str, str], float] = field(default_factory=dict)
    rollout: Rollout | None = field(default=None, repr=False)
    world: Physics | None = field(default=None, repr=False)
    results: tuple[FeetResult | None, ...] = field(default=(), repr=False)

    @property
    def sole_margin(self) -> float:
        """Of a foot's centre of pressure from the border of its sole [m]."""
        return min(self.sole_margins)

    def feet_found(self, robot: RobotModel, draws: int) -> tuple[FeetResult | None, ...]:
        """What `identify feet` finds in each of so many recordings; None where it finds nothing."""
        if self.rollout is None or self.world is None:
            return ()
        recordings = (_recorded(self.factor, robot, self.rollout, self.world, draw) for draw in range(draws))
        return tuple(_found(robot, each.log) for each in recordings)


def rehearse(
    robot: RobotModel,
    plan: Plan,
    told: Softness,
    factors: Sequence[float],
    progress: Callable[[str], None],
) -> list[Rehearsal]:
    """Play a plan on feet of `factors` times the stiffness told, on all cores, with the imperfections of the default
    preset."""
    preset = preset_named(DEFAULT)
    bushes = (dict.fromkeys(robot.feet, bush_of(told.times(factor))) for factor in factors)
    worlds = [replace(preset.physics(each, robot), timestep=TIMESTEP, floor=FLOOR) for each in bushes]
    progress(f"rehearse at {', '.join(f'{factor:.2g}' for factor in factors)} times the stiffness")
    rollouts = roll_each([(plan, world) for world in worlds], robot)
    found = []
    for factor, world, rollout in zip(factors, worlds, rollouts, strict=True):
        if isinstance(rollout, MotionError):
            found.append(Rehearsal(factor, fell=str(rollout)))
        else:
            found.append(_measured(factor, robot, rollout, world))
    return found


def _found(robot: RobotModel, log: MotionLog) -> FeetResult | None:
    try:
        return identify_feet(robot, [log])
    except PlantarError:
        return None


def bush_of(softness: Softness) -> Bush:
    """The twin's bush of a softness."""
    k, c = softness.stiffness, softness.damping
    return Bush(k, c, k, c, softness.vertical, softness.vertical_damping)


def _recorded(factor: float, robot: RobotModel, rollout: Rollout, world: Physics, draw: int) -> TwinRecording:
    return record(rollout, robot, world, preset_named(DEFAULT), round(SEEDS * factor) + draw)


def _measured(factor: float, robot: RobotModel, rollout: Rollout, world: Physics) -> Rehearsal:
    truth = _recorded(factor, robot, rollout, world, 0).truth.columns
    margins, standing = (np.full(2, np.inf) for _ in range(2))
    load, friction, bend = np.inf, 0.0, 0.0
    yields = dict[tuple[str, str], float]()
    weight = robot.mass * GRAVITY / len(robot.feet)
    for name, foot in robot.feet.items():
        pressure = np.column_stack([truth[f"{name}.contact.cop.{axis}"] for axis in "xy"])
        force = np.column_stack([truth[f"{name}.contact.force.{axis}"] for axis in "xyz"])
        carried = np.isfinite(pressure).all(axis=1)
        inside, at_ends = edge_distances(pressure, foot.sole.polygon), ends(edge_normals(foot.sole.polygon))
        inside = np.column_stack([inside[:, own].min(axis=1, initial=np.inf) for own in (at_ends, ~at_ends)])
        margins = np.minimum(margins, inside.min(axis=0) if carried.all() else -1.0)
        standing = np.minimum(standing, inside[0] if carried.all() else 0.0)
        load = min(load, float(force[:, 2].min()) / weight)
        sideways = np.linalg.norm(force[:, :2], axis=1) / np.maximum(force[:, 2], 1e-3)
        friction = max(friction, float(sideways.max()))
        bush = (world.bushes or {})[name]
        for axis, spring in zip(ROTATIONAL_AXES, (bush.pitch_stiffness, bush.roll_stiffness), strict=True):
            bend = max(bend, float(np.abs(truth[f"{name}.deflection.{axis}"]).max()))
            torque = truth[f"{name}.torque.{axis}"] - truth[f"{name}.torque.{axis}"].mean()
            yields[name, axis] = spring * float(torque @ truth[f"{name}.tilt.{axis}"] / (torque @ torque))
    bushes = {foot: bent[:, 1:] for foot, bent in rollout.bush.items()}
    limits = {body.joint: body.effort for body in describe(robot).bodies[1:]}
    effort = max(
        float(np.abs(rollout.efforts[:, place]).max()) / limits[joint]
        for place, joint in enumerate(rollout.joints)
    )
    near, at_rest = ((float(side[0]), float(side[1])) for side in (margins, standing))
    return Rehearsal(
        factor, near, at_rest, load, friction, effort, bend, None, bushes, yields, rollout, world
    )

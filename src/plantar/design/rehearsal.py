"""A motion played on the twin, at the stiffness that is told and at the ends of the range: what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from plantar.contact.polygon import edge_distances, edge_normals
from plantar.conventions import GRAVITY, NORMAL95, Array
from plantar.design.reach import ends
from plantar.design.soft_feet import Softness
from plantar.errors import MotionError, PlantarError
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import Plan
from plantar.results.feet import FeetResult, Parameter
from plantar.robot.model import RobotModel
from plantar.twin.bush import Bush
from plantar.twin.play import roll_each
from plantar.twin.presets import DEFAULT, preset_named
from plantar.twin.recording import TwinRecording, record
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.rollout import Rollout

GO_WITH_TIME: Final = ("noise", "slip angle")  # causes of which a longer motion of this kind leaves less
DRAWS: Final = 1000  # of the sensors in a unit of the stiffness' factor: each rehearsal has its own
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
    played; then the others are 0. `bushes`: by foot, pitch and roll (N, 2) [rad] at the plan's times. `log`: what the
    robot recorded; `result`: what `identify feet` finds in it.
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
    log: MotionLog | None = field(default=None, repr=False)
    result: FeetResult | None = field(default=None, repr=False)

    @property
    def sole_margin(self) -> float:
        """Of a foot's centre of pressure from the border of its sole [m]."""
        return min(self.sole_margins)

    def feet_found(self, robot: RobotModel) -> FeetResult | None:
        """What `identify feet` finds in its recording; None where it finds nothing."""
        if self.log is None:
            return None
        try:
            return identify_feet(robot, [self.log])
        except PlantarError:
            return None

    def percent(self, foot: str, axis: str, name: str) -> float | None:
        """95 % half width of a parameter [% of its value]; None where it is not identified."""
        row = self._row(foot, axis, name)
        if row is None or row.interval95 is None or not row.value:
            return None
        return 50 * (row.interval95[1] - row.interval95[0]) / abs(row.value)

    def of_noise(self, foot: str, axis: str, name: str) -> float | None:
        """What noise and drift make of that half width [% of the value]: it goes with the root of the duration."""
        rows = () if self.result is None else self.result.diagnosis
        own = (row for row in rows if (row.foot, row.axis, row.name) == (foot, axis, name))
        shares = next((row.variance_shares for row in own), {})
        share, half = sum(shares.get(cause, 0.0) for cause in GO_WITH_TIME), self.percent(foot, axis, name)
        return float(half * np.sqrt(share)) if share > 0 and half is not None else None

    def error(self, foot: str, axis: str, name: str, truth: float) -> float | None:
        """By how much a parameter came out too large [% of the `truth` at the stiffness told]."""
        row = self._row(foot, axis, name)
        return None if row is None or row.value is None else 100 * (row.value / (self.factor * truth) - 1)

    def usable(self, foot: str, axis: str, name: str) -> bool:
        """Whether the result calls a parameter usable."""
        row = self._row(foot, axis, name)
        return row is not None and row.verdict == "usable"

    def delay(self) -> tuple[float, float] | None:
        """Half width of the force sensors' delay and its error [s]; None where the recording does not show it."""
        found = None if self.result is None else self.result.sensor_delay
        if found is None or not found.measured:
            return None
        return NORMAL95 * found.std, found.wrench_delay - preset_named(DEFAULT).sensors.wrench_delay

    def vertical(self, truth: float) -> tuple[float, float] | None:
        """Half width and error [%] of the sum of both feet's vertical compliances, each 1/`truth` [N/m]; None where the
        recording does not show it."""
        rows = [self._row(foot, "z", "stiffness") for foot in ("left", "right")]
        known = [row for row in rows if row is not None and row.value and row.interval95 is not None]
        if len(known) < len(rows):
            return None
        total = sum(1 / row.value for row in known if row.value)
        low, high = (sum(1 / row.interval95[end] for row in known if row.interval95) for end in (1, 0))
        return 50 * (high - low) / total, 100 * (total * truth / len(known) - 1)

    def _row(self, foot: str, axis: str, name: str) -> Parameter | None:
        rows = () if self.result is None else self.result.parameters
        return next((row for row in rows if (row.foot, row.axis, row.name) == (foot, axis, name)), None)


def rehearse(
    robot: RobotModel,
    plan: Plan,
    told: Softness,
    factors: Sequence[float],
    progress: Callable[[str], None] = lambda _: None,
) -> list[Rehearsal]:
    """Play a plan on feet of `factors` times the stiffness told, on all cores, with the imperfections of the default
    preset."""
    preset = preset_named(DEFAULT)
    worlds = [
        replace(
            preset.physics(dict.fromkeys(robot.feet, bush_of(told.times(factor))), robot),
            timestep=TIMESTEP,
            floor=FLOOR,
        )
        for factor in factors
    ]
    progress(f"rehearse at {', '.join(f'{factor:.2g}' for factor in factors)} times the stiffness")
    rollouts = roll_each([(plan, world) for world in worlds], robot)
    found = []
    for factor, world, rollout in zip(factors, worlds, rollouts, strict=True):
        if isinstance(rollout, MotionError):
            found.append(Rehearsal(factor, fell=str(rollout)))
            continue
        recording = record(rollout, robot, world, preset, round(DRAWS * factor))
        found.append(_measured(factor, robot, rollout, recording))
    return found


def bush_of(softness: Softness) -> Bush:
    """The twin's bush of a softness."""
    k, c = softness.stiffness, softness.damping
    return Bush(k, c, k, c, softness.vertical, softness.vertical_damping)


def _measured(factor: float, robot: RobotModel, rollout: Rollout, recording: TwinRecording) -> Rehearsal:
    truth = recording.truth.columns
    margins, standing = (np.full(2, np.inf) for _ in range(2))
    load, friction, bend = np.inf, 0.0, 0.0
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
        bend = max(
            bend, *(float(np.abs(truth[f"{name}.deflection.{axis}"]).max()) for axis in ("pitch", "roll"))
        )
    bushes = {foot: bent[:, 1:] for foot, bent in rollout.bush.items()}
    limits = {body.joint: body.effort for body in describe(robot).bodies[1:]}
    effort = max(
        float(np.abs(rollout.efforts[:, place]).max()) / limits[joint]
        for place, joint in enumerate(rollout.joints)
    )
    near, at_rest = ((float(side[0]), float(side[1])) for side in (margins, standing))
    return Rehearsal(factor, near, at_rest, load, friction, effort, bend, bushes=bushes, log=recording.log)

"""Logs played in MuJoCo on several kinds of feet, and how far each is from the record."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from plantar.comparison.scenes import RIGID, Played, scenes
from plantar.comparison.tipping import on_an_edge
from plantar.errors import DataError, MotionError, RobotError
from plantar.exporters.job import USUAL, Stance
from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import Plan
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import stored_delay
from plantar.sensors.moments.bent_joints import put_straight, stored_bends
from plantar.twin.log_at import log_at
from plantar.twin.play import on_cores
from plantar.twin.replay import Replayed, beside, plan_of, plan_times, record_of
from plantar.twin.simulation.rollout import Rollout, roll_out

SIMULATORS: Final = ("mujoco",)
BEFORE: Final = 1.0  # s before a fall that are not scored: the robot is on its way down
SHORTEST: Final = 2.0  # s that are worth a score; the first one holds the zeros of the torques
Progress = Callable[[str], None]


@dataclass(frozen=True)
class KindScore:
    """One kind of feet in one motion: root mean square error of the chest's pitch and roll [rad], mean absolute error
    of the feet's torques [N·m], the mean over feet and axes; None where nothing is left to score.

    `until`: the time that is scored [s], the same for all kinds: to the end, or to `BEFORE` seconds before the first of
    them fell. `fell`: when this one fell [s], None where it stood to the end. `tips`: when a sole of the record first
    stands on its edge [s], None where none does; `flat_chest`: pitch and roll together up to then [rad].
    """

    motion: str
    feet: str
    chest_pitch: float | None
    chest_roll: float | None
    torque: float | None
    until: float
    fell: float | None
    tips: float | None = None
    flat_chest: float | None = None

    @property
    def chest(self) -> float | None:
        """Pitch and roll together [rad]."""
        if self.chest_pitch is None or self.chest_roll is None:
            return None
        return float(np.hypot(self.chest_pitch, self.chest_roll))


def compare(
    result: FeetResult,
    robot: RobotModel,
    logs: Sequence[MotionLog],
    progress: Progress = lambda _: None,
    swing: float | None = None,
    stance: Stance = USUAL,
) -> tuple[tuple[KindScore, ...], tuple[Replayed, ...]]:
    """Play each log's joints open loop on the model's rigid feet, on exported joints and on exported contact; where
    rubber slips or a sole tips, also on the contact with `FootHysteresis` in the loop.

    Args:
        result: of `identify_feet`. robot: that the logs are of. logs: with an attitude of the IMU.
        progress: is told each motion that is done. swing [rad], stance: as of `plantar.export`, for the
            contact.

    Returns:
        A score for each motion and kind, and what was simulated beside what was recorded, where no robot fell.

    Raises RobotError: a robot that cannot stand and move, or not one of the result's feet. DataError: a log without
    attitude, or in which no foot carries. ExportError: feet that cannot be exported.
    """
    _check(result, robot)
    scores: list[KindScore] = []
    found: list[Replayed] = []
    edges = [on_an_edge(robot, log) for log in logs]
    tipping = any(one is not None for one in edges)  # in one log: then all have the same kinds
    for log, tips in zip(logs, edges, strict=True):
        if not any(log.has(f"joint.{name}.position") for name in robot.joint_names):
            raise DataError("holds no joints to play", path=log.source)
        plan = plan_of(robot, _straight(result, robot, log))
        if plan.time[-1] < SHORTEST:
            valid = f"{SHORTEST:g} s or more"
            raise DataError(
                "is too short to compare", path=log.source, value=float(plan.time[-1]), valid=valid
            )
        record = record_of(robot, log, plan)  # before anything is played: a log may hold no attitude
        made = scenes(result, robot, plan, swing, stance, tipping)
        played = _played(robot, plan, made)
        fell = {kind: one.fell for kind, one in played.items() if isinstance(one, MotionError)}
        falls = [time for time in fell.values() if time is not None]
        if falls and (until := min(falls) - BEFORE) > SHORTEST:
            plan = _cut(plan, until)
            record, played = record_of(robot, log, plan), _played(robot, plan, made)
        for kind, one in played.items():
            if isinstance(one, MotionError):
                scores.append(KindScore(log.name, kind, None, None, None, 0.0, one.fell))
                continue
            replayed = beside(robot, plan, kind, one, record)
            scores.append(_score(replayed, float(plan.time[-1]), fell.get(kind), tips))
            found.append(replayed)
        progress(f"played {log.name}")
    return tuple(scores), tuple(found)


def _straight(result: FeetResult, robot: RobotModel, log: MotionLog) -> MotionLog:
    """The log with its joints where their links were, of a robot whose joints bend beyond their encoders."""
    if not result.joint_compliance:
        return log
    bends, even = stored_bends(robot, result.joint_compliance), log_at(log, log.time[0] + plan_times(log))
    return put_straight(robot, even, bends, stored_delay(result.sensor_delay))


def _check(result: FeetResult, robot: RobotModel) -> None:
    feet = sorted({row.foot for row in result.parameters})
    if not robot.joint_names or not robot.feet or robot.base == "fixed":
        message = "what is played is a standing robot whose joints move"
        raise RobotError(message, path=robot.path, valid="a floating base, joints and feet")
    if missing := [foot for foot in feet if foot not in robot.feet]:
        message = f"the result is of feet called {', '.join(feet)}"
        raise RobotError(message, path=robot.path, value=missing[0], valid=", ".join(robot.feet))


def _played(robot: RobotModel, plan: Plan, made: Mapping[str, Played]) -> dict[str, Rollout | MotionError]:
    """A rollout for each kind of feet, or how the robot fell."""

    def rolled(kind: str) -> Rollout | MotionError:
        try:
            one = made[kind]
            base = plan.base - np.array([[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, one.lower], [0, 0, 0, 0]])
            return roll_out(robot, replace(plan, base=base), RIGID, one.xml, force=one.force)
        except MotionError as error:
            return error.with_traceback(None)  # which would keep the simulation

    return dict(zip(made, on_cores(rolled, tuple(made)), strict=True))


def _cut(plan: Plan, until: float) -> Plan:
    kept = plan.time <= until
    return replace(plan, time=plan.time[kept], positions=plan.positions[kept], base=plan.base[kept])


def _score(one: Replayed, until: float, fell: float | None, tips: float | None) -> KindScore:
    torque = float(np.mean([one.torque_error(foot, axis) for foot, axis in one.torque]))
    tips = tips if tips is not None and tips < until else None
    flat = until if tips is None else tips
    chest = float(np.hypot(*one.chest_error(flat))) if flat > SHORTEST else None
    return KindScore(one.motion, one.feet, *one.chest_error(), torque, until, fell, tips, chest)


def pooled(scores: Sequence[KindScore], kind: str, flat: bool = False) -> float | None:
    """Chest error of one kind over all motions, root mean square [rad]; None where one has no score.

    flat: only as long as no sole of the record stands on its edge.
    """
    errors = [one.flat_chest if flat else one.chest for one in scores if one.feet == kind]
    known = [error for error in errors if error is not None]
    return float(np.sqrt(np.mean(np.square(known)))) if known and len(known) == len(errors) else None

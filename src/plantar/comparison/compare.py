"""Logs played in MuJoCo on three kinds of feet, and how far each is from the record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.comparison.scenes import KINDS, RIGID, scenes
from plantar.errors import MotionError
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.play import on_cores
from plantar.twin.replay import Replayed, beside, plan_of, record_of
from plantar.twin.simulation.rollout import roll_out

SIMULATORS: Final = ("mujoco",)
Progress = Callable[[str], None]


@dataclass(frozen=True)
class KindScore:
    """One kind of feet in one motion: root mean square error of the chest's pitch and roll [rad], mean absolute error
    of the feet's torques [N·m], the mean over feet and axes; None where the robot falls."""

    motion: str
    feet: str
    chest_pitch: float | None
    chest_roll: float | None
    torque: float | None

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
) -> tuple[tuple[KindScore, ...], tuple[Replayed, ...]]:
    """Play each log's joints open loop on the model's rigid feet, on exported joints and on exported contact.

    Args:
        result: of `identify_feet`. robot: that the logs are of. logs: with an attitude of the IMU.
        progress: is told each motion that is done.

    Returns:
        A score for each motion and kind, and what was simulated beside what was recorded, where no robot fell.

    Raises DataError: a log without attitude, or in which no foot carries. ExportError: feet that cannot be exported.
    """
    scores: list[KindScore] = []
    found: list[Replayed] = []
    for log in logs:
        plan = plan_of(robot, log)
        record = record_of(robot, log, plan)
        made = scenes(result, robot, plan)

        def rolled(kind: str) -> Replayed | None:
            try:
                rollout = roll_out(robot, plan, RIGID, made[kind])  # noqa: B023 - used within this turn
            except MotionError:
                return None
            return beside(robot, plan, kind, rollout, record)  # noqa: B023

        for kind, one in zip(KINDS, on_cores(rolled, KINDS), strict=True):
            scores.append(_score(log.name, kind, one))
            found += [one] if one is not None else []
        progress(f"played {log.name}")
    return tuple(scores), tuple(found)


def _score(motion: str, kind: str, one: Replayed | None) -> KindScore:
    if one is None:
        return KindScore(motion, kind, None, None, None)
    torque = float(np.mean([one.torque_error(foot, axis) for foot, axis in one.torque]))
    return KindScore(motion, kind, *one.chest_error(), torque)


def pooled(scores: Sequence[KindScore], kind: str) -> float | None:
    """Chest error of one kind over all motions, root mean square [rad]; None where the robot falls in one."""
    errors = [one.chest for one in scores if one.feet == kind]
    known = [error for error in errors if error is not None]
    return float(np.sqrt(np.mean(np.square(known)))) if known and len(known) == len(errors) else None

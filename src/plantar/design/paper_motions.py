"""For comparison: the best of the paper's fourteen motions, on the twin of the same robot with the same feet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plantar.conventions import ROTATIONAL_AXES
from plantar.design.rehearsals.rehearsal import bush_of
from plantar.design.soft_feet import Softness
from plantar.errors import MotionError
from plantar.logs.motion_log import MotionLog
from plantar.models import KelvinVoigt
from plantar.motions.campaign import CAMPAIGN
from plantar.motions.plan import Plan
from plantar.motions.select_motions import Selection, select_motions
from plantar.robot.model import RobotModel
from plantar.twin.play import planned, roll_each
from plantar.twin.presets import DEFAULT, preset_named
from plantar.twin.recording import record


@dataclass(frozen=True)
class PaperMotions:
    """The motions that this robot can do, ranked; `refused`: why it cannot do the others; `best`: the plan of the most
    informative one that nobody pushes."""

    selection: Selection
    refused: dict[str, str]
    best: Plan

    def log(self, rate: float) -> MotionLog:
        """Joint positions of the best motion, `rate` [Hz]."""
        time = np.arange(round(self.best.time[-1] * rate) + 1) / rate
        columns = {
            f"joint.{joint}.position": np.interp(time, self.best.time, self.best.positions[:, place])
            for place, joint in enumerate(self.best.joints)
        }
        return MotionLog(self.best.name, time, columns)

    def half_widths(self) -> list[dict[str, object]]:
        """Of the best motion alone, and of the best set: rows of foot, axis, name and percent."""
        alone = next(choice for choice in self.selection.alone if choice.motions == (self.best.name,))
        whole = self.selection.best[-1]
        return [
            {"foot": foot, "axis": axis, "name": term, "percent": alone.half_width_percent[foot, axis, term],
             "best_set_percent": whole.half_width_percent[foot, axis, term]}
            for foot in sorted({foot for foot, _, _ in whole.half_width_percent})
            for axis in ROTATIONAL_AXES
            for term in KelvinVoigt().terms
        ]  # fmt: skip


def paper_motions(robot: RobotModel, told: Softness, progress: Callable[[str], None]) -> PaperMotions:
    """Play the fourteen and rank them as `plantar select` does. Raises MotionError where the robot can do none."""
    plans, refused = list[Plan](), dict[str, str]()
    for name in CAMPAIGN:
        progress(f"plan {name}")
        try:
            plans.append(planned(name, robot))
        except MotionError as error:
            refused[name] = str(error)
    preset = preset_named(DEFAULT)
    world = preset.physics(dict.fromkeys(robot.feet, bush_of(told)), robot)
    jobs = [(plan, world) for plan in plans]
    rollouts = roll_each(jobs, robot, lambda name, share: progress(f"play {name} {100 * share:.0f} %"))
    logs, played = list[MotionLog](), dict[str, Plan]()
    for plan, rollout in zip(plans, rollouts, strict=True):
        if isinstance(rollout, MotionError):
            refused[plan.name] = str(rollout)
            continue
        logs.append(record(rollout, robot, world, preset, 0).log)
        played[plan.name] = plan
    free = [name for name, plan in played.items() if plan.hand is None]
    if not free:
        message = "can do none of the paper's motions without a hand"
        raise MotionError(message, path=robot.name, valid="a design without --like")
    selection = select_motions(robot, logs, progress=progress)
    best = next(choice.motions[0] for choice in selection.alone if choice.motions[0] in free)
    return PaperMotions(selection, refused, played[best])

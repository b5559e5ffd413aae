"""Motions played on the twin: planned, checked, rolled out on both cores, recorded."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from plantar.motions.campaign import Postures, plan_motion
from plantar.motions.plan import Plan
from plantar.robot import RobotModel
from plantar.twin import cache, hrp2
from plantar.twin.bush import PAPER, Feet
from plantar.twin.keep import plan_arrays, plan_from, plan_key, rollout_arrays, rollout_from, rollout_key
from plantar.twin.physics import Physics
from plantar.twin.presets import DEFAULT, preset_named
from plantar.twin.recording import TwinRecording, record
from plantar.twin.rollout import Rollout, roll_out, scene_xml

Progress = Callable[[str, float], None]  # motion, share done


def play(
    motion: str | Plan,
    robot: RobotModel | None = None,
    bushes: Feet | None = PAPER,
    preset: str = DEFAULT,
    seed: int = 0,
) -> TwinRecording:
    """Play one motion on the twin and record it.

    `robot`: the HRP-2-like robot where None. `bushes`: by foot; None stands on rigid feet. `preset`: see
    `PRESETS`. Raises MotionError when the motion cannot be played.
    """
    return play_all([motion], robot, bushes, preset, [seed])[0][0]


def play_all(
    motions: Sequence[str | Plan],
    robot: RobotModel | None = None,
    bushes: Feet | None = PAPER,
    preset: str = DEFAULT,
    seeds: Iterable[int] = (0,),
    progress: Progress | None = None,
) -> list[list[TwinRecording]]:
    """Play motions on both cores; one list of recordings for each seed, from one rollout a motion."""
    robot = robot or hrp2.robot()
    chosen = preset_named(preset)
    physics = chosen.physics(bushes)
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        rollouts = list(pool.map(lambda motion: _roll(motion, robot, physics, progress), motions))
    return [[record(rollout, robot, physics, chosen, seed) for rollout in rollouts] for seed in seeds]


def write_campaign(
    directory: str | os.PathLike[str], recordings: Iterable[TwinRecording], robot: RobotModel | None = None
) -> Path:
    """Write the robot file with its URDF, and each recording's log and truth; returns the robot file's path."""
    directory = Path(directory)
    for recording in recordings:
        recording.write(directory)
    return hrp2.write(directory) if robot is None else robot.path


def postures_of(robot: RobotModel) -> Postures:
    """Where the motions of a robot start: the published postures for HRP-2, bent knees for others."""
    return hrp2.postures() if robot.name == hrp2.NAME else Postures()


def planned(name: str, robot: RobotModel, **options: float | None) -> Plan:
    """`plan_motion` from the robot's own postures, kept in the cache."""
    postures = postures_of(robot)
    key = plan_key(name, robot, postures, options)
    if (kept := cache.load(key)) is not None:
        return plan_from(name, kept)
    plan = plan_motion(name, robot, postures, **options)
    cache.save(key, plan_arrays(plan))
    return plan


def rolled(
    plan: Plan, robot: RobotModel, physics: Physics, progress: Callable[[float], None] | None = None
) -> Rollout:
    """`roll_out` on the scene of `physics`, kept in the cache."""
    xml = scene_xml(robot, plan, physics, hrp2.look(robot))
    key = rollout_key(plan, physics, xml)
    if (kept := cache.load(key)) is not None:
        return rollout_from(plan.name, kept)
    rollout = roll_out(robot, plan, physics, xml, progress)
    cache.save(key, rollout_arrays(rollout))
    return rollout


def _roll(motion: str | Plan, robot: RobotModel, physics: Physics, progress: Progress | None) -> Rollout:
    plan = motion if isinstance(motion, Plan) else planned(motion, robot)
    report = None if progress is None else partial(progress, plan.name)
    rollout = rolled(plan, robot, physics, report)
    if report is not None:
        report(1.0)
    return rollout

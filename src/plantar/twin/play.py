"""Motions played on the twin: planned, checked, rolled out on both cores, recorded."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import CancelledError, ThreadPoolExecutor
from pathlib import Path
from threading import Event
from typing import TypeVar

from plantar.errors import MotionError
from plantar.motions.campaign import Postures, plan_motion
from plantar.motions.plan import Plan
from plantar.robot.model import RobotModel, load_robot
from plantar.twin import cache
from plantar.twin.bush import PAPER, Feet
from plantar.twin.keep import plan_arrays, plan_from, plan_key, rollout_arrays, rollout_from, rollout_key
from plantar.twin.presets import DEFAULT, Preset, preset_named
from plantar.twin.recording import TwinRecording, record
from plantar.twin.robots import hrp2
from plantar.twin.robots.true_robot import RobotSpread, true_robot
from plantar.twin.sensing.logger import write_robot
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout, roll_out, scene_xml

Progress = Callable[[str, float], None]  # motion, share done
Share = Callable[[float], None]
Job = TypeVar("Job")
Done = TypeVar("Done")


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
    *,
    sway: float | None = None,
    vertical: float | None = None,
    apart: float | None = None,
    period: float | None = None,
) -> list[list[TwinRecording]]:
    """Play motions on both cores; one list of recordings for each seed, from one rollout a motion.

    A preset that draws robots (`imperfect`) plays each seed on a robot of its own, whose file stays as it is.

    `sway`, `vertical`, `apart`, `period`: sizes of the motions given by name, see `plan_motion`. Raises MotionError,
    before anything is played, where one of them cannot be.
    """
    robot, names = robot or hrp2.robot(), list(motions)
    chosen = preset_named(preset)
    physics = chosen.physics(bushes, robot)

    def plan(motion: str | Plan) -> Plan:
        if isinstance(motion, Plan):
            return motion
        return planned(motion, robot, sway=sway, vertical=vertical, apart=apart, period=period)

    plans = on_cores(plan, names)
    if chosen.robot is not None:
        return [_of_true_robot(plans, robot, physics, chosen, seed, progress) for seed in seeds]
    rollouts = roll_all([(plan, physics) for plan in plans], robot, progress)
    return [[record(rollout, robot, physics, chosen, seed) for rollout in rollouts] for seed in seeds]


def _of_true_robot(
    plans: Sequence[Plan],
    robot: RobotModel,
    physics: Physics,
    preset: Preset,
    seed: int,
    progress: Progress | None,
) -> list[TwinRecording]:
    """Plans made for a robot file, played by the robot that stands behind it in this seed.

    Every recording has rubber of its own temperature, so that each is simulated for itself.
    """
    own, drawn = true_robot(robot, preset.robot or RobotSpread(), seed)
    worlds = [physics.stiffened(preset.stiffening(seed, plan.name)) for plan in plans]
    rollouts = roll_all(list(zip(plans, worlds, strict=True)), own, progress)
    return [
        record(rollout, own, world, preset, seed, drawn)
        for rollout, world in zip(rollouts, worlds, strict=True)
    ]


def roll_all(
    played: Sequence[tuple[Plan, Physics]], robot: RobotModel, progress: Progress | None = None
) -> list[Rollout]:
    """Roll out plans, each in its own world, on all cores; the first error stops the others."""
    return _rolled_on_cores(played, robot, progress, rolled)


def roll_each(
    played: Sequence[tuple[Plan, Physics]], robot: RobotModel, progress: Progress | None = None
) -> list[Rollout | MotionError]:
    """The same, but a robot that falls stops no other: its error stands in the place of its rollout."""

    def tried(plan: Plan, robot: RobotModel, physics: Physics, report: Share) -> Rollout | MotionError:
        try:
            return rolled(plan, robot, physics, report)
        except MotionError as error:
            return error

    return _rolled_on_cores(played, robot, progress, tried)


def _rolled_on_cores(
    played: Sequence[tuple[Plan, Physics]],
    robot: RobotModel,
    progress: Progress | None,
    way: Callable[[Plan, RobotModel, Physics, Share], Done],
) -> list[Done]:
    """`way` on every job; after an error the others stop at their next second of motion."""
    stop = Event()

    def roll(job: tuple[Plan, Physics]) -> Done:
        plan, physics = job

        def report(share: float) -> None:
            if stop.is_set():
                raise CancelledError
            if progress is not None:
                progress(plan.name, share)

        done = way(plan, robot, physics, report)
        report(1.0)
        return done

    try:
        return on_cores(roll, played)
    finally:
        stop.set()


def on_cores(work: Callable[[Job], Done], jobs: Sequence[Job]) -> list[Done]:
    """`work` on every job, as many at a time as there are cores, in the jobs' order.

    For work that releases the GIL. After an error the jobs that have not begun are dropped.
    """
    pool = ThreadPoolExecutor(os.cpu_count() or 1)
    futures = [pool.submit(work, job) for job in jobs]
    try:
        return [future.result() for future in futures]
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def write_campaign(
    directory: str | os.PathLike[str],
    recordings: Iterable[TwinRecording],
    robot: RobotModel | None = None,
    preset: str = DEFAULT,
) -> Path:
    """Write the robot file with its URDF, and each recording's log and truth; returns the robot file's path.

    A robot of one's own has its file copied to `robot.yaml`, unless it lies there already; where the preset's log has
    another IMU, the copy is named after the preset.
    """
    directory = Path(directory)
    for recording in recordings:
        recording.write(directory)
    logged = preset_named(preset).logger is not None
    if robot is None:
        built_in = hrp2.write(directory)
        return write_robot(load_robot(built_in), built_in, True) if logged else built_in
    if not logged and robot.path.parent.resolve() == directory.resolve():
        return robot.path
    file = directory / (f"{robot.path.stem}_{preset}.yaml" if logged else "robot.yaml")
    return write_robot(robot, file, logged)


def postures_of(robot: RobotModel) -> Postures:
    """Where the motions of a robot start: the published postures for HRP-2, bent knees for others."""
    return Postures() if hrp2.look(robot) is None else hrp2.postures()


def planned(name: str, robot: RobotModel, **options: float | None) -> Plan:
    """`plan_motion` from the robot's own postures, kept in the cache."""
    postures = postures_of(robot)
    options = {option: size for option, size in options.items() if size is not None}
    key = plan_key(name, robot, postures, options)
    return plan_from(
        name, cache.kept(key, lambda: plan_arrays(plan_motion(name, robot, postures, **options)))
    )


def rolled(plan: Plan, robot: RobotModel, physics: Physics, progress: Share | None = None) -> Rollout:
    """`roll_out` on the scene of `physics`, kept in the cache."""
    xml = scene_xml(robot, plan, physics, hrp2.look(robot))
    key = rollout_key(plan, physics, xml)
    made = cache.kept(key, lambda: rollout_arrays(roll_out(robot, plan, physics, xml, progress)))
    return rollout_from(plan.name, made)

"""Short plans and rollouts of the twin, kept in the session's cache, so that its tests take seconds."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog
from plantar.motions import Plan, Walk
from plantar.motions.body import Body
from plantar.motions.gait import Gait
from plantar.motions.stance import stand
from plantar.motions.walk import walk_plan
from plantar.robot.model import RobotModel
from plantar.twin import cache
from plantar.twin.keep import plan_arrays, plan_from
from plantar.twin.play import planned, rolled
from plantar.twin.presets import preset_named
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout, roll_out, scene_xml


def short(plan: Plan, start: float, end: float) -> Plan:
    """The part of a plan between two times [s], on a time base that starts at 0."""
    rows = (plan.time >= start) & (plan.time < end)
    hand = None if plan.hand is None else replace(plan.hand, path=plan.hand.path[rows])
    walk = plan.walk and Walk(
        {foot: poses[rows] for foot, poses in plan.walk.soles.items()},
        {foot: stands[rows] for foot, stands in plan.walk.stands.items()},
        plan.walk.zmp[rows],
        plan.walk.centre[rows],
    )
    return replace(
        plan,
        time=np.arange(rows.sum()) / 200.0,
        positions=plan.positions[rows],
        base=plan.base[rows],
        hand=hand,
        walk=walk,
    )


SETTLED = Physics(settle=1.0)  # soon enough for seconds of a motion
PARTS = {"Tilt3": (14.5, 34.5), "Squat": (0.0, 10.0)}  # s: from leaning forward to leaning aside; two bows


def planned_part(motion: str, robot: RobotModel, **options: float | None) -> Plan:
    """As `planned`, what shows all that the motion has to show in half of its time."""
    return short(planned(motion, robot, **options), *PARTS[motion])


@functools.cache
def plan(motion: str) -> Plan:
    return planned(motion, hrp2.robot())


def roll(played: Plan, physics: Physics | None = None) -> Rollout:
    physics = physics or Physics()
    return roll_out(hrp2.robot(), played, physics, scene_xml(hrp2.robot(), played, physics))


@functools.cache
def swayed() -> Rollout:
    """Six seconds of the right foot's manual roll on the paper's bushes."""
    return rolled(short(plan("Manual_right_roll"), 10.0, 16.0), hrp2.robot(), SETTLED)


@functools.cache
def tilted() -> Rollout:
    """Four seconds of Tilt3 on the paper's bushes."""
    return rolled(short(plan("Tilt3"), 2.0, 6.0), hrp2.robot(), SETTLED)


@functools.cache
def flung() -> Rollout:
    """Three seconds of Myrand5 on the paper's bushes."""
    return rolled(short(plan("Myrand5"), 10.0, 13.0), hrp2.robot(), SETTLED)


@functools.cache
def walked() -> MotionLog:
    """Ten steps of 15 cm, read by sensors with noise and offsets; each foot was zeroed in the air."""
    robot, gait = hrp2.robot(), Gait(step=0.15, period=0.9, turn=0.0, steps=10, trial=1)

    def made() -> Mapping[str, Array]:
        body = Body(robot)
        return plan_arrays(walk_plan(body, "Walk15", stand(body, hrp2.postures().standing, {}), gait))

    played = plan_from("Walk15", cache.kept(cache.key("walk", repr(gait)), made))
    return record(rolled(played, robot, Physics()), robot, Physics(), preset_named("sensors"), 0).log

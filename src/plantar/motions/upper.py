"""Sweeps of the upper limbs while the legs keep still: the paper's Myrand motions."""

from __future__ import annotations

import numpy as np

from plantar.motions.body import Body
from plantar.motions.plan import RATE, Plan
from plantar.motions.profile import sweep
from plantar.motions.stance import Stance
from plantar.motions.track import splined

DURATION = 40.0  # s
LOW, HIGH = 0.1, 0.8  # Hz: quicker arms make the robot stamp
AMPLITUDE = 0.35  # rad, less where a limit is near
ROOM = 0.8  # of the way to the nearer limit at most


def sweep_plan(body: Body, name: str, start: Stance, variant: int) -> Plan:
    """Every joint that no foot stands on sweeps from 0.1 to 0.8 Hz, each at its own time and sense.

    Two variants differ in the order of the joints and their senses. Legs stay as they are.
    """
    time = np.arange(round(DURATION * RATE) + 1) / RATE
    found = np.tile(start.configuration, (time.size, 1))
    random = np.random.default_rng(variant)
    for joint in upper_joints(body):
        place = body.model.joints[body.model.getJointId(joint)].idx_q
        centre = start.configuration[place]
        low, high = body.model.lowerPositionLimit[place], body.model.upperPositionLimit[place]
        speed = body.model.upperVelocityLimit[body.model.joints[body.model.getJointId(joint)].idx_v]
        room = max(min(high - centre, centre - low), 0.0)
        swing = min(AMPLITUDE, ROOM * room, 0.5 * speed / (2 * np.pi * HIGH))
        begin, sense = random.uniform(1.0, 8.0), random.choice([-1.0, 1.0])
        end = random.uniform(DURATION - 9.0, DURATION - 1.0)
        found[:, place] += sense * swing * sweep(time, begin, end, LOW, HIGH)
    return splined(body, name, start, time, found)


def upper_joints(body: Body) -> list[str]:
    """Joints that carry neither foot, of one degree of freedom."""
    carrying: set[int] = set()
    for foot in body.robot.feet:
        frame = body.model.frames[body.model.getFrameId(body.sole(foot))]
        carrying |= set(body.model.supports[frame.parentJoint])
    return [
        body.model.names[joint]
        for joint in range(2, body.model.njoints)
        if joint not in carrying and body.model.joints[joint].nq == 1
    ]

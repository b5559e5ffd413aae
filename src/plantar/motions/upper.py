"""Sweeps of the upper limbs while the legs keep still: the paper's Myrand motions."""

from __future__ import annotations

import numpy as np

from plantar.motions.body import Body
from plantar.motions.feasible import planned_zmp
from plantar.motions.plan import RATE, Plan
from plantar.motions.profile import sweep
from plantar.motions.stance import Stance
from plantar.motions.track import splined

DURATION = 40.0  # s
LOW = 0.1  # Hz, at which a sweep begins
# Variant -> fastest sweep [Hz] and amplitude [rad], less where a limit is near. Quicker arms make the robot stamp; near
# 0.5 Hz the robot resonates on its bushes, and one draw of the senses there tips it over: that one stays below.
SWEEPS = {4: (0.4, 0.3), 5: (0.8, 0.35)}
ROOM = 0.8  # of the way to the nearer limit at most
# Of the support polygon's half length and width: how far the arms may lead the ZMP of a robot on rigid feet. A robot
# that stands on bushes answers several times as far where a sweep passes its resonance.
LED = 0.32


def sweep_plan(body: Body, name: str, start: Stance, variant: int) -> Plan:
    """Every joint that no foot stands on sweeps up from 0.1 Hz, each at its own time and sense; legs stay as they are.

    Two variants differ in the order of the joints, their senses, and how fast and far they go (SWEEPS); all swings
    are less by one factor on a robot whose arms would lead its ZMP too far (LED).
    """
    fastest, amplitude = SWEEPS[variant]
    time = np.arange(round(DURATION * RATE) + 1) / RATE
    found = np.tile(start.configuration, (time.size, 1))
    random = np.random.default_rng(variant)
    for joint in upper_joints(body):
        place = body.model.joints[body.model.getJointId(joint)].idx_q
        centre = start.configuration[place]
        low, high = body.model.lowerPositionLimit[place], body.model.upperPositionLimit[place]
        speed = body.model.upperVelocityLimit[body.model.joints[body.model.getJointId(joint)].idx_v]
        room = max(min(high - centre, centre - low), 0.0)
        swing = min(amplitude, ROOM * room, 0.5 * speed / (2 * np.pi * fastest))
        begin, sense = random.uniform(1.0, 8.0), random.choice([-1.0, 1.0])
        end = random.uniform(DURATION - 9.0, DURATION - 1.0)
        found[:, place] += sense * swing * sweep(time, begin, end, LOW, fastest)
    plan = splined(body, name, start, time, found)
    gentler = _gentler(body, plan)
    if gentler < 1:
        plan = splined(body, name, start, time, start.configuration + gentler * (found - start.configuration))
    return plan


def _gentler(body: Body, plan: Plan) -> float:
    """Share of the swings with which the planned ZMP stays near where it starts; 1 where it does so already."""
    balance = planned_zmp(body, plan)
    led = np.abs(balance.zmp - balance.zmp[0]).max(axis=0)
    half = np.ptp(balance.polygon, axis=0) / 2
    return float(min(1.0, *(LED * half / np.maximum(led, 1e-9))))


def upper_joints(body: Body) -> list[str]:
    """Joints that carry neither foot, of one degree of freedom."""
    return [
        body.model.names[joint]
        for joint in range(2, body.model.njoints)
        if joint not in body.leg_joints and body.model.joints[joint].nq == 1
    ]

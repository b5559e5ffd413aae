"""Motions of the chest over feet that both stand: the paper's tilts, and squats."""

from __future__ import annotations

from functools import partial

import numpy as np
import pinocchio as pin
from pink.tasks import Task

from plantar.conventions import Array
from plantar.motions.body import CHEST, Body
from plantar.motions.footsteps import REST
from plantar.motions.plan import Plan
from plantar.motions.profile import bows, cycles
from plantar.motions.stance import Stance
from plantar.motions.track import track

PERIOD = 10.0  # s
SQUAT_PERIOD = 4.0  # s
SQUATS = 4  # of one motion


def tilt_plan(body: Body, name: str, start: Stance, sway: float, vertical: float) -> Plan:
    """The chest sways by `sway` [m] forward and backward twice, then left and right twice, at 0.1 Hz.

    `vertical`: how far the chest goes down and up again in each period [m].
    """
    duration = 2 * REST + 4 * PERIOD

    def displacement(time: Array) -> Array:
        x = sway * cycles(time, REST, PERIOD, 2)
        y = sway * cycles(time, REST + 2 * PERIOD, PERIOD, 2)
        return np.column_stack([x, y, -vertical * bows(time, REST, PERIOD, 4)])

    chest = body.pose(start.configuration, CHEST)

    def tasks(offset: Array) -> list[Task]:
        return [body.chest_task(pin.SE3(chest.rotation, chest.translation + offset))]

    return track(body, name, start, duration, displacement, tasks)


def squat_plan(body: Body, name: str, start: Stance, depth: float) -> Plan:
    """Knees bend until the chest is `depth` [m] lower, the centre of mass stays over its place."""
    duration = 2 * REST + SQUATS * SQUAT_PERIOD

    def displacement(time: Array) -> Array:
        down = -depth * bows(time, REST, SQUAT_PERIOD, SQUATS)
        return np.column_stack([np.zeros_like(time), np.zeros_like(time), down])

    return track(body, name, start, duration, displacement, partial(_squat_tasks, body, start))


def _squat_tasks(body: Body, start: Stance, offset: Array) -> list[Task]:
    chest = body.pose(start.configuration, CHEST)
    keep = body.chest_task(pin.SE3(chest.rotation, chest.translation + offset))
    keep.set_position_cost([0.0, 0.0, 10.0])
    return [keep, body.centre_task(body.centre_of_mass(start.configuration))]

"""Motions in which an operator moves a robot that keeps still: the paper's manual sways."""

from __future__ import annotations

from typing import Literal

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.motions.body import Body
from plantar.motions.plan import RATE, Hand, Plan
from plantar.motions.profile import window
from plantar.motions.stance import Stance
from plantar.motions.track import still
from plantar.robot.model import Placement

DURATION = 36.0  # s
RAMP = 3.0  # s
ALONG, ACROSS = (
    0.72,
    0.9,
)  # of the sole's half length and width: how far the operator leads the centre of mass
ROOM = 0.008  # m, kept to the edge even by soles so narrow that the shares would leave less
STEADIED = 520.0  # N·m, weight times height of a robot that a hand can lead so far; a heavier one less
ASIDE = 0.2  # of the sway goes across the wanted axis: no hand moves in a plane
TEMPOS = (0.23, 0.41, 0.67)  # Hz: slow, brisk and quick swings of one hand
SHARES = (0.5, 0.35, 0.15)  # of the swing that each of them has


def manual_plan(
    body: Body, name: str, start: Stance, axis: Literal["pitch", "roll"], sway: Array | None
) -> Plan:
    """The operator holds the chest and sways it: forward and backward (pitch) or left and right (roll).

    `sway` (x, y) [m] at the chest; without one, the centre of mass goes most of the way to the sole's edge.
    """
    time = np.arange(round(DURATION * RATE) + 1) / RATE
    held = Placement(body.chest_link, np.array([0.0, 0.0, 0.1]), np.zeros(3))
    grip = _grip(body, start.configuration, held)
    reach = _reach(body, start, grip[2]) if sway is None else sway
    swing = hand_swing(time, phase=0.0), ASIDE * hand_swing(time, phase=1.3)
    x, y = (swing[0], swing[1]) if axis == "pitch" else (swing[1], swing[0])
    path = grip + np.column_stack([reach[0] * x, reach[1] * y, np.zeros_like(time)])
    return still(body, name, start, DURATION, Hand(held, path))


def hand_swing(time: Array, phase: float) -> Array:
    """A hand's swing of at most 1: three tempos that drift against each other, easing in and out."""
    swing = np.zeros_like(time)
    for place, (tempo, share) in enumerate(zip(TEMPOS, SHARES, strict=True)):
        drift = 0.3 * np.sin(2 * np.pi * time / (11.0 + 3 * place) + phase)
        swing += share * np.sin(2 * np.pi * tempo * time + drift + phase * (place + 1))
    return swing * window(time, 0.5, time[-1] - 0.5, RAMP)


def _grip(body: Body, q: Array, held: Placement) -> Array:
    joint, pose = body.robot.frame(held)
    name = body.robot.model.names[joint] if joint else body.model.names[1]
    body.centre_of_mass(q)
    return np.array((body.data.oMi[body.model.getJointId(name)] * pose).translation)


def _reach(body: Body, start: Stance, height: float) -> Array:
    """Sway of the hand (x, y) [m] that leads the centre of mass most of the way to the sole's edge."""
    soles = [body.robot.feet[name].sole.polygon for name in start.standing]
    half = np.min([np.ptp(polygon, axis=0) / 2 for polygon in soles], axis=0)
    centre = body.centre_of_mass(start.configuration)[2]
    led = np.minimum([ALONG, ACROSS] * half, half - ROOM)
    return np.asarray(led * min(1.0, STEADIED / (body.robot.mass * GRAVITY * centre)) * height / centre)

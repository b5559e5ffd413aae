"""Seconds in which a sole slides: from the closed chain where both stand, and from the IMU's acceleration."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from plantar.contact.phases import DOUBLE, SUPPORTS, FootContact, widened
from plantar.contact.reasons import EDGES, Reason
from plantar.contact.relative_pose import relative_pose
from plantar.contact.slip_indicator import (
    SlipIndicator,
    apart_speed,
    as_usual,
    slides,
    turning,
    twist_speed,
    unresisted,
)
from plantar.conventions import Array, Mask
from plantar.feet.exclusion.sole_velocity import SoleMotion, friction, sole_motion
from plantar.feet.recording import Recording
from plantar.robot.model import RobotModel
from plantar.signals.segments import runs

AFTER = 0.05  # s before and behind a lean: a place is computed for a level sole
# m/s: a speed between soles, or of a turning one, that says so much as one deviation of the IMU's.
UNREST = 0.0007


def without_slip(robot: RobotModel, recording: Recording) -> Recording:
    """The recording without samples in which soles slide.

    Without an accelerometer only double support and turning on the floor show it.

    Where the closed chain holds, one sole cannot slide without the other.
    """
    contacts, period = recording.contacts, recording.period
    flat = {foot: contact.standing & ~_not_flat(contact, period) for foot, contact in contacts.items()}
    both = np.asarray(_both(contacts) & np.all(list(flat.values()), axis=0))
    apart = _apart(recording, both)
    twists = {foot: twist_speed(bush.heading, flat[foot], period) for foot, bush in recording.bushes.items()}
    fastest = np.nan_to_num(np.fmax.reduce([np.abs(twist) for twist in twists.values()]))
    unrest = (np.nan_to_num(apart.speed) ** 2 + fastest**2) / UNREST**2
    moves = _moves(sole_motion(robot, recording, flat, unrest), recording, flat)
    turns = {foot: _turns(twist, period) for foot, twist in twists.items()}
    ways = {
        foot: np.hypot(np.nan_to_num(moves[foot].speed), np.nan_to_num(twist))
        for foot, twist in twists.items()
    }
    for foot in contacts:
        indicators = {
            Reason.SOLES_APART: apart,
            Reason.SOLE_SLIDES: _shared(moves, foot, both),
            Reason.SOLE_TURNS: _shared(turns, foot, both),
        }
        way = np.fmax(np.where(both, np.max(list(ways.values()), axis=0), ways[foot]), apart.speed)
        for run in runs(slides(list(indicators.values()), way, period) & flat[foot]):
            slide = np.zeros(len(way), dtype=bool)
            slide[run] = True
            surest = max(indicators, key=lambda reason: indicators[reason].clearness(run))
            recording = recording.without(foot, slide, surest)
    return recording


def _both(contacts: Mapping[str, FootContact]) -> Mask:
    """Where two feet stand together, (N,); nowhere for robots with other numbers of feet."""
    double = [contact.support == SUPPORTS.index(DOUBLE) for contact in contacts.values()]
    return np.asarray(np.all(double, axis=0) & (len(double) == 2))


def _apart(recording: Recording, both: Mask) -> SlipIndicator:
    """How fast the soles move against each other where both stand."""
    if not both.any():
        return as_usual(np.full(len(both), np.nan))
    apart = relative_pose(*recording.bushes.values())
    return apart_speed(apart.position[:, :2], apart.yaw, both, recording.period)


def _moves(
    motion: SoleMotion | None, recording: Recording, flat: Mapping[str, Mask]
) -> dict[str, SlipIndicator]:
    """How fast each sole moves over the floor, where friction does not say that it cannot be."""
    if motion is None:
        return {foot: as_usual(np.full(len(recording.time), np.nan)) for foot in flat}
    floor, found = friction(recording, flat), {}
    for foot, velocity in motion.velocity.items():
        moves = SlipIndicator(np.asarray(np.hypot(*velocity.T)), motion.deviation[foot])
        against = unresisted(moves, velocity, floor, recording.period)
        found[foot] = SlipIndicator(np.where(against, np.nan, moves.speed), moves.deviation)
    return found


def _turns(twist: Array, period: float) -> SlipIndicator:
    """How fast a sole turns on the floor, where it is not its bush that gives way."""
    usual = as_usual(np.abs(twist))
    return SlipIndicator(np.where(turning(twist, period), usual.speed, np.nan), usual.deviation)


def _shared(indicators: Mapping[str, SlipIndicator], foot: str, both: Mask) -> SlipIndicator:
    """One foot's slip indicator, and where both feet stand, that of the faster one."""
    speed, deviation = indicators[foot].speed, indicators[foot].deviation
    for other in indicators.values():
        faster = both & ~(np.nan_to_num(other.speed) <= np.nan_to_num(speed))
        speed, deviation = np.where(faster, other.speed, speed), np.where(faster, other.deviation, deviation)
    return SlipIndicator(speed, deviation)


def _not_flat(contact: FootContact, period: float) -> Mask:
    """Where the sole tips or has just done so: its place is computed for a level sole."""
    return widened(contact.left_out_for(EDGES), round(AFTER / period))

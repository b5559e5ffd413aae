"""Seconds in which a sole slides: from the closed chain where both stand, and from the IMU's acceleration."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from plantar.contact.deflection import closure
from plantar.contact.phases import DOUBLE, SUPPORTS, FootContact, widened
from plantar.contact.slip import Witness, apart_speed, as_usual, slides, turning, twist_speed, unresisted
from plantar.conventions import Array, Mask
from plantar.feet.exclusion.edge_rolling import TIPPING
from plantar.feet.exclusion.sole_velocity import SoleMotion, friction, sole_motion
from plantar.feet.recording import Recording
from plantar.robot.model import RobotModel
from plantar.signals.segments import runs

APART = "slip: the soles move against each other"
AFTER = 0.05  # s
TWIST = "slip: the sole turns on the floor"
ALONE = "slip: the sole moves over the floor"
UNREST = (
    0.0007  # m/s: a speed between soles, or of a turning one, that says so much as one deviation of the IMU's
)


def leave_out_slip(robot: RobotModel, recording: Recording) -> None:
    """Leave out where soles slide. Without an accelerometer only double support and turning on the floor show it.

    Where the closed chain holds, one sole cannot slide without the other.
    """
    contacts, period = recording.contacts, recording.period
    flat = {foot: contact.standing & ~_tipping(contact, period) for foot, contact in contacts.items()}
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
    for foot, contact in contacts.items():
        witnesses = {APART: apart, ALONE: _shared(moves, foot, both), TWIST: _shared(turns, foot, both)}
        way = np.fmax(np.where(both, np.max(list(ways.values()), axis=0), ways[foot]), apart.speed)
        for run in runs(slides(list(witnesses.values()), way, period) & flat[foot]):
            stretch = np.zeros(len(way), dtype=bool)
            stretch[run] = True
            surest = max(witnesses, key=lambda reason: witnesses[reason].clearness(run))
            contact.leave_out(stretch, surest)


def _both(contacts: Mapping[str, FootContact]) -> Mask:
    """Where two feet stand together, (N,); nowhere for robots with other numbers of feet."""
    double = [contact.support == SUPPORTS.index(DOUBLE) for contact in contacts.values()]
    return np.asarray(np.all(double, axis=0) & (len(double) == 2))


def _apart(recording: Recording, both: Mask) -> Witness:
    """How fast the soles move against each other where both stand."""
    if not both.any():
        return as_usual(np.full(len(both), np.nan))
    apart = closure(*recording.bushes.values())
    return apart_speed(apart.position[:, :2], apart.yaw, both, recording.period)


def _moves(motion: SoleMotion | None, recording: Recording, flat: Mapping[str, Mask]) -> dict[str, Witness]:
    """How fast each sole moves over the floor, where friction does not say that it cannot be."""
    if motion is None:
        return {foot: as_usual(np.full(len(recording.time), np.nan)) for foot in flat}
    floor, found = friction(recording, flat), {}
    for foot, velocity in motion.velocity.items():
        moves = Witness(np.asarray(np.linalg.norm(velocity, axis=1)), motion.deviation[foot])
        against = unresisted(moves, velocity, floor, recording.period)
        found[foot] = Witness(np.where(against, np.nan, moves.speed), moves.deviation)
    return found


def _turns(twist: Array, period: float) -> Witness:
    """How fast a sole turns on the floor, where it is not its bush that gives way."""
    usual = as_usual(np.abs(twist))
    return Witness(np.where(turning(twist, period), usual.speed, np.nan), usual.deviation)


def _shared(witnesses: Mapping[str, Witness], foot: str, both: Mask) -> Witness:
    """One foot's witness, and where both feet stand, that of the faster one."""
    speed, deviation = witnesses[foot].speed, witnesses[foot].deviation
    for other in witnesses.values():
        faster = both & ~(np.nan_to_num(other.speed) <= np.nan_to_num(speed))
        speed, deviation = np.where(faster, other.speed, speed), np.where(faster, other.deviation, deviation)
    return Witness(speed, deviation)


def _tipping(contact: FootContact, period: float) -> Mask:
    """Where the sole tips or has just done so: its place is computed for a level sole."""
    return widened(contact.left_out_for(*TIPPING), round(AFTER / period))

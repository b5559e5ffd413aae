"""Seconds in which a sole slides: from the closed chain where both stand, and from the IMU's acceleration."""

from __future__ import annotations

import numpy as np

from plantar.contact import DOUBLE, SUPPORTS, FootContact, widened
from plantar.conventions import Array, Mask, rotation_from_quaternion
from plantar.deflection import BushState, closure
from plantar.identify.edges import TIPPING
from plantar.identify.orientation import attitude
from plantar.identify.recording import Recording
from plantar.robot import RobotModel
from plantar.slip import slides, sliding, sole_velocity, turning

APART = "slip: the soles move against each other"
AFTER = 0.05  # s
TWIST = "slip: the sole turns on the floor"
ALONE = "slip: the sole moves over the floor"


def leave_out_slip(robot: RobotModel, recording: Recording) -> None:
    """Leave out where soles slide. Without an accelerometer only double support shows it."""
    contacts = recording.contacts
    flat = {
        foot: contact.standing & ~_tipping(contact, recording.period) for foot, contact in contacts.items()
    }
    both = _both(recording) & np.all(list(flat.values()), axis=0)
    if both.any():
        apart = closure(*recording.bushes.values())
        slid = sliding(apart.position[:, :2], apart.yaw, both, recording.period)
        for contact in contacts.values():
            contact.leave_out(slid, APART)
    period, acceleration = recording.period, _acceleration(robot, recording)
    turns, moves = {}, {}
    for foot, bush in recording.bushes.items():
        turns[foot] = turning(bush.heading, flat[foot], period)
        moves[foot] = np.zeros(len(recording.time), dtype=bool)
        if acceleration is not None:
            place = recording.places[foot]
            velocity, noise = sole_velocity(place, bush.heading, acceleration, bush.rate, flat[foot], period)
            moves[foot] = slides(velocity, period, noise, _friction(bush)) & flat[foot]
    for found, reason in ((turns, TWIST), (moves, ALONE)):
        # Where the closed chain holds, one sole cannot slide without the other.
        together = np.all(list(found.values()), axis=0)
        for foot, contact in contacts.items():
            contact.leave_out(np.asarray(np.where(both, together, found[foot])), reason)


def _friction(bush: BushState) -> Array:
    """The floor's force on a level sole along its x and y axes over the load, (N, 2)."""
    (x, y, z), (pitch, roll) = bush.wrench[:, :3].T, bush.deflection.T
    down = np.sin(pitch) * x + np.cos(pitch) * z
    along = np.column_stack([np.cos(pitch) * x - np.sin(pitch) * z, np.cos(roll) * y + np.sin(roll) * down])
    return np.asarray(along / np.where(bush.force_z > 0, bush.force_z, np.nan)[:, None])


def _tipping(contact: FootContact, period: float) -> Mask:
    """Where the sole tips or has just done so: its place is computed for a level sole."""
    tips = np.isin(contact.code, [k for k, reason in enumerate(contact.reasons) if reason in TIPPING])
    return widened(tips, round(AFTER / period))


def _both(recording: Recording) -> Mask:
    """Where two feet stand together; nowhere for robots with other numbers of feet."""
    if len(recording.bushes) != 2:
        return np.zeros(len(recording.time), dtype=bool)
    supports = [contact.support == SUPPORTS.index(DOUBLE) for contact in recording.contacts.values()]
    return np.asarray(supports[0] & supports[1])


def _acceleration(robot: RobotModel, recording: Recording) -> Array | None:
    """Horizontal acceleration of the IMU in the world, (N, 2) [m/s²]; None where the log has no accelerometer."""
    log, imu = recording.log, robot.imu
    if imu is None or not log.has(*(f"imu.{imu.name}.linear_acceleration.{axis}" for axis in "xyz")):
        return None
    orientation, _ = attitude(log, imu, [])
    length = np.linalg.norm(orientation, axis=1, keepdims=True)
    unit = orientation / np.where(length > 0, length, np.nan)
    proper = log.linear_acceleration(imu.name)
    return np.asarray(np.einsum("nij,nj->ni", rotation_from_quaternion(unit)[:, :2], proper))

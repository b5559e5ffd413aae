"""An attitude that tells a share too much or too little of each tilt: stiffness and damping are off by that share.

Gyroscope and attitude of one IMU may share the fault, so they do not contradict each other. The accelerometer does:
over a sole that stands it shows how far the believed vertical leans (see `tilt_error`), and a lean that goes with the
tilt itself is a scale. An IMU that sits higher than the robot file says leans as well, more the faster the tilt: that
part is taken off. A scale of the accelerometer, common to its axes, leaves all as it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from plantar.contact.deflection import BushState
from plantar.contact.phases import FootContact
from plantar.conventions import Array, rotation_from_quaternion
from plantar.estimation.orthonormal import without
from plantar.estimation.slow_drift import drift_basis
from plantar.faults.gyroscope import SURE
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import Imu
from plantar.sensors.accelerometer_delay import EDGE
from plantar.sensors.tilt_error import KEPT_PER_PERIOD, TOLD, enough_of, lean_of, stance_leans
from plantar.signals.filters import low_pass
from plantar.signals.orientation import unit_quaternions

ATTITUDE_SCALE = "attitude_scale"
# An accelerometer whose axes differ by 2 % shows as much, and so does a URDF with wrong lengths.
SCALE_OFF = 0.03
SINGULAR = 1e4  # condition beyond which one pace of sway does not tell scale and height apart
WITHOUT_LEAN = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]])  # the tilt as the soles have it
# Of the share, beside the tilt as the soles have it: less, and most of it is the attitude's wander.
STAYS = 0.5
RATE = 1.0  # 1/s, of samples of the lean that tell something new: it is slower than TOLD


@dataclass(frozen=True)
class AttitudeScale:
    """Sums over stances, about the world's x and y: `products` (2, 3, 3) of the lean, the tilt, and the lean for each
    metre by which the IMU is higher.

    An attitude that wanders while the robot hardly tilts is what it believes of a tilt: its lean goes with that, and
    not with the tilt that the lean leaves. A scale shows beside both.

    `seconds`: of all stances. Logs of one IMU add up.
    """

    products: Array = field(default_factory=lambda: np.zeros((2, 3, 3)))
    seconds: float = 0.0

    def __add__(self, other: AttitudeScale) -> AttitudeScale:
        return AttitudeScale(self.products + other.products, self.seconds + other.seconds)

    @property
    def share(self) -> tuple[Array, Array]:
        """By which share of each tilt the attitude is too small (2,), and its deviations; zero where none shows."""
        (share, std), (left, _) = (self._beside(reading) for reading in (np.eye(3), WITHOUT_LEAN))
        return np.where(left * share > STAYS * share**2, share, 0.0), std

    def _beside(self, reading: Array) -> tuple[Array, Array]:
        """The share beside what `reading` (3, 3) makes of lean, tilt and height, and its deviations."""
        share, std = np.zeros(2), np.zeros(2)
        for axis, products in enumerate(self.products):
            sums = reading @ products @ reading.T
            size = np.sqrt(np.diag(sums))
            if not (size > 0).all() or np.linalg.cond(sums[1:, 1:] / np.outer(size[1:], size[1:])) > SINGULAR:
                continue
            inverse = np.linalg.inv(sums[1:, 1:])
            found = inverse @ sums[1:, 0]
            left = max(float(sums[0, 0] - found @ sums[1:, 0]), 0.0)
            share[axis], std[axis] = (
                -found[0],
                np.sqrt(left * inverse[0, 0] / max(RATE * self.seconds, 1.0)),
            )
        return share, std


def log_attitude_scale(
    log: MotionLog,
    imu: Imu,
    orientation: Array,
    bushes: Mapping[str, BushState],
    contacts: Mapping[str, FootContact],
) -> AttitudeScale:
    """What the stances of one log tell; nothing where it has no attitude or no accelerometer of its own.

    orientation: w x y z, IMU to world, (N, 4); bushes and contacts: of every foot, computed with this orientation.
    """
    if log.orientation(imu.name) is None or not log.has_imu(imu.name, "linear_acceleration"):
        return AttitudeScale()
    unit, acceleration, period = unit_quaternions(orientation), log.linear_acceleration(imu.name), log.period
    found, every = AttitudeScale(), enough_of(period)
    edge, thinned = round(EDGE / (every * period)), max(1, int(1 / (KEPT_PER_PERIOD * TOLD * every * period)))
    step = thinned * every * period
    to_world = rotation_from_quaternion(unit)
    for run, lean, height in stance_leans(unit, acceleration, bushes, contacts, period, every):
        # Of what points up at rest, however the IMU is mounted: its own z axis may lie level, and turn as it yaws.
        up = np.median(to_world[run][:, 2], axis=0)
        believed = to_world[run][:, :2] @ (up / np.linalg.norm(up))
        tilt = low_pass(believed, period, TOLD, every=every)
        higher = lean_of(np.zeros_like(believed), believed, height, period, every)
        signals = np.stack([lean, tilt, higher], axis=2)[edge:-edge:thinned]  # (n, 2, 3)
        # What an attitude drifts by over seconds is no share of any tilt, but goes with slow ones for a while.
        flat = signals.reshape(len(signals), -1)
        flat = without(drift_basis(step * np.arange(len(flat), dtype=np.float64)), flat - flat.mean(axis=0))
        signals = flat.reshape(signals.shape)
        products = step * np.einsum("nai,naj->aij", signals, signals)
        found = found + AttitudeScale(products, len(signals) * step)
    return found


def attitude_scale_notes(found: AttitudeScale) -> list[Note]:
    """A warning where the attitude is off by a share that matters."""
    share, std = found.share
    off = np.abs(share) > np.maximum(SCALE_OFF, SURE * std)
    if not off.any():
        return []
    worst = float(share[np.argmax(np.where(off, np.abs(share), 0.0))])
    text = (
        f"the IMU's orientation shows {1 / (1 + worst):.3g} times the tilts that its accelerometer and the standing "
        "soles do; stiffness and damping are off by the same share (valid: 1; check the scales of gyroscope and "
        "accelerometer, and the encoders between IMU and feet)"
    )
    return [Note(ATTITUDE_SCALE, "warning", text)]

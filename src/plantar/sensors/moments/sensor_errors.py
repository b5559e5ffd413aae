"""What a foot's force sensor, the IMU and the clocks may get wrong, and by how much before the moments are asked.

The columns of a fit of moments are, in this order: torques about pitch of each foot, torques about roll of each foot,
what else each foot's sensor may get wrong, the IMU's turn about its three axes, the compliances of `carrying_joints`,
and the delays of each foot, of the encoders, of the gyroscope, and of all torques about pitch and about roll behind the
forces.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY, Array
from plantar.robot.model import Foot, RobotModel
from plantar.sensors.load_errors import LEAST_GAIN
from plantar.sensors.moments.joint_torques import carrying_joints

LOOSE = 0.3  # share: deviation of a torque's gain before the moments are asked
ANOTHER_UNIT = 10.0  # share: likewise, where it may be kgf.m for N.m
LEAST_ARM = 0.003  # m, likewise as LEAST_GAIN
LEAST_BETWEEN = 0.001  # N.m/N, likewise
LATE = 0.02  # s, of feet's sensors, encoders and gyroscope behind the accelerometer
LATE_TORQUES = 0.01  # s, of torques behind the forces of the same sensors: mostly read together
BENDING = 0.3  # rad, by which a joint may bend beyond its encoder with the robot's weight at a metre
STIFF = 1e-4  # rad, likewise, of one that bends by nothing
MOUNT = 0.1  # rad, by which sensors and IMU may be turned: wide, so that no turned mount passes for a gain
ZERO = 0.02  # of the weight: deviation of a force channel's zero, as between two recordings of one sensor
ZERO_ARM = 0.1  # m, times that: of a torque channel's, of a force about as far aside as a foot reaches


def prior_deviations(robot: RobotModel, gains: float = LOOSE, bending: float = BENDING) -> Array:
    """Deviations of the sensors' coefficients before the moments are asked, (k,): of all columns before the links'.

    gains: those of the torques' gains; bending: of each joint of the legs [rad], with the robot's weight at a metre.
    """
    feet = len(robot.feet)
    of_feet = np.tile(sensor_errors(robot)[1], feet)
    late = [*np.full(feet + 2, LATE), *np.full(2, LATE_TORQUES)]
    bends = np.full(len(carrying_joints(robot)), bending / (robot.mass * GRAVITY))
    return np.concatenate([np.full(2 * feet, gains), of_feet, np.full(3, MOUNT), bends, late])


def compliance_columns(robot: RobotModel) -> slice:
    """The columns of the joints' compliances, one for each of `carrying_joints`."""
    start = len(robot.feet) * (2 + len(sensor_errors(robot)[1])) + 3  # behind gains, sensors, the IMU's turn
    return slice(start, start + len(carrying_joints(robot)))


def turn_columns(robot: RobotModel) -> dict[str, slice]:
    """By foot, the three columns of its force sensor's turn."""
    feet, own = len(robot.feet), len(sensor_errors(robot)[1])
    starts = {
        foot: 2 * feet + place * own + 4 for place, foot in enumerate(robot.feet)
    }  # behind gain and place
    return {foot: slice(start, start + 3) for foot, start in starts.items()}


def zero_deviations(robot: RobotModel) -> Array:
    """Deviations of the channels' zeros before the moments are asked, (6 feet,) [N, N.m]."""
    force = ZERO * robot.mass * GRAVITY
    return np.tile(np.repeat([force, ZERO_ARM * force], 3), len(robot.feet))


def sensor_errors(robot: RobotModel) -> tuple[Array, Array]:
    """What else a force sensor may get wrong: matrices (k, 6, 6) that act on what it reads, and their deviations (k,).

    The gain of all channels, the place along x, y and z, the turn about them, each channel's own gain and what one
    channel does to another; no torque reaches a force.
    """
    uncertainty = robot.uncertainty
    share = max(uncertainty.wrench_gain, LEAST_GAIN)
    place = max(uncertainty.bush_position, LEAST_ARM)
    between = max(uncertainty.wrench_crosstalk, LEAST_BETWEEN)
    none, crosses = np.zeros((3, 3)), [pin.skew(axis) for axis in np.eye(3)]
    errors = [(np.eye(6), share)]
    errors += [(np.block([[none, none], [cross, none]]), place) for cross in crosses]
    errors += [(np.block([[cross, none], [none, cross]]), MOUNT) for cross in crosses]
    for read, real in (pair for pair in np.ndindex(6, 6) if pair[0] >= 3 or pair[1] < 3):
        single = np.zeros((6, 6))
        single[read, real] = 1.0
        errors.append((single, share if read == real else between))
    matrices, deviations = zip(*errors, strict=True)
    return np.array(matrices), np.array(deviations)


def bush_directions(robot: RobotModel, foot: Foot) -> Array:
    """The bush's pitch and roll axes in the force sensor's frame, (2, 3)."""
    sensor, bush = (robot.frame(each)[1].rotation for each in (foot.wrench.placement, foot.bush))
    return np.asarray((bush.T @ sensor)[[1, 0]])

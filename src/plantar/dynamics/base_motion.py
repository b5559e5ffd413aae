"""The root frame's motion from an IMU anywhere on the robot, moved through the encoders.

With R, p, ω_r, α_r, v_r, a_r the pose and motion of the IMU's link relative to the root link, in root axes, and ω, α,
A those of the root frame itself (A: proper acceleration of its origin):

    ω_imu = ω + ω_r,   α_imu = α + α_r + ω × ω_r,
    A_imu = A + α × p + ω × (ω × p) + 2 ω × v_r + a_r

Attitude never enters.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar import _core
from plantar.conventions import GRAVITY, Array
from plantar.dynamics.equation import Equation
from plantar.robot.kinematics import packed_frame


def root_motion(
    equation: Equation, link: int, placement: pin.SE3, measured: Array, q: Array, v: Array, a: Array
) -> Array:
    """The root frame's motion (N, 9), as in `Motion.base`, of a floating base.

    measured: the same of an IMU in its own axes, (N, 9); link: that carries it, an index into `Equation.links`;
    placement: in that link; q, v, a: of all joints, (N, n_joints).
    """
    return _core.root_motion(equation.core, link, packed_frame(placement), measured, q, v, a)


def root_motion_from_sole(
    equation: Equation, link: int, placement: pin.SE3, q: Array, v: Array, a: Array
) -> Array:
    """The root frame's motion (N, 9) where a level sole stands still (Iwasaki 2012): its frame is an IMU at rest."""
    still = np.zeros((len(q), 9))
    still[:, 2] = GRAVITY
    return root_motion(equation, link, placement, still, q, v, a)

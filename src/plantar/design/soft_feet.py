"""The robot on soft feet: what its bushes do while it follows its joints, for any stiffness.

The joints go where they are told; the body as a whole is left three freedoms, its height and its lean about x and y
above the middle of the bushes. It is a pendulum that the bushes hold upright against gravity: near the stiffness at
which they no longer can, all motions grow.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.fft import next_fast_len

from plantar.conventions import GRAVITY, Array
from plantar.errors import MotionError
from plantar.robot.model import RobotModel

SILENCE: Final = 15.0  # s of rest that are added, in which a soft robot comes to rest
# m by which a robot's weight would press one foot's bush: published feet give 1 to 3 mm.
SINKS: Final = 0.0025
DAMPED: Final = 0.04  # s, damping over stiffness where it is not told: table 1 of the paper has 0.037 to 0.08
# Times the stiffness at which the robot just stands: nearer to it nothing can be predicted.
CARRIED: Final = 1.05


@dataclass(frozen=True)
class Softness:
    """Bushes that are alike: stiffness [N·m/rad] and damping [N·m·s/rad] of pitch and roll, of z [N/m, N·s/m]."""

    stiffness: float
    damping: float
    vertical: float
    vertical_damping: float

    @classmethod
    def told(cls, robot: RobotModel, stiffness: float, damping: float | None) -> Softness:
        """From what the user tells; z from the robot's weight."""
        vertical = robot.mass * GRAVITY / SINKS
        own = DAMPED * stiffness if damping is None else damping
        return cls(stiffness, own, vertical, 0.005 * vertical)

    def times(self, factor: float) -> Softness:
        """Softer or stiffer rubber of the same kind in pitch and roll."""
        return Softness(factor * self.stiffness, factor * self.damping, self.vertical, self.vertical_damping)


@dataclass(frozen=True)
class Pendulum:
    """A robot as a rigid body above the middle of its bushes.

    `mass` [kg]; `inertia` (2,): about x and y through that middle [kg·m²]; `height` of the centre of mass above it
    [m]; `places`: of the bushes about that middle, (2,) [m] each, by foot.
    """

    mass: float
    inertia: Array
    height: float
    places: Mapping[str, Array]

    @property
    def least_stiffness(self) -> float:
        """Of each foot in pitch, with which the robot just stands on all of them [N·m/rad]: m g h over the feet."""
        return self.mass * GRAVITY * self.height / len(self.places)

    def check_carried(self, stiffness: float, robot: str) -> None:
        """MotionError where feet of this stiffness let the robot fall over."""
        least = CARRIED * self.least_stiffness
        if stiffness < least:
            message = f"feet of {stiffness:.4g} N·m/rad cannot hold the robot upright"
            raise MotionError(message, path=robot, valid=f"at least {least:.4g} N·m/rad each")


@dataclass(frozen=True)
class Response:
    """What the bushes do, by foot: `deflection` (..., 2, N) pitch, roll [rad], `rate` [rad/s], `load` (..., N) [N]
    without the share of the weight that the feet carry at rest."""

    deflection: Mapping[str, Array]
    rate: Mapping[str, Array]
    load: Mapping[str, Array]


def respond(
    pendulum: Pendulum,
    bush: Softness,
    wrench: Array,
    tilts: Mapping[str, Array],
    period: float,
    beside: tuple[float, float],
) -> Response:
    """Motions on soft feet, linear and exact for constant inertia, by the Fourier transform.

    `wrench` (..., 3, N): vertical force [N] and moments about x and y at the middle of the bushes [N·m] that the
    motion asks of the ground, less those at rest. `tilts`: by foot, roll and pitch of the ankle against the floor,
    (..., 2, N) [rad]. `period` [s]. `beside`: stiffness of what stands beside the springs of pitch and roll [N·m/rad].
    All begin and end at rest.
    """
    count = wrench.shape[-1]
    size = next_fast_len(count + round(SILENCE / period), real=True)
    s = 2j * np.pi * np.fft.rfftfreq(size, period)
    asked = np.fft.rfft(wrench, size)
    turned = {foot: np.fft.rfft(tilt, size) for foot, tilt in tilts.items()}
    spring = bush.stiffness + bush.damping * s
    press = bush.vertical + bush.vertical_damping * s
    # Height and lean about x and y of the body; forces of the bushes on it, less what it asks for.
    matrix = np.zeros((s.size, 3, 3), dtype=complex)
    weight = pendulum.mass * GRAVITY * pendulum.height
    for axis, inertia in enumerate((pendulum.mass, *pendulum.inertia)):
        matrix[:, axis, axis] += inertia * s**2 - (weight if axis else 0.0)
    missing = -asked
    for foot, (x, y) in pendulum.places.items():
        arm = np.array([1.0, y, -x])  # how high the body's freedoms lift this foot
        matrix += press[:, None, None] * np.outer(arm, arm)
        for freedom, more in ((1, beside[1]), (2, beside[0])):  # roll, pitch
            matrix[:, freedom, freedom] += spring + more
            missing[..., freedom, :] -= (spring + more) * turned[foot][..., freedom - 1, :]
    moved = np.einsum("fij,...jf->...if", np.linalg.inv(matrix), missing)

    def back(values: Array) -> Array:
        return np.asarray(np.fft.irfft(values, size)[..., :count])

    deflection, rate, load = {}, {}, {}
    for foot, (x, y) in pendulum.places.items():
        bent = -(turned[foot] + moved[..., 1:, :])[..., ::-1, :]  # pitch, roll of the sole against the ankle
        deflection[foot], rate[foot] = back(bent), back(s * bent)
        load[foot] = back(-press * np.einsum("i,...if->...f", np.array([1.0, y, -x]), moved))
    return Response(deflection, rate, load)

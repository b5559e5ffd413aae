"""The rubber under each foot: the truth that identification has to find again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True)
class Bush:
    """Kelvin-Voigt of each axis, and what real rubber adds to it.

    Stiffness and damping of pitch and roll [N·m/rad, N·m·s/rad] and of z [N/m, N·s/m]. `hardening` is a cubic
    term [N·m/rad³]. An elastoplastic (Jenkins) element stands beside the spring: it pulls with up to
    `slip_torque` [N·m] and yields after `slip_angle` [rad]. Zero torque or hardening turns either off.
    """

    pitch_stiffness: float
    pitch_damping: float
    roll_stiffness: float
    roll_damping: float
    z_stiffness: float = 239018.0
    z_damping: float = 1000.0
    pitch_hardening: float = 0.0
    roll_hardening: float = 0.0
    pitch_slip_torque: float = 0.0
    roll_slip_torque: float = 0.0
    pitch_slip_angle: float = 0.01
    roll_slip_angle: float = 0.01

    @property
    def is_linear(self) -> bool:
        """Whether there is nothing beside the spring and the damper."""
        beside = (self.pitch_hardening, self.roll_hardening, self.pitch_slip_torque, self.roll_slip_torque)
        return not any(beside)


Feet = Mapping[str, Bush]

# Table 1 of the paper; z is what another group measured on the same robot.
PAPER: Final[Feet] = MappingProxyType(
    {
        "right": Bush(434.0, 15.89, 323.0, 17.53),
        "left": Bush(480.0, 24.27, 352.0, 28.15),
    }
)
# What others use for HRP-2's feet without having identified them; LAAS gives no damping, so another's stands there.
GUESSES: Final[Mapping[str, Bush]] = MappingProxyType(
    {
        "LAAS": Bush(502.0, 12.0, 707.0, 12.0, 239018.0),
        "JRL": Bush(600.0, 60.0, 600.0, 60.0, 40000.0),
        "Kinetics Observer": Bush(400.0, 12.0, 400.0, 12.0, 40000.0, 120.0),
        "bush customizer": Bush(1000.0, 25.0, 1000.0, 25.0, 500000.0, 1000.0),
    }
)

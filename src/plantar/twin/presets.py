"""Named sets of imperfections: how far from ideal the twin and its sensors are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

from plantar.errors import PlantarError, located
from plantar.twin.bush import Feet
from plantar.twin.physics import Physics
from plantar.twin.sensors import DEGREE, Sensors

SLIP_TORQUE: Final = {"pitch": 5.0, "roll": 2.2}  # N·m: 7 to 10 % of the largest torques of the campaign
SLIP_ANGLE: Final = 0.01  # rad


@dataclass(frozen=True)
class Preset:
    """Imperfections of the physics and of the sensors.

    `slip_torque`: of the elastoplastic element beside each spring, (pitch, roll) [N·m].
    """

    name: str
    sensors: Sensors
    slip_torque: tuple[float, float] = (0.0, 0.0)

    def physics(self, bushes: Feet | None) -> Physics:
        """The world in which these bushes stand."""
        if bushes is None:
            return Physics(bushes=None)
        pitch, roll = self.slip_torque
        rubber = {
            foot: replace(bush, pitch_slip_torque=pitch, roll_slip_torque=roll, slip_angle=SLIP_ANGLE)
            if pitch or roll
            else bush
            for foot, bush in bushes.items()
        }
        return Physics(bushes=rubber)


SENSORS: Final = Sensors(
    encoder=2e-5,
    encoder_rate=1e-3,
    effort=0.1,
    gyroscope=(0.0013, 0.0013, 0.0022),
    accelerometer=(0.003, 0.003, 0.005),
    attitude=0.005 * DEGREE,
    attitude_bias=0.15 * DEGREE,
    attitude_drift=0.03 * DEGREE,
    yaw_bias=5 * DEGREE,
    yaw_drift=1 * DEGREE,
    force=1.0,
    torque=0.1,
    force_zero=2.0,
    torque_zero=0.5,
)

PRESETS: Final[Mapping[str, Preset]] = MappingProxyType(
    {
        "ideal": Preset("ideal", Sensors()),
        "sensors": Preset("sensors", SENSORS),
        "realistic": Preset(
            "realistic", replace(SENSORS, wrench_delay=0.005), (SLIP_TORQUE["pitch"], SLIP_TORQUE["roll"])
        ),
    }
)
DEFAULT: Final = "realistic"


def preset_named(name: str) -> Preset:
    """The preset of that name; PlantarError lists what there is."""
    if name not in PRESETS:
        raise PlantarError(located(f"unknown preset '{name}'", valid=", ".join(PRESETS)))
    return PRESETS[name]

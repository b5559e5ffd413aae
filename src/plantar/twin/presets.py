"""Named sets of imperfections: how far from ideal the twin and its sensors are."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY
from plantar.errors import PlantarError
from plantar.robot.model import RobotModel
from plantar.twin.bush import Feet
from plantar.twin.robots import hrp2
from plantar.twin.robots.true_robot import RobotSpread
from plantar.twin.sensing.logger import Logger
from plantar.twin.sensing.sensor_errors import SensorSpread
from plantar.twin.sensing.sensors import DEGREE, Sensors
from plantar.twin.simulation.mjcf import FLOOR
from plantar.twin.simulation.physics import Physics, Slip

# N·m in pitch and roll of HRP-2: 7 to 10 % of the largest torques of the campaign.
SLIP_TORQUE: Final = (5.0, 2.2)
SLIP_ANGLE: Final = 0.01  # rad
HARDENING: Final = 5000.0  # N·m/rad³: a tenth more torque at 0.1 rad
SOFT_FLOOR: Final = (62500.0, 500.0, 0.9)  # a contact that takes 4 ms to settle
SLIPPERY: Final = (Slip(6.0, 7.0, 0.02), Slip(14.0, 15.0, 0.02))  # seconds of every motion


def sized_for(robot: RobotModel | None) -> float:
    """How much more than HRP-2 a robot's weight bears on its feet: what stands beside their springs grows with it, so
    that hysteresis is alike in shape under small robots and large ones. None: the built-in robot, 1."""
    if robot is None:
        return 1.0
    return round(gravitational_stiffness(robot) / gravitational_stiffness(hrp2.robot()), 3)


def gravitational_stiffness(robot: RobotModel) -> float:
    """m·g·h [N·m/rad], h the height of the centre of mass above the soles with all joints at neutral."""
    model = robot.model
    data, neutral = model.createData(), pin.neutral(model)
    centre = np.array(pin.centerOfMass(model, data, neutral))
    placements = [robot.frame(foot.sole.placement) for foot in robot.feet.values()]
    soles = [data.oMi[joint] * place for joint, place in placements]
    heights = [float(sole.rotation[:, 2] @ (centre - sole.translation)) for sole in soles]
    return float(robot.mass * GRAVITY * np.mean(heights))


@dataclass(frozen=True)
class Preset:
    """Imperfections of the physics and of the sensors.

    `slip_torque`: of the elastoplastic element beside each spring, (pitch, roll) [N·m], and `hardening` [N·m/rad³] of
    both axes, under HRP-2; under another robot see `sized_for`. `floor` and `slips` as in `Physics`. `robot` and
    `sensor_errors`: by how much the robot and its sensors differ from the robot file, the same in all recordings of a
    seed; `between`: the share by which stiffness and damping differ from recording to recording is drawn between these,
    for each seed.
    """

    name: str
    sensors: Sensors
    slip_torque: tuple[float, float] = (0.0, 0.0)
    hardening: float = 0.0
    floor: tuple[float, float, float] = FLOOR
    slips: tuple[Slip, ...] = ()
    logger: Logger | None = None
    robot: RobotSpread | None = None
    sensor_errors: SensorSpread | None = None
    between: tuple[float, float] = (0.0, 0.0)

    def physics(self, bushes: Feet | None, robot: RobotModel | None = None) -> Physics:
        """The world in which these bushes stand, under `robot` (None: the built-in one); rigid feet (None) have no
        rubber, the floor stays."""
        world = Physics(bushes=bushes, floor=self.floor, slips=self.slips)
        if bushes is None:
            return world
        pitch, roll = self.slip_torques(robot)
        rubber = dict.fromkeys(("pitch_hardening", "roll_hardening"), sized_for(robot) * self.hardening)
        rubber |= {"pitch_slip_torque": pitch, "roll_slip_torque": roll, "pitch_slip_angle": SLIP_ANGLE}
        rubber["roll_slip_angle"] = SLIP_ANGLE
        return replace(world, bushes={foot: replace(bush, **rubber) for foot, bush in bushes.items()})

    def slip_torques(self, robot: RobotModel | None) -> tuple[float, float]:
        """Of each foot of `robot` in pitch and roll [N·m]."""
        pitch, roll = (sized_for(robot) * torque for torque in self.slip_torque)
        return pitch, roll

    def stiffening(self, seed: int, motion: str) -> float:
        """The share by which stiffness and damping are larger in one recording; a temperature's doing."""
        spread = np.random.default_rng([seed, zlib.crc32(b"between")]).uniform(*self.between)
        return float(spread * np.random.default_rng([seed, zlib.crc32(motion.encode()), 2]).standard_normal())


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

HARSH: Final = replace(
    SENSORS,
    **{
        size: 2 * getattr(SENSORS, size)
        for size in (
            "encoder", "encoder_rate", "effort", "attitude", "attitude_bias", "attitude_drift", "yaw_bias", "yaw_drift",
            "force", "torque", "force_zero", "torque_zero",
        )
    },
    gyroscope=(0.0026, 0.0026, 0.0044),
    accelerometer=(0.006, 0.006, 0.010),
    gyroscope_bias=0.001,
    wrench_delay=0.010,
    filtered_attitude=True,
)  # fmt: skip

# The attitude is an estimator's, which leans by a quarter of a degree and wanders; the force sensors are a decade old.
PLAIN: Final = replace(
    SENSORS,
    encoder=1e-4,
    encoder_rate=5e-3,
    attitude=0.02 * DEGREE,
    attitude_bias=0.25 * DEGREE,
    attitude_drift=0.1 * DEGREE,
    force=2.0,
    torque=0.3,
    force_zero=0.0,
    torque_zero=1.0,
)

# The attitude wanders instead of drifting in a line, and the devices filter as real ones do.
WANDERING: Final = replace(
    SENSORS,
    attitude_drift=0.0,
    attitude_walk=0.03 * DEGREE,
    wrench_cutoff=60.0,
    gyroscope_cutoff=80.0,
    wrench_hold=0.003,
)

PRESETS: Final[Mapping[str, Preset]] = MappingProxyType(
    {
        preset.name: preset
        for preset in (
            Preset("ideal", Sensors()),
            Preset("sensors", SENSORS),
            Preset("realistic", replace(SENSORS, wrench_delay=0.005), SLIP_TORQUE),
            Preset("harsh", HARSH, (2 * SLIP_TORQUE[0], 2 * SLIP_TORQUE[1]), HARDENING, SOFT_FLOOR, SLIPPERY),
            Preset("plain_log", PLAIN, logger=Logger()),
            Preset(
                "imperfect",
                WANDERING,
                SLIP_TORQUE,
                robot=RobotSpread(),
                sensor_errors=SensorSpread(),
                between=(0.003, 0.01),
            ),
        )
    }
)
DEFAULT: Final = "realistic"


def preset_named(name: str) -> Preset:
    """The preset of that name; PlantarError lists what there is."""
    if name not in PRESETS:
        raise PlantarError(f"unknown preset '{name}'", valid=", ".join(PRESETS))
    return PRESETS[name]

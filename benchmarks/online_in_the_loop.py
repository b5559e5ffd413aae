"""The twin walks with what its stabiliser believes of its feet: rigid, half, double, true stiffness, or learnt online.

    python benchmarks/online_in_the_loop.py [MOTION]

The physics is the same; only the compliance differs by which the stabiliser turns a wanted torque into an angle. Prints
the rms of the root's lean away from its plan, from 12 s on. "online" begins with double the stiffness and takes each
foot's numbers from the estimator once they are identified; its sensors are the stabiliser's own, exact at 200 Hz.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from unittest.mock import patch

import mujoco
import numpy as np
import pinocchio as pin

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.errors import MotionError
from plantar.motions.plan import RATE, Plan
from plantar.online.estimator import FootEstimator
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER
from plantar.twin.play import planned
from plantar.twin.presets import preset_named
from plantar.twin.robots import hrp2
from plantar.twin.simulation import rollout
from plantar.twin.simulation.mjcf import SERVO_ANGLE
from plantar.twin.simulation.physics import Physics
from plantar.twin.walking.control import WalkingControl

SETTLED = 12.0  # s of a walk, before which nothing is scored
CASES = ("rigid", "half", "double", "true", "online")


class Believing(WalkingControl):
    """The twin's controller with another belief about its feet."""

    case = "true"

    def __init__(
        self, model: mujoco.MjModel, robot: RobotModel, plan: Plan, physics: Physics, joints: tuple[str, ...]
    ) -> None:
        super().__init__(model, robot, plan, physics, joints)
        self.model, self.robot, self.tick = model, robot, 0
        limits = self.estimator.model.upperEffortLimit
        self.servo = {foot: limits[self.feet.legs[foot]][-2:].min() / SERVO_ANGLE for foot in robot.feet}
        factor = {"half": 0.5, "double": 2.0, "online": 2.0}.get(self.case, 1.0)
        for foot, bush in PAPER.items():
            for place, axis in enumerate(("roll", "pitch")):
                stiffness = factor * getattr(bush, f"{axis}_stiffness")
                if self.case == "rigid":
                    stiffness = np.inf
                self.believe(foot, place, stiffness, getattr(bush, f"{axis}_damping"))
        feet = {
            name: replace(foot, wrench=replace(foot.wrench, placement=foot.bush, sign=1.0))
            for name, foot in robot.feet.items()
        }
        sensing = replace(robot, feet=feet, uncertainty=EXACT)
        self.online = FootEstimator(sensing, wrench_delay=0.0) if self.case == "online" else None
        self.columns = [robot.joint_names.index(name) for name in joints]

    def believe(self, foot: str, place: int, stiffness: float, damping: float) -> None:
        self.feet.compliance[foot][place] = 1 / stiffness + 1 / self.servo[foot]
        self.feet.lag[foot][place] = damping / stiffness

    def led(self, sample: int, data: mujoco.MjData, rows: Array) -> Array:
        if self.online is not None:
            self.learn(data)
        return super().led(sample, data, rows)

    def learn(self, data: mujoco.MjData) -> None:
        assert self.online is not None
        position = np.zeros(len(self.robot.joint_names))
        position[self.columns] = data.qpos[self.estimator._q]
        found = self.online.step(
            self.tick / RATE,
            position,
            {foot: self.wrench(data, foot) for foot in self.robot.feet},
            attitude=self.sensor(data, "imu.orientation"),
            angular_velocity=self.sensor(data, "imu.angular_velocity"),
        )
        self.tick += 1
        for foot, now in found.items():
            for place, axis in enumerate(("roll", "pitch")):
                one = getattr(now, axis)
                if one.identified:
                    self.believe(foot, place, one.stiffness.value, max(one.damping.value, 0.0))

    def sensor(self, data: mujoco.MjData, name: str) -> Array:
        sensor = self.model.sensor(name)
        return np.array(data.sensordata[int(sensor.adr[0]) : int(sensor.adr[0] + sensor.dim[0])])

    def wrench(self, data: mujoco.MjData, foot: str) -> Array:
        """Of the sole on the ankle in the ankle's axes: the opposite of what the engine's sensors on the sole read."""
        pitch, roll = (float(data.joint(f"{foot}.{axis}").qpos[0]) for axis in ROTATIONAL_AXES)
        turn = pin.utils.rotate("y", pitch) @ pin.utils.rotate("x", roll)
        return np.concatenate([-turn @ self.sensor(data, f"{foot}.{kind}") for kind in ("force", "torque")])


def lean(plan: Plan, played: rollout.Rollout) -> float:
    """Rms of the root's roll and pitch away from its plan [rad]."""
    late, squares = plan.time >= SETTLED, []
    for pose, measured in zip(plan.base[late], played.base[late], strict=True):
        w, x, y, z = measured[3:7]
        up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        squares.append(np.arccos(min(1.0, float(pose[2, :3] @ up))) ** 2)
    return float(np.sqrt(np.mean(squares)))


def main(motion: str = "Walk12") -> None:
    robot = hrp2.robot()
    plan, physics = planned(motion, robot), preset_named("sensors").physics(PAPER)
    xml = rollout.scene_xml(robot, plan, physics)
    for case in CASES:
        Believing.case = case
        with patch.object(rollout, "WalkingControl", Believing):
            try:
                played = rollout.roll_out(robot, plan, physics, xml)
            except MotionError as error:
                print(f"{case:7} {error}")
                continue
        print(f"{case:7} leans {1e3 * lean(plan, played):.2f} mrad rms", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])

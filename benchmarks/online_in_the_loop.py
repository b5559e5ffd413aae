"""The twin walks with what its stabiliser believes of its feet: rigid, half, double, true stiffness, or learnt online.

    python benchmarks/online_in_the_loop.py [MOTION | Sway]

The physics is the same; only the compliance differs by which the stabiliser turns a wanted torque into an angle. `Sway`
stands and moves its weight. Prints how far chest attitude and zero-moment point are from their plans, from 12 s on.
"online" begins with double the stiffness and takes each foot's numbers from the estimator once they are identified; its
sensors are the stabiliser's own, exact at 200 Hz.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from unittest.mock import patch

import mujoco
import numpy as np
import pinocchio as pin

from plantar.conventions import ROTATIONAL_AXES, Array, rotation_from_quaternion
from plantar.errors import MotionError
from plantar.motions import walk
from plantar.motions.body import Body
from plantar.motions.footsteps import Footsteps, footsteps
from plantar.motions.gait import Gait
from plantar.motions.plan import RATE, Plan
from plantar.motions.stance import stand
from plantar.online.estimator import FootEstimator
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER
from plantar.twin.play import planned
from plantar.twin.presets import preset_named
from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import truth_columns
from plantar.twin.simulation import rollout
from plantar.twin.simulation.mjcf import SERVO_ANGLE
from plantar.twin.simulation.physics import Physics
from plantar.twin.walking.control import WalkingControl

SETTLED = 12.0  # s of a motion, before which nothing is scored
ALONG, ACROSS = 0.02, 0.06  # m: half of how far the ZMP of `Sway` moves
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


def sway() -> Plan:
    """Standing: the ZMP moves between the feet and along them, and no foot lifts."""
    robot = hrp2.robot()
    body = Body(robot)
    start = stand(body, hrp2.postures().standing, {"right": (0.0, 0.0)}, None)

    def waypoints(gait: Gait, soles: Mapping[str, pin.SE3], middles: Mapping[str, Array]) -> Footsteps:
        found = footsteps(gait, soles, middles)
        middle, time = found.waypoints[0, 1:], np.arange(0.0, 36.1, 1.0)
        size = np.where((time > 1.5) & (time < 34.0), 1.0, 0.0)
        moved = size[:, None] * np.column_stack(
            [ALONG * np.sin(2 * np.pi * time / 5), ACROSS * np.sin(2 * np.pi * time / 7)]
        )
        return Footsteps(found.start, (), np.column_stack([time, middle + moved]))

    with patch.object(walk, "footsteps", waypoints):
        return walk.walk_plan(body, "Sway", start, Gait(0.0, 1.0, 0.0, 1, 0))


def chest_lean(robot: RobotModel, plan: Plan, played: rollout.Rollout) -> float:
    """Rms of the IMU's roll and pitch away from its plan [rad]."""
    assert robot.imu is not None
    model, (joint, pose) = robot.floating_model, robot.frame(robot.imu.placement)
    carrier = int(model.getJointId(robot.model.names[joint])) if joint else 1
    data, squares = model.createData(), []
    places = [model.joints[model.getJointId(name)].idx_q for name in plan.joints]
    for sample in np.flatnonzero(plan.time >= SETTLED)[::5]:
        q = pin.neutral(model)
        q[:7], q[places] = pin.SE3ToXYZQUAT(pin.SE3(plan.base[sample])), plan.positions[sample]
        pin.forwardKinematics(model, data, q)
        wanted = (data.oMi[carrier] * pose).rotation[2]
        measured = rotation_from_quaternion(played.sensors["imu.orientation"][sample][None])[0, 2]
        squares.append(np.arccos(min(1.0, float(wanted @ measured))) ** 2)
    return float(np.sqrt(np.mean(squares)))


def zmp_error(robot: RobotModel, plan: Plan, played: rollout.Rollout) -> float:
    """Rms of the zero-moment point away from its plan, the feet believed to stand where they should [m]."""
    assert plan.walk is not None
    truth = truth_columns(played, cut_feet(describe(robot), robot))
    total, moment = np.zeros(plan.time.size), np.zeros((plan.time.size, 2))
    for foot in robot.feet:
        load = truth[f"{foot}.contact.force.z"]
        pressure = np.column_stack([truth[f"{foot}.contact.cop.{axis}"] for axis in "xy"])
        sole = plan.walk.soles[foot]
        place = sole[:, :2, 3] + np.einsum("nij,nj->ni", sole[:, :2, :2], pressure)
        loaded = np.isfinite(pressure).all(axis=1)
        total += np.where(loaded, load, 0.0)
        moment += np.where(loaded[:, None], load[:, None] * place, 0.0)
    late = (plan.time >= SETTLED) & (total > 0.0)
    away = moment[late] / total[late, None] - plan.walk.zmp[late]
    return float(np.sqrt(np.mean(np.sum(away**2, axis=1))))


def main(motion: str = "Walk12") -> None:
    robot = hrp2.robot()
    physics = preset_named("sensors").physics(PAPER)
    plan = sway() if motion == "Sway" else planned(motion, robot)
    xml = rollout.scene_xml(robot, plan, physics)
    for case in CASES:
        Believing.case = case
        with patch.object(rollout, "WalkingControl", Believing):
            try:
                played = rollout.roll_out(robot, plan, physics, xml)
            except MotionError as error:
                print(f"{case:7} {error}", flush=True)
                continue
        lean, away = chest_lean(robot, plan, played), zmp_error(robot, plan, played)
        print(f"{case:7} chest {1e3 * lean:.2f} mrad rms, ZMP {1e3 * away:.1f} mm rms", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])

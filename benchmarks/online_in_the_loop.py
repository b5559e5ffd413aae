"""The twin walks with what its stabiliser believes of its feet: rigid, half, double, true stiffness, or learnt online.

    python benchmarks/online_in_the_loop.py --motion Walk12
    python benchmarks/online_in_the_loop.py --motion Sway --preset realistic
    python benchmarks/online_in_the_loop.py --motion Sway --stiffer 8 --cases rigid true online

The physics is the same; only the compliance differs by which the stabiliser turns a wanted torque into an angle. `Sway`
stands and moves its weight. Prints how far chest attitude and zero-moment point are from their plans, from 12 s on.
"online" begins with double the stiffness and takes each foot's numbers from the estimator once they are known for
motions like those made; "identified" waits until a memory of the rubber is excluded; "told" is the same with a batch
result that knows the rubber's element or that it has none. The estimator's sensors are the stabiliser's own, exact at
200 Hz. When each number is believed first is told in seconds of control, which begins 3 s before the motion.
`--stiffer`: times the paper's feet, on which a robot that believes them rigid falls at once.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar
from unittest.mock import patch

import mujoco
import numpy as np
import pinocchio as pin

from online import Twin, law
from plantar.conventions import ROTATIONAL_AXES, Array, rotation_from_quaternion
from plantar.errors import MotionError
from plantar.motions import walk
from plantar.motions.body import Body
from plantar.motions.footsteps import Footsteps, footsteps
from plantar.motions.gait import Gait
from plantar.motions.plan import RATE, Plan
from plantar.motions.stance import stand
from plantar.online.estimates import Flag
from plantar.online.estimator import FootEstimator
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER
from plantar.twin.bush import Feet
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
CASES = ("rigid", "half", "double", "true", "online", "identified", "told")
ONLINE = ("online", "identified", "told")
UNKNOWN = {"pitch": Flag.PITCH_UNKNOWN | Flag.PITCH_MEMORY, "roll": Flag.ROLL_UNKNOWN | Flag.ROLL_MEMORY}


class Believing(WalkingControl):
    """The twin's controller with another belief about its feet."""

    case = "true"
    bushes: Feet = PAPER
    batch: FeetResult | None = None
    believed: ClassVar[dict[str, float]] = {}

    def __init__(
        self, model: mujoco.MjModel, robot: RobotModel, plan: Plan, physics: Physics, joints: tuple[str, ...]
    ) -> None:
        super().__init__(model, robot, plan, physics, joints)
        self.model, self.robot, self.tick = model, robot, 0
        limits = self.estimator.model.upperEffortLimit
        self.servo = {foot: limits[self.feet.legs[foot]][-2:].min() / SERVO_ANGLE for foot in robot.feet}
        factor = {"half": 0.5, "double": 2.0} | dict.fromkeys(ONLINE, 2.0)
        for foot, bush in self.bushes.items():
            for place, axis in enumerate(("roll", "pitch")):
                stiffness = factor.get(self.case, 1.0) * getattr(bush, f"{axis}_stiffness")
                if self.case == "rigid":
                    stiffness = np.inf
                self.believe(foot, place, stiffness, getattr(bush, f"{axis}_damping"))
        feet = {
            name: replace(foot, wrench=replace(foot.wrench, placement=foot.bush, sign=1.0))
            for name, foot in robot.feet.items()
        }
        sensing = replace(robot, feet=feet, uncertainty=EXACT)
        batch = self.batch if self.case == "told" else None
        self.online = FootEstimator(sensing, batch, wrench_delay=0.0) if self.case in ONLINE else None
        self.believed.clear()
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
                known = one.identified if self.case != "online" else not now.flags & UNKNOWN[axis]
                if known:
                    self.believed.setdefault(f"{foot} {axis}", self.tick / RATE)
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


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--motion", default="Walk12")
    parser.add_argument("--preset", default="sensors", help="whose rubber; the sensors are exact")
    parser.add_argument("--stiffer", type=float, default=1.0)
    parser.add_argument("--cases", nargs="+", default=list(CASES), choices=CASES)
    chosen = parser.parse_args()
    robot, preset = hrp2.robot(), preset_named(chosen.preset)
    bushes = Physics().stiffened(chosen.stiffer - 1).bushes or {}
    Believing.bushes, Believing.batch = bushes, law(preset, 0, Twin(robot, bushes))
    physics = preset.physics(bushes)
    plan = sway() if chosen.motion == "Sway" else planned(chosen.motion, robot)
    xml = rollout.scene_xml(robot, plan, physics)
    print(f"{chosen.motion}, {chosen.preset}, feet {chosen.stiffer:g} times as stiff as the paper's")
    for case in chosen.cases:
        Believing.case = case
        with patch.object(rollout, "WalkingControl", Believing):
            try:
                played = rollout.roll_out(robot, plan, physics, xml)
            except MotionError as error:
                print(f"{case:10} {error}", flush=True)
                continue
        lean, away = chest_lean(robot, plan, played), zmp_error(robot, plan, played)
        first = ", ".join(f"{what} {time:.1f} s" for what, time in Believing.believed.items())
        print(f"{case:10} chest {1e3 * lean:.2f} mrad rms, ZMP {1e3 * away:.2f} mm rms  {first}", flush=True)


if __name__ == "__main__":
    main()

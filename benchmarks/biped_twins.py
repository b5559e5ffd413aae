"""Twins of bipeds whose URDFs come with example-robot-data, built as `plantar init` cannot know them.

What the URDF tells stays: legs, links, axes of the standing robot. What it does not is drawn: how high and how far
aside the bushes sit, where the force sensors are and how they are turned, where on its link the IMU is, what the soles
measure. Each robot draws its own, the same each time.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import yaml

import talos
from plantar.conventions import GRAVITY, Array, rotation_from_rpy
from plantar.errors import MotionError
from plantar.exporters.poses import pose, rpy_of
from plantar.robot.model import RobotModel, load_robot
from plantar.robot_guess import guess_robot_file
from plantar.robot_guess.imu import right_angles
from plantar.twin import Bush
from plantar.twin.bush import Feet
from plantar.twin.play import play_all
from plantar.twin.robots import hrp2

MODELS = talos.URDF.parents[2]
URDFS: Mapping[str, str] = {
    "talos": "talos_data/robots/talos_reduced.urdf",
    "talos_full": "talos_data/robots/talos_full_v2.urdf",
    "g1": "g1_description/urdf/g1_29dof_rev_1_0.urdf",
    "g1_hands": "g1_description/urdf/g1_29dof_with_hand_rev_1_0.urdf",
    "icub": "icub_description/robots/icub.urdf",
    "icub_reduced": "icub_description/robots/icub_reduced.urdf",
    "romeo": "romeo_description/urdf/romeo_small.urdf",
    "romeo_fingers": "romeo_description/urdf/romeo.urdf",
    "alexander": "alexander_description/urdf/alexander_v1.lowerBodyOnly.urdf",
    "human": "human_description/robots/human.urdf",
    "simple_humanoid": "simple_humanoid_description/urdf/simple_humanoid.urdf",
    "alex": "alex_description/urdf/alex_nub_hands.urdf",
    "bolt": "bolt_description/robots/bolt.urdf",
}
HRP2 = "hrp2"  # the built-in twin's robot
MOTIONS = ("Tilt3", "Manual_left_pitch", "Manual_right_roll", "Myrand5")
PRESET = "sensors"  # springs and dampers: the truth is two numbers an axis
THICKNESS = (0.012, 0.045)  # m, of the rubber and what is below it
ASIDE = 0.005  # m, of a bush's centre, forward and to the side
LARGER = 0.05  # share by which soles are longer or shorter than drawn
OFF_TRUNK = 0.1  # m at most, of an IMU from its link's origin along each axis
MOUNT = np.radians(0.5)  # of an IMU in its housing, about each axis
STIFFER = (2.0, 3.2)  # times what the robot's weight asks of both bushes together
FEET_APART = (None, 0.3)  # m: as in the posture, or as a robot stands whose posture has them on each other
RATES = {"pitch": (0.018, 0.03), "roll": (0.018, 0.04)}  # s: damping over stiffness


def urdf_of(name: str, folder: Path) -> Path:
    """Where a robot's URDF is; the built-in one is written into `folder`."""
    return load_robot(hrp2.write(folder)).urdf_path if name == HRP2 else MODELS / URDFS[name]


def known_robot(name: str, urdf: Path, folder: Path) -> RobotModel:
    """The robot as it is: a file in `folder` beside which init's is held. Raises RobotError where init refuses."""
    random = np.random.default_rng(zlib.crc32(name.encode()))
    file = folder / "known.yaml"
    entry: dict[str, Any] = yaml.safe_load(guess_robot_file(urdf, [], file))
    turn = right_angles()[int(random.integers(24))]  # of both force sensors, as they are the same part
    rise = float(random.uniform(*THICKNESS))
    rung = float(random.choice([0.0, 0.5, 1.0]))  # of the force sensors: at the sole, between, in the ankle
    larger = random.normal(1.0, LARGER, 2)
    for foot in entry["feet"].values():
        axes = rotation_from_rpy(np.array(foot["sole"].get("rpy", [0, 0, 0]), dtype=float))
        depth = float(axes[:, 2] @ foot["sole"]["xyz"])
        height = depth + min(rise, 0.8 * abs(depth))
        aside = random.normal(0, ASIDE, 2)
        sensor = [0.0, 0.0, (1 - rung) * depth]
        foot["bush"] |= {"xyz": (axes @ [*aside, height]).tolist()}
        foot["wrench"] |= {
            "link": foot["ankle"],
            "xyz": (axes @ sensor).tolist(),
            "rpy": rpy_of(pose(np.zeros(3), rotation=axes @ turn)).tolist(),
        }
        foot["sole"]["polygon"] = (np.array(foot["sole"]["polygon"]) * larger).tolist()
    imu = entry["imu"]
    imu["rpy"] = (np.array(imu.get("rpy", [0, 0, 0]), dtype=float) + random.normal(0, MOUNT, 3)).tolist()
    if "imu" not in imu["link"].lower():  # else the frame is the IMU's own
        imu["xyz"] = random.uniform(-OFF_TRUNK, OFF_TRUNK, 3).tolist()
    file.write_text(yaml.safe_dump(entry))
    return load_robot(file)


def bushes_of(name: str, robot: RobotModel) -> Feet:
    """Bushes that carry a robot of this weight and height."""
    random = np.random.default_rng(zlib.crc32(f"{name} bushes".encode()))
    model = robot.model
    data, neutral = model.createData(), pin.neutral(model)
    centre = np.array(pin.centerOfMass(model, data, neutral))
    pin.framesForwardKinematics(model, data, neutral)
    soles = [robot.frame(foot.sole.placement) for foot in robot.feet.values()]
    places = [(data.oMi[joint] * place).translation for joint, place in soles]
    height = float(np.linalg.norm(centre - np.mean(places, axis=0)))
    least = robot.mass * GRAVITY * height / 2

    def one() -> Bush:
        pitch, roll = (least * float(random.uniform(*STIFFER)) * share for share in (1.1, 0.9))
        damping = [stiffness * float(random.uniform(*RATES[axis]))
                   for axis, stiffness in (("pitch", pitch), ("roll", roll))]  # fmt: skip
        vertical = robot.mass * GRAVITY / float(random.uniform(0.002, 0.004))
        return Bush(pitch, damping[0], roll, damping[1], vertical, 0.005 * vertical)

    return {foot: one() for foot in robot.feet}


def recorded(robot: RobotModel, bushes: Feet, folder: Path, seed: int) -> tuple[list[Path], list[str]]:
    """Logs of the motions that the robot can do, and why it cannot do the others."""
    paths, refused = list[Path](), list[str]()
    for motion in MOTIONS:
        reasons = list[str]()
        for apart in FEET_APART:
            try:
                log = play_all([motion], robot, bushes, PRESET, [seed], apart=apart)[0][0]
            except MotionError as error:
                reasons.append(str(error))
                continue
            paths.append(log.write(folder))
            break
        else:
            refused.append(reasons[-1])
    return paths, refused


def placed(robot: RobotModel, part: str, foot: str = "") -> tuple[Array, Array]:
    """Place (3,) [m] and axes (3, 3) of the `imu`, or of a foot's `bush`, `wrench` or `sole`, in its joint's frame; the
    axes of a sensor that reads the opposite turned round."""
    assert robot.imu is not None
    if part == "imu":
        _, found = robot.frame(robot.imu.placement)
        return np.array(found.translation), np.array(found.rotation)
    own = robot.feet[foot]
    placement = {"bush": own.bush, "wrench": own.wrench.placement, "sole": own.sole.placement}[part]
    _, found = robot.frame(placement)
    sign = own.wrench.sign if part == "wrench" else 1.0
    return np.array(found.translation), sign * np.array(found.rotation)

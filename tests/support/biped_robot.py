"""The robot of `biped`: its URDF of sliding legs, its robot file, and where sensors and bushes sit."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import yaml
from scipy.spatial.transform import Rotation

from plantar.robot.model import RobotModel, load_robot
from plantar.robot.uncertainty import EXACT

FEET = ("left", "right")
HIPS = {"left": np.array([0.0, 0.1, -0.1]), "right": np.array([0.0, -0.1, -0.1])}
SOLE_DEPTH = 0.09  # m below the foot link's origin


@dataclass(frozen=True)
class Frame:
    """Where something sits on its link: `xyz` [m], `rpy` [rad]."""

    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @cached_property
    def rotation(self) -> np.ndarray:
        return Rotation.from_euler("xyz", self.rpy).as_matrix()

    def entry(self, **more: object) -> dict[str, object]:
        return {**more, "xyz": list(self.xyz), "rpy": list(self.rpy)}


@dataclass(frozen=True)
class Mounting:
    """Where sensors and bush sit; the defaults can be moved to show that results do not depend on them."""

    imu: Frame = Frame((-0.05, 0.02, 0.3))
    bush: Frame = Frame((0.0, 0.0, -0.06))
    wrench: Frame = Frame((0.01, 0.0, -0.04))
    sign: int = 1


AS_USUAL = Mounting()


def write_robot(folder: Path, mounting: Mounting = AS_USUAL, **changes: object) -> Path:
    """`biped.urdf` and `robot.yaml` in `folder`; `changes` replace keys of the latter. Returns the latter's path."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "biped.urdf").write_text(URDF)
    path = folder / "robot.yaml"
    path.write_text(yaml.safe_dump({**robot_entry(mounting), **changes}, sort_keys=False))
    return path


def robot_entry(mounting: Mounting = AS_USUAL) -> dict[str, object]:
    """The robot file's content."""
    feet = {
        foot: {
            "ankle": f"{foot}_foot",
            "bush": mounting.bush.entry(),
            "wrench": mounting.wrench.entry(name=foot, link=f"{foot}_foot", sign=mounting.sign),
            "sole": {
                "link": f"{foot}_sole",
                "polygon": [[0.13, 0.08], [-0.13, 0.08], [-0.13, -0.08], [0.13, -0.08]],
            },
        }
        for foot in FEET
    }
    return {
        "name": "biped",
        "urdf": "biped.urdf",
        "imu": mounting.imu.entry(name="chest", link="torso"),
        "feet": feet,
        "uncertainty": asdict(EXACT),  # tests that ask for more say so
    }


def make_robot(folder: Path, mounting: Mounting = AS_USUAL, **changes: object) -> RobotModel:
    return load_robot(write_robot(folder, mounting, **changes))


def _leg(foot: str) -> str:
    """Three slides in series, ankle pitch, ankle roll, foot and sole."""
    hip = " ".join(map(str, HIPS[foot]))
    parts = []
    joints = [
        ("leg_x", "1 0 0"),
        ("leg_y", "0 1 0"),
        ("leg_z", "0 0 1"),
        ("ankle_pitch", "0 1 0"),
        ("ankle_roll", "1 0 0"),
    ]
    links = ["torso", *(f"{foot}_{name}" for name in ("thigh", "knee", "shin", "ankle", "foot"))]
    for (joint, axis), parent, child in zip(joints, links, links[1:], strict=False):
        kind, xyz = ("prismatic" if "leg" in joint else "revolute"), (hip if joint == "leg_x" else "0 0 0")
        parts.append(
            f'<joint name="{foot}_{joint}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>'
            f'<limit lower="-1.2" upper="1.2" effort="100" velocity="10"/></joint>'
        )
        parts.append(_link(child, 4.2 if child.endswith("foot") else 0.2))
    return "".join(parts) + (
        f'<link name="{foot}_sole"/><joint name="{foot}_sole_fixed" type="fixed"><parent link="{foot}_foot"/>'
        f'<child link="{foot}_sole"/><origin xyz="0 0 {-SOLE_DEPTH}"/></joint>'
    )


def _link(name: str, mass: float) -> str:
    inertia = f'ixx="{0.02 * mass}" ixy="0" ixz="0" iyy="{0.02 * mass}" iyz="0" izz="{0.01 * mass}"'
    return f'<link name="{name}"><inertial><mass value="{mass}"/><inertia {inertia}/></inertial></link>'


URDF = (
    '<robot name="biped">'
    + _link("torso", 48.0)
    + _leg("left")
    + _leg("right")
    + _link("head", 2.0)
    + '<joint name="neck" type="revolute"><parent link="torso"/><child link="head"/><origin xyz="0 0 0.4"/>'
    '<axis xyz="0 0 1"/><limit lower="-1.5" upper="1.5" effort="5" velocity="5"/></joint></robot>'
)

"""A small biped in URDF, MJCF and SDFormat, and a result whose numbers are known, for the export tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from plantar.conventions import DAMPING_UNIT, STIFFNESS_UNIT, rotation_from_rpy

# foot -> axis -> K, C, offset
TRUTH: dict[str, dict[str, tuple[float, float, float]]] = {
    "left": {"z": (40000.0, 400.0, 20.0), "pitch": (480.0, 24.27, 5.66), "roll": (352.0, 28.15, -4.12)},
    "right": {"pitch": (434.0, 15.89, 4.79), "roll": (323.0, 17.53, -0.05)},
}
UNITS = {"stiffness": STIFFNESS_UNIT, "damping": DAMPING_UNIT}
CENTRE = np.array([0.01, 0.0, -0.08])  # of the bush in the ankle
RPY = {"left": np.array([0.0, 0.0, 0.3]), "right": np.zeros(3)}
SOLE_Z = -0.11
POLYGON = [[0.1, 0.06], [-0.1, 0.06], [-0.1, -0.06], [0.1, -0.06]]


def bush_rotation(foot: str) -> np.ndarray:
    return rotation_from_rpy(RPY[foot])


def result(urdf: Path, robot: str = "biped") -> dict[str, Any]:
    """A plantar.feet/1 result with TRUTH in it; the sole is given in the URDF's own sole frame."""
    parameters, offsets = [], []
    for foot, axes in TRUTH.items():
        for axis, (k, c, o) in axes.items():
            for name, value in (("stiffness", k), ("damping", c)):
                parameters.append({"foot": foot, "axis": axis, "name": name, "unit": UNITS[name][axis], "value": value,
                                   "std": 0.01 * value, "interval95": [0.98 * value, 1.02 * value],
                                   "verdict": "usable"})  # fmt: skip
            for motion, shift in (("sway", -0.5), ("squat", 0.5)):
                offsets.append(
                    {"foot": foot, "axis": axis, "motion": motion, "unit": "N.m", "value": o + shift}
                )
    feet = {
        foot: {
            "ankle": f"{foot}_ankle",
            "bush": {"link": f"{foot}_ankle", "xyz": CENTRE.tolist(), "rpy": RPY[foot].tolist()},
            "sole": {"link": f"{foot}_sole", "xyz": [0, 0, 0], "rpy": [0, 0, 0], "polygon": POLYGON},
        }
        for foot in TRUTH
    }
    return {"schema": "plantar.feet/1", "robot": robot, "plantar": "0.1.0", "parameters": parameters,
            "offsets": offsets, "notes": [], "robot_model": {"urdf": str(urdf), "feet": feet}}  # fmt: skip


INERTIAL = (
    '<inertial><origin xyz="{com}"/><mass value="{mass}"/>'
    '<inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial>'
)


def _box(tag: str, name: str, size: str, xyz: str) -> str:
    return f'<{tag} name="{name}"><origin xyz="{xyz}"/><geometry><box size="{size}"/></geometry></{tag}>'


def write_urdf(path: Path, *, rigid_legs: bool = False) -> Path:
    """A pelvis on two legs of one hip and one ankle joint; each foot one box that reaches the ground."""
    kind = "fixed" if rigid_legs else "revolute"
    parts = ['<link name="pelvis">' + INERTIAL.format(com="0 0 0", mass=20, i=0.3) + "</link>"]
    for side, y in (("left", 0.1), ("right", -0.1)):
        shin = INERTIAL.format(com="0 0 -0.2", mass=4, i=0.05)
        ankle = INERTIAL.format(com="0 0 -0.03", mass=1.5, i=0.005)
        limit = '<limit lower="-1" upper="1" effort="100" velocity="10"/>'
        parts.append(
            f'<link name="{side}_shin">{shin}{_box("collision", "shin", "0.08 0.08 0.4", "0 0 -0.2")}</link>'
            f'<link name="{side}_ankle">{ankle}{_box("collision", "cover", "0.08 0.08 0.05", "0 0 0")}'
            f"{_box('collision', 'foot', '0.2 0.12 0.04', f'0.01 0 {SOLE_Z + 0.02}')}</link>"
            f'<link name="{side}_sole"/><link name="{side}_sensor"/>'
            f'<joint name="{side}_hip" type="{kind}"><origin xyz="0 {y} 0"/><parent link="pelvis"/>'
            f'<child link="{side}_shin"/><axis xyz="0 1 0"/>{limit}</joint>'
            f'<joint name="{side}_ankle_pitch" type="{kind}"><origin xyz="0 0 -0.4"/><parent link="{side}_shin"/>'
            f'<child link="{side}_ankle"/><axis xyz="0 1 0"/>{limit}</joint>'
            f'<joint name="{side}_sensor_fix" type="fixed"><origin xyz="0 0 -0.05"/><parent link="{side}_ankle"/>'
            f'<child link="{side}_sensor"/></joint>'
            f'<joint name="{side}_sole_fix" type="fixed"><origin xyz="0 0 {SOLE_Z}"/><parent link="{side}_ankle"/>'
            f'<child link="{side}_sole"/></joint>'
        )
    path.write_text(f'<?xml version="1.0"?>\n<robot name="biped">\n{"".join(parts)}\n</robot>\n')
    return path


def write_mjcf(path: Path) -> Path:
    """The same robot as a user's MJCF: classes with traps, a keyframe, sites, an exclude, an included file."""
    (path.parent / "defaults.xml").write_text(
        '<mujocoinclude><default><joint damping="3" armature="0.2" frictionloss="1" stiffness="7" limited="true" '
        'range="-60 60"/><geom density="800"/><default class="foot"><geom type="box" rgba="1 0 0 1"/></default>'
        "</default></mujocoinclude>"
    )
    legs = ""
    for side, y in (("left", 0.1), ("right", -0.1)):
        legs += f"""
      <body name="{side}_shin" pos="0 {y} 0">
        <joint name="{side}_hip" axis="0 1 0"/>
        <geom name="{side}_shin_geom" type="box" size="0.04 0.04 0.21" pos="0 0 -0.2"/>
        <body name="{side}_ankle" pos="0 0 -0.4" childclass="foot">
          <joint name="{side}_ankle_pitch" axis="0 1 0"/>
          <geom name="{side}_cover" size="0.04 0.04 0.025"/>
          <geom name="{side}_foot" size="0.1 0.06 0.02" pos="0.01 0 {SOLE_Z + 0.02}"/>
          <!-- the sole's frame -->
          <site name="{side}_sole" pos="0 0 {SOLE_Z}"/>
          <site name="{side}_ft" pos="0 0 {SOLE_Z + 0.01}"/>
          <body name="{side}_heel" pos="-0.08 0 -0.1"><geom size="0.01 0.05 0.009" mass="0.1"/></body>
        </body>
      </body>"""
    path.write_text(f"""<mujoco model="biped">
  <include file="defaults.xml"/>
  <worldbody>
    <geom name="floor" type="plane" size="3 3 0.1"/>
    <body name="pelvis" pos="0 0 0.52">
      <freejoint/>
      <geom type="box" size="0.1 0.15 0.1" mass="20" pos="0 0 0.1"/>{legs}
    </body>
  </worldbody>
  <contact><exclude body1="left_ankle" body2="right_ankle"/></contact>
  <sensor><force site="left_ft"/><torque site="right_ft"/></sensor>
  <actuator><motor joint="left_hip"/></actuator>
  <keyframe><key name="bent" qpos="0 0 0.52 1 0 0 0 0.1 0.2 0.3 0.4" qvel="1 2 3 4 5 6 7 8 9 10"/></keyframe>
</mujoco>
""")
    return path


def write_sdf(path: Path, version: str) -> Path:
    """The same robot in SDFormat: poses in the model frame (before 1.7) or relative to joints."""
    parts = ["<link name='pelvis'><pose>0 0 0.5 0 0 0</pose><inertial><mass>20</mass></inertial></link>"]
    modern = version >= "1.7"
    box = "<collision name='{n}'><pose>{p} 0 0 0</pose><geometry><box><size>{s}</size></box></geometry></collision>"
    for side, y in (("left", 0.1), ("right", -0.1)):

        def place(height: float, joint: str, local: str, y: float = y) -> str:
            return (
                f"<pose relative_to='{joint}'>{local}</pose>"
                if modern
                else f"<pose>0 {y} {height} 0 0 0</pose>"
            )

        def joint(name: str, kind: str, parent: str, child: str, at: str) -> str:
            where = f"<pose relative_to='{parent}'>{at} 0 0 0</pose>" if modern else ""
            axis = "" if kind == "fixed" else "<axis><xyz>0 1 0</xyz></axis>"
            return (f"<joint name='{name}' type='{kind}'>{where}<parent>{parent}</parent><child>{child}</child>"
                    f"{axis}</joint>")  # fmt: skip

        zero = "0 0 0 0 0 0"
        cover = box.format(n="cover", p="0 0 0", s="0.08 0.08 0.05")
        foot = box.format(n="foot", p=f"0.01 0 {SOLE_Z + 0.02}", s="0.2 0.12 0.04")
        parts.append(
            f"<link name='{side}_shin'>{place(0.5, side + '_hip', zero)}<inertial><mass>4</mass></inertial></link>"
            f"<link name='{side}_ankle'>{place(0.1, side + '_ankle_pitch', zero)}"
            f"<inertial><mass>1.5</mass></inertial>{cover}{foot}</link>"
            f"<link name='{side}_sole'>{place(0.1 + SOLE_Z, side + '_sole_fix', zero)}"
            "<inertial><mass>0.01</mass></inertial></link>"
            + joint(f"{side}_hip", "fixed", "pelvis", f"{side}_shin", f"0 {y} 0")
            + joint(f"{side}_ankle_pitch", "fixed", f"{side}_shin", f"{side}_ankle", "0 0 -0.4")
            + joint(f"{side}_sole_fix", "fixed", f"{side}_ankle", f"{side}_sole", f"0 0 {SOLE_Z}")
        )
    path.write_text(f"<sdf version='{version}'><model name='biped'>{''.join(parts)}</model></sdf>")
    return path

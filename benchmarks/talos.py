"""TALOS on bushes of its own, a second robot for the benchmarks: its URDF comes with example-robot-data."""

from __future__ import annotations

from pathlib import Path

import pinocchio as pin

from plantar.robot.model import RobotModel, load_robot
from plantar.twin import Bush
from plantar.twin.bush import Feet

URDF = Path(pin.__file__).parents[4] / "share/example-robot-data/robots/talos_data/robots/talos_reduced.urdf"
BUSHES: Feet = {
    "left": Bush(950.0, 24.0, 760.0, 30.0, 300e3, 1500.0),
    "right": Bush(870.0, 18.0, 700.0, 22.0, 240e3, 1500.0),
}
FOOT = """  {side}:
    ankle: leg_{side}_6_link
    bush: {{xyz: [0, 0, -0.08]}}
    wrench: {{name: {side}, link: leg_{side}_6_link, xyz: [0, 0, -0.08]}}
    sole: {{xyz: [0, 0, -0.107], polygon: [[0.105, 0.07], [-0.105, 0.07], [-0.105, -0.07], [0.105, -0.07]]}}
"""


def robot(folder: Path) -> RobotModel:
    """Write TALOS' robot file into a folder and load it."""
    (folder / "talos.urdf").write_text(URDF.read_text())
    feet = "".join(FOOT.format(side=side) for side in BUSHES)
    file = folder / "talos.yaml"
    file.write_text(f"name: talos\nurdf: talos.urdf\nimu: {{name: chest, link: torso_2_link}}\nfeet:\n{feet}")
    return load_robot(file)

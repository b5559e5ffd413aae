"""Robots from URDFs as they are published, rounded and with links of next to no inertia, stand in MuJoCo."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from example_robots import G1, ICUB, ROMEO
from plantar.robot.model import load_robot
from plantar.robot_guess import guess_robot_file
from plantar.twin import Bush
from plantar.twin.simulation.mjcf import Scene, mjcf_text

BUSH = Bush(300.0, 6.0, 220.0, 5.0, 200e3, 800.0)


@pytest.mark.parametrize("urdf", [ICUB, G1, ROMEO], ids=lambda path: path.stem)
def test_published_urdfs_stand_in_mujoco_with_their_weight(tmp_path: Path, urdf: Path) -> None:
    """iCub's URDF has inertias of 1e-20, which MuJoCo refuses in words that name no link."""
    file = tmp_path / "robot.yaml"
    file.write_text(guess_robot_file(urdf, [], file))
    robot = load_robot(file)
    model = mujoco.MjModel.from_xml_string(mjcf_text(robot, {"left": BUSH, "right": BUSH}, Scene()))
    assert float(np.sum(model.body_mass)) == pytest.approx(robot.mass, rel=2e-3)

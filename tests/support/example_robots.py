"""URDFs of real robots that the test dependency example-robot-data brings along."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin

from plantar.conventions import Array

ROBOTS = Path(pin.__file__).parents[4] / "share" / "example-robot-data" / "robots"
TALOS = ROBOTS / "talos_data/robots/talos_reduced.urdf"
G1 = ROBOTS / "g1_description/urdf/g1_29dof_rev_1_0.urdf"
ICUB = ROBOTS / "icub_description/robots/icub.urdf"
HUMANOID = ROBOTS / "simple_humanoid_description/urdf/simple_humanoid.urdf"
HAND = ROBOTS / "allegro_hand_description/urdf/allegro_right_hand.urdf"
PANDA = ROBOTS / "panda_description/urdf/panda.urdf"
UR5 = ROBOTS / "ur_description/urdf/ur5_robot.urdf"
HUMAN = ROBOTS / "human_description/robots/human.urdf"
ROMEO = ROBOTS / "romeo_description/urdf/romeo_small.urdf"
GO2 = ROBOTS / "go2_description/urdf/go2.urdf"
CENTAURO = ROBOTS / "centauro_description/urdf/centauro.urdf"
BOLT = ROBOTS / "bolt_description/robots/bolt.urdf"
BAXTER = ROBOTS / "baxter_description/urdf/baxter.urdf"
TIAGO = ROBOTS / "tiago_description/robots/tiago_no_hand.urdf"


def model(urdf: Path, *, floating: bool = False) -> pin.Model:
    text = urdf.read_text()
    return pin.buildModelFromXML(text, pin.JointModelFreeFlyer()) if floating else pin.buildModelFromXML(text)


def talos_file(folder: Path) -> Path:
    """A robot file of TALOS in `folder`."""
    feet = "".join(
        f"""  {side}:
    ankle: leg_{side}_6_link
    bush: {{xyz: [0, 0, -0.09]}}
    wrench: {{name: {side}, xyz: [0, 0, -0.08]}}
    sole: {{xyz: [0, 0, -0.107], polygon: [[0.105, 0.07], [-0.105, 0.07], [-0.105, -0.07], [0.105, -0.07]]}}
"""
        for side in ("left", "right")
    )
    path = folder / "talos.yaml"
    path.write_text(f"name: talos\nurdf: {TALOS}\nimu: {{name: chest, link: torso_2_link}}\nfeet:\n{feet}")
    return path


def random_motion(model: pin.Model, samples: int, seed: int) -> tuple[Array, Array, Array]:
    pin.seed(seed)
    bound = 2 * np.ones(model.nq)
    q = np.array([pin.randomConfiguration(model, -bound, bound) for _ in range(samples)])
    rng = np.random.default_rng(seed)
    return q, rng.normal(size=(samples, model.nv)), rng.normal(size=(samples, model.nv))

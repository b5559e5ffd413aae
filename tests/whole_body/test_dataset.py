"""A log made ready for eq. 1: which foot stands, however its sensor is mounted."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from biped import record, sway
from biped_robot import Frame, Mounting, write_robot
from plantar.conventions import GRAVITY
from plantar.robot.model import load_robot
from plantar.whole_body.dataset import Body, _stands


def test_a_foot_stands_by_the_force_along_its_soles_normal(tmp_path: Path) -> None:
    """A sensor that lies on its side and reads the robot's push says the same."""
    turned = Mounting(wrench=Frame((0.01, 0.0, -0.04), (0.4, 1.2, 0.3)), sign=-1)
    motion = sway(duration=4.0)
    for mounting in (Mounting(), turned):
        body = Body.of(load_robot(write_robot(tmp_path / str(mounting.sign), mounting)), floating=True)
        log = record(motion, mounting)
        assert _stands(body, log, "left").all()
        names = [name for name in log.columns if name.startswith("wrench.left.force.")]
        force = np.linalg.norm(log.stack(names), axis=1)
        for share in (0.1, 0.3):  # of the weight
            scaled = {name: share * body.robot.mass * GRAVITY * log.column(name) / force for name in names}
            assert _stands(body, log.with_columns(scaled), "left").all() == (share > 0.2)

"""A log made ready for eq. 1: which foot stands, however its sensor is mounted, and what is left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from biped import record, sway
from biped_robot import Frame, Mounting, write_robot
from plantar.conventions import GRAVITY
from plantar.robot.model import load_robot
from plantar.whole_body.dataset import Body, _stands, prepare_whole
from plantar.whole_body.settings import DynamicsSettings


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


def test_what_a_rope_holds_for_a_while_is_left_out(tmp_path: Path) -> None:
    """A quarter of the weight for 8 s of 30: eq. 1 holds before and after. Feet that stand always may read any load."""
    log = record(sway(duration=30.0))
    rope = 1 - 0.25 * ((log.time > 10) & (log.time < 18))
    held = log.with_columns(
        {name: rope * log.column(name) for name in log.columns if name.endswith("force.z")}
    )
    body = Body.of(load_robot(write_robot(tmp_path)), floating=True)
    free, found = (prepare_whole(body, each, DynamicsSettings()) for each in (log, held))
    assert "held_for_a_while" not in {note.code for note in free.notes}
    (note,) = (note for note in found.notes if note.code == "held_for_a_while")
    assert note.severity == "warning"
    time = found.log.time
    assert not found.valid[(time > 10.2) & (time < 17.8)].any()
    np.testing.assert_array_equal(found.valid[(time < 7) | (time > 21)], free.valid[(time < 7) | (time > 21)])
    always = replace(
        body.robot, feet={name: replace(foot, contact="always") for name, foot in body.robot.feet.items()}
    )
    assert (
        prepare_whole(replace(body, robot=always), held, DynamicsSettings()).valid.sum() == free.valid.sum()
    )

"""Ports by their roles become one log: its clock, its columns, its file; parts of a port, units and signs."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.logs.readers.column_map import Port
from plantar.logs.readers.ports import joints_for, log_of_ports, port_columns
from plantar.logs.readers.read_limit import ReadLimit
from plantar.notes import Note

START = 1_700_000_000.0
STAMPS = START + 0.25 + np.arange(20) / 100
VALUES = np.arange(20.0)[:, None] * [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]


def test_a_log_of_ports_counts_from_its_first_second(tmp_path: Path) -> None:
    """Encoders in degrees, two joints of them; a force sensor that reads the other way; a port without a role."""
    roles = {
        "arm": [Port("joints.position", unit="deg", joints=("hip", "knee"), take=(1, 3))],
        "ft": [Port("wrench.left", sign=-1.0)],
    }
    data = {"arm": (STAMPS, VALUES), "ft": (STAMPS, VALUES), "other": (STAMPS - 9.5, VALUES[:, :1])}
    notes = [Note("file_cut", "warning", "arm is cut")]
    limit = ReadLimit(tmp_path, memory=2**20, files=[])
    log = log_of_ports("sway", limit, "f00d", data, roles, None, notes)
    assert (log.name, log.path, log.sha256, log.notes) == ("sway", tmp_path, "f00d", tuple(notes))
    # The earliest stamp of any port is 9.25 s before START.
    np.testing.assert_allclose(log.time, 10.25 + np.arange(20) / 100, atol=1e-6)
    for place, joint in enumerate(("hip", "knee"), start=1):
        np.testing.assert_allclose(log.column(f"joint.{joint}.position"), np.radians(VALUES[:, place]))
    np.testing.assert_allclose(log.wrench("left"), -VALUES)
    assert set(log.columns) == {
        "joint.hip.position", "joint.knee.position",
        *(f"wrench.left.{part}.{axis}" for part in ("force", "torque") for axis in "xyz"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("columns", "found"), [({}, ("hip", "knee")), ({"joints": ["knee", "hip"]}, ("knee", "hip"))]
)
def test_joints_without_names_are_those_of_the_robot_file_or_else_of_the_urdf(
    columns: Any, found: Any
) -> None:
    robot: Any = SimpleNamespace(columns=columns, joint_names=("hip", "knee"), path=Path("robot.yaml"))
    notes: list[Note] = []
    assert joints_for(2, robot, Path("log.x"), notes) == found
    assert bool(notes) is not bool(columns), "an order that is told is no guess"
    port = Port("joints.velocity")
    made = port_columns(port, VALUES[:, :2], robot, Path("log.x"), [])
    assert [made[f"joint.{name}.velocity"][1] for name in found] == [1.0, 2.0]

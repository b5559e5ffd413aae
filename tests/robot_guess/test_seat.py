"""Where the ground pushes, by a force sensor whose seat is known."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped_robot import URDF
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot_guess.seat import Seat, is_fixed, pressure

DEPTH = -0.09  # m: where the sole's plane lies in the foot's axes


@pytest.mark.parametrize("sign", [1, -1])
def test_the_centre_of_pressure_is_where_the_force_passes_through_the_sole(sign: int) -> None:
    """In the foot's axes, whatever the ankle link's and the sensor's are: by the wrench of one force at one place."""
    upright = Rotation.from_euler("xyz", [0.3, -0.2, 1.0]).as_matrix()  # the foot's axes in the ankle link
    rotation = Rotation.from_euler("xyz", [0.5, 0.1, -0.7]).as_matrix()  # the sensor's in its own link
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("xyz", [-0.4, 0.2, 0.6]).as_matrix()
    pose[:3, 3] = [0.01, 0.02, -0.03]
    seat = Seat("sensor", np.array([0.0, 0.01, 0.02]), rotation, "", True, 0.0, sign=sign)
    place, axes = pose[:3, :3] @ seat.xyz + pose[:3, 3], pose[:3, :3] @ rotation
    at, force = np.array([0.05, -0.02, DEPTH]), np.array([20.0, -30.0, 500.0])  # in the foot's axes
    torque = np.cross(upright @ at - place, upright @ force)  # about the sensor, in the ankle link
    wrench = sign * np.concatenate([axes.T @ upright @ force, axes.T @ torque])
    found = pressure(seat, SimpleNamespace(upright=upright, depth=DEPTH), wrench[None], pose)  # type: ignore[arg-type]
    assert found[0] == pytest.approx([0.05, -0.02, 500.0])


def test_a_frame_beyond_a_joint_or_of_no_link_is_not_fixed_to_the_ankle(tmp_path: Path) -> None:
    (tmp_path / "biped.urdf").write_text(URDF)
    tree = UrdfTree.load(tmp_path / "biped.urdf")
    frames = ("left_foot", "left_sole", "torso", "right_foot", "nowhere")
    assert [is_fixed(tree, "left_foot", frame) for frame in frames] == [True, True, False, False, False]

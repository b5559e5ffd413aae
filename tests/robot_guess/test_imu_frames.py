"""Which frame the IMU's tilts are those of, and which others may still be meant."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from example_robots import G1, ICUB
from plantar.conventions import Array, rotation_from_rpy
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot_guess import _first_draft
from plantar.robot_guess.imu import Mount, find_frame, turned_to_gravity
from plantar.robot_guess.sensors import Sensors
from plantar.robot_guess.stance import Stance

SAMPLES = 200


def poses(pitch: Array) -> Array:
    """Of a link that pitches over level soles, (n, 4, 4)."""
    made = np.tile(np.eye(4), (len(pitch), 1, 1))
    made[:, :3, :3] = [rotation_from_rpy(np.array([0.0, angle, 0.0])) for angle in pitch]
    return made


@pytest.mark.parametrize("named", ["torso", "twin", "head"])
def test_a_frame_that_tilts_otherwise_is_not_offered(named: str) -> None:
    sway = np.radians(4) * np.sin(np.linspace(0, 20, SAMPLES))
    links = {"torso": poses(sway), "twin": poses(sway), "head": poses(0 * sway)}
    felt = np.einsum("nji,j->ni", links["torso"][:, :3, :3], [0.0, 0.0, 1.0])
    up = np.tile([0.0, 0.0, 1.0], (SAMPLES, 1))
    none = np.zeros(SAMPLES, np.intp)
    stance = Stance({}, {}, np.zeros((SAMPLES, 3)), up, {}, {}, felt, links, none)
    others = tuple(link for link in links if link != named)
    found = turned_to_gravity(Mount(named, np.eye(3), True, "a frame", others), stance)
    assert found.link in ("torso", "twin")
    assert {found.link, *found.others} == {"torso", "twin"}
    assert ("tilts as the IMU does" in found.reason) == (named == "head")


def leaning(frame: float, felt: float) -> Mount:
    """What is guessed of a mount whose frame leans by `frame` [deg], of an IMU that feels up leant by `felt` [deg]."""
    sway = np.radians(4) * np.sin(np.linspace(0, 20, SAMPLES))
    links = {"torso": poses(sway)}
    turn = rotation_from_rpy(np.array([np.radians(felt - frame), 0.0, 0.0]))
    up = np.einsum("nji,j->ni", links["torso"][:, :3, :3], [0.0, 0.0, 1.0]) @ turn.T
    level = np.tile([0.0, 0.0, 1.0], (SAMPLES, 1))
    none = np.zeros(SAMPLES, np.intp)
    stance = Stance({}, {}, np.zeros((SAMPLES, 3)), level, {}, {}, up, links, none)
    return turned_to_gravity(Mount("torso", np.eye(3), False, "told"), stance)


def test_angles_between_imu_and_soles_are_told_in_degrees() -> None:
    for felt, before, after in ((6.0, "soles are ", " deg apart"), (90.0, "as it is, ", " deg off gravity"),
                                (40.0, "turned by ", " deg to agree")):  # fmt: skip
        reason = leaning(0.0, felt).reason
        assert float(reason.split(before)[1].split(after)[0]) == pytest.approx(felt, abs=0.5)
    assert np.abs(np.degrees(leaning(0.0, 90.0).rpy)).max() == 90.0


def test_a_first_draft_takes_the_frame_of_the_imus_own_messages() -> None:
    sensors = Sensors(imus={"torso": "chest", "spare": ""}, wrenches={"torso": "head"})
    draft = _first_draft(UrdfTree.load(ICUB), [], sensors, ICUB)
    assert draft.imu is not None
    assert (draft.imu[0], draft.imu[1].link) == ("torso", "chest")
    assert draft.imu[1].reason.endswith("; the logs also hold spare")


def test_imu_frames_come_before_skins_and_say_what_else_there_is() -> None:
    tree = UrdfTree.load(ICUB)
    assert find_frame(tree, "chest", "").link == "imu_frame"
    assert find_frame(tree, "chest", "chest").link == "chest", "the frame of its messages"
    assert find_frame(UrdfTree.load(G1), "pelvis", "").link == "imu_in_pelvis"
    assert find_frame(UrdfTree.load(G1), "imu", "").others == ("imu_in_pelvis",)


@pytest.mark.parametrize(
    ("name", "frame"), [("chest_imu", ""), ("imu0", "biped/chest_imu"), ("imu_link", "trunk")]
)
def test_a_chest_is_a_trunk_and_a_torso_before_any_other_part_of_the_body(name: str, frame: str) -> None:
    """Also where only the frame of its messages says so, which the URDF does not have."""
    links = ("pelvis_link", "waist_link", "torso_link", "hand_link")
    robot = "".join(f"<link name='{link}'/>" for link in links) + "".join(
        f"<joint name='j{k}' type='fixed'><parent link='{one}'/><child link='{next_}'/></joint>"
        for k, (one, next_) in enumerate(pairwise(links))
    )
    found = find_frame(
        UrdfTree(ET.fromstring(f"<robot name='b'>{robot}</robot>"), Path("b.urdf")), name, frame
    )
    assert found.link == "torso_link"
    assert "torso" in found.reason
    assert not found.others

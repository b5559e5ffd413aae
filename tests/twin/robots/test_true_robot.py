"""A robot drawn about its robot file: the same for the same seed, as far off as asked, and a robot that can exist."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.robot.model import load_robot
from plantar.twin.robots import hrp2
from plantar.twin.robots.true_robot import RobotSpread, true_robot

EXACT = RobotSpread(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_the_seed_decides() -> None:
    first, again, other = (true_robot(hrp2.robot(), RobotSpread(), seed) for seed in (3, 3, 4))
    assert first[0].urdf == again[0].urdf
    assert first[1] == again[1]
    assert first[0].urdf != other[0].urdf
    assert first[1]["imu"] != other[1]["imu"]


def test_what_was_drawn_is_what_differs() -> None:
    file = hrp2.robot()
    before = file.urdf
    robot, drawn = true_robot(file, RobotSpread(), 7)
    assert file.urdf == before
    assert robot.joint_names == file.joint_names
    for joint, name in enumerate(file.joint_names, 1):
        true, told = robot.model.inertias[joint], file.model.inertias[joint]
        link = next(
            link for link in drawn["links"] if link.endswith(f"LINK{name[-1]}") and link[:4] == name[:4]
        )
        if name[:4] in {"RLEG", "LLEG"}:
            assert true.mass / told.mass - 1 == pytest.approx(drawn["links"][link]["mass"], abs=1e-9)
            np.testing.assert_allclose(true.lever - told.lever, drawn["links"][link]["com"], atol=1e-9)
    for side, foot in robot.feet.items():
        moved = foot.bush.xyz - file.feet[side].bush.xyz
        np.testing.assert_allclose(moved, drawn[f"{side}.bush"]["xyz"])


def test_draws_have_the_spread_that_was_asked_for() -> None:
    drawn = [true_robot(hrp2.robot(), RobotSpread(), seed)[1] for seed in range(12)]
    masses = [link["mass"] for one in drawn for link in one["links"].values()]
    assert np.std(masses) == pytest.approx(0.05, rel=0.2)
    turns = [angle for one in drawn for part in ("imu", "right.wrench") for angle in one[part]["turn"]]
    assert np.std(turns) == pytest.approx(0.01, rel=0.35)


def test_without_spread_it_is_the_file() -> None:
    file = hrp2.robot()
    robot, _ = true_robot(file, EXACT, 5)
    for true, told in zip(robot.model.inertias, file.model.inertias, strict=True):
        assert true.isApprox(told, 1e-9)
    np.testing.assert_allclose(robot.imu.placement.rotation, file.imu.placement.rotation, atol=1e-12)


def test_an_inertia_that_no_body_can_have_is_drawn_about_too(tmp_path: Path) -> None:
    """Files in use hold some: a hollow shell's moments that are not those of any mass."""
    file = load_robot(hrp2.write(tmp_path))
    link = next(link for link in ET.fromstring(file.urdf).iter("link") if link.find("inertial") is not None)
    name = str(link.get("name"))
    urdf = ET.fromstring(file.urdf)
    inertia = urdf.find(f"link[@name='{name}']/inertial/inertia")
    assert inertia is not None
    inertia.set("ixx", "-0.001")
    told = replace(file, urdf=ET.tostring(urdf, encoding="unicode"))
    robot, drawn = true_robot(told, RobotSpread(), 7)
    assert name in drawn["links"]
    assert robot.mass != told.mass

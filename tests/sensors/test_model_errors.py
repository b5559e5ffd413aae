"""Inertial parameters drawn about a URDF's own, by as much as the robot file says that they may be off."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from example_robots import ICUB
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.uncertainty import Uncertainty
from plantar.robot_guess import guess_robot_file
from plantar.sensors.model_errors import LIGHT, drawn_imu_turns, drawn_parameter_errors, link_errors
from plantar.twin.robots import hrp2


def robot(mass: float, centre: float) -> RobotModel:
    return replace(hrp2.robot(), uncertainty=Uncertainty(link_mass=mass, link_com=centre))


def test_draws_spread_as_the_robot_file_says() -> None:
    own = hrp2.robot().floating_model
    masses = np.array([inertia.mass for inertia in list(own.inertias)[1:]])
    heavier = drawn_parameter_errors(robot(0.05, 0.0)).reshape(-1, len(masses), 10)
    assert np.std(heavier[:, :, 0] / masses) == pytest.approx(0.05, rel=0.15)
    moved = drawn_parameter_errors(robot(0.0, 0.005)).reshape(-1, len(masses), 10)
    assert np.abs(moved[:, :, 0]).max() < 1e-12
    assert np.std(moved[:, :, 1:4] / masses[:, None]) == pytest.approx(0.005, rel=0.15)


def test_an_exact_urdf_has_no_draws() -> None:
    assert len(drawn_parameter_errors(robot(0.0, 0.0))) == 0
    assert len(link_errors(robot(0.0, 0.0))) == 0


def test_links_errors_are_what_pinocchio_says_of_a_link_that_is_off() -> None:
    told = robot(0.05, 0.005)
    bodies = list(told.floating_model.inertias)[1:]
    heavy = [place for place, body in enumerate(bodies) if body.mass > LIGHT * told.mass]
    found = link_errors(told).reshape(4, len(heavy), len(bodies), 10)
    for number, place in enumerate(heavy):
        body = bodies[place]
        assert not np.delete(found[:, number], place, axis=1).any()
        np.testing.assert_allclose(found[0, number, place], 0.05 * body.toDynamicParameters(), atol=1e-12)
        for axis, along in enumerate(np.eye(3)):
            moved = pin.Inertia(body.mass, body.lever + 1e-6 * along, body.inertia).toDynamicParameters()
            slope = (moved - body.toDynamicParameters()) / 1e-6
            np.testing.assert_allclose(found[1 + axis, number, place], 0.005 * slope, atol=1e-6)


def test_draws_and_links_errors_say_the_same() -> None:
    told = robot(0.05, 0.005)
    spread = np.sqrt(np.sum(link_errors(told) ** 2, axis=0))
    large = spread > 0.02 * spread.max()
    np.testing.assert_allclose(np.std(drawn_parameter_errors(told), axis=0)[large], spread[large], rtol=0.4)


def test_every_recording_meets_the_same_wrong_robots() -> None:
    first, second = (drawn_parameter_errors(robot(0.05, 0.005)) for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_links_with_next_to_no_inertia_are_drawn_too(tmp_path: Path) -> None:
    """iCub's URDF gives some links an inertia of 1e-20 or so: drawn anew, it may be a hair negative."""
    file = tmp_path / "robot.yaml"
    file.write_text(guess_robot_file(ICUB, [], file))
    drawn = drawn_parameter_errors(load_robot(file))
    assert np.isfinite(drawn).all()
    assert np.abs(drawn).max() > 0.01


def test_imus_are_turned_as_the_robot_file_says() -> None:
    told = replace(hrp2.robot(), uncertainty=Uncertainty(imu_mount=0.02))
    turns = drawn_imu_turns(told)
    assert np.sqrt(np.mean(turns**2)) == pytest.approx(0.02, rel=0.15)
    np.testing.assert_array_equal(drawn_imu_turns(told), turns)
    assert len(drawn_imu_turns(replace(told, uncertainty=Uncertainty(imu_mount=0.0)))) == 0

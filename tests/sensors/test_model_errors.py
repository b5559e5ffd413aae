"""Inertial parameters and IMU's mount drawn about a robot file's own, by as much as it says that they may be off."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from example_robots import ICUB
from plantar.conventions import GRAVITY
from plantar.dynamics import equation_of, model_parameters
from plantar.dynamics.inertial_motion import inertial_signals
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.uncertainty import EXACT, Uncertainty
from plantar.robot_guess import guess_robot_file
from plantar.sensors.model_errors import DELAY_DRAWS, drawn_parameter_errors, drawn_wrench_errors
from plantar.twin.robots import hrp2


def unsure(mass: float, centre: float) -> RobotModel:
    return replace(hrp2.robot(), uncertainty=Uncertainty(link_mass=mass, link_com=centre))


def test_draws_spread_as_the_robot_file_says() -> None:
    own = hrp2.robot().floating_model
    masses = np.array([inertia.mass for inertia in list(own.inertias)[1:]])
    heavier = drawn_parameter_errors(unsure(0.05, 0.0)).reshape(-1, len(masses), 10)
    assert np.std(heavier[:, :, 0] / masses) == pytest.approx(0.05, rel=0.15)
    moved = drawn_parameter_errors(unsure(0.0, 0.005)).reshape(-1, len(masses), 10)
    assert np.abs(moved[:, :, 0]).max() < 1e-12
    assert np.std(moved[:, :, 1:4] / masses[:, None]) == pytest.approx(0.005, rel=0.15)


def test_an_exact_urdf_has_no_draws() -> None:
    assert len(drawn_parameter_errors(unsure(0.0, 0.0))) == 0


def test_every_recording_meets_the_same_wrong_robots() -> None:
    first, second = (drawn_parameter_errors(unsure(0.05, 0.005)) for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_links_with_next_to_no_inertia_are_drawn_too(tmp_path: Path) -> None:
    """iCub's URDF gives some links an inertia of 1e-20 or so: drawn anew, it may be a hair negative."""
    file = tmp_path / "robot.yaml"
    file.write_text(guess_robot_file(ICUB, [], file))
    drawn = drawn_parameter_errors(load_robot(file))
    assert np.isfinite(drawn).all()
    assert np.abs(drawn).max() > 0.01


def test_an_imu_that_may_be_turned_makes_the_weight_lean_as_far_either_way(robot: RobotModel) -> None:
    """A turn about a level axis swings the weight sideways by as much; one about the vertical does nothing to it."""
    turn, still = 0.02, slice(0, 3)
    own = replace(robot, uncertainty=replace(EXACT, imu_mount=turn))
    equation, parameters = equation_of(own.floating_model), model_parameters(own.floating_model)
    signals = inertial_signals(own, record(sway(duration=2.0)), 8.0)
    mount = robot.required_imu.placement.rotation
    signals = replace(
        signals, rate=0 * signals.rate, proper=np.tile(GRAVITY * mount.T[:, 2], (len(signals.rate), 1))
    )
    drawn = drawn_wrench_errors(own, equation, signals, still, parameters)
    assert drawn.shape == (DELAY_DRAWS, 3, 6)
    leans = drawn[:, 0, :3] / (robot.mass * GRAVITY)
    # Of sixteen draws a spread is known to a fifth of itself.
    assert np.std(leans[:, :2]) == pytest.approx(turn, rel=0.4)
    assert np.abs(leans[:, 2]).max() < 1e-3 * turn
    heavy = replace(own, uncertainty=replace(own.uncertainty, link_mass=0.05))
    both = drawn_wrench_errors(heavy, equation, signals, still, parameters)
    heavier = drawn_wrench_errors(
        replace(heavy, uncertainty=replace(EXACT, link_mass=0.05)), equation, signals, still, parameters
    )
    np.testing.assert_allclose(both, drawn + heavier, rtol=1e-9, atol=1e-9)
    exact = replace(own, uncertainty=EXACT)
    assert len(drawn_wrench_errors(exact, equation, signals, still, parameters)) == 0

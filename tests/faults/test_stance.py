"""The balance of a standing robot, by hand: moments about the centre of mass over the load."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import Frame, Mounting, make_robot
from plantar.faults.stance import Stance, StanceSides, stance_of, usual
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def stance(robot: RobotModel) -> Stance:
    found = stance_of(robot, record(sway(duration=12.0)))
    assert found is not None
    return found


def test_a_torque_adds_its_moment_arm(stance: Stance) -> None:
    """20 N.m at one foot, over the whole load, is so many metres, in the sole's own direction."""
    before = stance.sides()
    load = usual(sum(wrench[:, :3] for wrench in stance.wrenches))
    pushed = [wrench.copy() for wrench in stance.wrenches]
    pushed[0][:, 3] += 20.0
    after = Stance(stance.robot, stance.imu, stance.orientation, stance.positions, pushed).sides()
    moved = after.moment_arms.sum(axis=(1, 2)) - before.moment_arms.sum(axis=(1, 2))
    assert usual(moved) == pytest.approx(20.0 / load, rel=0.05)


def test_a_sensor_on_its_side_is_loaded_as_well(tmp_path: Path, stance: Stance) -> None:
    mounting = Mounting(wrench=Frame((0.01, 0.0, -0.04), (0.0, np.pi / 2, 0.0)))
    found = stance_of(make_robot(tmp_path, mounting), record(sway(duration=12.0), mounting))
    assert found is not None
    together, expected = (one.sides().moment_arms.sum(axis=(1, 2)) for one in (found, stance))
    np.testing.assert_allclose(together, expected, atol=1e-6)


def test_changes_undo_themselves(stance: Stance) -> None:
    as_read = stance.sides().moment_arms
    for again in (
        stance.exchanged_wrenches().exchanged_wrenches(),
        stance.exchanged_joints(1, 2).exchanged_joints(1, 2),
        stance.scaled_joint(3, -1.0).scaled_joint(3, -1.0),
    ):
        assert np.array_equal(again.sides().moment_arms, as_read)


def test_a_log_in_the_air_has_no_stance(robot: RobotModel) -> None:
    log = record(sway(duration=12.0))
    light = {name: 0 * log.column(name) for name in log.columns if name.startswith("wrench.")}
    assert stance_of(robot, MotionLog(log.name, log.time, {**log.columns, **light})) is None


def test_a_hum_of_the_structure_is_no_unbalanced_moment(robot: RobotModel, stance: Stance) -> None:
    """40 Hz in the same horizontal force of both feet, which the samples meet at any phase; and a gap beside some."""
    log = record(sway(duration=12.0))
    hum = 60.0 * np.sin(2 * np.pi * 40.3 * log.time)
    hum[::97] = np.nan
    loud = {name: log.column(name) + hum for name in log.columns if name.endswith("force.x")}
    found = stance_of(robot, MotionLog(log.name, log.time, {**log.columns, **loud}))
    assert found is not None
    assert found.sides().misfit == pytest.approx(stance.sides().misfit, abs=0.003)
    bare = replace(found, wrenches=[wrench + [60.0, 0, 0, 0, 0, 0] for wrench in found.wrenches])
    assert bare.sides().misfit > 0.05  # what the hum's crest would make


@pytest.mark.parametrize("degrees", [-120.0, -30.0, 0.0, 90.0])
def test_up_that_sways_in_another_direction_than_the_force_is_turned(degrees: float) -> None:
    """By the right hand about the vertical, from up's direction to the force's."""
    phase = np.linspace(0.0, 40.0, 50)
    tilts = np.radians(3.0) * np.column_stack([np.cos(phase), 0.3 * np.sin(3 * phase)])
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    noise = np.radians(0.2) * np.random.default_rng(1).normal(size=tilts.shape)
    up, push = (
        np.column_stack([level, np.ones(len(level))])
        for level in (tilts, tilts @ np.array([[cos, sin], [-sin, cos]]) + noise)
    )
    angle, deviation = StanceSides(np.zeros((50, 2, 6, 3)), up, push).turn
    # Noise across of 0.2 degrees beside tilts of `size` degrees in all: the angle of a mean of so many.
    size = np.degrees(np.sqrt(np.sum((tilts - tilts.mean(axis=0)) ** 2)))
    assert deviation == pytest.approx(0.2 * np.sqrt(2) / size, rel=0.3)
    assert angle == pytest.approx(np.radians(degrees), abs=3 * deviation)


@pytest.mark.parametrize("rpy", [(0.0, 0.0, 0.0), (0.0, np.pi / 2, 0.0)])
def test_sensors_below_the_rubber_are_turned_back_to_the_ankles(
    tmp_path: Path, rpy: tuple[float, float, float]
) -> None:
    """Of a robot that faces along the world's x, level soles have the world's axes."""
    mounting = Mounting(wrench=Frame((0.01, 0.0, -0.04), rpy))
    robot = make_robot(tmp_path, mounting)
    above = stance_of(robot, record(sway(duration=12.0), mounting))
    assert above is not None
    root, each, _ = above._posed
    below = list[np.ndarray]()
    for wrench, axes, foot in zip(above.wrenches, each, robot.feet.values(), strict=True):
        mount = foot.wrench.placement.rotation
        level = wrench.reshape(-1, 2, 3) @ (axes @ root.transpose(0, 2, 1)) @ mount
        below.append(level.reshape(-1, 6))
    as_read = replace(above, wrenches=below)
    right = above.sides().moment_arms.sum(axis=(1, 2))
    wrong, back = (
        one.sides().moment_arms.sum(axis=(1, 2)) - right for one in (as_read, as_read.sole_wrenches())
    )
    assert usual(wrong) > 0.002
    assert usual(back) < 0.05 * usual(wrong)

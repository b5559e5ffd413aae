"""Worlds in plain MuJoCo: what the exact sensors read is what springs, weight and geometry make."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from outside import sensors
from outside.motions import plan
from outside.physics import Motion, play
from outside.robots import EXACT, Spread, real_robot, rubber_of, write_told
from outside.rubber import GRAVITY, Rubber
from outside.stance import Stance
from plantar.conventions import Array
from plantar.robot.model import RobotModel, load_robot

SECONDS = 8.0
SEEN = slice(3000, 6000)  # of its milliseconds
SEED = 3


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return real_robot("hrp2", tmp_path_factory.mktemp("hrp2"))


@pytest.fixture(scope="module", params=[False, True], ids=["springs", "sliding"])
def played(robot: RobotModel, request: pytest.FixtureRequest) -> tuple[Motion, dict[str, Rubber]]:
    rubber = rubber_of(robot, SEED, sliding=request.param)
    made = plan(Stance(robot), "mixed", SECONDS, SEED)
    return play(robot, made.start, made.targets, rubber), rubber


def at_bush(robot: RobotModel, motion: Motion, foot: str, stiffness: float) -> tuple[Array, Array]:
    """In the SEEN rows, torque about the sinking bush's y axis (n,), and the sole's pitch against the ankle (n,)."""
    model, side = robot.model, robot.feet[foot]
    assert robot.imu is not None
    data, pitch, torque = model.createData(), [], []
    read = (motion.joints[SEEN], motion.orientation[SEEN], motion.wrenches[foot][SEEN])
    for joints, seen, wrench in zip(*read, strict=True):
        pin.forwardKinematics(model, data, joints)
        parts = [robot.frame(place) for place in (robot.imu.placement, side.bush, side.wrench.placement)]
        imu, bush, sensor = ((data.oMi[joint] * place) for joint, place in parts)
        up = (imu.rotation.T @ bush.rotation).T @ Rotation.from_quat(seen, scalar_first=True).as_matrix()[2]
        pitch.append(np.arctan2(up[0], up[2]))
        turned = bush.rotation.T @ sensor.rotation * side.wrench.sign
        force = turned @ wrench[:3]
        centre = np.array([0.0, 0.0, force[2] / stiffness])
        arm = bush.actInv(sensor).translation - centre
        torque.append((turned @ wrench[3:] + np.cross(arm, force))[1])
    return np.array(torque), np.array(pitch)


def test_soles_stay_flat_and_carry_the_robot(
    robot: RobotModel, played: tuple[Motion, dict[str, Rubber]]
) -> None:
    motion, _ = played
    assert motion.tilt < 1e-4
    still = [np.linalg.norm(wrench[:500, :3].mean(axis=0)) for wrench in motion.wrenches.values()]
    assert sum(still) == pytest.approx(robot.mass * GRAVITY, rel=2e-3)


def test_torque_is_spring_damper_and_sliding_element(
    robot: RobotModel, played: tuple[Motion, dict[str, Rubber]]
) -> None:
    motion, rubber = played
    torque, pitch = at_bush(robot, motion, "left", rubber["left"].stiffness)
    hinge, rate = rubber["left"].pitch, np.gradient(pitch, motion.time[SEEN])
    rest = torque - hinge.stiffness * pitch - hinge.damping * rate
    if hinge.slip_torque:
        inside = np.diff(rest)[50:-50] / np.diff(pitch)[50:-50]
        assert np.median(inside) == pytest.approx(hinge.slip_torque / hinge.slip_angle, rel=0.05)
    else:
        assert np.ptp(rest[50:-50]) < 0.01 * np.ptp(torque)


def test_exact_sensors_read_the_motion(robot: RobotModel, played: tuple[Motion, dict[str, Rubber]]) -> None:
    motion, _ = played
    for rate, off in ((1000.0, 1e-9), (250.0, 1e-4)):
        drawn = sensors.draw_sensors(robot, sensors.EXACT, SEED, rate=rate)
        columns = sensors.record(robot, motion, sensors.EXACT, drawn, SEED, "mixed")
        rows = np.round((columns["time"] + 0.05) * 1000).astype(int)
        read = columns[f"wrench.{robot.feet['left'].wrench.name}.force.z"]
        exact = motion.wrenches["left"][rows, 2]
        np.testing.assert_allclose(read, exact, rtol=0, atol=off * np.abs(exact).max())


def test_a_log_holds_nothing_quicker_than_its_rate_can(
    robot: RobotModel, played: tuple[Motion, dict[str, Rubber]]
) -> None:
    """A sole that strikes the floor hums at 220 Hz: samples at 250 Hz would make 30 Hz of it."""
    motion, _ = played
    hum = 50.0 * np.sin(2 * np.pi * 220.0 * motion.time)
    humming = replace(motion, wrenches={foot: one + hum[:, None] for foot, one in motion.wrenches.items()})
    drawn = sensors.draw_sensors(robot, sensors.EXACT, SEED, rate=250.0)
    name = f"wrench.{robot.feet['left'].wrench.name}.force.x"
    still, hums = (
        sensors.record(robot, each, sensors.EXACT, drawn, SEED, "mixed")[name] for each in (motion, humming)
    )
    assert np.abs(hums - still)[50:-50].max() < 2.0


def test_a_delay_and_a_filter_make_force_sensors_as_late_as_is_told(
    robot: RobotModel, played: tuple[Motion, dict[str, Rubber]]
) -> None:
    motion, _ = played
    lab = replace(sensors.EXACT, wrench_delay=(0.006, 0.006), wrench_cutoff=80.0)
    drawn = sensors.draw_sensors(robot, lab, SEED, rate=1000.0)
    columns = sensors.record(robot, motion, lab, drawn, SEED, "mixed")
    name = f"wrench.{robot.feet['left'].wrench.name}.force.x"
    late = drawn.late["left"]
    expected = np.interp(columns["time"] + 0.05 - late, motion.time, motion.wrenches["left"][:, 0])
    assert late == pytest.approx(0.006 + np.sqrt(2) / (2 * np.pi * 80))
    assert np.ptp(columns[name] - expected) < 0.02 * np.ptp(expected)


def test_the_told_robot_is_another_one_unless_the_lab_is_exact(robot: RobotModel, tmp_path: Path) -> None:
    told = load_robot(write_told(robot, Spread(), SEED, tmp_path))
    assert told.mass != pytest.approx(robot.mass, rel=1e-3)
    assert told.mass == pytest.approx(robot.mass, rel=0.1)
    same = load_robot(write_told(robot, EXACT, SEED, tmp_path))
    assert same.mass == pytest.approx(robot.mass, rel=1e-9)
    for name, foot in same.feet.items():
        np.testing.assert_allclose(foot.bush.xyz, robot.feet[name].bush.xyz, atol=1e-12)
    assert same.uncertainty.bush_position == 0

"""A channel of a wrench sensor is mended where that explains the data, and only if no other row pays for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import small_biped
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel, load_robot
from plantar.whole_body.dataset import Body, prepare_whole
from plantar.whole_body.sensor_calibration import calibrate
from plantar.whole_body.settings import DynamicsSettings

TURN = np.pi / 4  # of the sensors about the vertical: each of their channels is felt in two rows at the base


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    folder: Path = tmp_path_factory.mktemp("biped")
    small_biped.robot(folder)
    file = folder / "biped.yaml"
    file.write_text(file.read_text().replace("rpy: [0.1, 0, 0.2]", f"rpy: [0, 0, {TURN}]"))
    return load_robot(file)


@pytest.fixture(scope="module")
def log(robot: RobotModel) -> MotionLog:
    return small_biped.record(robot, robot.floating_model, "one", 1, 20.0, 0.2)


def codes(robot: RobotModel, log: MotionLog) -> set[str]:
    body = Body.of(robot, floating=True)
    return {
        note.code
        for note in calibrate(body, [prepare_whole(body, log, DynamicsSettings())], as_recorded=False)[1]
    }


def test_a_reversed_channel_of_turned_sensors_is_found(robot: RobotModel, log: MotionLog) -> None:
    names = [f"wrench.{side}.torque.x" for side in ("left", "right")]
    reversed_log = log.with_columns({name: -log.column(name) for name in names})
    assert "wrench_polarity" in codes(robot, reversed_log)
    assert "wrench_polarity" not in codes(robot, log)


def test_a_mend_that_spoils_another_row_is_refused(robot: RobotModel, log: MotionLog) -> None:
    """Torques so wrong that x reversed gives the right moment about the base's x, and a worse one about its y."""
    turn = pin.exp3(np.array([0.0, 0.0, TURN]))
    random = np.random.default_rng(3)
    wrong = 30.0 * small_biped.smooth(random, log.time, 1.0)[0]
    columns = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        names = [f"wrench.{side}.torque.{axis}" for axis in "xyz"]
        x, _, z = (sign * log.stack(names) @ turn.T).T  # in the foot's axes
        # Reversing the sensor's x swaps x and y of the foot and both their signs.
        recorded = np.column_stack([x + wrong, -x, z]) @ turn
        columns |= dict(zip(names, (sign * recorded).T, strict=True))
    assert "wrench_polarity" not in codes(robot, log.with_columns(columns))


@pytest.mark.parametrize(("degrees", "said"), [(0.5, False), (3.0, True)])
def test_a_tilted_mount_is_told_in_degrees(
    robot: RobotModel, log: MotionLog, degrees: float, said: bool
) -> None:
    """Its accelerometer and gyroscope read in axes that are turned about the IMU's x."""
    turn = pin.exp3(np.array([np.radians(degrees), 0.0, 0.0]))
    columns = {}
    for kind in ("linear_acceleration", "angular_velocity"):
        names = [f"imu.trunk.{kind}.{axis}" for axis in "xyz"]
        columns |= dict(zip(names, (log.stack(names) @ turn.T).T, strict=True))
    body = Body.of(robot, floating=True)
    tilted = prepare_whole(body, log.with_columns(columns), DynamicsSettings())
    notes = [note for note in calibrate(body, [tilted], as_recorded=False)[1] if note.code == "imu_tilt"]
    assert len(notes) == said
    for note in notes:
        told = [float(part) for part in note.text.split("by (")[1].split(")")[0].split(",")]
        assert np.linalg.norm(told) == pytest.approx(degrees, abs=0.5)

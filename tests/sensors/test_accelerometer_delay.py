"""An accelerometer that its own filter delays is told from the orientation over standing soles, and read on time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sines, sway
from biped_robot import AS_USUAL, make_robot
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import (
    AccelerometerDelay,
    accelerometer_delay,
    with_accelerometers_on_time,
)

ACCELERATION = imu_columns("chest", "linear_acceleration")
TORSO = (
    sines((0.03, 0.25, 1.0), (0.015, 0.9, 2.0)),
    sines((0.04, 0.3, 0.0), (0.02, 1.1, 1.0)),
    sines((0.0, 0.0, 0.0)),
)
SWAY = record(sway("sway", duration=30.0, torso=TORSO))


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return make_robot(tmp_path_factory.mktemp("biped"))


def late_by(delay: float, noise: float = 0.02, tilt: float = 2e-4) -> MotionLog:
    """The sway with an accelerometer that is late [s] and noisy [m/s²], its orientation wandering by `tilt` [rad]."""
    random = np.random.default_rng(3)
    at = SWAY.time - delay
    columns = {
        name: np.interp(at, SWAY.time, SWAY.columns[name]) + noise * random.standard_normal(len(at))
        for name in ACCELERATION
    }
    wander = tilt * np.cumsum(random.standard_normal((len(at), 4)), axis=0) / np.sqrt(len(at))
    for place, name in enumerate(imu_columns("chest", "orientation")):
        columns[name] = SWAY.columns[name] + wander[:, place]
    return SWAY.with_columns(columns)


def on_time(robot: RobotModel, logs: list[MotionLog]) -> list[MotionLog]:
    return with_accelerometers_on_time(robot, logs, [accelerometer_delay(robot, log) for log in logs])


@pytest.mark.parametrize("delay", [0.004, 0.0, -0.003])
def test_standing_soles_tell_how_late_it_is(robot: RobotModel, delay: float) -> None:
    found, std = accelerometer_delay(robot, late_by(delay)).late
    assert 0 < std < 0.0007
    assert abs(found - delay) < 3 * std


def test_it_is_read_at_the_moments_of_the_orientation(robot: RobotModel) -> None:
    late = late_by(0.004, noise=0.0, tilt=0.0)
    (read,) = on_time(robot, [late])
    assert [note.code for note in read.notes] == ["accelerometer_delay"]
    inner, exact = slice(200, -200), SWAY.linear_acceleration("chest")
    before, after = (np.abs(one.linear_acceleration("chest") - exact)[inner].mean() for one in (late, read))
    assert float(read.notes[0].text.split("accelerometer ")[1].split(" ±")[0]) == pytest.approx(4.0, abs=0.7)
    assert after < 0.2 * before


@pytest.mark.parametrize("delay", [0.0, 0.0008, -0.004, 0.02])
def test_none_little_early_and_a_fault_are_left_as_they_are(robot: RobotModel, delay: float) -> None:
    log = late_by(delay)
    assert on_time(robot, [log])[0] is log


def test_a_quiet_log_is_read_as_the_others_of_its_imu(robot: RobotModel) -> None:
    quiet = late_by(0.004).with_columns(
        {name: np.full(len(SWAY), np.nan) for name in imu_columns("chest", "orientation")}
    )
    assert on_time(robot, [quiet])[0] is quiet
    read = on_time(robot, [late_by(0.004), quiet])
    assert all(one.notes for one in read)


def test_without_an_accelerometer_or_a_stance_nothing_is_told(robot: RobotModel) -> None:
    hung = late_by(0.004).with_columns(
        {name: np.zeros(len(SWAY)) for name in SWAY.columns if name.startswith("wrench.")}
    )
    for log in (SWAY.with_columns({name: np.full(len(SWAY), np.nan) for name in ACCELERATION}), hung):
        assert accelerometer_delay(robot, log).late == (0.0, np.inf)
    assert AccelerometerDelay().sure == 0.0


def test_an_imu_out_of_place_is_no_delay(tmp_path: Path) -> None:
    """The robot file has the IMU 5 cm lower than it is."""
    x, y, z = AS_USUAL.imu.xyz
    told = make_robot(tmp_path, replace(AS_USUAL, imu=replace(AS_USUAL.imu, xyz=(x, y, z - 0.05))))
    found, std = accelerometer_delay(told, late_by(0.0)).late
    assert abs(found) < 3 * std


def test_identify_says_that_it_reads_the_accelerometer_earlier(robot: RobotModel) -> None:
    settings = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
    found = identify_feet(robot, [late_by(0.004)], settings=settings)
    assert sum(note.code == "accelerometer_delay" for note in found.notes) == 1

"""A tilt that orientation and gyroscope both scale is told by the accelerometer over standing soles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway
from biped_robot import AS_USUAL, Frame, Mounting, make_robot
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.sensors.attitude_scale import ATTITUDE_SCALE, AttitudeScale, attitude_scale_notes

KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return make_robot(tmp_path_factory.mktemp("robot"))


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    return [record(sway(f"sway_{seed}", seed=seed, duration=20.0)) for seed in (1, 2)]


def scaled(log: MotionLog, by: float, mounting: Mounting = AS_USUAL) -> MotionLog:
    """The trunk's tilts and rates times `by`, heading as it is; the accelerometer keeps telling the truth."""
    quaternion, mount = log.orientation("chest"), Rotation.from_matrix(mounting.imu.rotation)
    assert quaternion is not None
    trunk = Rotation.from_quat(quaternion, scalar_first=True) * mount.inv()
    yaw, pitch, roll = trunk.as_euler("ZYX").T
    told = Rotation.from_euler("ZYX", np.column_stack([yaw, by * pitch, by * roll])) * mount
    columns = dict(zip("wxyz", told.as_quat(scalar_first=True).T, strict=True))
    rates = {
        f"imu.chest.angular_velocity.{axis}": by * rate
        for axis, rate in zip("xyz", log.angular_velocity("chest").T, strict=True)
    }
    return log.with_columns({f"imu.chest.orientation.{axis}": part for axis, part in columns.items()} | rates)


def leaning(log: MotionLog, by: float) -> MotionLog:
    """An attitude that leans forward by `by` [rad] throughout: the zero of its accelerometer, say."""
    quaternion = log.orientation("chest")
    assert quaternion is not None
    told = Rotation.from_rotvec([0.0, by, 0.0]) * Rotation.from_quat(quaternion, scalar_first=True)
    columns = dict(zip("wxyz", told.as_quat(scalar_first=True).T, strict=True))
    return log.with_columns({f"imu.chest.orientation.{axis}": part for axis, part in columns.items()})


def told(result: FeetResult) -> list[str]:
    return [note.text for note in result.notes if note.code == ATTITUDE_SCALE]


@pytest.mark.parametrize("by", [0.95, 1.06])
def test_a_scaled_attitude_is_told_with_its_scale(
    robot: RobotModel, logs: list[MotionLog], by: float
) -> None:
    result = identify_feet(robot, [scaled(log, by) for log in logs], settings=KNOWN)
    (text,) = told(result)
    assert float(text.split("shows ")[1].split()[0]) == pytest.approx(by, abs=0.005)
    assert not [row for row in result.parameters if row.axis != "z" and row.verdict == "usable"]


def test_a_right_attitude_one_that_leans_and_one_without_accelerometer_say_nothing(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    right = identify_feet(robot, logs, settings=KNOWN)
    assert not told(right)
    assert [row for row in right.parameters if row.verdict == "usable"]
    assert not told(identify_feet(robot, [leaning(log, 0.02) for log in logs], settings=KNOWN))
    scaled_logs = [scaled(log, 0.95) for log in logs]
    blind = [
        MotionLog(log.name, log.time, {k: v for k, v in log.columns.items() if "linear_acc" not in k})
        for log in scaled_logs
    ]
    assert not told(identify_feet(robot, blind, settings=KNOWN))


def test_an_imu_higher_than_the_file_says_is_no_scale(robot: RobotModel, logs: list[MotionLog]) -> None:
    """By a tenth of its height, which leans by as much at 0.5 Hz."""
    assert robot.imu is not None
    placement = replace(robot.imu.placement, xyz=robot.imu.placement.xyz + np.array([0.0, 0.0, 0.1]))
    higher = replace(robot, imu=replace(robot.imu, placement=placement))
    assert not told(identify_feet(higher, logs, settings=KNOWN))
    assert told(identify_feet(higher, [scaled(log, 0.9) for log in logs], settings=KNOWN))


@pytest.mark.parametrize("rpy", [(0.2, np.pi / 2, 0.3), (np.pi / 2, 0.0, 0.0), (np.pi, 0.1, 0.0)])
def test_an_imu_that_is_mounted_on_its_side_tells_its_scale_as_well(
    tmp_path: Path, rpy: tuple[float, float, float]
) -> None:
    """Its own z axis lies level, or points down: what tilts is the axis that points up at rest."""
    mounting = Mounting(imu=Frame((-0.05, 0.02, 0.3), rpy))
    sideways = make_robot(tmp_path, mounting)
    logs = [record(sway(f"sway_{seed}", seed=seed, duration=20.0), mounting) for seed in (1, 2)]
    assert not told(identify_feet(sideways, logs, settings=KNOWN))
    (text,) = told(identify_feet(sideways, [scaled(log, 0.94, mounting) for log in logs], settings=KNOWN))
    assert float(text.split("shows ")[1].split()[0]) == pytest.approx(0.94, abs=0.005)


def made(share: float, height: float, rest: float) -> AttitudeScale:
    """Two paces of sway, 40 s: a lean of `share` of the tilt, `height` times what a metre makes, and the `rest`."""
    products = np.empty((2, 3, 3))
    basis = np.array([[share, height, rest], [1.0, 0.0, 0.0], [0.6, 0.8, 0.0]])
    products[:] = 10 * (basis @ np.diag([1.0, 1.0, 1.0]) @ basis.T)
    return AttitudeScale(products, 40.0)


def test_sums_of_logs_add_up_and_a_share_that_is_not_sure_is_not_told() -> None:
    one = made(-0.05, 0.0, 0.3)
    both = one + one
    np.testing.assert_allclose(one.share[0], [0.05, 0.05])
    np.testing.assert_allclose(both.share[0], one.share[0])
    np.testing.assert_allclose(both.share[1], one.share[1] / np.sqrt(2))
    np.testing.assert_allclose(one.share[1], 0.3 / 0.8 / np.sqrt(40))
    assert not attitude_scale_notes(one)
    assert not attitude_scale_notes(AttitudeScale())
    (note,) = attitude_scale_notes(made(-0.05, 0.0, 0.01))
    assert "0.952 times" in note.text
    assert not attitude_scale_notes(made(0.6, 0.8, 0.01)), "the height explains it all"


def test_an_attitude_that_wanders_while_the_robot_hardly_tilts_has_no_scale() -> None:
    """What is believed of a tilt is then the wander itself: it goes with the lean, what the lean leaves does not."""
    time = np.arange(0, 60, 0.05)
    tilt, wander = 0.002 * np.sin(2.0 * time), 0.004 * np.sin(0.7 * time)
    higher = 0.003 * np.sin(3.1 * time)
    for scale, found in ((1.0, False), (1.1, True)):
        believed = scale * tilt + (wander if scale == 1 else 0)
        lean = believed - tilt + 1e-5 * np.random.default_rng(3).standard_normal(len(time))
        signals = np.column_stack([lean, believed, higher])
        one = AttitudeScale(np.tile(0.05 * signals.T @ signals, (2, 1, 1)), time[-1])
        assert bool(attitude_scale_notes(one)) is found


def test_what_an_attitude_drifts_by_is_no_share_of_its_tilts(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two milliradians within half a minute: they went with the slow tilts for a while, as 6 % of them."""
    log = record(sway("sway", seed=1, duration=60.0))
    drift = 0.002 * np.cos(2 * np.pi * log.time / 33.0)
    quaternion = log.orientation("chest")
    assert quaternion is not None
    turned = Rotation.from_rotvec(np.outer(drift, [1.0, 1.0, 0.0]))
    drifting = (turned * Rotation.from_quat(quaternion, scalar_first=True)).as_quat(scalar_first=True)
    columns = {f"imu.chest.orientation.{axis}": part for axis, part in zip("wxyz", drifting.T, strict=True)}
    told = list[AttitudeScale]()
    monkeypatch.setattr("plantar.feet.prepare.attitude_scale_notes", lambda found: [told.append(found)][:0])
    identify_feet(robot, [log.with_columns(columns)], settings=KNOWN)
    share, std = told[0].share
    assert np.abs(share).max() < 0.006
    assert std.max() < 0.02

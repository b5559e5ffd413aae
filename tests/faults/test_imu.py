"""An IMU's own columns against one another: units, conventions and dead channels, each named alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sines, sway
from plantar.faults.imu import check_imu, without_odd_accelerometer
from plantar.logs.motion_log import MotionLog

GYROSCOPE, ACCELEROMETER, ORIENTATION = (
    [f"imu.chest.{kind}.{axis}" for axis in axes]
    for kind, axes in (("angular_velocity", "xyz"), ("linear_acceleration", "xyz"), ("orientation", "wxyz"))
)


@pytest.fixture(scope="module")
def log() -> MotionLog:
    torso = (
        sines((0.05, 0.4, 0.0), (0.02, 0.9, 1.0)),
        sines((0.06, 0.3, 2.0), (0.02, 0.8, 0.0)),
        sines((0.0, 0.0, 0.0)),
    )
    return record(sway(duration=40.0, torso=torso))


def scaled(names: list[str], factor: float) -> Callable[[MotionLog], MotionLog]:
    return lambda log: log.with_columns({name: factor * log.column(name) for name in names})


def held(log: MotionLog) -> MotionLog:
    """An accelerometer that repeats its first reading."""
    return log.with_columns({name: np.full(len(log), log.column(name)[0]) for name in ACCELEROMETER})


def without(names: list[str]) -> Callable[[MotionLog], MotionLog]:
    def cut(log: MotionLog) -> MotionLog:
        return MotionLog(log.name, log.time, {k: v for k, v in log.columns.items() if k not in names})

    return cut


def reordered(log: MotionLog) -> MotionLog:
    """Quaternions written x y z w."""
    moved = dict(zip(ORIENTATION, (log.column(name) for name in np.roll(ORIENTATION, -1)), strict=True))
    return log.with_columns(moved)


def inverted(log: MotionLog) -> MotionLog:
    return log.with_columns({name: -log.column(name) for name in ORIENTATION[1:]})


def dead(log: MotionLog) -> MotionLog:
    """The yaw rate, which hardly moves here, is the one that stops."""
    return log.with_columns({GYROSCOPE[2]: np.zeros(len(log))})


def turned(log: MotionLog) -> MotionLog:
    """A gyroscope that is mounted 8 degrees about the vertical beside the orientation's axes."""
    rates = Rotation.from_rotvec([0.0, 0.0, np.radians(8.0)]).apply(log.stack(GYROSCOPE))
    return log.with_columns(dict(zip(GYROSCOPE, rates.T, strict=True)))


def in_world(log: MotionLog) -> MotionLog:
    rates = Rotation.from_quat(log.stack(ORIENTATION), scalar_first=True).apply(log.stack(GYROSCOPE))
    return log.with_columns(dict(zip(GYROSCOPE, rates.T, strict=True)))


FAULTS: dict[str, tuple[Callable[[MotionLog], MotionLog], str, bool]] = {
    "degrees per second": (scaled(GYROSCOPE, 180 / np.pi), "degrees", True),
    "a gyroscope of another scale": (scaled(GYROSCOPE, 4.0), "gyroscope_scale", False),
    "a gyroscope that reads a tenth too much": (scaled(GYROSCOPE, 1.1), "gyroscope_scale", False),
    "a gyroscope about other axes": (turned, "gyroscope_frame", False),
    "a gyroscope in the world's axes": (in_world, "gyroscope_frame", False),
    "an accelerometer that points down": (scaled(ACCELEROMETER, -1.0), "sign", True),
    "a gyroscope axis reversed": (scaled(GYROSCOPE[:1], -1.0), "sign", True),
    "acceleration in g": (scaled(ACCELEROMETER, 1 / 9.80665), "accelerometer_unit", True),
    "acceleration of another scale": (scaled(ACCELEROMETER, 3.0), "accelerometer_unit", False),
    "quaternions x y z w": (reordered, "quaternion_order", True),
    "quaternions not normed": (scaled(ORIENTATION, 2.0), "quaternion_norm", True),
    "a dead gyroscope axis": (dead, "dead_channel", True),
    "a dead accelerometer": (scaled(ACCELEROMETER, 0.0), "dead_channel", False),
    "an accelerometer that reads one value": (held, "dead_channel", False),
}


SAID = {
    "a gyroscope of another scale": "columns 'imu.chest.angular_velocity.*': 4 times the orientation's rate (valid: "
    "about 1)",
    "a gyroscope about other axes": "columns 'imu.chest.angular_velocity.*': turns about axes 8 deg beside the "
    "orientation's (valid: both in the IMU's own frame)",
    "a gyroscope in the world's axes": "columns 'imu.chest.angular_velocity.*': turns about the world's axes (valid: "
    "the IMU's own)",
    "an accelerometer that reads one value": "columns 'imu.chest.linear_acceleration.*': never change; is the sensor "
    "dead? Not used (valid: m/s², about 9.81 at rest)",
}


@pytest.mark.parametrize("name", FAULTS)
def test_each_fault_is_named_and_refused_where_nothing_could_be_fitted(log: MotionLog, name: str) -> None:
    spoil, code, fatal = FAULTS[name]
    found = list(check_imu("chest", spoil(log)))
    assert [(finding.code, finding.fatal) for finding in found] == [(code, fatal)], found
    assert found[0].text == SAID.get(name, found[0].text)


def test_a_sound_imu_is_left_alone_whatever_it_lacks(log: MotionLog) -> None:
    lacking = [without(GYROSCOPE), without(ACCELEROMETER), without(ORIENTATION), scaled(ORIENTATION, -1.0)]
    for each in (log, *(change(log) for change in lacking)):
        assert list(check_imu("chest", each)) == []


def test_a_gyroscope_that_reads_one_value_on_a_robot_that_stands_still_is_not_dead(log: MotionLog) -> None:
    still = {name: np.full(len(log), log.column(name)[0]) for name in (*ORIENTATION, *ACCELEROMETER)}
    resting = log.with_columns(still | {name: np.zeros(len(log)) for name in GYROSCOPE})
    assert not [finding for finding in check_imu("chest", resting) if finding.code == "dead_channel"]


def test_a_coarse_gyroscope_that_hardly_turns_about_one_axis_is_not_dead(log: MotionLog) -> None:
    step = 0.5 * np.ptp(log.column(GYROSCOPE[1]))
    read = {name: step * np.round(log.column(name) / step) for name in GYROSCOPE[:2]}
    coarse = log.with_columns(read | {GYROSCOPE[2]: np.zeros(len(log))})
    assert not [finding for finding in check_imu("chest", coarse) if finding.code == "dead_channel"]


def test_an_accelerometer_alone_cannot_be_dead(log: MotionLog) -> None:
    """Without an orientation it is what tells gravity's direction."""
    (finding,) = check_imu("chest", scaled(ACCELEROMETER, 0.0)(without(ORIENTATION)(log)))
    assert (finding.code, finding.fatal) == ("dead_channel", True)


def test_an_inverted_attitude_is_told_by_accelerometer_or_gyroscope(log: MotionLog) -> None:
    leaning = record(sway(torso=(lambda t: 0.4 + 0.0 * t, lambda t: 0.3 * np.sin(t), lambda t: 0.0 * t)))
    findings = list(check_imu("chest", inverted(leaning)))
    assert {finding.code for finding in findings} == {"quaternion_order"}
    assert all("inverted it agrees" in finding.text for finding in findings)


@pytest.mark.parametrize(
    ("quarters", "said"), [(1, "turns about axes 90 deg beside"), (2, "turned by 180 deg about z")]
)
def test_an_orientation_turned_about_the_imus_z_is_no_other_quaternion(
    log: MotionLog, quarters: int, said: str
) -> None:
    """About one axis alone it turns as one would that is read otherwise, which the accelerometer may contradict."""
    still = sines((0.0003, 0.3, 0.0))
    nods = record(sway(torso=(still, sines((0.1, 0.4, 0.0), (0.03, 0.9, 1.0)), still)))
    half = np.pi / 4 * quarters
    w, x, y, z = (nods.column(name) for name in ORIENTATION)
    c, s = np.cos(half), np.sin(half)
    turned = (w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s)
    (finding,) = check_imu("chest", nods.with_columns(dict(zip(ORIENTATION, turned, strict=True))))
    assert finding.fatal
    assert said in finding.text
    assert ("it agrees" in finding.text) == (quarters == 2)  # half a turn is misread quaternions as well


def test_an_accelerometer_that_points_down_is_told_of_without_a_gyroscope(log: MotionLog) -> None:
    (finding,) = check_imu("chest", scaled(ACCELEROMETER, -1.0)(without(GYROSCOPE)(log)))
    assert (finding.code, finding.fatal) == ("sign", True)
    assert "gyroscope" not in finding.text
    assert "read as x y z w it agrees" in finding.text  # of an upright IMU nothing tells the two apart


def test_a_gyroscope_in_the_world_is_told_of_where_a_reversed_axis_looks_the_same() -> None:
    """Of an IMU that is mounted half a turn about the vertical, and pitches and yaws little."""
    still = sines((0.002, 0.3, 0.0))
    log = record(sway(duration=40.0, torso=(sines((0.05, 0.4, 0.0), (0.02, 0.9, 1.0)), still, still)))
    back = Rotation.from_euler("z", np.pi)
    rates = Rotation.from_quat(log.stack(ORIENTATION), scalar_first=True).apply(log.stack(GYROSCOPE))
    about = (Rotation.from_quat(log.stack(ORIENTATION), scalar_first=True) * back).as_quat(scalar_first=True)
    turned = dict(zip(GYROSCOPE, rates.T, strict=True)) | dict(zip(ORIENTATION, about.T, strict=True))
    accelerations = back.inv().apply(log.stack(ACCELEROMETER))
    turned |= dict(zip(ACCELEROMETER, accelerations.T, strict=True))
    (finding,) = check_imu("chest", log.with_columns(turned))
    assert finding.code == "sign"
    assert finding.text == (
        "column 'imu.chest.angular_velocity.x' and 'imu.chest.angular_velocity.y': turns against the orientation, "
        "which the accelerometer's up does not contradict, or all of the gyroscope turns about the world's axes "
        "(valid: right-handed about the IMU's axes)"
    )


@pytest.mark.parametrize(("degrees", "told"), [(22.0, False), (28.0, True)])
def test_an_attitude_that_leans_against_the_accelerometer_is_told_from_25_degrees_on(
    log: MotionLog, degrees: float, told: bool
) -> None:
    leaning = Rotation.from_rotvec([np.radians(degrees), 0.0, 0.0])
    believed = leaning * Rotation.from_quat(log.stack(ORIENTATION), scalar_first=True)
    quaternions = believed.as_quat(scalar_first=True)
    wrong = log.with_columns(dict(zip(ORIENTATION, quaternions.T, strict=True)))
    found = [one for one in check_imu("chest", wrong) if one.code == "attitude_mismatch"]
    assert len(found) == told
    for one in found:
        assert float(one.text.split("by ")[1].split(" deg")[0]) == pytest.approx(degrees, abs=2.0)


@pytest.mark.parametrize(("share", "told"), [(0.55, True), (0.65, False), (1.55, False), (1.65, True)])
def test_an_accelerometer_in_another_unit_is_told_beyond_its_limits(
    log: MotionLog, share: float, told: bool
) -> None:
    found = [one.code for one in check_imu("chest", scaled(ACCELEROMETER, share)(log))]
    assert ("accelerometer_unit" in found) == told


@pytest.mark.parametrize("share", [0.0, 0.01, 3.0])
def test_an_accelerometer_that_is_told_is_not_used(log: MotionLog, share: float) -> None:
    """Beside zeros, or an acceleration without gravity, no wrench would follow Newton's law."""
    assert without_odd_accelerometer("chest", log) is log
    left = without_odd_accelerometer("chest", scaled(ACCELEROMETER, share)(log))
    assert set(log.columns) - set(left.columns) == set(ACCELEROMETER)

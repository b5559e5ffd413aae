"""An accelerometer and an orientation that a filter sets apart are told by standing soles, and read on time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from biped import record, sines, sway
from biped_robot import AS_USUAL, make_robot
from plantar.feet.assess.data_faults import UNMENDED
from plantar.feet.first_look import look_at
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import (
    ORIENTATION,
    AccelerometerDelay,
    accelerometer_delay,
    device_delay,
    filter_delay,
    imu_delay,
    orientation_notes,
    with_imus_on_time,
)
from plantar.sensors.imu_filter import ImuFilter

ALIKE = 0.001
COLUMNS = 11
RATE = 1.5
STRAY = 0.0005

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
    return with_imus_on_time(
        robot, logs, imu_delay([accelerometer_delay(robot, log) for log in logs], gyroscope=None)
    )


@pytest.mark.parametrize("delay", [0.004, 0.0, -0.003])
def test_standing_soles_tell_how_late_it_is(robot: RobotModel, delay: float) -> None:
    found, std = accelerometer_delay(robot, late_by(delay)).late()
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
        assert accelerometer_delay(robot, log).late() == (0.0, np.inf)
    assert device_delay([AccelerometerDelay()]) == (0.0, np.inf)
    assert filter_delay((0.0, np.inf), ImuFilter(0.004, 1e-4, True))[0] == 0.0


def test_an_imu_out_of_place_is_no_delay(tmp_path: Path) -> None:
    """The robot file has the IMU 5 cm lower than it is."""
    x, y, z = AS_USUAL.imu.xyz
    told = make_robot(tmp_path, replace(AS_USUAL, imu=replace(AS_USUAL.imu, xyz=(x, y, z - 0.05))))
    found, std = accelerometer_delay(told, late_by(0.0)).late()
    assert abs(found) < 3 * std


def test_identify_says_that_it_reads_the_accelerometer_earlier(robot: RobotModel) -> None:
    settings = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
    found = identify_feet(robot, [late_by(0.004)], settings=settings)
    assert sum(note.code == "accelerometer_delay" for note in found.notes) == 1


@pytest.mark.parametrize(("gyroscope", "moved"), [
    (ImuFilter(0.0, 0.0003, True), True),
    (ImuFilter(0.0002, 0.0005, True), True),
    (ImuFilter(0.0002, 0.0007, True), False),  # may be as early
    (ImuFilter(-0.004, 0.0003, True), False),
    (ImuFilter(0.0, 0.0003, False), False),
    (None, False),
])  # fmt: skip
def test_early_beside_an_orientation_that_the_gyroscope_keeps_to_it_is_right(
    gyroscope: ImuFilter | None, moved: bool
) -> None:
    """Either a filter delays both, or the orientation follows the accelerometer and the gyroscope does not."""
    late, std = filter_delay((-0.006, 0.0002), gyroscope, (0.004, 0.0003))
    assert late == (-0.004 if moved else 0.0)
    assert not moved or std == pytest.approx(np.hypot(0.0003, STRAY))
    assert filter_delay((0.0, 0.0002), gyroscope, (0.004, 0.0003))[0] == 0.0  # no accelerometer is early


def orientation_late_by(delay: float) -> MotionLog:
    """The sway with orientation and gyroscope late [s]; the quaternion's sign turns, and turns back."""
    sign = np.where((SWAY.time > 12) & (SWAY.time < 13), -1.0, 1.0)
    at, moved = SWAY.time - delay, imu_columns("chest", "orientation", "angular_velocity")
    return SWAY.with_columns(
        {
            name: np.interp(at, SWAY.time, SWAY.columns[name]) * (sign if "orientation" in name else 1.0)
            for name in moved
        }
    )


@pytest.mark.parametrize("delay", [0.002, 0.004])
def test_a_trunk_that_turns_shows_a_late_orientation_otherwise_than_an_early_accelerometer(
    robot: RobotModel, delay: float
) -> None:
    found = accelerometer_delay(robot, orientation_late_by(delay))
    late, std = found.late(ORIENTATION)
    assert late == pytest.approx(delay, abs=0.0003)
    assert std < 0.0003
    assert found.late()[0] < -1.5 * delay


@pytest.mark.parametrize("without", [(), ("linear_acceleration",), ("angular_velocity",)])
def test_orientation_and_gyroscope_behind_one_filter_are_read_on_time(
    robot: RobotModel, without: tuple[str, ...]
) -> None:
    """In every log of the device, also where a sensor is missing."""
    late = orientation_late_by(0.004)
    kept = {name: values for name, values in late.columns.items() if name.split(".")[-2] not in without}
    told = [accelerometer_delay(robot, late)] * 2
    logs = [late, MotionLog(late.name, late.time, kept)]
    _, read = with_imus_on_time(robot, logs, imu_delay(told, ImuFilter(0.0, 0.0003, True)))
    assert [note.code for note in read.notes] == ["orientation_delay"]
    shown = float(read.notes[0].text.split("gyroscope ")[1].split(" ±")[0])
    assert shown == pytest.approx(4.0, abs=0.3)
    for name in imu_columns("chest", "orientation", "angular_velocity"):
        if name in kept:
            before, after = (np.abs(one.columns[name]) - np.abs(SWAY.columns[name]) for one in (late, read))
            assert np.abs(after[200:-200]).mean() < 0.2 * np.abs(before).mean()
    for name in ACCELERATION:
        assert name not in kept or read.columns[name] is SWAY.columns[name]


def told(late: float, std: float) -> AccelerometerDelay:
    """Sums that tell a delay [s] with a deviation: of a lean that goes with it alone, over 100 s."""
    rest = std**2 * RATE * 100.0
    products = np.zeros((COLUMNS, COLUMNS))
    products[:2, :2] = [[late**2 + rest, late], [late, 1.0]]
    return AccelerometerDelay(products, 100.0)


def test_what_sums_tell() -> None:
    np.testing.assert_allclose(told(0.004, 0.0005).late(), (0.004, 0.0005), rtol=1e-9)


def test_logs_of_one_device_tell_by_weight_and_less_where_they_disagree() -> None:
    logs = [told(0.003, 0.001), told(0.0042, 0.0005), AccelerometerDelay()]
    late, std = device_delay(logs)
    assert late == pytest.approx((0.003 * 1 + 0.0042 * 4) / 5)
    # Apart by 1.1 deviations: Σ (x - mean)²/σ² = 1.15 over one degree of freedom.
    assert std == pytest.approx(0.001 / np.sqrt(5) * np.sqrt(0.0012**2 / (0.001**2 + 0.0005**2)))
    agreeing = device_delay([told(0.004, 0.001), told(0.0041, 0.0005)])
    assert agreeing[1] == pytest.approx(0.001 / np.sqrt(5))


def test_a_gyroscope_behind_its_filter_tells_of_the_accelerometer_beside_it() -> None:
    """2.0 ± 1.2 ms and, from the gyroscope, 3.5 ± 1.0 ms: their mean by weight, which is sure, as neither stray is."""
    own, usual = np.hypot(0.0012, STRAY), np.hypot(0.0002, ALIKE)
    assert filter_delay((0.002, 0.0012), gyroscope=None) == (0.0, pytest.approx(own))
    late, std = filter_delay((0.002, 0.0012), ImuFilter(0.0035, 0.0002, True))
    assert late == pytest.approx((0.002 / own**2 + 0.0035 / usual**2) / (own**-2 + usual**-2))
    assert std == pytest.approx((own**-2 + usual**-2) ** -0.5)


@pytest.mark.parametrize("gyroscope", [None, ImuFilter(0.0001, 0.0001, True), ImuFilter(0.0049, 1e-5, True)])
def test_without_a_filter_or_against_it_the_accelerometer_is_believed(gyroscope: ImuFilter | None) -> None:
    """Of 1.0 ± 0.2 ms, 4.9 ms are 3.4 deviations away; 1.8 ms alone is sure."""
    assert filter_delay((0.001, 0.0002), gyroscope)[0] == 0.0
    assert filter_delay((0.0018, 0.0002), gyroscope=None)[0] == 0.0018


def test_a_gyroscope_later_than_a_filter_makes_it_tells_nothing_of_the_accelerometer() -> None:
    told = (0.003, 0.008)
    assert filter_delay(told, ImuFilter(0.0099, 1e-4, True))[0] > 0.009
    assert filter_delay(told, ImuFilter(0.0101, 1e-4, True))[0] == 0.0


def test_an_orientation_that_follows_the_accelerometer_makes_it_late_for_nothing() -> None:
    """Gyroscope and orientation are apart by another time in each log then."""
    assert filter_delay((0.004, 0.0002), ImuFilter(0.002, 0.0001, False))[0] == 0.0
    assert filter_delay((0.004, 0.0002), ImuFilter(0.0, 0.0001, True))[0] == 0.004


@pytest.mark.parametrize(("late", "moved"), [(0.0099, True), (0.0101, False), (-0.004, False)])
def test_only_a_filter_s_delay_is_undone(late: float, moved: bool) -> None:
    assert (filter_delay((late, 0.0001), gyroscope=None)[0] != 0.0) is moved


@pytest.mark.parametrize("lag", [0.0, 0.02, 0.2])
def test_an_orientation_that_lags_is_named_where_no_gyroscope_tells(robot: RobotModel, lag: float) -> None:
    kept = float(np.exp(-SWAY.period / lag)) if lag else 0.0
    columns = dict(SWAY.columns)
    for name in imu_columns("chest", "orientation"):
        own = SWAY.columns[name]
        columns[name] = lfilter([1 - kept], [1, -kept], own, zi=kept * own[:1])[0]
    lagging = replace(SWAY, columns=columns)
    blind = lagging.without(imu_columns("chest", "angular_velocity"))
    assert orientation_notes(lagging, "chest", accelerometer_delay(robot, lagging)) == []
    notes = look_at(robot, False, blind).log.notes
    assert [note.code for note in notes if note.code in UNMENDED] == (["orientation_late"] if lag else [])

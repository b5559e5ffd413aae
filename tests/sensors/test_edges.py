"""What is told of sensors turns at its limits, in its units: deviations, texts and severities by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import (
    AccelerometerDelay,
    filter_delay,
    imu_delay,
    with_imus_on_time,
)
from plantar.sensors.attitude_scale import AttitudeScale, attitude_scale_notes
from plantar.sensors.bandwidth import Fading, fading_notes, slow_filter
from plantar.sensors.delays.clock_drift import ClockDrift
from plantar.sensors.delays.delays_by_log import DelaysByLog
from plantar.sensors.delays.sensor_delay import known_delay
from plantar.sensors.imu_filter import ImuFilter, imu_filter, with_gyroscopes_on_time
from plantar.sensors.moments.moment_fit import MomentFit, Part, is_wrong
from plantar.sensors.moments.sensor_errors import turn_columns
from plantar.sensors.moments.sensor_turns import sensor_turn_notes
from plantar.sensors.moments.torque_gains import TorqueGain, torque_gain_notes
from plantar.signals.gyroscope_delay import GyroscopeDelay

WEIGHT = 700.0


def test_clocks_that_run_apart_are_told_in_per_cent_and_milliseconds() -> None:
    """A delay that grows evenly by 6 ms scatters by that over √12 about its mean."""
    found = ClockDrift(-0.0002, 30.0)
    assert found.std == pytest.approx(0.006 / np.sqrt(12))
    assert "run apart by 0.02 %: by 6 ms at the end of a log of 30 s; not corrected" in found.note.text
    apart = DelaysByLog({"a": 0.002, "b": -0.0045, "c": 0.01})
    assert apart.std == pytest.approx(np.std([0.002, -0.0045, 0.01], ddof=1))
    assert "in each log: a +2.0 ms, b -4.5 ms, c +10.0 ms; not corrected" in apart.note.text
    assert known_delay(-0.0035).note.text == "wrenches taken as -3.5 ms late, as given in the settings"


@pytest.mark.parametrize(
    ("corner", "deviations", "told"), [(8.9, 5.1, True), (9.1, 5.1, False), (8.9, 4.9, False), (-8.9, 5.1, True)]
)  # fmt: skip
def test_a_low_pass_is_told_up_to_nine_hertz_beyond_five_deviations(
    corner: float, deviations: float, told: bool
) -> None:
    """Half of the logarithm of 1 + (f / corner)² begins with f² / 2 corner²; a gain that grows is the other side's."""
    slope = -np.sign(corner) / (2 * corner**2)
    found = Fading(slope, abs(slope) / deviations)
    assert found.corner == pytest.approx(abs(corner))
    notes = fading_notes(slow_filter(found))
    assert len(notes) == told
    sides = ("forces and torques", "IMU and encoders")[:: 1 if corner > 0 else -1]
    assert not notes or notes[0].text.startswith(f"{sides[0]} fade beside {sides[1]} as motion")
    assert not notes or "behind a low-pass of 8.9 Hz, and" in notes[0].text
    assert fading_notes(slow_filter(None)) == []


@pytest.mark.parametrize(("apart", "steady"), [(2.45, True), (2.55, False)])
def test_logs_of_one_device_scatter_by_two_and_a_half_deviations(apart: float, steady: bool) -> None:
    """Two logs at ± d: the root of their mean square about the mean is √2 d."""
    half = 0.0001 * apart / np.sqrt(2)
    found = imu_filter([GyroscopeDelay(0.003 + sign * half, 0.0001, 0.9) for sign in (1, -1)] + [None])
    assert found is not None
    assert (found.late, found.std) == pytest.approx((0.003, 0.0001 * apart / np.sqrt(2)))
    assert (found.steady, found.shown) == (steady, steady)
    assert imu_filter([None]) is None


def imu_log(*kinds: str) -> MotionLog:
    time = 0.01 * np.arange(500)
    columns = {"imu.chest.orientation.w": np.ones(500)}
    columns |= {f"imu.chest.orientation.{axis}": np.zeros(500) for axis in "xyz"}
    columns |= {f"imu.chest.{kind}.{axis}": time for kind in kinds for axis in "xyz"}
    return MotionLog("log", time, columns)


@pytest.mark.parametrize(
    ("late", "kinds", "said"),
    [(0.0034, ("angular_velocity",), "gyroscope 3.4 ms behind the orientation, read earlier by as much"),
     (-0.0034, ("angular_velocity",), "gyroscope 3.4 ms ahead of the orientation, read later by as much"),
     (-0.0034, ("angular_velocity", "linear_acceleration"), None)],
)  # fmt: skip
def test_a_gyroscope_is_read_on_time_and_told(late: float, kinds: tuple[str, ...], said: str | None) -> None:
    (read,) = with_gyroscopes_on_time([imu_log(*kinds)], "chest", ImuFilter(late, 0.0001, True))
    assert [note.text for note in read.notes] == ([] if said is None else [f"log: {said}"])
    moved = read.column("imu.chest.angular_velocity.x")[100] - 1.0
    assert moved == pytest.approx(0.0 if said is None else late)


@pytest.mark.parametrize(
    ("late", "told"), [(0.00298, False), (0.00302, True), (0.0099, True), (0.0101, False), (-0.005, False)]
)
def test_an_accelerometer_is_late_by_three_deviations_and_less_than_ten_milliseconds(
    late: float, told: bool
) -> None:
    """Half a millisecond of encoders and legs beside what the log claims: together one."""
    claimed = 0.0005 * np.sqrt(3)
    assert filter_delay((late, claimed), None) == pytest.approx((late if told else 0.0, 0.001))
    assert filter_delay((late, claimed), ImuFilter(late, 0.0, False))[0] == 0.0, "logs disagree"


@pytest.mark.parametrize(("gyroscope", "beside"), [(0.0034, True), (0.0030, False)])
def test_a_gyroscope_tells_of_its_accelerometer_where_they_agree(gyroscope: float, beside: bool) -> None:
    """Filters of one device differ by a millisecond; 4.24 ms is three deviations of both, one millisecond each."""
    late, claimed = 0.0075, 0.0005 * np.sqrt(3)
    found, std = filter_delay((late, claimed), ImuFilter(gyroscope, 0.0, True))
    expected = ((late + gyroscope) / 2, 0.001 / np.sqrt(2)) if beside else (late, 0.001)
    assert (found, std) == pytest.approx(expected)


def test_an_accelerometer_goes_with_its_gyroscope_across_the_largest_delay() -> None:
    """One millisecond each: 9.9 and 10.5 ms are 10.2 together, and one alone that late is a fault."""
    told = (0.0105, 0.0005 * np.sqrt(3))
    assert filter_delay(told, ImuFilter(0.0099, 0.0, True))[0] == pytest.approx(0.0102)
    assert filter_delay(told, ImuFilter(0.0, 0.0, True))[0] == 0.0


def test_an_accelerometer_read_earlier_is_told_with_its_interval(robot: RobotModel) -> None:
    """A lean of 4 ms times the tilt's rate, and as much again that is nobody's: one and a half new values a second."""
    products = np.zeros((11, 11))
    products[0, 0], products[0, 1], products[1, 1] = 0.004**2 + 0.004**2, 0.004, 1.0
    products[1, 0] = 0.004
    one = AccelerometerDelay(products, 2e4)
    late, std = one.late()
    assert late == pytest.approx(0.004)
    assert std == pytest.approx(0.004 / np.sqrt(1.5 * 2e4), rel=1e-6)
    (read,) = with_imus_on_time(robot, [imu_log("linear_acceleration")], imu_delay([one], gyroscope=None))
    wide = 1.96e3 * np.hypot(std, 0.0005)
    assert read.notes[-1].text.startswith(
        f"accelerometer 4.0 ± {wide:.1f} ms behind the IMU's orientation (95 %)"
    )
    assert read.column("imu.chest.linear_acceleration.x")[100] == pytest.approx(1.004)


def scaled(share: float, noise: float = 1e-4, seconds: float = 400.0) -> AttitudeScale:
    """A tilt of ± 1 about each axis, a lean of minus a share of it, noise beside it, a height of its own."""
    tilt, other, height = (np.tile(np.repeat([1.0, -1.0], size), 400 // (2 * size)) for size in (1, 2, 4))
    lean = -share * tilt + noise * other
    signals = np.stack([lean, tilt, height])
    return AttitudeScale(np.tile(signals @ signals.T * seconds / 400, (2, 1, 1)), seconds)


@pytest.mark.parametrize(
    ("share", "noise", "told"),
    [
        (0.0299, 1e-4, False),
        (0.0301, 1e-4, True),
        (-0.0301, 1e-4, True),
        (0.06, 0.19, True),
        (0.06, 0.21, False),
    ],
)
def test_an_attitude_s_scale_is_told_from_three_per_cent_and_six_deviations_on(
    share: float, noise: float, told: bool
) -> None:
    """A deviation is noise over √(seconds): of 400 s a twentieth."""
    found = scaled(share, noise)
    assert found.share[0] == pytest.approx([share, share])
    assert found.share[1] == pytest.approx([noise / 20, noise / 20], rel=1e-3)
    notes = attitude_scale_notes(found)
    assert len(notes) == told
    assert not notes or f"shows {1 / (1 + share):.3g} times the tilts" in notes[0].text


@pytest.mark.parametrize(
    ("mean", "std", "apart", "severity", "said"),
    [(0.059, 0.01, False, "info", "together they read 1.06 ± 0.02 times what they should (95 %; "
      "one foot's alone may be off by 16 %)"),
     (0.061, 0.01, False, "warning", "together they read 1.06 ± 0.02 times"),
     (-0.061, 0.01, False, "warning", "together they read 0.94 ± 0.02 times"),
     (0.05, 0.01, True, "info", "the left's read 1.05 times and the right's read 1.04 times what they should")],
)  # fmt: skip
def test_a_torque_gain_is_told_by_its_size(
    mean: float, std: float, apart: bool, severity: str, said: str
) -> None:
    gain = TorqueGain(mean, std, {"left": 0.05, "right": 0.04}, apart)
    note = torque_gain_notes({"pitch": gain})["pitch"]
    assert note.severity == severity
    assert said in note.text
    assert "Check unit and calibration" in note.text


@pytest.mark.parametrize(("share", "sign"), [(-1.49, False), (-1.51, True)])
def test_a_torque_that_reads_far_too_little_may_be_reversed(share: float, sign: bool) -> None:
    note = torque_gain_notes({"roll": TorqueGain(-0.5, 0.1, {"left": share, "right": 0.0})})["roll"]
    assert ("Check sign, unit" in note.text) == sign


@pytest.mark.parametrize(
    ("turn", "std", "told"),
    [(0.049, 0.005, False), (0.0515, 0.005, True), (-0.0515, 0.005, True), (0.2, 0.026, False)],
)
def test_a_sensor_turned_by_a_twentieth_of_a_radian(
    robot: RobotModel, turn: float, std: float, told: bool
) -> None:
    """Known to as much (95 %), and more than what mounts are usually off by explains."""
    columns = turn_columns(robot)
    values = np.zeros(1 + max(own.stop for own in columns.values()))
    values[columns["right"].start + 1] = turn * (1 if abs(turn) < 0.0515 else 1.3)
    fit = MomentFit(values, [Part(std**2 * np.eye(values.size), 1e6)])
    notes = sensor_turn_notes(robot, fit)
    assert list(notes) == ["right"] * told
    sizes = np.degrees([values[columns["right"].start + 1], 1.96 * std])
    assert (
        not notes or f"turned by {sizes[0]:+.0f} ± {sizes[1]:.0f} deg about its y axis" in notes["right"].text
    )


@pytest.mark.parametrize("count", [1, 2])
def test_values_are_wrong_beyond_what_one_of_a_hundred_are_by_chance(count: int) -> None:
    """Hotelling's limit for two values known with eight degrees of freedom, Student's for one."""
    freedom = 8.0
    if count == 1:
        limit = stats.t.ppf(0.995, freedom - 1)
    else:
        limit = np.sqrt(2 * stats.f.ppf(0.99, 2, freedom - 2) / 2)
    values = limit * np.array([1.0, -1.0])[:count]
    for size, wrong in ((0.99, False), (1.01, True)):
        assert is_wrong(size * values, [Part(np.eye(count), freedom)], list(range(count))) == wrong


@pytest.mark.parametrize(("early", "told"), [(0.0024, False), (0.0026, True)])
def test_an_orientation_that_seems_late_by_less_may_stand_beside_early_encoders(
    early: float, told: bool
) -> None:
    """The gyroscope keeps to the orientation; encoders 5 ms early would look like 2.5 ms."""
    found, _ = filter_delay((-early, 0.0), ImuFilter(0.0, 0.0, True), (early, 0.0))
    assert found == pytest.approx(-early if told else 0.0)

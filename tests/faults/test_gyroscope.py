"""Turns of a gyroscope beside its orientation's: how they compare, and which differences are no fault."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sines, sway
from plantar.faults import gyroscope
from plantar.faults.gyroscope import Turns, check_gyroscope, imu_late
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.signals.resampling import shifted

SCALE_OFF = 0.05
TURNED = 0.1

GYROSCOPE = [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]


@pytest.fixture(scope="module")
def log() -> MotionLog:
    torso = (sines((0.05, 0.4, 0.0)), sines((0.06, 0.3, 2.0)), sines((0.03, 0.5, 1.0)))
    return record(sway(duration=40.0, torso=torso))


def findings(log: MotionLog) -> list[Finding]:
    orientation = log.orientation("chest")
    assert orientation is not None
    turns = Turns.of(log, "chest", orientation)
    assert turns is not None
    return list(check_gyroscope("chest", log, orientation, turns))


def codes(log: MotionLog) -> list[str]:
    return [finding.code for finding in findings(log)]


def changed(log: MotionLog, rates: np.ndarray) -> MotionLog:
    return log.with_columns(dict(zip(GYROSCOPE, rates.T, strict=True)))


def small(log: MotionLog, share: float = 0.01) -> MotionLog:
    """The same with turns of a share, in noise of a good IMU: as a walking robot's chest turns."""
    random, orientation = np.random.default_rng(0), log.orientation("chest")
    assert orientation is not None
    turn = Rotation.from_rotvec(share * Rotation.from_quat(orientation, scalar_first=True).as_rotvec())
    turn = Rotation.from_rotvec(2e-5 * random.standard_normal((len(log), 3))) * turn
    quaternions = turn.as_quat(scalar_first=True).T
    names = [f"imu.chest.orientation.{part}" for part in "wxyz"]
    rates = share * log.stack(GYROSCOPE) + 2e-4 * random.standard_normal((len(log), 3))
    return changed(log.with_columns(dict(zip(names, quaternions, strict=True))), rates)


@pytest.mark.parametrize(("factor", "found"), [(1.0, []), (57.3, ["degrees"]), (1.2, ["gyroscope_scale"])])
def test_what_is_read_while_the_robot_stands_does_not_count(
    log: MotionLog, factor: float, found: list[str]
) -> None:
    """It stands for three quarters of the time after whole swings; its gyroscope is less noisy than its attitude."""
    random, names = np.random.default_rng(1), [f"imu.chest.orientation.{part}" for part in "wxyz"]
    moves = (log.time < 10.0)[:, None]
    noise = 1e-3 * random.standard_normal((len(log), 3))
    rates = np.where(moves, log.stack(GYROSCOPE), 0.0) + 0.02 * noise
    turn = Rotation.from_quat(log.stack(names), scalar_first=True).as_rotvec()
    last = turn[np.flatnonzero(moves)[-1]]
    read = Rotation.from_rotvec(noise) * Rotation.from_rotvec(np.where(moves, turn, last))
    made = log.with_columns(dict(zip(names, read.as_quat(scalar_first=True).T, strict=True)))
    assert codes(changed(made, factor * rates)) == found


@pytest.mark.parametrize(
    ("factor", "found"),
    [
        (1.0, []),
        (57.3, ["degrees"]),
        ([1, -1, 1], ["sign"]),
        (1.2, ["gyroscope_scale"]),
        (3.0, ["gyroscope_scale"]),
    ],
)
def test_small_turns_tell_where_the_imu_s_noise_is_less(
    log: MotionLog, factor: float | list[float], found: list[str]
) -> None:
    few = small(log)
    assert codes(changed(few, factor * few.stack(GYROSCOPE) + [0.02, -0.01, 0.03])) == found


def test_turns_count_from_six_times_the_noise_of_both_their_ends_on(log: MotionLog) -> None:
    """And of the rates between them, half a second; of all three axes together."""
    few = small(log)
    orientation = few.orientation("chest")
    assert orientation is not None
    turns = Turns.of(few, "chest", orientation)
    assert turns is not None
    ends, between = np.sqrt(2) * 2e-5, 2e-4 * np.sqrt(0.5 * log.period)
    assert turns.least == pytest.approx(6 * np.sqrt(3) * np.hypot(ends, between), rel=0.08)


def test_turns_that_drown_in_noise_tell_nothing(log: MotionLog) -> None:
    few = small(log)
    noise = 2e-3 * np.random.default_rng(1).standard_normal((len(log), 3))
    orientation = few.orientation("chest")
    assert orientation is not None
    assert Turns.of(changed(few, few.stack(GYROSCOPE) + noise), "chest", orientation) is None


def test_a_bias_is_no_fault(log: MotionLog) -> None:
    assert codes(changed(log, log.stack(GYROSCOPE) + [0.02, -0.01, 0.03])) == []


@pytest.mark.parametrize(("share", "found"), [(0.5, []), (1.5, ["gyroscope_scale"])])
def test_a_scale_is_told_beyond_its_limit(log: MotionLog, share: float, found: list[str]) -> None:
    assert codes(changed(log, (1 + share * SCALE_OFF) * log.stack(GYROSCOPE))) == found


@pytest.mark.parametrize(("share", "found"), [(0.5, []), (1.5, ["gyroscope_frame"])])
def test_axes_are_told_beyond_theirs(log: MotionLog, share: float, found: list[str]) -> None:
    turn = Rotation.from_rotvec([0.0, share * TURNED, 0.0])
    assert codes(changed(log, turn.apply(log.stack(GYROSCOPE)))) == found


def test_what_is_told_has_its_number(log: MotionLog) -> None:
    """Factors as they are, angles in degrees, times in milliseconds; each side of a delay by its name."""
    rates = log.stack(GYROSCOPE)
    (finding,) = findings(changed(log, 57.3 * rates))
    assert "57 times the orientation's rate" in finding.text
    (finding,) = findings(changed(log, 3.0 * rates))
    assert "3 times the orientation's rate" in finding.text
    (finding,) = findings(changed(log, 1.2 * rates))
    assert "1.20 times the orientation's rate" in finding.text
    (finding,) = findings(changed(log, Rotation.from_rotvec([0.0, np.radians(20.0), 0.0]).apply(rates)))
    assert "about axes 20 deg beside" in finding.text
    for late, said in ((0.03, "the gyroscope is 30 ms behind the orientation"),
                       (-0.03, "the orientation is 30 ms behind the gyroscope")):  # fmt: skip
        told = [
            one.text
            for one in findings(changed(log, np.nan_to_num(shifted(rates, log.period, -late))))
            if one.code == "imu_late"
        ]
        assert len(told) == 1
        assert said in told[0]


@pytest.mark.parametrize(("share", "said"), [(0.45, False), (0.55, True), (-1.0, False)])
def test_an_axis_is_called_reversed_where_the_accelerometer_feels_half_of_the_tilt(
    log: MotionLog, share: float, said: bool
) -> None:
    """Else the orientation may be the wrong one."""
    names = [f"imu.chest.linear_acceleration.{axis}" for axis in "xyz"]
    orientation = log.orientation("chest")
    assert orientation is not None
    up = Rotation.from_quat(orientation, scalar_first=True).inv().apply([0.0, 0.0, 9.80665])
    felt = up.mean(axis=0) + share * (up - up.mean(axis=0))
    turned = changed(log, log.stack(GYROSCOPE) * [1, -1, 1]).with_columns(
        dict(zip(names, felt.T, strict=True))
    )
    assert ("sign" in codes(turned)) == said


def test_a_few_wild_windows_move_no_reading_and_still_ones_have_no_part() -> None:
    random = np.random.default_rng(0)
    turn = 0.05 * random.standard_normal((60, 3))
    turn[40:] *= 1e-3
    integral = 1.1 * turn
    integral[:5] += 9.0
    integral[40:] += 1.0
    found = Turns(integral, {"as it is": turn, "inverted": -turn}, turn, 0.005)
    assert found.apart["as it is"] == pytest.approx(0.1, rel=1e-6)
    assert found.apart["inverted"] == pytest.approx(2.1, rel=1e-6)
    assert found.agree


def test_the_rate_behind_a_gap_is_not_known(log: MotionLog, monkeypatch: pytest.MonkeyPatch) -> None:
    """There the orientation turns by what happened in the whole gap."""
    asked: list[np.ndarray] = []
    monkeypatch.setattr(gyroscope, "gyroscope_delay", lambda rates, turning, period: asked.append(turning))
    kept = np.abs(log.time - 20.0) > 0.2
    holed = log.select(kept)
    orientation = holed.orientation("chest")
    assert orientation is not None
    assert list(imu_late("chest", holed, orientation)) == []
    (turning,) = asked
    behind = int(np.flatnonzero(np.diff(holed.time) > 0.1)[0]) + 1
    assert np.isnan(turning[behind]).all()
    assert np.isfinite(turning[10 : behind - 1]).all()
    assert np.isfinite(turning[behind + 1 : -10]).all()


def written_with(log: MotionLog, digits: int) -> MotionLog:
    """The log as a text file has it whose quaternions have few digits."""
    names = [f"imu.chest.orientation.{part}" for part in "wxyz"]
    return log.with_columns({name: np.round(log.column(name), digits) for name in names})


@pytest.mark.parametrize("later", [60.0, 3600.0, 1.7e9])
def test_a_clock_that_was_set_on_the_way_makes_no_fault_of_the_gyroscope(
    log: MotionLog, later: float
) -> None:
    set_anew = np.where(np.arange(len(log)) < len(log) // 2, log.time, log.time + later)
    assert codes(MotionLog("set", set_anew, log.columns)) == []


def test_few_digits_of_the_orientation_are_no_gain_of_the_gyroscope(log: MotionLog) -> None:
    """Steps of 2 mrad beside turns of some mrad: the slope over them is too small, and tells of the steps."""
    few = written_with(small(log, 0.03), 3)
    orientation = few.orientation("chest")
    assert orientation is not None
    turns = Turns.of(few, "chest", orientation)
    assert turns is not None
    slope = float(np.sum(turns.integral * turns.turn) / np.sum(turns.turn**2))
    assert slope < 0.7
    assert codes(few) == []
    assert codes(changed(few, 2.5 * few.stack(GYROSCOPE))) != []


def test_a_reversed_axis_names_what_else_would_read_alike(log: MotionLog) -> None:
    """A chest that only yaws reads with an inverted quaternion as with a reversed z; one that leans does not."""
    (finding,) = findings(changed(log, log.stack(GYROSCOPE) * [1, -1, 1]))
    assert "angular_velocity.y'" in finding.text
    assert "inverted" not in finding.text
    still = sines((0.0, 0.4, 0.0))
    yawing = record(sway(duration=40.0, torso=(still, still, sines((0.2, 0.5, 1.0)))))
    (finding,) = findings(changed(yawing, yawing.stack(GYROSCOPE) * [1, 1, -1]))
    assert "angular_velocity.z'" in finding.text
    assert "or the orientation's quaternion is inverted" in finding.text


def test_windows_behind_an_empty_row_are_compared_too(log: MotionLog) -> None:
    orientation = log.orientation("chest")
    assert orientation is not None
    rates = log.stack(GYROSCOPE).copy()
    rates[len(rates) // 10] = np.nan
    whole, torn = (Turns.of(changed(log, one), "chest", orientation) for one in (log.stack(GYROSCOPE), rates))
    assert whole is not None
    assert torn is not None
    assert len(torn.integral) > 0.8 * len(whole.integral)


def test_a_heading_that_is_set_anew_is_no_fault_of_the_gyroscope(log: MotionLog) -> None:
    names, orientation = [f"imu.chest.orientation.{part}" for part in "wxyz"], log.orientation("chest")
    assert orientation is not None
    heading = np.where(log.time > 17.0, 1.5, 0.0)[:, None] * [0.0, 0.0, 1.0]
    seen = Rotation.from_rotvec(heading) * Rotation.from_quat(orientation, scalar_first=True)
    jumped = log.with_columns(dict(zip(names, seen.as_quat(scalar_first=True).T, strict=True)))
    assert codes(jumped) == []
    assert codes(changed(jumped, 1.2 * jumped.stack(GYROSCOPE))) == ["gyroscope_scale"]

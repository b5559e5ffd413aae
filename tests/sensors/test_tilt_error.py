"""An attitude that follows its accelerometer is noticed, and a standing sole puts it right."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import TRUTH, record, sway
from biped_robot import make_robot
from plantar.conventions import GRAVITY
from plantar.faults.log_faults import check_log
from plantar.feet.identify import identify_feet
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.sensors.tilt_error import (
    TiltError,
    enough_of,
    lean_of,
    log_tilt_error,
    put_right,
    stance_leans,
    tilt_error_of,
)
from plantar.signals.resampling import shifted
from plantar.twin.sensing import attitude_filter
from plantar.twin.sensing.attitude_filter import filtered_attitude

CORRECTION_RATE = 0.2  # 1/s, of the filter below
KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)


def parts(log: MotionLog) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Orientation, rates and proper acceleration of the IMU."""
    orientation = log.orientation("chest")
    assert orientation is not None
    return orientation, log.angular_velocity("chest"), log.linear_acceleration("chest")


def filtered(log: MotionLog) -> MotionLog:
    """The log with the attitude that a causal filter makes of its gyroscope and accelerometer."""
    orientation, rates, acceleration = parts(log)
    believed = filtered_attitude(orientation[0], rates, acceleration, log.period)
    return log.with_columns(
        {f"imu.chest.orientation.{axis}": believed[:, place] for place, axis in enumerate("wxyz")}
    )


def test_an_accelerometer_that_reads_nothing_says_nothing() -> None:
    log = record(sway(duration=30.0))
    orientation, rates, acceleration = parts(log)
    silent, missing = acceleration.copy(), acceleration.copy()
    silent[2000:2100], missing[2000:2100] = 0.0, np.nan
    with np.errstate(all="raise"):
        found = tilt_error_of(orientation, rates, silent, log.period)
    assert found == tilt_error_of(orientation, rates, missing, log.period)


def test_a_pull_is_noticed_and_a_true_attitude_has_none() -> None:
    log = record(sway(duration=30.0))
    assert not tilt_error_of(*parts(log), log.period).believed
    random = np.random.default_rng(0)
    orientation, rates, acceleration = parts(log)
    noisy = orientation + random.normal(0, 5e-5, orientation.shape)
    noisy /= np.linalg.norm(noisy, axis=1, keepdims=True)
    shaken = rates + random.normal(0, 2e-3, rates.shape)
    assert not tilt_error_of(noisy, shaken, acceleration, log.period).believed
    found = tilt_error_of(*parts(filtered(log)), log.period)
    assert found.believed
    assert CORRECTION_RATE / 2 < found.rate < 2 * CORRECTION_RATE


def test_damping_survives_a_filtered_attitude(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    logs = [filtered(record(sway(f"sway_{seed}", seed=seed, duration=30.0))) for seed in (1, 2)]
    found = identify_feet(robot, logs, settings=KNOWN)
    assert sum(note.code == "attitude_tilted" for note in found.notes) == 2
    left = identify_feet(robot, [without_accelerometer(log) for log in logs], settings=KNOWN)
    missed = []
    for (foot, axis), law in TRUTH.items():
        error, uncorrected = (
            abs(one.parameter(foot, axis, "damping").value / law.damping - 1) for one in (found, left)
        )
        assert error < 0.02
        missed.append(uncorrected)
        assert found.parameter(foot, axis, "stiffness").value == pytest.approx(law.stiffness, rel=0.01)
    assert np.median(missed) > 0.02
    assert max(missed) > 0.05


def test_a_pull_is_told_in_noise_that_hides_most_of_it() -> None:
    """What it does to the damping does not depend on how noisy the gyroscope beside it is."""
    log = record(sway(duration=60.0))
    orientation, rates, acceleration = parts(log)
    noise = np.random.default_rng(2).normal(0, 0.015, rates.shape)
    believed = parts(filtered(log))[0]
    found, clean = (tilt_error_of(believed, one, acceleration, log.period) for one in (rates + noise, rates))
    assert found.rate * found.product < 0.3 * found.error
    assert found.believed
    assert abs(found.rate - clean.rate) < 3 * found.std
    assert not tilt_error_of(orientation, rates + noise, acceleration, log.period).believed


def test_its_deviation_is_how_the_rate_scatters() -> None:
    """Over draws of the gyroscope's noise: independent values are two axes' in the band."""
    log, random = record(sway(duration=30.0)), np.random.default_rng(3)
    orientation, rates, acceleration = parts(log)
    found = [
        tilt_error_of(orientation, rates + random.normal(0, 0.01, rates.shape), acceleration, log.period)
        for _ in range(60)
    ]
    scatter = np.sqrt(np.mean([one.rate**2 for one in found]))
    assert scatter == pytest.approx(np.median([one.std for one in found]), rel=0.2)


@pytest.mark.parametrize(("hertz", "kept"), [(0.25, 1.0), (1.0, 0.96), (1.5, 0.5), (2.25, 0.04)])
def test_a_lean_is_what_the_accelerometer_feels_over_gravity_and_height(hertz: float, kept: float) -> None:
    """An attitude that is off by δ feels g δ - h δ'': (g + h ω²) δ; what is faster than 1.5 Hz is not told."""
    time, height, omega = np.arange(0.0, 40.0, 0.01), 0.9, 2 * np.pi * hertz
    lean = 0.01 * np.sin(omega * time)
    push = np.column_stack([(GRAVITY + height * omega**2) * lean, np.zeros_like(lean)])
    inner = slice(500, -500)
    found = lean_of(push, np.zeros((len(time), 2)), height, 0.01, every=1)[inner]
    assert found[:, 0] @ lean[inner] / (lean[inner] @ lean[inner]) == pytest.approx(kept, abs=0.04)
    assert np.abs(found[:, 1]).max() < 1e-9


@pytest.mark.parametrize(("hertz", "left"), [(0.5, 0.0), (2.0, 0.04), (3.0, 0.5), (4.5, 0.96)])
def test_an_attitude_is_put_right_as_far_as_robots_sway(hertz: float, left: float) -> None:
    """A body that stands upright, and whose attitude leans by a milliradian, up to 3 Hz."""
    time, height = np.arange(0.0, 20.0, 0.005), 0.8
    lean = 1e-3 * np.sin(2 * np.pi * hertz * time)
    none = np.zeros_like(time)
    orientation = np.column_stack([np.cos(lean / 2), none, np.sin(lean / 2), none])
    place = np.column_stack([-height * np.sin(lean), none, -height * np.cos(lean)])
    bushes = {"left": SimpleNamespace(sole_position=place)}
    contacts = {"left": SimpleNamespace(standing=np.ones(len(time), dtype=bool))}
    felt = np.column_stack([none, none, GRAVITY + none])
    orientation.flags.writeable = False  # as a log's is
    still = np.zeros((len(time), 3))
    right = put_right(orientation, still, felt, bushes, contacts, 0.005)  # type: ignore[arg-type]
    inner = slice(600, -600)
    found = 2 * right[inner, 2]
    assert found @ lean[inner] / (lean[inner] @ lean[inner]) == pytest.approx(left, abs=0.04)


@pytest.mark.parametrize(("late", "noise", "off"), [(0.0, 0.0, 5e-4), (0.03, 0.0, 5e-4), (0.0, 0.08, 5e-3)])
def test_a_zero_of_the_accelerometer_is_no_share_of_each_tilt(late: float, noise: float, off: float) -> None:
    """0.05 m/s² along the vertical go with each tilt as a lean does: half a percent, which a gyroscope, were it late,
    does not show. One that is noise tells less of it than is believed of the accelerometer."""
    time, height, zero = np.arange(0.0, 60.0, 0.005), 0.8, 0.05
    omega = 2 * np.pi * 0.3
    tilt, none = 0.05 * np.sin(omega * time), np.zeros_like(time)
    orientation = np.column_stack([np.cos(tilt / 2), none, np.sin(tilt / 2), none])
    place = -height * np.column_stack([np.sin(tilt), none, np.cos(tilt)])
    bushes = {"left": SimpleNamespace(sole_position=place)}
    contacts = {"left": SimpleNamespace(standing=np.ones(len(time), dtype=bool))}
    world = np.column_stack([none, none, GRAVITY + none])
    world -= np.gradient(np.gradient(place, 0.005, axis=0), 0.005, axis=0)
    felt = Rotation.from_quat(orientation, scalar_first=True).inv().apply(world) + [0.0, 0.0, zero]
    rates = np.column_stack([none, 0.05 * omega * np.cos(omega * (time - late)), none])
    rates += np.random.default_rng(4).normal(0, noise, rates.shape)
    right = put_right(orientation, rates, felt, bushes, contacts, 0.005)  # type: ignore[arg-type]
    inner = slice(600, -600)
    found = 2 * right[inner, 2]
    assert found @ tilt[inner] / (tilt[inner] @ tilt[inner]) == pytest.approx(1.0, abs=off)


def test_few_samples_of_a_lean_tell_what_all_do() -> None:
    """Of what the accelerometer feels and of where the sole is; with noise above all that a lean holds."""
    random, period = np.random.default_rng(5), 0.002
    push, place = (scale * random.standard_normal((20_000, 2)).cumsum(axis=0) for scale in (0.01, 1e-4))
    every = enough_of(period)
    assert every == 12
    whole, few = (lean_of(push, place, 0.9, period, nth) for nth in (1, every))
    inner = slice(100, -100)
    apart = few[inner] - whole[::every][inner]
    assert np.abs(apart).max() < 1e-3 * np.abs(whole).std()


@pytest.mark.parametrize(("seconds", "stances"), [(4.8, 0), (5.2, 1)])
def test_a_stance_of_five_seconds_tells_a_lean_and_a_shorter_one_does_not(
    seconds: float, stances: int
) -> None:
    count, stands = 2000, np.arange(2000) * 0.01 < seconds
    place = np.zeros((count, 3))
    place[:, 2] = -0.8
    bushes = {"left": SimpleNamespace(sole_position=place)}
    contacts = {"left": SimpleNamespace(standing=stands)}
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    felt = np.tile([0.0, 0.0, GRAVITY], (count, 1))
    found = list(stance_leans(upright, felt, bushes, contacts, 0.01))  # type: ignore[arg-type]
    assert len(found) == stances
    assert all(height == pytest.approx(0.8) for _, _, height in found)


def test_what_the_soles_have_put_right_is_no_fault_of_the_log(tmp_path: Path) -> None:
    robot, log = make_robot(tmp_path), filtered(record(sway("sway", seed=1, duration=30.0)))
    late = [finding.code for finding in check_log(robot, log)]
    assert "imu_late" in late
    found = identify_feet(robot, [log], settings=KNOWN)
    assert not any(note.code == "imu_late" for note in found.notes)
    alone = identify_feet(robot, [without_accelerometer(log)], settings=KNOWN)
    assert any(note.code == "imu_late" for note in alone.notes)


def test_soles_put_an_attitude_right_however_far_it_was_pulled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Soles are flat below the bushes that a wrong attitude bends: one round leaves 3 % of what it was off by."""
    monkeypatch.setattr(attitude_filter, "CORRECTION_RATE", 2.0)
    robot, log = make_robot(tmp_path), record(sway("sway", seed=1, duration=30.0))
    pulled, shown = filtered(log), TiltError(1.0, 1.0, 1.0, 30.0)
    found, known, wrong = (
        prepare(robot, one, "fit", *own).raw["left"].deflection[300:-300]
        for one, own in ((pulled, [shown]), (log, [shown]), (pulled, []))
    )
    assert (np.std(wrong - known, axis=0) > 5e-4).all()
    assert (np.std(found - known, axis=0) < 0.006 * np.std(wrong - known, axis=0)).all()


@pytest.mark.parametrize("scale", [1.0, 0.85])
def test_a_gyroscope_s_scale_is_judged_beside_the_attitude_that_the_soles_have_put_right(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scale: float
) -> None:
    """An attitude that leans with the motion, quickly, turns by another share than the gyroscope, which is right."""
    monkeypatch.setattr(attitude_filter, "CORRECTION_RATE", 2.0)
    log = filtered(record(sway("sway", seed=1, duration=30.0)))
    rates = {name: scale * log.column(name) for name in log.columns if ".angular_velocity." in name}
    robot, log = make_robot(tmp_path), checked(make_robot(tmp_path), log.with_columns(rates))
    assert any(note.code == "gyroscope_scale" for note in log.notes)
    assert robot.imu is not None
    found = prepare(robot, log, "fit", log_tilt_error(log, robot.imu))
    assert any(note.code == "attitude_tilted" for note in found.notes)
    assert any(note.code == "gyroscope_scale" for note in found.notes) == (scale != 1.0)


def test_a_late_gyroscope_is_told_by_how_much_it_is_behind_the_attitude_that_was_put_right(
    tmp_path: Path,
) -> None:
    """An attitude that leans with the motion is late itself: what both are apart by before says nothing of either."""
    log = filtered(record(sway("sway", seed=1, duration=30.0)))
    rates = np.nan_to_num(shifted(log.angular_velocity("chest"), log.period, -0.04))
    robot = make_robot(tmp_path)
    log = checked(
        robot, log.with_columns(dict(zip(imu_columns("chest", "angular_velocity"), rates.T, strict=True)))
    )

    def apart(notes: Iterable[Note]) -> float:
        (note,) = [note for note in notes if note.code == "imu_late"]
        return float(note.text.split("gyroscope is ")[1].split(" ms behind the orientation")[0])

    assert apart(log.notes) < 35
    assert robot.imu is not None
    found = prepare(robot, log, "fit", TiltError(1.0, 1.0, 1.0, 30.0))
    assert any(note.code == "attitude_tilted" for note in found.notes)
    assert apart(found.notes) == pytest.approx(40, abs=2)


def test_a_gyroscope_that_was_read_on_time_is_late_no_more(tmp_path: Path) -> None:
    """All logs of a device tell of its filter; one alone may have seemed a little later than a filter is."""
    log, robot = record(sway("sway", seed=1, duration=30.0)), make_robot(tmp_path)
    said = Note("imu_late", "warning", "sway: the gyroscope is 6 ms behind the orientation")
    assert said not in prepare(robot, checked(robot, log.with_columns({}, said)), "fit").notes


def without_accelerometer(log: MotionLog) -> MotionLog:
    """Without it there is nothing to put the attitude right by."""
    return replace(log, columns={k: v for k, v in log.columns.items() if "linear_acceleration" not in k})


def test_a_quiet_log_is_put_right_by_what_the_others_of_its_imu_show(tmp_path: Path) -> None:
    """In a slow tilt noise hides the pull; left as it is, the log would bend the law of all."""
    robot = make_robot(tmp_path)
    lively = [filtered(record(sway(f"sway_{seed}", seed=seed, duration=30.0))) for seed in (1, 2)]
    quiet = filtered(record(sway("quiet", seed=3, duration=30.0)))
    random = np.random.default_rng(4)
    shaken = quiet.angular_velocity("chest") + random.normal(0, 0.03, (len(quiet), 3))
    quiet = quiet.with_columns(
        {f"imu.chest.angular_velocity.{axis}": shaken[:, place] for place, axis in enumerate("xyz")}
    )
    alone = identify_feet(robot, [quiet], settings=KNOWN)
    assert not any(note.code == "attitude_tilted" for note in alone.notes)
    together = identify_feet(robot, [*lively, quiet], settings=KNOWN)
    assert any(note.code == "attitude_tilted" and "quiet" in note.text for note in together.notes)


def test_zeros_of_the_imu_are_no_pull() -> None:
    """An accelerometer's along x and a gyroscope's about y, together: constant, they look like a pull along x."""
    log = record(sway(duration=30.0))
    orientation, rates, acceleration = parts(log)
    found = tilt_error_of(orientation, rates + [0.0, 0.02, 0.0], acceleration + [1.0, 0.0, 0.0], log.period)
    assert not found.believed


def test_what_recordings_tell_adds_up_each_to_its_own() -> None:
    total = TiltError(1.0, 2.0, 30.0, 400.0) + TiltError(5.0, 6.0, 70.0, 800.0)
    assert total == TiltError(6.0, 8.0, 100.0, 1200.0)

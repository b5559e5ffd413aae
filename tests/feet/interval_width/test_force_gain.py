"""Gains of force sensors against the URDF's weight, and what they do to verdicts."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot, robot_entry
from feet_trials import LINEAR, codes
from plantar.conventions import GRAVITY, NORMAL95
from plantar.feet.identify import identify_feet
from plantar.feet.interval_width.force_gain import (
    WINDOW,
    GainError,
    _inverse_gains,
    _mass_deviation,
    _windows,
    force_gain_errors,
)
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

SHIFTING = sway(shift=0.7, duration=30.0)


@pytest.fixture(scope="module")
def weighed(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    """The biped with links that somebody has weighed: its trunk is most of it."""
    return make_robot(tmp_path_factory.mktemp("weighed"), uncertainty={"link_mass": 0.01})


def scaled(log: MotionLog, **gains: float) -> MotionLog:
    """The log with force and torque of some feet multiplied."""
    return log.with_columns(
        {
            name: gain * values
            for foot, gain in gains.items()
            for name, values in log.columns.items()
            if name.startswith(f"wrench.{foot}.")
        }
    )


def prepared(robot: RobotModel, log: MotionLog) -> Recording:
    return prepare(robot, checked(robot, log), "fit")


def errors(robot: RobotModel, log: MotionLog) -> dict[str, float]:
    found = force_gain_errors(robot, [prepared(robot, log)])
    return {foot: each.share for foot, each in found.items() if each.sure}


def test_a_recording_shorter_than_a_window_has_none(weighed: RobotModel) -> None:
    recording = prepared(weighed, record(sway(duration=20.0)))
    weight = weighed.mass * GRAVITY
    half = round(WINDOW / 2 / recording.period)
    for count, found in ((2 * half - 1, 0), (half + 1, 0), (2 * half, 1), (3 * half, 2)):
        assert _windows(first(recording, count), weight).shape == (found, 2)


def first(recording: Recording, count: int) -> Recording:
    """Its feet's first samples."""
    return SimpleNamespace(  # type: ignore[return-value]
        raw={foot: SimpleNamespace(force_z=state.force_z[:count]) for foot, state in recording.raw.items()},
        period=recording.period,
    )


def test_sensors_that_carry_the_weight_are_right(weighed: RobotModel) -> None:
    for log in (record(SHIFTING), scaled(record(SHIFTING), left=1.03, right=0.98)):
        assert errors(weighed, log) == {}


@pytest.mark.parametrize("gain", [1.12, 0.88])
def test_both_gains_are_found_without_a_shift_of_weight(weighed: RobotModel, gain: float) -> None:
    found = errors(weighed, scaled(record(sway()), left=gain, right=gain))
    assert found == pytest.approx({"left": gain - 1, "right": gain - 1}, abs=0.01)


def test_a_shift_of_weight_shows_whose_gain_it_is(weighed: RobotModel) -> None:
    assert errors(weighed, scaled(record(SHIFTING), left=1.12)) == pytest.approx({"left": 0.12}, abs=0.02)


def test_feet_that_the_weight_does_not_tell_apart_are_doubted_alike(weighed: RobotModel) -> None:
    found = force_gain_errors(weighed, [prepared(weighed, scaled(record(sway()), left=1.08, right=1.02))])
    assert min(each.share for each in found.values()) > 0.045


def test_a_hand_that_carries_some_weight_in_one_recording_is_no_gain(weighed: RobotModel) -> None:
    """A tenth of it, now more, now less; another recording shows that the sensors are right."""
    log = record(sway())
    hand = 1 - 0.1 - 0.05 * np.sin(2 * np.pi * log.time / 5)
    vertical = {name: hand * log.column(name) for name in log.columns if name.endswith("force.z")}
    held = prepared(weighed, log.with_columns(vertical))
    alone, beside = (
        force_gain_errors(weighed, recordings)["left"].share
        for recordings in ([held], [held, prepared(weighed, log)])
    )
    assert alone == pytest.approx(-0.1, abs=0.02)
    assert beside == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("beside", [1.0, 1.12])
def test_a_rope_that_carries_a_quarter_for_a_while_is_no_gain(weighed: RobotModel, beside: float) -> None:
    """The rest of the log has all of the weight, and tells a gain that is wrong as ever."""
    log = scaled(record(sway(shift=0.3, duration=30.0)), left=beside, right=beside)
    rope = 1 - 0.25 * ((log.time > 8) & (log.time < 16))
    held = log.with_columns(
        {name: rope * log.column(name) for name in log.columns if name.endswith("force.z")}
    )
    found = force_gain_errors(weighed, [prepared(weighed, held)])
    assert found["left"].share == pytest.approx(beside - 1, abs=0.01)
    assert found["left"].sure == (beside > 1)


def windows_of(share: float, load: float = 1.0, left: float = 1.0) -> np.ndarray:
    """Both feet's forces over the weight (20, 2), the left one carrying about a `share` of the `load`."""
    shares = share + 0.03 * np.random.default_rng(round(1000 * share)).standard_normal(20)
    return np.column_stack([left * load * shares, load * (1 - shares)])


def test_a_load_that_the_robot_carries_in_some_recordings_is_no_gain() -> None:
    """A fifth of its weight in two of five; the left foot carries a little more of it, which looked like +45 %."""
    alike = (np.eye(2) - 0.5) / 0.1**2
    free = [windows_of(share) for share in (0.50, 0.48, 0.52)]
    inverse, covariance = _inverse_gains([*free, windows_of(0.55, 1.2), windows_of(0.56, 1.2)], alike)
    np.testing.assert_allclose(inverse, 1.0, atol=0.01)
    assert np.sqrt(covariance[0, 0]) < 0.05
    for shares in (
        (1.0, 0.0),
        (0.5, 0.3, 0.7),
    ):  # a gain shows as it did: on single legs the sums differ as much
        inverse, _ = _inverse_gains([windows_of(share, left=0.7) for share in shares], alike)
        np.testing.assert_allclose(1 / inverse, [0.7, 1.0], atol=0.02)


def test_zeros_on_a_light_robot_that_bounces_are_hardly_a_gain(weighed: RobotModel) -> None:
    """3 % of the weight are missing at all loads: no foot alone reads wrong, and what bounces is no hand."""
    log = record(sway(shift=0.3, duration=30.0))
    weight = weighed.mass * GRAVITY
    bounce = 0.01 * weight * np.sin(2 * np.pi * 1.4 * log.time)
    names = [name for name in log.columns if name.endswith("force.z")]
    light = log.with_columns({name: log.column(name) - 0.015 * weight + bounce for name in names})
    found = force_gain_errors(weighed, [prepared(weighed, light)])
    for each in found.values():
        assert each.share == pytest.approx(-0.03, abs=0.002)
        assert each.std < 0.006
        assert each.reach < 0.033  # 5 % where nobody could tell which foot it is


@pytest.mark.parametrize("other", [0.02, 0.035])
def test_the_more_the_weight_misses_the_farther_a_gain_may_be_off(other: float) -> None:
    """By no more than the usual error where the weight is right, by all of it where nothing else explains it."""
    reaches = [GainError(share, 0.0, 0.01, other).reach for share in np.linspace(0.0, 0.1, 41)]
    assert np.all(np.diff(reaches) >= -1e-9)
    assert np.diff(reaches).max() < 0.01  # no threshold
    assert reaches[0] == pytest.approx(NORMAL95 * 0.01, rel=0.1)
    assert reaches[-1] == pytest.approx(np.hypot(0.1 / 1.1, NORMAL95 * 0.01))
    # Where nothing is missing it does not matter which foot carries it.
    assert GainError(0.0, 0.05, 0.01, other).reach == pytest.approx(reaches[0], rel=0.15)
    assert GainError(-0.1, 0.0, 0.01, other).reach == pytest.approx(np.hypot(0.1 / 0.9, NORMAL95 * 0.01))


def test_an_exact_sensor_on_a_robot_that_was_weighed_has_no_error() -> None:
    assert GainError(0.0, 0.01, 0.0, 0.02).reach == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("share", [-0.9, -0.6, 1.0, 9.0])
def test_a_sensor_that_reads_a_fraction_or_a_multiple_reaches_as_far(share: float) -> None:
    """As one that was zeroed under load, or reads another unit."""
    seen = abs(share / (1 + share))
    assert GainError(share, 0.01, 0.01, 0.02).reach == pytest.approx(seen, rel=0.1)


def test_a_robot_file_that_doubts_its_masses_allows_more(tmp_path: Path, weighed: RobotModel) -> None:
    log = scaled(record(sway()), left=1.12, right=1.12)
    assert errors(weighed, log)
    assert errors(make_robot(tmp_path, uncertainty={"link_mass": 0.05}), log) == {}


def test_forces_zeroed_under_load_and_robots_that_hang_say_nothing(
    tmp_path: Path, weighed: RobotModel
) -> None:
    log = record(sway())
    zeroed = log.with_columns(
        {name: log.column(name) - 0.8 * log.column(name).mean() for name in log.columns if "force.z" in name}
    )
    assert errors(weighed, zeroed) == {}
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    feet = {name: {**foot, "contact": "always"} for name, foot in feet.items()}
    always = make_robot(tmp_path, feet=feet, uncertainty={"link_mass": 0.01})
    assert errors(always, scaled(log, left=1.12, right=1.12)) == {}


def test_intervals_hold_both_a_wrong_gain_and_wrong_masses(weighed: RobotModel) -> None:
    """12 % more force and torque on the left: its numbers are 12 % too large, and those of the right foot are right."""
    found = identify_feet(weighed, [scaled(record(SHIFTING), left=1.12)], settings=LINEAR)
    assert "force_gain" in codes(found)
    for (foot, axis), law in TRUTH.items():
        for name, truth in (("stiffness", law.stiffness), ("damping", law.damping)):
            row = found.parameter(foot, axis, name)
            assert row.interval95 is not None
            assert row.half_width_percent is not None
            if foot == "left":
                assert row.interval95[0] < truth < row.interval95[1]
                assert row.half_width_percent > 10
                assert row.verdict == "weak"
            else:
                assert row.half_width_percent < 3  # the usual gain of a force sensor
    limits = {(each.foot, each.axis, each.name): each.limit for each in found.diagnosis}
    assert limits["left", "pitch", "stiffness"] == "force gain"
    assert "force_gain" not in codes(identify_feet(weighed, [record(SHIFTING)], settings=LINEAR))


def test_a_balance_decides_between_masses_and_gains(tmp_path: Path) -> None:
    """Both feet read 12 % more than the URDF weighs: a robot of 67.2 kg, or wrong sensors on one of 60 kg."""
    log = scaled(record(SHIFTING), left=1.12, right=1.12)
    doubts = {"link_mass": 0.05, "wrench_gain": 0.01}
    unknown, heavy, light = (
        identify_feet(make_robot(tmp_path / str(mass), uncertainty=doubts, **mass), [log], settings=LINEAR)
        for mass in ({}, {"mass": 67.2}, {"mass": 60.0})
    )
    half = [
        found.parameter("left", "pitch", "stiffness").half_width_percent for found in (unknown, heavy, light)
    ]
    assert None not in half
    assert half[1] < 4 < half[0]  # type: ignore[operator]
    assert half[2] > 10  # type: ignore[operator]
    assert {"weighed", "force_gain"} & set(codes(heavy)) == {"weighed"}
    assert {"weighed", "force_gain"} & set(codes(light)) == {"force_gain"}
    assert "weighed 60.0 kg" in next(note.text for note in light.notes if note.code == "force_gain")
    assert "was weighed" in (light.parameter("left", "pitch", "stiffness").advice or "")


def test_links_are_off_each_by_itself(weighed: RobotModel) -> None:
    """Their errors add up in squares; of a robot that was weighed the balance tells."""
    masses = np.array([inertia.mass for inertia in weighed.model.inertias])
    rng = np.random.default_rng(0)
    drawn = (masses * rng.normal(1.0, weighed.uncertainty.link_mass, (20_000, len(masses)))).sum(axis=1)
    assert _mass_deviation(weighed) == pytest.approx(np.std(drawn) / masses.sum(), rel=0.03)
    assert _mass_deviation(weighed) < 0.9 * weighed.uncertainty.link_mass

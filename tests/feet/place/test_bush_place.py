"""A bush's centre or a sensor that is elsewhere than the robot file says is found, told and taken into account."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from biped import SLIPPING, TRUTH, record, sines, sway
from biped_robot import FEET, Frame, Mounting
from feet_trials import AXES, LINEAR, PUNCTUAL, codes, noisy, shifted
from plantar.conventions import Axis
from plantar.feet.identify import identify_feet
from plantar.feet.place.bush_place import shape_moved
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.regression.axis import AxisFit
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.results.feet import FeetResult
from plantar.robot.guesses import Guess
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty


@pytest.fixture(scope="module")
def recorded() -> list[MotionLog]:
    return [noisy(record(sway(f"sway_{seed}", seed, duration=40.0)), seed) for seed in (3, 4)]


def turned(log: MotionLog, angle: float) -> MotionLog:
    """The log of force sensors that are turned by `angle` [rad] about z."""
    c, s = np.cos(angle), np.sin(angle)
    moved = {}
    for foot in FEET:
        for part in ("force", "torque"):
            x, y = (log.columns[f"wrench.{foot}.{part}.{axis}"] for axis in "xy")
            moved[f"wrench.{foot}.{part}.x"], moved[f"wrench.{foot}.{part}.y"] = c * x + s * y, c * y - s * x
    return log.with_columns(moved)


def worst(result: FeetResult) -> float:
    """The largest error of a stiffness, as a share."""
    rows = {(foot, axis): result.parameter(foot, axis, "stiffness") for foot in FEET for axis in AXES}
    return max(abs(row.value / TRUTH[key].stiffness - 1) for key, row in rows.items())


@pytest.fixture
def measured(robot: RobotModel) -> RobotModel:
    """The robot as a careful lab knows it; `robot` itself is exactly what its file says."""
    return replace(robot, uncertainty=Uncertainty())


@pytest.mark.parametrize("height", [0.03, -0.03])
def test_a_centre_at_another_height_is_found(
    robot: RobotModel, measured: RobotModel, recorded: list[MotionLog], height: float
) -> None:
    logs = [shifted(log, np.array([0.0, 0.0, height])) for log in recorded]
    found = identify_feet(measured, logs, settings=LINEAR)
    assert "bush_place" in codes(found)
    for model in found.models:
        assert abs(model.moment_arms[1]) == pytest.approx(0.03, abs=0.004)
    assert worst(found) < 0.02


def placed(axis: Axis, height: float, *codes: str) -> AxisFit:
    """A fit of which only the height of the bush's centre and the notes matter."""
    fit = Mock(spec=AxisFit)
    fit.axis, fit.moment_arms = axis, (0.0, height)
    fit.notes = tuple(Note(code, "warning", "") for code in codes)
    return fit


@pytest.mark.parametrize(("pitch", "roll", "expected"), [
    (-0.029, -0.012, -0.029), (0.029, 0.028, 0.029), (-0.012, -0.029, None), (0.004, 0.001, None),
])  # fmt: skip
def test_an_axis_whose_motions_show_less_takes_the_height_from_the_other(
    pitch: float, roll: float, expected: float | None
) -> None:
    fits = {"pitch": placed("pitch", pitch), "roll": placed("roll", roll)}
    known = PlaceSpread(0.005, 0.005, 0.02).known_from(fits, "roll")
    assert (known and known.height) == expected
    assert known is None or known.above == 0.005


def test_a_guessed_height_is_one_for_both_axes_and_the_file_s_word_stays() -> None:
    """Guessed to 4 cm, of pitch and roll at once: 5 mm is what they may seem to differ by."""
    fits = {"pitch": placed("pitch", 0.052), "roll": placed("roll", 0.022)}
    guessed = PlaceSpread(0.04, 0.04, 0.02, between=0.005)
    known = guessed.known_from(fits, "roll")
    assert known is not None
    assert known.height == 0.052
    assert known.deviations[1] == 0.04
    assert known.expected[1] == 0.005
    assert guessed.expected[1] == 0.04
    assert PlaceSpread(0.04, 0.04, 0.02).known_from(fits, "roll") is None


@pytest.mark.parametrize(("told", "own", "above"), [
    ("bush_place", (0.002, 0.03), 0.03), ("bush_place_far", (0.0, -0.001), 0.03), ("bush_turned", (0.0, 0.0), 0.005),
    ("bush_place", (0.02, -0.03), 0.005),
])  # fmt: skip
def test_a_height_told_of_one_foot_puts_the_other_foot_s_in_doubt(
    told: str, own: tuple[float, float], above: float
) -> None:
    spread = PlaceSpread(0.005, 0.005, 0.02)
    wide = spread.doubted_by([placed("pitch", -0.03, told)], [placed("roll", height) for height in own])
    assert wide == replace(spread, above=above)


def test_a_height_far_off_is_found_where_one_axis_alone_shows_it(measured: RobotModel) -> None:
    """Motions that lean forward and hardly aside: both feet's sensors are 4 cm lower than the robot file has them."""
    little, none = sines((0.0001, 0.5, 0.0)), sines((0.0, 0.0, 0.0))
    ankles = {foot: (sines((0.02, 0.3, 2.0), (0.01, 0.8, 0.0)), little) for foot in FEET}
    forward = sway("forward", 5, duration=40.0, torso=(none, none, none), ankles=ankles)
    log = shifted(noisy(record(forward), 5), np.array([0.0, 0.0, 0.04]))
    found = identify_feet(measured, [log], settings=PUNCTUAL)
    for foot in FEET:  # roll alone would stay where the robot file has it
        arms = [one.moment_arms[1] for one in found.models if one.foot == foot]
        assert arms == pytest.approx([-0.04, -0.04], abs=0.002)


def test_a_turned_force_sensor_is_found(measured: RobotModel, recorded: list[MotionLog]) -> None:
    logs = [turned(log, np.radians(5)) for log in recorded]
    found = identify_feet(measured, logs, settings=LINEAR)
    assert "bush_place" in codes(found)
    for model in found.models:
        assert abs(model.turned) == pytest.approx(np.radians(5), abs=0.02)
    assert worst(found) < 0.02


def test_an_imu_turned_in_its_mount_shows_where_hips_move(measured: RobotModel) -> None:
    turn = Mounting(imu=Frame((0.0, 0.0, 0.0), (0.0, 0.0, 0.02)))
    logs = [noisy(record(sway(f"sway_{seed}", seed, duration=40.0), turn), seed) for seed in (3, 4)]
    found = identify_feet(measured, logs, settings=LINEAR)
    for model in found.models:
        assert abs(model.imu_turned[2]) == pytest.approx(0.02, abs=0.003)
    assert worst(found) < 0.01
    sure = replace(measured, uncertainty=Uncertainty(imu_mount=0.0))
    assert not any(any(model.imu_turned) for model in identify_feet(sure, logs, settings=LINEAR).models)


def test_an_offset_is_as_unsure_as_the_mount_of_the_imu(
    measured: RobotModel, recorded: list[MotionLog]
) -> None:
    """It is the torque at zero angle: a mount that is off by a moves it by stiffness times a."""
    loose, exact = (replace(measured, uncertainty=Uncertainty(bush_position=0.0, wrench_crosstalk=0.0, imu_mount=mount))
                    for mount in (0.01, 0.0))  # fmt: skip
    wide, narrow = (identify_feet(robot, recorded, settings=LINEAR).offsets for robot in (loose, exact))
    for more, less in zip(wide, narrow, strict=True):
        expected = 0.01 * TRUTH[more.foot, more.axis].stiffness
        assert np.sqrt(more.std**2 - less.std**2) == pytest.approx(expected, rel=0.1)


def test_a_place_and_a_stiffness_that_both_move_leave_no_constant(measured: RobotModel) -> None:
    """Their product is of second order; the offset takes it up."""
    turn = Mounting(imu=Frame((0.0, 0.0, 0.0), (0.03, 0.03, 0.02)))
    aside = np.array([0.02, 0.0, 0.04])
    logs = [
        shifted(noisy(record(sway(f"sway_{seed}", seed, duration=40.0), turn), seed), aside)
        for seed in (3, 4)
    ]
    found = identify_feet(measured, logs, settings=LINEAR)
    assert any(any(model.imu_turned) for model in found.models)
    table = found.residuals.to_pydict()
    used, motion, side = (np.array(table[name]) for name in ("used", "motion", "foot"))
    for foot in FEET:
        for axis in AXES:
            left = np.array(table[f"{axis}.torque"]) - np.array(table[f"{axis}.predicted"])
            for log in logs:
                assert abs(np.mean(left[used & (motion == log.name) & (side == foot)])) < 0.01


def test_a_centre_in_its_place_is_left_there(measured: RobotModel, recorded: list[MotionLog]) -> None:
    found = identify_feet(measured, recorded, settings=LINEAR)
    assert "bush_place" not in codes(found)
    assert worst(found) < 0.01


def test_a_centre_far_from_its_place_takes_usable_away(
    measured: RobotModel, recorded: list[MotionLog]
) -> None:
    logs = [shifted(log, np.array([0.0, 0.0, 0.1])) for log in recorded]
    found = identify_feet(measured, logs, settings=LINEAR)
    assert "bush_place_far" in codes(found)
    rows = [found.parameter(foot, "pitch", "stiffness") for foot in FEET]
    assert not any(row.verdict == "usable" for row in rows)
    assert any("far for an oversight" in row.reason for row in rows)


def test_guesses_are_less_sure_than_what_was_measured(robot: RobotModel, measured: RobotModel) -> None:
    spread, known = PlaceSpread.of(measured, "left"), Uncertainty()
    assert spread.above == spread.aside == np.hypot(known.bush_position, known.wrench_crosstalk)
    guesses = (Guess("feet.left.bush", "drawn", 0.03), Guess("feet.right.wrench", "drawn"))
    guessed = replace(measured, guesses=guesses)
    assert PlaceSpread.of(guessed, "left").above == pytest.approx(np.hypot(0.03, known.wrench_crosstalk))
    assert PlaceSpread.of(guessed, "right").above == pytest.approx(np.hypot(0.02, known.wrench_crosstalk))
    assert not PlaceSpread.of(robot, "left").deviations.any()
    assert PlaceSpread.of(replace(measured, guesses=(Guess("imu", "by name"),)), "left").turned == 0.02
    assert PlaceSpread.of(replace(robot, guesses=(Guess("imu", "by name"),)), "left").turned == 0.0


def test_a_place_in_doubt_is_as_measured_as_before(measured: RobotModel) -> None:
    """An arm that no bush has doubts the numbers, however far another foot's motions have widened the prior."""
    spread = PlaceSpread.of(measured, "left")
    wider = spread.doubted_by([placed("roll", 0.06, "bush_place")], [placed("roll", 0.01)])
    assert wider.above == 0.06
    assert wider.measured
    guessed = replace(measured, guesses=(Guess("feet.left.bush", "drawn", 0.03),))
    assert not PlaceSpread.of(guessed, "left").measured


def test_a_sensor_zeroed_under_load_says_nothing_of_the_place(measured: RobotModel) -> None:
    feet = {name: replace(foot, contact="always") for name, foot in measured.feet.items()}
    assert not PlaceSpread.of(replace(measured, feet=feet), "left").deviations.any()


def imu_turned(log: MotionLog, angle: float) -> MotionLog:
    """The log of an IMU that is turned by `angle` [rad] about its z axis."""
    w, x, y, z = (log.columns[f"imu.chest.orientation.{axis}"] for axis in "wxyz")
    c, s = np.cos(angle / 2), np.sin(angle / 2)
    moved = dict(zip("wxyz", (c * w - s * z, c * x + s * y, c * y - s * x, c * z + s * w), strict=True))
    columns = {f"imu.chest.orientation.{axis}": values for axis, values in moved.items()}
    c, s = np.cos(angle), np.sin(angle)
    for quantity in ("angular_velocity", "linear_acceleration"):
        x, y = (log.columns[f"imu.chest.{quantity}.{axis}"] for axis in "xy")
        columns |= {f"imu.chest.{quantity}.x": c * x + s * y, f"imu.chest.{quantity}.y": c * y - s * x}
    return log.with_columns(columns)


def slipping() -> list[MotionLog]:
    motions = [sway(f"sway_{seed}", seed, duration=40.0, truth=SLIPPING) for seed in (3, 4)]
    return [noisy(record(motion), seed) for seed, motion in enumerate(motions)]


RUBBER = replace(PUNCTUAL, model="elastoplastic")


def test_beside_a_memory_the_place_is_taken_off_once(measured: RobotModel) -> None:
    logs = [shifted(log, np.array([0.02, 0.0, 0.03])) for log in slipping()]
    found = identify_feet(measured, logs, settings=RUBBER)
    assert worst(found) < 0.02
    assert max(row.rms_error for row in found.validation) < 0.3
    for foot in FEET:
        for axis in AXES:
            assert found.parameter(foot, axis, "slip_angle").value == pytest.approx(0.006, rel=0.05)


def test_a_turned_imu_shows_in_a_memory(measured: RobotModel) -> None:
    """The ankles hold still and the torso sways, so that the IMU alone shows the bushes' angles."""
    logs = []
    for seed in (3, 4):
        motion = sway(f"sway_{seed}", seed, duration=40.0, truth=SLIPPING)
        pitch, roll = motion.ankles["left"]
        still = dict.fromkeys(FEET, (sines((0.0, 0.0, 0.0)),) * 2)
        swaying = replace(motion, torso=(pitch, roll, motion.torso[2]), ankles=still)
        logs.append(imu_turned(noisy(record(swaying), seed), 0.03))
    found = identify_feet(measured, logs, settings=RUBBER)
    for model in found.models:
        assert abs(model.imu_turned[2]) == pytest.approx(0.03, abs=0.01)
    for foot in FEET:
        for axis in AXES:
            assert found.parameter(foot, axis, "slip_angle").value == pytest.approx(0.006, rel=0.05)


def test_a_shape_moves_in_its_logarithm_and_stays_positive() -> None:
    shape = np.array([2e-3, 2.0, 1.0])
    found = shape_moved(shape, np.array([1e-6, -40.0, 800.0]))
    assert found[0] == pytest.approx(2e-3 + 1e-6, rel=1e-6)
    assert found[1:] == pytest.approx([2.0 / np.e, np.e])

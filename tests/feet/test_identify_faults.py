"""From logs with something missing, odd or wrong to numbers that stay right, or one line that says why not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped import VERTICAL, WEIGHT, Motion, record, sway, times
from biped_robot import FEET, make_robot, robot_entry
from feet_trials import AXES, EXACT, PUNCTUAL, assert_truth, codes, noisy, rotational, without
from plantar.errors import DataError, LogError, RobotError
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    """Three exact recordings; the third is for validation."""
    return [record(sway(name, seed=seed)) for seed, name in enumerate(("first", "second", "third"))]


@pytest.fixture(scope="module")
def result(robot: RobotModel, logs: list[MotionLog]) -> FeetResult:
    return identify_feet(robot, logs[:2], logs[2:], PUNCTUAL)


def test_without_orientation_gravity_comes_from_gyroscope_and_accelerometer(robot: RobotModel) -> None:
    recordings = [
        without(record(sway(name, seed, duration=60.0)), "orientation") for seed, name in enumerate("ab")
    ]
    found = identify_feet(robot, recordings)
    assert_truth(found, 0.01)
    assert "attitude_derived" in codes(found)


def test_velocities_may_be_missing_or_late(
    robot: RobotModel, logs: list[MotionLog], result: FeetResult
) -> None:
    """A controller's filtered velocities, 30 ms late, would go straight into the damping."""
    missing = identify_feet(robot, [without(log, ".velocity") for log in logs[:2]])
    np.testing.assert_allclose(rotational(missing), rotational(result), rtol=EXACT)
    late = [
        log.with_columns({n: np.roll(v, 3) for n, v in log.columns.items() if n.endswith(".velocity")})
        for log in logs[:2]
    ]
    np.testing.assert_allclose(rotational(identify_feet(robot, late)), rotational(result), rtol=EXACT)


def test_without_a_gyroscope_rates_come_from_the_orientation(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    found = identify_feet(robot, [without(log, "angular_velocity") for log in logs[:2]])
    assert_truth(found, 0.005)
    assert "gyroscope_missing" in codes(found)


def test_missing_values_are_left_out_with_a_reason(
    robot: RobotModel, logs: list[MotionLog], result: FeetResult
) -> None:
    column = "joint.left_ankle_pitch.position"
    holed = [
        log.with_columns({column: np.where((log.time > 5) & (log.time < 7), np.nan, log.column(column))})
        for log in logs[:2]
    ]
    found = identify_feet(robot, holed)
    assert_truth(found, EXACT)
    reasons = {phase.reason for phase in found.phases if phase.foot == "left"}
    assert any(reason and "NaN" in reason for reason in reasons)
    assert all(
        phase.reason is None or "NaN" not in phase.reason for phase in found.phases if phase.foot == "right"
    )


def test_a_slower_sensor_in_the_table_is_no_hole(robot: RobotModel, logs: list[MotionLog]) -> None:
    """Wrenches at a third of the rate, NaN in the rows between."""
    sparse = []
    for log in logs[:2]:
        between = np.arange(len(log)) % 3 != 0
        names = [name for name in log.columns if name.startswith("wrench.")]
        sparse.append(log.with_columns({n: np.where(between, np.nan, log.column(n)) for n in names}))
    found = identify_feet(robot, sparse, settings=PUNCTUAL)
    assert_truth(found, 3e-3)
    assert "holes_filled" in codes(found)


def test_gaps_are_left_out(robot: RobotModel) -> None:
    motion = sway("gap")
    time = times(motion)
    found = identify_feet(robot, [record(motion, at=time[(time < 8) | (time > 9.5)])])
    assert_truth(found, 1e-4)
    assert "resampled" in codes(found)


def test_single_absurd_values_do_no_harm(robot: RobotModel, logs: list[MotionLog]) -> None:
    def spiked(name: str, value: float) -> np.ndarray:
        return np.where(np.arange(len(logs[0])) == 700, value, logs[0].column(name))

    torque, force = "wrench.left.torque.y", "wrench.right.force.z"
    found = identify_feet(
        robot, [logs[0].with_columns({torque: spiked(torque, np.inf), force: spiked(force, 1e308)})]
    )
    assert_truth(found, EXACT)
    assert "absurd_values" in codes(found)
    quaternion = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
    assert_truth(identify_feet(robot, [logs[0].with_columns({n: spiked(n, 0.0) for n in quaternion})]), EXACT)


@pytest.mark.parametrize("every", [10, 20])
def test_a_log_slower_than_twice_the_filter_serves(robot: RobotModel, every: int) -> None:
    """10 Hz and 5 Hz: the filter that the fit would like does not exist there."""
    log = record(sway("slow", duration=60.0))
    columns = {name: values[::every] for name, values in log.columns.items()}
    slow = MotionLog("slow", log.time[::every], columns)
    found = identify_feet(robot, [slow])
    assert_truth(found, 0.02)
    assert "internal_error" not in codes(found)


def test_jitter_is_resampled(robot: RobotModel) -> None:
    motion = sway("jitter")
    found = identify_feet(robot, [record(motion, at=times(motion, rate=200.0, jitter=0.25, seed=3))])
    assert_truth(found, 5e-3)


def test_a_joint_on_the_path_that_is_not_recorded_is_a_warning(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    found = identify_feet(robot, [without(logs[0], "left_ankle_roll")])
    (text,) = (note.text for note in found.notes if note.code == "path_joint_missing")
    assert "which the URDF has not" not in text
    assert_truth(found, 2e-3, feet=("right",))
    misspelt = without(logs[0], "left_ankle_roll")
    misspelt = misspelt.with_columns(
        {"joint.left_ankel_roll.position": logs[0].column("joint.left_ankle_roll.position")}
    )
    notes = {note.code: note.text for note in identify_feet(robot, [misspelt]).notes}
    assert "The log has left_ankel_roll, which the URDF has not" in notes["path_joint_missing"]


def test_a_joint_off_the_path_may_be_missing(
    robot: RobotModel, logs: list[MotionLog], result: FeetResult
) -> None:
    found = identify_feet(robot, [without(log, "neck") for log in logs[:2]])
    np.testing.assert_allclose(rotational(found), rotational(result), rtol=1e-12)
    assert "joint_missing" in codes(found)


def test_a_missing_wrench_is_an_error_that_names_the_column(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(
        LogError,
        match=r"^first, column 'wrench\.left\.torque\.y': is missing \(valid: the log has "
        r"wrench\.left\.torque\.z, wrench\.left\.torque\.x\)$",
    ):
        identify_feet(robot, [without(logs[0], "left.torque.y")])
    with pytest.raises(
        LogError,
        match=r"^first, column 'imu\.chest\.linear_acceleration\.x': is missing \(valid: the log has "
        r"imu\.chest\.angular_velocity\.x, imu\.chest\.angular_velocity\.z\)$",
    ):
        identify_feet(robot, [without(logs[0], "orientation", "linear")])


def test_two_logs_of_one_name_are_refused(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(
        DataError,
        match=r"^two logs are called 'first': first and first \(valid: file names that differ, since "
        r"results name motions by them\)$",
    ):
        identify_feet(robot, [logs[0], logs[1]], [logs[0]])


def test_a_robot_that_stands_still_identifies_nothing(robot: RobotModel) -> None:
    def flat(t: np.ndarray) -> np.ndarray:
        return 0.0 * t + 0.01

    motion = Motion("still", 20.0, (flat,) * 3, dict.fromkeys(FEET, (flat, flat)))
    found = identify_feet(robot, [noisy(record(motion), 1)])
    for foot in FEET:
        for axis in AXES:
            for name in ("stiffness", "damping"):
                row = found.parameter(foot, axis, name)
                assert row.verdict == "unidentifiable", row
                assert row.advice


def test_columns_that_never_change_identify_nothing(robot: RobotModel) -> None:
    log = record(sway())
    odd = np.arange(len(log)) % 2 == 1
    for towards in (None, np.inf):
        frozen = {}
        for name in log.columns:
            first = np.full(len(log), log.column(name)[0])
            frozen[name] = first if towards is None else np.where(odd, np.nextafter(first, towards), first)
        for row in identify_feet(robot, [log.with_columns(frozen)]).parameters:
            assert row.verdict == "unidentifiable"


def test_a_foot_in_the_air_gives_no_rows(robot: RobotModel) -> None:
    motion = sway("step", duration=20.0, lifts=(("left", 6.0, 10.0),))
    found = identify_feet(robot, [record(motion)])
    assert_truth(found, 2e-3)
    left = [phase for phase in found.phases if phase.foot == "left"]
    assert [phase.support for phase in left if phase.support != "transition"].count("air") >= 1
    for phase in left:
        if phase.end > 6.1 and phase.start < 9.9:
            assert not phase.used
            assert phase.reason
    right = [phase for phase in found.phases if phase.foot == "right"]
    single = [phase for phase in right if phase.support == "single"]
    assert single
    assert all(phase.used for phase in single)
    assert found.residuals is not None
    rows = found.residuals.to_pydict()
    used = np.array(rows["used"]) & (np.array(rows["foot"]) == "left")
    time = np.array(rows["time"])
    assert not used[(time > 6.1) & (time < 9.9)].any()


def test_a_foot_that_never_stands_is_unidentifiable_and_the_other_is_found(robot: RobotModel) -> None:
    found = identify_feet(robot, [record(sway("hop", duration=15.0, lifts=(("left", -1.0, 20.0),)))])
    assert_truth(
        found, 1.1 * WEIGHT**2 / VERTICAL / 330, feet=("right",)
    )  # the vertical compliance does not show
    assert "z_unknown" in codes(found)
    for axis in AXES:
        row = found.parameter("left", axis, "stiffness")
        assert (row.value, row.std, row.interval95, row.verdict) == (None, None, None, "unidentifiable")
        assert "no samples" in row.reason
        assert row.advice
    assert {"foot_never_stands", "no_double_support"} <= codes(found)


def test_no_foot_on_the_ground_is_an_error(robot: RobotModel) -> None:
    lifts = (("left", -1.0, 20.0), ("right", -1.0, 20.0))
    with pytest.raises(
        DataError,
        match=r"^fly: no foot carries load in any log: 0\.0 kg where the robot weighs 60\.0 kg \(valid: "
        r"a standing robot, forces in N, masses in kg; 'contact: always' for sensors zeroed under "
        r"load\)$",
    ):
        identify_feet(robot, [record(sway("fly", duration=10.0, lifts=lifts))])


def test_a_robot_with_one_foot(tmp_path: Path) -> None:
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    robot = make_robot(tmp_path, feet={"right": feet["right"]})
    found = identify_feet(robot, [record(sway(duration=12.0))])
    assert_truth(found, 1.2 * (WEIGHT / 2) ** 2 / VERTICAL / 330, feet=("right",))
    assert "z_unknown" in codes(found)
    assert "no_double_support" not in codes(found)
    assert {row.foot for row in found.parameters} == {"right"}


def test_robots_without_feet_or_imu_are_refused(tmp_path: Path, logs: list[MotionLog]) -> None:
    with pytest.raises(
        RobotError, match=r"robot\.yaml: names no feet \(valid: feet: \{left: \.\.\., right: \.\.\.\}\)$"
    ):
        identify_feet(make_robot(tmp_path / "a", feet={}), logs)
    entry = robot_entry()
    del entry["imu"]
    with pytest.raises(
        RobotError,
        match=r"robot\.yaml: names no imu: bush angles need the direction of gravity \(valid: imu: "
        r"\{name: \.\.\., link: \.\.\.\}\)$",
    ):
        identify_feet(make_robot(tmp_path / "b", imu=None), logs)


@pytest.mark.parametrize("unit", [0.2248, 0.3])
def test_feet_that_carry_another_weight_than_the_robot_s_identify_nothing_usable(
    robot: RobotModel, logs: list[MotionLog], unit: float
) -> None:
    """Forces and torques alike in another unit: stiffness follows them, and no residual shows it."""
    names = [name for name in logs[0].columns if name.startswith("wrench.")]
    other = [log.with_columns({name: unit * log.column(name) for name in names}) for log in logs]
    found = identify_feet(robot, other)
    assert "weight" in codes(found)
    assert not [row for row in found.parameters if row.axis != "z" and row.verdict == "usable"]

"""From logs to stiffness, damping and offset: exact on exact logs, indifferent to how sensors are mounted."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pa_parquet
import pytest
from scipy.spatial.transform import Rotation

from biped import (
    FEET,
    TRUTH,
    VERTICAL,
    WEIGHT,
    Frame,
    Law,
    Motion,
    Mounting,
    make_robot,
    record,
    robot_entry,
    sway,
    times,
)
from plantar.errors import DataError, LogError, RobotError
from plantar.identify.feet import identify_feet
from plantar.identify.settings import FeetSettings
from plantar.log import MotionLog
from plantar.result import FeetResult, read_result
from plantar.robot import RobotModel

# The biped's forces are drawn, not moved by Newton: its logs cannot show a delay, and are known to have none.
PUNCTUAL = FeetSettings(wrench_delay=0.0)

EXACT = 1e-4  # what differences of the joints' positions cost
Truth = Mapping[tuple[str, str], Law]
AXES = ("pitch", "roll")


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    """Three exact recordings; the third is for validation."""
    return [record(sway(name, seed=seed)) for seed, name in enumerate(("first", "second", "third"))]


@pytest.fixture(scope="module")
def result(robot: RobotModel, logs: list[MotionLog]) -> FeetResult:
    return identify_feet(robot, logs[:2], logs[2:], PUNCTUAL)


def assert_truth(result: FeetResult, rel: float, feet: tuple[str, ...] = FEET, truth: Truth = TRUTH) -> None:
    """Stiffness, damping and every motion's offset agree with the law that made the logs."""
    for foot in feet:
        for axis in AXES:
            law = truth[foot, axis]
            assert result.parameter(foot, axis, "stiffness").value == pytest.approx(law.stiffness, rel=rel)
            assert result.parameter(foot, axis, "damping").value == pytest.approx(law.damping, rel=4 * rel)
    for row in result.offsets:
        law = truth[row.foot, row.axis]
        assert row.foot not in feet or row.value == pytest.approx(law.offset, abs=0.2 * rel * law.stiffness)


def rotational(result: FeetResult) -> np.ndarray:
    """Stiffness and damping in a fixed order."""
    names = ("stiffness", "damping")
    return np.array(
        [result.parameter(foot, axis, name).value for foot in FEET for axis in AXES for name in names]
    )


def codes(result: FeetResult) -> set[str]:
    return {note.code for note in result.notes}


def without(log: MotionLog, *parts: str) -> MotionLog:
    """The log without the columns whose name holds one of `parts`."""
    kept = {name: values for name, values in log.columns.items() if not any(part in name for part in parts)}
    return MotionLog(log.name, log.time, kept)


def noisy(log: MotionLog, seed: int) -> MotionLog:
    """White noise of usual sizes on every channel."""
    random = np.random.default_rng(seed)
    size = {"orientation": 1e-4, "angular_velocity": 2e-3, "linear": 0.02, "position": 1e-5, "velocity": 1e-3}
    size |= {"force": 1.0, "torque": 0.1}

    def spoiled(name: str, values: np.ndarray) -> np.ndarray:
        return values + random.normal(0, next(s for part, s in size.items() if part in name), len(values))

    return log.with_columns({name: spoiled(name, values) for name, values in log.columns.items()})


def test_exact_logs_give_the_truth(result: FeetResult) -> None:
    assert_truth(result, EXACT)
    rows = [row for row in result.parameters if row.axis in AXES]
    assert {row.verdict for row in rows} == {"usable"}
    assert {row.unit for row in rows} == {"N.m/rad", "N.m.s/rad"}
    assert len(result.offsets) == 2 * 2 * 2


def test_exact_logs_are_predicted_exactly(result: FeetResult) -> None:
    kinds = {(row.kind, row.motion) for row in result.validation}
    assert {("direct", "first"), ("direct", "second"), ("cross", "third")} <= kinds
    for row in result.validation:
        if row.axis in AXES:
            assert row.mean_abs_error < EXACT * row.max_abs
            assert row.zero_mean_abs > 0.1


def test_the_vertical_stiffness_shows_in_the_closed_chain(result: FeetResult) -> None:
    for foot in FEET:
        row = result.parameter(foot, "z", "stiffness")
        assert row.value == pytest.approx(VERTICAL, rel=1e-4)
        assert row.unit == "N/m"


def test_all_samples_of_a_healthy_log_serve(result: FeetResult, logs: list[MotionLog]) -> None:
    assert {phase.support for phase in result.phases} == {"double"}
    for foot in FEET:
        served = sum(phase.end - phase.start for phase in result.phases if phase.used and phase.foot == foot)
        assert served > 0.97 * sum(log.duration for log in logs)


def test_noise_leaves_the_truth_within_the_intervals(robot: RobotModel, logs: list[MotionLog]) -> None:
    """Noise of usual sizes: K within 1 %, C within 3 %; deviations of that order, not claimed 0."""
    result = identify_feet(robot, [noisy(log, seed) for seed, log in enumerate(logs)], settings=PUNCTUAL)
    hits = 0
    for foot in FEET:
        for axis in AXES:
            law = TRUTH[foot, axis]
            for name, truth, tolerance in (
                ("stiffness", law.stiffness, 0.01),
                ("damping", law.damping, 0.03),
            ):
                row = result.parameter(foot, axis, name)
                assert row.value == pytest.approx(truth, rel=tolerance)
                assert row.interval95 is not None
                assert row.std is not None
                assert 1e-5 < row.std / truth < tolerance
                hits += row.interval95[0] <= truth <= row.interval95[1]
    assert hits >= 6, "of 8"


@pytest.mark.parametrize(
    "mounting",
    [
        Mounting(imu=Frame((0.2, -0.1, 0.5), (0.4, -1.1, 2.0))),
        Mounting(wrench=Frame((0.03, -0.02, 0.05), (0.0, 0.0, np.pi / 2))),
        Mounting(wrench=Frame((0.0, 0.0, -0.02), (np.pi, 0.0, 0.3))),
        Mounting(sign=-1),
        Mounting(
            sign=-1,
            wrench=Frame((-0.02, 0.01, 0.0), (0.3, -0.2, 1.0)),
            imu=Frame((0.0, 0.1, 0.0), (np.pi, 0.0, 0.0)),
        ),
        Mounting(bush=Frame((0.01, -0.005, -0.05))),
        Mounting(bush=Frame((0.0, 0.0, -0.06), (0.05, -0.04, 0.6))),
    ],
)
def test_sensors_and_bush_may_sit_anywhere(tmp_path: Path, mounting: Mounting) -> None:
    """The frame law: what is identified belongs to the bush, whatever the sensors' places, axes and signs."""
    robot = make_robot(tmp_path, mounting)
    assert_truth(identify_feet(robot, [record(sway(duration=12.0), mounting)]), EXACT)


def test_the_imus_yaw_never_enters(robot: RobotModel, logs: list[MotionLog], result: FeetResult) -> None:
    turned = []
    for log in logs[:2]:
        orientation = log.orientation("chest")
        assert orientation is not None
        yaw = Rotation.from_euler("z", (1.0 + 0.05 * log.time)[:, None])
        quaternion = (yaw * Rotation.from_quat(orientation, scalar_first=True)).as_quat(scalar_first=True)
        quaternion[::7] *= -1
        names = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
        turned.append(log.with_columns(dict(zip(names, quaternion.T, strict=True))))
    np.testing.assert_allclose(rotational(identify_feet(robot, turned)), rotational(result), rtol=1e-8)


def test_a_wrong_sign_is_refused(tmp_path: Path, logs: list[MotionLog]) -> None:
    with pytest.raises(DataError, match=r"sign: -1"):
        identify_feet(make_robot(tmp_path), [record(sway(), Mounting(sign=-1))])


def test_equation_7_order_and_company_do_not_matter(robot: RobotModel, logs: list[MotionLog]) -> None:
    spoiled = [noisy(log, seed) for seed, log in enumerate(logs)]
    one, other = identify_feet(robot, spoiled), identify_feet(robot, spoiled[::-1])
    np.testing.assert_allclose(rotational(one), rotational(other), rtol=1e-9)
    # A motion told twice says the same as once, but for the weight that it gets against the feet's likeness in z.
    twin = MotionLog("again", spoiled[0].time, spoiled[0].columns)
    once, twice = identify_feet(robot, spoiled[:1]), identify_feet(robot, [spoiled[0], twin])
    np.testing.assert_allclose(rotational(once), rotational(twice), rtol=1e-3)


def biased(name: str, seed: int, shift: float) -> MotionLog:
    truth = {key: replace(law, offset=law.offset + shift) for key, law in TRUTH.items()}
    return record(sway(name, seed=seed, truth=truth))


def test_each_motion_has_its_own_offset_unless_shared(robot: RobotModel) -> None:
    recordings = [biased("low", 1, -2.0), biased("high", 2, 3.0)]
    own = identify_feet(robot, recordings)
    np.testing.assert_allclose(rotational(own), rotational(identify_feet(robot, recordings[:1])), rtol=EXACT)
    values = {(row.foot, row.axis, row.motion): row.value for row in own.offsets}
    for (foot, axis), law in TRUTH.items():
        assert values[foot, axis, "low"] == pytest.approx(law.offset - 2.0, abs=1e-3)
        assert values[foot, axis, "high"] == pytest.approx(law.offset + 3.0, abs=1e-3)
    shared = identify_feet(robot, recordings, settings=FeetSettings(offset="shared"))
    assert np.abs(rotational(shared) / rotational(own) - 1).max() > 0.003, "one offset for two biases costs"
    for foot in FEET:
        for axis in AXES:
            assert len({row.value for row in shared.offsets if (row.foot, row.axis) == (foot, axis)}) == 1
    errors = [
        sum(row.mean_abs_error for row in found.validation if row.kind == "direct") for found in (own, shared)
    ]
    assert errors[1] > errors[0] + 1.0


def test_an_unseen_motions_offset_comes_from_its_first_second(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    found = identify_feet(robot, logs[:1], [biased("unseen", 5, 10.0)])
    for row in found.validation:
        if row.kind == "cross" and row.axis in AXES:
            assert row.mean_abs_error < 1e-3


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
    with pytest.raises(DataError, match="fly: no foot carries load"):
        identify_feet(robot, [record(sway("fly", duration=10.0, lifts=lifts))])


def test_a_robot_with_one_foot(tmp_path: Path) -> None:
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    robot = make_robot(tmp_path, feet={"right": feet["right"]})
    found = identify_feet(robot, [record(sway(duration=12.0))])
    assert_truth(found, 1.2 * (WEIGHT / 2) ** 2 / VERTICAL / 330, feet=("right",))
    assert "z_unknown" in codes(found)
    assert {row.foot for row in found.parameters} == {"right"}


def test_robots_without_feet_or_imu_are_refused(tmp_path: Path, logs: list[MotionLog]) -> None:
    with pytest.raises(RobotError, match="feet"):
        identify_feet(make_robot(tmp_path / "a", feet={}), logs)
    entry = robot_entry()
    del entry["imu"]
    with pytest.raises(RobotError, match="imu"):
        identify_feet(make_robot(tmp_path / "b", imu=None), logs)


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


def test_jitter_is_resampled(robot: RobotModel) -> None:
    motion = sway("jitter")
    found = identify_feet(robot, [record(motion, at=times(motion, rate=200.0, jitter=0.25, seed=3))])
    assert_truth(found, 5e-3)


def test_a_joint_on_the_path_that_is_not_recorded_is_a_warning(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    found = identify_feet(robot, [without(logs[0], "left_ankle_roll")])
    assert "path_joint_missing" in codes(found)
    assert_truth(found, 2e-3, feet=("right",))


def test_a_joint_off_the_path_may_be_missing(
    robot: RobotModel, logs: list[MotionLog], result: FeetResult
) -> None:
    found = identify_feet(robot, [without(log, "neck") for log in logs[:2]])
    np.testing.assert_allclose(rotational(found), rotational(result), rtol=1e-12)
    assert "joint_missing" in codes(found)


def test_a_missing_wrench_is_an_error_that_names_the_column(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(LogError, match=r"first, column 'wrench\.left\.torque\.y': is missing"):
        identify_feet(robot, [without(logs[0], "left.torque.y")])
    with pytest.raises(LogError, match=r"linear_acceleration"):
        identify_feet(robot, [without(logs[0], "orientation", "linear")])


def test_two_logs_of_one_name_are_refused(robot: RobotModel, logs: list[MotionLog]) -> None:
    with pytest.raises(DataError, match="two logs are called 'first'"):
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


def test_the_result_keeps_the_contract(result: FeetResult, tmp_path: Path) -> None:
    path = result.save(tmp_path / "out")
    content = json.loads(path.read_text())
    assert content["schema"] == "plantar.feet/1"
    assert content["robot"] == "biped"
    assert content["model"] == "kelvin_voigt"
    assert content["created"].endswith("Z")
    assert content["inputs"][0] == {"path": "first", "sha256": None, "role": "fit"}
    assert [row["role"] for row in content["inputs"]] == ["fit", "fit", "validate"]
    assert content["settings"]["offset"] == "per-motion"
    keys = {"foot", "axis", "name", "unit", "value", "std", "interval95", "relative_std_percent", "verdict"}
    for row in content["parameters"]:
        assert keys <= set(row)
        assert row["axis"] in ("pitch", "roll", "z")
        assert row["verdict"] in ("usable", "weak", "unidentifiable")
        assert row["interval95"] is None or (
            len(row["interval95"]) == 2 and row["interval95"][0] <= row["interval95"][1]
        )
    for row in content["offsets"]:
        assert set(row) == {"foot", "axis", "motion", "unit", "value", "std"}
    for row in content["phases"]:
        assert set(row) == {"motion", "foot", "start", "end", "support", "used", "reason"}
        assert row["start"] <= row["end"]
        assert row["used"] == (row["reason"] is None)
    numbers = {"mean_abs_error", "rms_error", "max_abs", "percent_of_max", "zero_mean_abs"}
    for row in content["validation"]:
        assert {"kind", "motion", "foot", "axis"} | numbers <= set(row)
        assert all(isinstance(row[name], float) for name in numbers)
    for row in content["notes"]:
        assert set(row) == {"code", "severity", "text"}
    assert read_result(path, "plantar.feet/1") == content


def test_residuals_have_a_row_for_each_sample_foot_and_motion(result: FeetResult, tmp_path: Path) -> None:
    result.save(tmp_path)
    table = pa_parquet.read_table(tmp_path / "residuals.parquet")
    names = {"motion", "role", "foot", "time", "used", "support", "force_z", "cop_x", "cop_y"}
    names |= {f"{axis}.{part}" for axis in AXES for part in ("deflection", "rate", "torque", "predicted")}
    assert names <= set(table.column_names)
    assert table.num_rows == 3 * 2 * 2001
    columns = table.to_pydict()
    used = np.array(columns["used"])
    for axis in AXES:
        torque, predicted = (
            np.array(columns[f"{axis}.torque"])[used],
            np.array(columns[f"{axis}.predicted"])[used],
        )
        np.testing.assert_allclose(predicted, torque, atol=1e-2)
    assert set(columns["role"]) == {"fit", "validate"}


def test_progress_is_told(robot: RobotModel, logs: list[MotionLog]) -> None:
    told: list[str] = []
    identify_feet(robot, logs[:1], progress=told.append)
    assert any("first" in line for line in told)
    assert any("left" in line for line in told)

"""From logs to stiffness, damping and offset: exact on exact logs, indifferent to how sensors are mounted."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow.parquet as pa_parquet
import pytest
from scipy.spatial.transform import Rotation

from biped import TRUTH, VERTICAL, record, sway
from biped_robot import FEET, Frame, Mounting, make_robot
from feet_trials import AXES, EXACT, LINEAR, PUNCTUAL, assert_truth, biased, noisy, rotational
from plantar.errors import DataError
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.results.io import read_result
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    """Three exact recordings; the third is for validation."""
    return [record(sway(name, seed=seed)) for seed, name in enumerate(("first", "second", "third"))]


@pytest.fixture(scope="module")
def result(robot: RobotModel, logs: list[MotionLog]) -> FeetResult:
    return identify_feet(robot, logs[:2], logs[2:], PUNCTUAL)


def test_exact_logs_give_the_truth(result: FeetResult) -> None:
    assert_truth(result, EXACT)
    rows = [row for row in result.parameters if row.axis in AXES]
    assert {row.verdict for row in rows} == {"usable"}
    assert {row.unit for row in rows} == {"N.m/rad", "N.m.s/rad"}
    assert len(result.offsets) == 2 * 2 * 2


def test_exact_logs_are_predicted_exactly(result: FeetResult) -> None:
    kinds = {(row.kind, row.motion) for row in result.validation}
    assert {("direct", "first"), ("direct", "second"), ("cross", "third")} <= kinds
    told = [row.kind for row in result.validation]
    assert told == sorted(told, key=["direct", "cross"].index), "what was fitted first"
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
    with pytest.raises(
        DataError,
        match=r"^sway: column 'wrench\.left\.force\.z', value -299\.2: pulls the standing foot down "
        r"\(valid: > 0; set 'sign: -1' in feet\.left\.wrench, or turn its rpy if it sits upside "
        r"down\)$",
    ):
        identify_feet(make_robot(tmp_path), [record(sway(), Mounting(sign=-1))])


def test_equation_7_order_and_company_do_not_matter(
    robot: RobotModel, logs: list[MotionLog], monkeypatch: pytest.MonkeyPatch
) -> None:
    spoiled = [noisy(log, seed) for seed, log in enumerate(logs[:2])]
    one, other = identify_feet(robot, spoiled), identify_feet(robot, spoiled[::-1])
    np.testing.assert_allclose(rotational(one), rotational(other), rtol=1e-9)
    # Made again to the last bit, a motion says the same, but for the weight that it gets against the feet's likeness in
    # z.
    again = {name: np.nextafter(values, np.inf) for name, values in spoiled[0].columns.items()}
    twin = MotionLog("again", spoiled[0].time + 60.0, again)
    monkeypatch.setattr(
        "plantar.logs.inputs.same_noise", lambda _: ()
    )  # which would tell that it is one recording
    once, twice = (identify_feet(robot, each, settings=LINEAR) for each in (spoiled[:1], [spoiled[0], twin]))
    np.testing.assert_allclose(rotational(once), rotational(twice), rtol=1e-3)


def test_an_unseen_motions_offset_comes_from_its_first_second(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    found = identify_feet(robot, logs[:1], [biased("unseen", 5, 10.0)], LINEAR)
    for row in found.validation:
        if row.kind == "cross" and row.axis in AXES:
            assert row.mean_abs_error < 1e-3


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

"""Eq. 3 on arms and legs with known friction, and on a real arm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import example_robots
import small_biped
from kept_texts import assert_as_kept, lines_of
from plantar.dynamics import base_parameters, model_parameters
from plantar.dynamics.equation import Equation
from plantar.errors import DataError, LogError, RobotError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.results.dynamics import DynamicsResult
from plantar.robot.model import RobotModel, load_robot
from plantar.whole_body import regularised_fit
from plantar.whole_body.joints import Inertia, identify_joints

COULOMB_SPEED = 0.02

VISCOUS, COULOMB, OFFSET = 3.0, 2.0, 0.5
TERMS = "".join(
    f"  {name}: {{terms: [viscous, coulomb, offset, stiffness, inertia]}}\n" for name in ("elbow_joint",)
)


@pytest.fixture(scope="module", autouse=True)
def weights_by_hundreds() -> Iterator[None]:
    """Every second weight of the regularisation is tried: each takes a fit of every fold."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(regularised_fit, "REGULARISATIONS", regularised_fit.REGULARISATIONS[::2])
        yield


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    folder = tmp_path_factory.mktemp("arm")
    (folder / "arm.urdf").write_text(example_robots.UR5.read_text())
    (folder / "arm.yaml").write_text("name: arm\nurdf: arm.urdf\nbase: fixed\njoints:\n" + TERMS)
    return load_robot(folder / "arm.yaml")


def record(arm: RobotModel, real: pin.Model, name: str, seed: int, speed: float = 1.0) -> MotionLog:
    rng = np.random.default_rng(seed)
    time = np.arange(0, 30, 0.01)
    states = np.array([small_biped.smooth(rng, speed * time, 1.2) for _ in range(6)])
    q, v, a = states[:, 0].T, speed * states[:, 1].T, speed**2 * states[:, 2].T
    data = real.createData()
    torque = np.array([pin.rnea(real, data, *sample) for sample in zip(q, v, a, strict=True)])
    torque += VISCOUS * v + COULOMB * np.tanh(v / COULOMB_SPEED) + OFFSET
    torque[:, 2] += 5.0 * q[:, 2] + 0.8 * a[:, 2]
    torque += rng.normal(0, 0.3, torque.shape)
    columns = {}
    for k, joint in enumerate(arm.joint_names):
        for quantity, values in (("position", q), ("velocity", v), ("acceleration", a), ("effort", torque)):
            columns[f"joint.{joint}.{quantity}"] = values[:, k]
    return MotionLog(name, time, columns)


@pytest.fixture(scope="module")
def real(arm: RobotModel) -> pin.Model:
    return small_biped.truth(arm.model, 3)


@pytest.fixture(scope="module")
def result(arm: RobotModel, real: pin.Model) -> DynamicsResult:
    return identify_joints(arm, [record(arm, real, "slow", 1)], [record(arm, real, "fast", 2, 2.0)])


def test_friction_spring_and_actuator_inertia_come_back_within_three_percent(result: DynamicsResult) -> None:
    expected = {"viscous": VISCOUS, "coulomb": COULOMB}
    for joint in (
        "shoulder_pan_joint",
        "shoulder_lift_joint",
        "elbow_joint",
        "wrist_1_joint",
        "wrist_2_joint",
    ):
        for name, value in expected.items():
            assert result.parameter(joint, name).value == pytest.approx(value, rel=0.03), (joint, name)
            assert result.parameter(joint, name).verdict == "usable"
    assert result.parameter("elbow_joint", "stiffness").value == pytest.approx(5.0, rel=0.03)
    assert [row.name for row in result.parameters if row.joint == "elbow_joint"] == [
        "viscous", "coulomb", "offset", "stiffness", "inertia",
    ]  # fmt: skip


def test_intervals_hold_the_truth(result: DynamicsResult, arm: RobotModel, real: pin.Model) -> None:
    truth = {"viscous": VISCOUS, "coulomb": COULOMB}
    rows = [row for row in result.parameters if row.name in truth]
    inside = [row.interval95[0] <= truth[row.name] <= row.interval95[1] for row in rows]
    assert np.mean(inside) > 0.8
    exact = base_parameters(Equation(arm.model)).grouping @ model_parameters(real)
    covered = [
        abs(row.value - value) < 2.5 * row.std
        for row, value in zip(result.base_parameters, exact, strict=True)
    ]
    assert np.mean(covered) > 0.85


def test_a_motion_twice_as_fast_is_predicted(result: DynamicsResult) -> None:
    row = result.score("fast", "all")
    assert row.kind == "cross"
    assert row.relative_error_percent is not None
    assert row.relative_error_percent < 3.0
    assert row.rms_error < 0.3 * row.cad_rms_error


def test_friction_never_drives_a_joint(arm: RobotModel, real: pin.Model) -> None:
    """Torque recorded with the sign of friction reversed: the fit stops at zero and says so."""
    log = record(arm, real, "odd", 4)
    name = arm.joint_names[0]
    wrong = log.column(f"joint.{name}.effort") - 2 * VISCOUS * log.column(f"joint.{name}.velocity")
    row = identify_joints(arm, [log.with_columns({f"joint.{name}.effort": wrong})]).parameter(name, "viscous")
    assert 0 <= row.value < 1e-3
    assert row.verdict == "unidentifiable"


def test_a_joint_that_stands_still_is_unidentifiable(arm: RobotModel, real: pin.Model) -> None:
    log = record(arm, real, "still", 5)
    name = arm.joint_names[5]
    held = {
        f"joint.{name}.{quantity}": np.zeros(len(log))
        for quantity in ("position", "velocity", "acceleration")
    }
    found = identify_joints(arm, [log.with_columns(held)])
    assert found.parameter(name, "viscous").verdict == "unidentifiable"
    assert "of the joints' terms" in next(note.text for note in found.notes if note.code == "unexcited")
    assert "moves" in found.parameter(name, "viscous").reason


def test_a_passive_spring_needs_no_torque(tmp_path: Path) -> None:
    """A biped whose arm hangs on a spring and damper: eq. 3 finds both from motion and contacts alone."""
    robot = small_biped.robot(tmp_path, "joints:\n  shoulder: {passive: true, terms: [stiffness, viscous]}\n")
    model = robot.floating_model
    log = small_biped.record(robot, model, "swing", 7, 20.0, 0.05)
    # The arm's motion is given; the torque that it took was the spring's and the damper's where they match it best.
    torque = log.column("joint.shoulder.effort")
    states = np.column_stack([log.column(f"joint.shoulder.{kind}") for kind in ("position", "velocity")])
    expected = -np.linalg.lstsq(states, torque, rcond=None)[0]
    columns = {name: values for name, values in log.columns.items() if not name.endswith(".effort")}
    found = identify_joints(robot, [MotionLog("swing", log.time, columns)])
    assert [row.name for row in found.parameters] == ["stiffness", "viscous"]
    assert np.sign(found.parameter("shoulder", "stiffness").value) in (np.sign(expected[0]), 0.0)


def described(terms: str) -> str:
    """These terms of every joint of the small biped: none is chosen by held-out parts, which takes three fits."""
    legs = [f"{side}_{joint}" for side in ("left", "right") for joint in ("roll", "pitch", "ankle")]
    return "joints:\n" + "".join(f"  {name}: {{terms: [{terms}]}}\n" for name in ("shoulder", *legs))


def test_a_floating_robots_friction_is_found_beside_its_contacts(tmp_path: Path) -> None:
    robot = small_biped.robot(tmp_path, described("viscous, coulomb, offset"))
    log = small_biped.record(robot, small_biped.truth(robot.floating_model, 8), "walk", 8, 20.0, 0.2)
    columns = {
        f"joint.{name}.effort": log.column(f"joint.{name}.effort")
        + 1.5 * log.column(f"joint.{name}.velocity")
        for name in robot.joint_names
    }
    found = identify_joints(robot, [log.with_columns(columns)])
    for name in robot.joint_names:
        assert found.parameter(name, "viscous").value == pytest.approx(1.5, rel=0.05), name


def test_a_rotor_is_no_spring_and_a_sensors_zero_no_offset_to_use(tmp_path: Path) -> None:
    """Joints that nobody described: a rotor's torque is nearly as a spring's that pushes. A zero of the force sensor's
    torque is an offset of the ankle above it."""
    robot = small_biped.robot(tmp_path)
    log = small_biped.record(robot, small_biped.truth(robot.floating_model, 8), "walk", 8, 20.0, 0.2)
    columns = {"wrench.left.torque.y": log.column("wrench.left.torque.y") + 2.0}
    for name in robot.joint_names:
        acceleration = np.gradient(log.column(f"joint.{name}.velocity"), log.time)
        columns[f"joint.{name}.effort"] = log.column(f"joint.{name}.effort") + 0.7 * acceleration + 3.0
    found = identify_joints(robot, [log.with_columns(columns)])
    assert {row.name for row in found.parameters} == {"viscous", "coulomb", "offset", "inertia"}
    for name in robot.joint_names:
        assert found.parameter(name, "inertia").value == pytest.approx(0.7, rel=0.1), name
        assert found.parameter(name, "inertia").verdict == "weak", name
        assert "gains and delays of sensors" in found.parameter(name, "inertia").reason
        assert "held-out" not in found.parameter(name, "viscous").reason, name
    assert found.parameter("left_ankle", "offset").value == pytest.approx(3.0 + 2.0, abs=0.3)
    assert found.parameter("left_ankle", "offset").verdict == "weak"
    assert "force sensor" in found.parameter("left_ankle", "offset").reason
    assert found.parameter("shoulder", "offset").verdict == "usable"


@pytest.mark.parametrize("inertia", ["together", "first", "known"])
def test_inertias_known_found_first_or_together_give_the_joints_parameters(
    tmp_path: Path, inertia: Inertia
) -> None:
    robot = small_biped.robot(tmp_path, described("viscous, coulomb, stiffness"))
    model = robot.floating_model
    log = small_biped.record(
        robot, model if inertia == "known" else small_biped.truth(model, 9), "walk", 9, 30.0, 0.2
    )
    columns = {}
    for name in robot.joint_names:
        position, velocity, effort = (
            log.column(f"joint.{name}.{kind}") for kind in ("position", "velocity", "effort")
        )
        columns[f"joint.{name}.effort"] = (
            effort + 4.0 * velocity + 5.0 * np.tanh(velocity / COULOMB_SPEED) + 40.0 * position
        )
    found = identify_joints(robot, [log.with_columns(columns)], inertia=inertia)
    for name in robot.joint_names:
        for term, value in (("viscous", 4.0), ("coulomb", 5.0), ("stiffness", 40.0)):
            assert found.parameter(name, term).value == pytest.approx(value, rel=0.03), (name, term)
    changed = any(row.value != row.cad for row in found.inertial_parameters)
    assert changed == (inertia != "known")
    assert found.settings["inertia"] == inertia


def test_a_fixed_base_has_no_inertias_to_find_first(arm: RobotModel, real: pin.Model) -> None:
    with pytest.raises(
        RobotError,
        match=r"arm\.yaml: a fixed base has no base rows to identify inertias from first \(valid: "
        r"inertia: together, known\)$",
    ):
        identify_joints(arm, [record(arm, real, "one", 6)], inertia="first")


def test_what_cannot_serve_is_refused_in_one_line(arm: RobotModel, real: pin.Model) -> None:
    log = record(arm, real, "one", 6)
    silent = {name: values for name, values in log.columns.items() if not name.endswith("effort")}
    with pytest.raises(
        DataError,
        match=r"^one: holds no joint torques \(valid: joint\.<joint>\.effort, or passive: true in the "
        r"robot file\)$",
    ):
        identify_joints(arm, [MotionLog("one", log.time, silent)])
    with pytest.raises(
        DataError,
        match=r"^one: columns 'joint\.\*\.position': the log holds no joint positions, such as of "
        r"elbow_joint, shoulder_lift_joint, shoulder_pan_joint and 3 more \(valid: columns "
        r"joint\.<joint>\.position; for other names a map, `columns` in the robot file\)$",
    ):
        identify_joints(arm, [MotionLog("one", log.time, {})])
    with pytest.raises(
        (DataError, LogError), match=r"^two, column 'joint\.shoulder_pan_joint\.effort': is missing$"
    ):
        identify_joints(arm, [record(arm, real, "other", 7)], [MotionLog("two", log.time, silent)])
    with pytest.raises(DataError, match=r"^no logs to fit \(valid: at least one\)$"):
        identify_joints(arm, [])


def test_kuka_predicts_its_second_recording(shared_data: Path) -> None:
    folder = shared_data / "kuka_lwr4"
    kuka = load_robot(folder / "robot.yaml")
    one, two = (open_log(folder / f"recording_{k}.csv", kuka) for k in (1, 2))
    found = identify_joints(kuka, [one], [two])
    row = found.score("recording_2", "all")
    assert row.relative_error_percent is not None
    assert row.relative_error_percent <= 2.4
    # The quickest fifth from the slower part: pulled and dissipative, it beats the CAD by far.
    velocity = np.column_stack([one.column(f"joint.{name}.velocity") for name in kuka.joint_names])
    pace = np.convolve(np.mean((velocity / velocity.std(axis=0)) ** 2, axis=1), np.ones(100) / 100, "same")
    slow = replace(one.select(slice(None)), columns=one.columns)
    gaps = pace < np.quantile(pace, 0.6)
    masked = {
        name: np.where(gaps, values, np.nan) for name, values in one.columns.items() if "effort" in name
    }
    quick = {name: np.where(pace > np.quantile(pace, 0.8), values, np.nan) for name, values in one.columns.items()
             if "effort" in name}  # fmt: skip
    extrapolated = identify_joints(
        kuka, [slow.with_columns(masked)], [replace(one.with_columns(quick), name="quick")]
    )
    quickly = extrapolated.score("quick", "all").relative_error_percent
    assert quickly is not None
    assert quickly < 4.0


def test_a_joint_that_slides_has_forces(tmp_path: Path) -> None:
    """A lift of 2 kg: its friction is in newtons, in what it says and in its scores."""
    inertial = (
        '<inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    )
    (tmp_path / "lift.urdf").write_text(
        '<robot name="lift"><link name="base"/><link name="cart">' + inertial + "</link>"
        '<joint name="lift" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="100" velocity="9"/></joint></robot>'
    )
    terms = "joints: {lift: {terms: [viscous, coulomb, offset]}}\n"
    (tmp_path / "lift.yaml").write_text("name: lift\nurdf: lift.urdf\nbase: fixed\n" + terms)
    time = np.arange(0, 20, 0.01)
    q, v, a = small_biped.smooth(np.random.default_rng(0), time, 0.3)
    force = 2 * (9.81 + a) + VISCOUS * v + COULOMB * np.tanh(v / COULOMB_SPEED) + OFFSET
    force += np.random.default_rng(1).normal(0, 0.1, len(time))
    states = {"position": q, "velocity": v, "acceleration": a, "effort": force}
    log = MotionLog("up and down", time, {f"joint.lift.{name}": values for name, values in states.items()})
    found = identify_joints(tmp_path / "lift.yaml", log, inertia="known")
    viscous = found.parameter("lift", "viscous")
    assert (round(viscous.value, 1), viscous.unit) == (VISCOUS, "N.s/m")
    assert [row.unit for row in found.parameters] == ["N.s/m", "N", "N"]
    assert found.score("up and down", "lift").unit == "N"


def test_all_of_a_result_is_as_it_is_kept(result: DynamicsResult) -> None:
    text = lines_of(result.to_dict(), "created", "plantar", "robot_model", "path", "sha256")
    assert_as_kept(f"{text}{result}", Path(__file__).parent / "kept" / "joints.txt", share=1e-4, least=1e-6)

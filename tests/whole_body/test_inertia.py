"""Eq. 2 on robots with known parameters, and on a real humanoid."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest

import small_biped
from kept_texts import assert_as_kept, lines_of
from plantar.dynamics import Contact, Motion, base_parameters, model_parameters
from plantar.dynamics.base_motion import root_motion, root_motion_from_sole
from plantar.dynamics.consistency import Normal, Prior, consistent_fit, is_consistent, pseudo_inertia
from plantar.dynamics.equation import Equation
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.logs.readers import open_log
from plantar.results.dynamics import DynamicsResult
from plantar.robot.model import RobotModel, load_robot
from plantar.whole_body import regularised_fit
from plantar.whole_body.inertia import identify_inertia
from plantar.whole_body.regularised_fit import HeldOutError, chosen_regularisation
from plantar.whole_body.settings import DynamicsSettings


@pytest.fixture(scope="module", autouse=True)
def weights_by_hundreds() -> Iterator[None]:
    """Every second weight of the regularisation is tried: each takes a fit of every fold."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(regularised_fit, "REGULARISATIONS", regularised_fit.REGULARISATIONS[::2])
        yield


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return small_biped.robot(tmp_path_factory.mktemp("biped"))


@pytest.fixture(scope="module")
def real(robot: RobotModel) -> pin.Model:
    return small_biped.truth(robot.floating_model, 1)


@pytest.fixture(scope="module")
def logs(robot: RobotModel, real: pin.Model) -> list[MotionLog]:
    return [small_biped.record(robot, real, name, seed, 25.0, 0.5) for name, seed in (("one", 1), ("two", 2))]


@pytest.fixture(scope="module")
def result(robot: RobotModel, logs: list[MotionLog]) -> DynamicsResult:
    return identify_inertia(robot, logs[:1], logs[1:])


def test_the_imus_motion_moves_to_the_root_through_a_moving_arm(robot: RobotModel) -> None:
    """Against Pinocchio: a root with known motion, the IMU's readings made from it, and back."""
    model, data = robot.floating_model, robot.floating_model.createData()
    equation = Equation(model)
    rng = np.random.default_rng(0)
    joint, placement = robot.frame(robot.imu.placement)  # type: ignore[union-attr]
    for _ in range(5):
        q = pin.randomConfiguration(model, -np.ones(model.nq), np.ones(model.nq))
        v, a = rng.normal(size=(2, model.nv))
        pin.forwardKinematics(model, data, q, v, a)

        def proper(motion: pin.Motion, slope: pin.Motion, rotation: np.ndarray) -> np.ndarray:
            up = rotation.T @ np.array([0, 0, 9.81])
            return slope.linear + np.cross(motion.angular, motion.linear) + up

        speed, slope = placement.actInv(data.v[joint + 1]), placement.actInv(data.a[joint + 1])
        world = (data.oMi[joint + 1] * placement).rotation
        measured = np.concatenate([proper(speed, slope, world), speed.angular, slope.angular])
        rows = (measured, q[7:], v[6:], a[6:])
        found = root_motion(equation, joint, placement, *(row[None] for row in rows))
        root = proper(data.v[1], data.a[1], data.oMi[1].rotation)
        expected = np.concatenate([root, data.v[1].angular, data.a[1].angular])
        np.testing.assert_allclose(found[0], expected, atol=1e-10)


def test_a_sole_that_stands_still_gives_the_roots_motion(robot: RobotModel) -> None:
    """Against Pinocchio: root velocity and acceleration that keep the foot at rest and level."""
    model = robot.floating_model
    data = model.createData()
    rng = np.random.default_rng(1)
    joint, placement = robot.frame(robot.feet["left"].sole.placement)
    frame = model.addFrame(pin.Frame("sole", joint + 1, 0, placement, pin.FrameType.OP_FRAME), False)
    data = model.createData()
    q = pin.neutral(model)
    q[7:] = rng.uniform(-0.5, 0.5, model.nq - 7)
    pin.framesForwardKinematics(model, data, q)
    q[3:7] = pin.Quaternion(data.oMf[frame].rotation.T).coeffs()
    v, a = rng.normal(size=(2, model.nv))
    jacobian = pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL)
    v[:6] = -np.linalg.solve(jacobian[:, :6], jacobian[:, 6:] @ v[6:])
    pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
    drift = pin.getFrameAcceleration(model, data, frame, pin.LOCAL).vector
    a[:6] = -np.linalg.solve(jacobian[:, :6], jacobian[:, 6:] @ a[6:] + drift)
    up = pin.Quaternion(q[3:7]).toRotationMatrix().T @ np.array([0, 0, 9.80665])
    expected = np.concatenate([a[:3] + np.cross(v[3:6], v[:3]) + up, v[3:6], a[3:6]])
    rows = (q[None, 7:], v[None, 6:], a[None, 6:])
    found = root_motion_from_sole(Equation(robot.floating_model), joint, placement, *rows)
    np.testing.assert_allclose(found[0], expected, atol=1e-10)


def test_a_log_without_imu_is_taken_from_its_standing_sole(robot: RobotModel, real: pin.Model) -> None:
    equation = Equation(robot.floating_model)
    rng = np.random.default_rng(4)
    time = np.arange(0, 20, small_biped.PERIOD)
    states = np.array([small_biped.smooth(rng, time, 0.4) for _ in robot.joint_names])
    q, v, a = states[:, 0].T, states[:, 1].T, states[:, 2].T
    joint, placement = robot.frame(robot.feet["left"].sole.placement)
    base = root_motion_from_sole(equation, joint, placement, q, v, a)
    ground = equation.inverse_dynamics(Motion(base, q, v, a), model_parameters(real))[:6].T
    sensor = robot.frame(robot.feet["left"].wrench.placement)
    transfer = equation.contact_transfer(q, Contact(*sensor))[:, :6]
    wrench = np.linalg.solve(transfer, ground[:, :, None])[:, :, 0]
    columns = {f"joint.{name}.position": q[:, k] for k, name in enumerate(robot.joint_names)}
    kinds = [f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]
    for side, values in (("left", wrench), ("right", np.zeros_like(wrench))):
        columns |= {f"wrench.{side}.{kind}": values[:, k] for k, kind in enumerate(kinds)}
    found = identify_inertia(replace(robot, imu=None), [MotionLog("sway", time, columns)])
    assert "base_from_sole" in {note.code for note in found.notes}
    assert found.mass == pytest.approx(sum(inertia.mass for inertia in real.inertias), rel=0.02)
    assert found.score("sway", "torque.y").rms_error < 0.4 * found.score("sway", "torque.y").cad_rms_error


def test_the_held_out_wrench_is_predicted_and_the_urdf_is_not_believed(result: DynamicsResult) -> None:
    for row in result.validation:  # type: ignore[attr-defined]
        assert row.rms_error < 0.5 * row.cad_rms_error, (row.kind, row.axis)
    assert {row.kind for row in result.validation} == {"direct", "cross"}  # type: ignore[attr-defined]


def test_mass_and_every_link_are_those_of_a_body(result: DynamicsResult, real: pin.Model) -> None:
    total = sum(inertia.mass for inertia in real.inertias)
    assert result.mass == pytest.approx(total, rel=0.01)  # type: ignore[attr-defined]
    values = np.array([row.value for row in result.inertial_parameters])  # type: ignore[attr-defined]
    assert is_consistent(values)


def test_intervals_of_base_parameters_hold_the_truth(
    robot: RobotModel, real: pin.Model, result: DynamicsResult
) -> None:
    base = base_parameters(Equation(robot.floating_model))
    exact = base.grouping @ model_parameters(real)
    rows = result.base_parameters  # type: ignore[attr-defined]
    inside = [abs(row.value - value) < 2.2 * row.std for row, value in zip(rows, exact, strict=True)]
    assert np.mean(inside) > 0.9


def test_the_identified_urdf_loads_with_the_same_bodies(result: DynamicsResult, tmp_path: Path) -> None:
    path = result.save(tmp_path).parent / "identified.urdf"  # type: ignore[attr-defined]
    values = np.array([row.value for row in result.inertial_parameters])  # type: ignore[attr-defined]
    model = pin.buildModelFromXML(path.read_text(), pin.JointModelFreeFlyer())
    np.testing.assert_allclose(model_parameters(model), values, atol=1e-12)
    # MuJoCo takes a URDF's root for the world: give it a floating one.
    floating = path.read_text().replace("<link ", '<link name="world"/><link ', 1)
    joint = '<joint name="float" type="floating"><parent link="world"/><child link="trunk"/></joint>'
    simulated = mujoco.MjModel.from_xml_string(floating.replace("</robot>", joint + "</robot>"))
    assert simulated.body_mass.sum() == pytest.approx(values[::10].sum(), rel=1e-9)
    assert {p.name for p in tmp_path.iterdir()} == {"identified.urdf", "residuals.parquet", "result.json"}


def test_the_trivial_predictor_is_the_mean_of_all_fitted_motions(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    """Also for the first one: by its own mean alone it would look harder to beat than the others."""
    found = identify_inertia(robot, logs)
    columns = found.residuals.to_pydict()
    force = {
        log.name: np.array(columns["force.x.measured"])[np.array(columns["motion"]) == log.name]
        for log in logs
    }
    trivial = np.mean([values.mean() for values in force.values()])
    for name, values in force.items():
        expected = np.mean(np.abs(values - trivial))
        assert found.score(name, "force.x").zero_mean_abs == pytest.approx(expected, rel=1e-9)


def test_a_reversed_torque_channel_and_a_tilted_mount_are_found_and_said(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    flipped = {
        f"wrench.{side}.torque.x": -logs[0].column(f"wrench.{side}.torque.x") for side in ("left", "right")
    }
    found = identify_inertia(robot, [logs[0].with_columns(flipped)])
    assert "wrench_polarity" in {note.code for note in found.notes}
    assert "torque.x" in next(note.text for note in found.notes if note.code == "wrench_polarity")
    turn = pin.exp3(np.array([0.0, 0.06, 0.0]))
    names = [f"imu.trunk.{kind}" for kind in ("angular_velocity", "linear_acceleration")]
    tilted = {
        f"{name}.{axis}": (logs[0].stack(f"{name}.{a}" for a in "xyz") @ turn.T)[:, k]
        for name in names
        for k, axis in enumerate("xyz")
    }
    codes = {note.code for note in identify_inertia(robot, [logs[0].with_columns(tilted)]).notes}
    assert "imu_tilt" in codes
    assert "wrench_polarity" not in codes


def test_an_accelerometer_without_gravity_is_left_for_the_soles(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    names = imu_columns("trunk", "linear_acceleration")
    column = logs[0].column(names[2])
    found = identify_inertia(robot, [logs[0].with_columns({names[2]: column - column.mean()})])
    assert "base_from_sole" in {note.code for note in found.notes}


def test_crosstalk_of_a_force_channel_is_found_mended_and_said(
    robot: RobotModel, logs: list[MotionLog], real: pin.Model
) -> None:
    """A lateral force that holds shares of a torque looks like a wrong torque at the base, half a metre above."""
    shares = {"left": 6.0, "right": 4.0}
    leaking = {
        f"wrench.{side}.force.y": logs[0].column(f"wrench.{side}.force.y")
        + share * logs[0].column(f"wrench.{side}.torque.x")
        for side, share in shares.items()
    }
    log = logs[0].with_columns(leaking)
    found = identify_inertia(robot, [log])
    note = next(note.text for note in found.notes if note.code == "wrench_crosstalk")
    assert "wrench_polarity" not in {note.code for note in found.notes}
    assert "force.y" in note
    assert "torque.x" in note
    before, after = (
        float(part.split()[0].rstrip(",")) for part in note.split("miss it by ")[1].split("and by ")
    )
    assert before > 3 * after, "what mends it leaves less"
    for side, share in shares.items():
        said = float(note.split(f"{side} ")[1].split()[0].rstrip(","))
        assert said == pytest.approx(share, rel=0.1)
    raw = identify_inertia(robot, [log], settings=DynamicsSettings(as_recorded=True))
    assert "left as recorded" in next(note.text for note in raw.notes if note.code == "wrench_crosstalk")
    assert raw.score(log.name, "force.y").rms_error > 3 * found.score(log.name, "force.y").rms_error


def test_sound_sensors_are_left_alone(result: DynamicsResult) -> None:
    assert not {"wrench_crosstalk", "wrench_polarity", "imu_tilt"} & {note.code for note in result.notes}


def test_what_stands_still_is_named_as_not_excited(robot: RobotModel, real: pin.Model) -> None:
    log = small_biped.record(robot, real, "still", 5, 6.0, 0.1)
    held = {f"joint.shoulder.{quantity}": np.zeros(len(log)) for quantity in ("position", "velocity")}
    found = identify_inertia(robot, [log.with_columns(held)])
    assert "arm." in next(note.text for note in found.notes if note.code == "unexcited")
    assert all(np.isfinite(row.value) for row in found.inertial_parameters)


def test_a_frozen_log_excites_its_weight_and_little_more(robot: RobotModel, logs: list[MotionLog]) -> None:
    frozen = logs[0].with_columns(
        {name: np.full(len(logs[0]), values[0]) for name, values in logs[0].columns.items()}
    )
    found = identify_inertia(robot, [frozen])
    assert found.rank <= 6
    assert "unexcited" in {note.code for note in found.notes}
    assert all(np.isfinite(row.value) for row in found.inertial_parameters)


def test_gaps_and_nan_are_left_out_with_a_note(robot: RobotModel, logs: list[MotionLog]) -> None:
    column = logs[0].column("imu.trunk.linear_acceleration.z").copy()
    column[1000:1040] = np.nan
    found = identify_inertia(robot, [logs[0].with_columns({"imu.trunk.linear_acceleration.z": column})])
    assert "left_out" in {note.code for note in found.notes}
    assert found.mass == pytest.approx(identify_inertia(robot, logs[:1]).mass, rel=0.01)


def test_consistency_bounds_what_least_squares_would_make_negative() -> None:
    """One body whose mass the data push below zero: the fit stays a body, on its edge."""
    prior = Prior.around(pin.Inertia.FromEllipsoid(2.0, 0.3, 0.2, 0.1).toDynamicParameters())
    regressor = np.eye(10)
    target = prior.cad - np.array([10 * prior.cad[0], *np.zeros(9)])
    found = consistent_fit(Normal.of(regressor, target, prior), prior, 1e-6, positive=())
    assert is_consistent(found)
    assert (
        np.linalg.eigvalsh(pseudo_inertia(found))[0]
        < 0.05 * np.linalg.eigvalsh(pseudo_inertia(prior.cad))[-1]
    )
    free = consistent_fit(Normal.of(regressor, 1.05 * prior.cad, prior), prior, 1e-9, positive=())
    np.testing.assert_allclose(free, 1.05 * prior.cad, rtol=1e-4, atol=1e-6)


def test_the_strongest_pull_that_cannot_be_told_from_the_best_is_chosen() -> None:
    def tried(regularisation: float, *errors: float) -> HeldOutError:
        return HeldOutError(regularisation, np.array(errors))

    best = tried(1.0, 1.0, 1.0, 1.0)
    assert chosen_regularisation([best, tried(10.0, 1.2, 0.9, 1.0), tried(100.0, 1.2, 1.2, 1.25)]) == 10.0
    assert chosen_regularisation([tried(0.1, 1.3, 1.3, 1.3), best]) == 1.0


@pytest.mark.slow
def test_icub_walking_is_predicted_where_the_cad_is_wrong(shared_data: Path) -> None:
    folder = shared_data / "icub_walking"
    icub = load_robot(folder / "robot.yaml")
    log = open_log(folder / "walking.csv.gz", icub)
    half = len(log) // 2
    first = replace(log.select(slice(0, half)), name="first")
    second = replace(log.select(slice(half, None)), name="second")
    found = identify_inertia(icub, [first], [second])
    assert found.score("second", "torque.x").rms_error <= 9.3
    assert found.score("second", "torque.y").rms_error <= 2.2
    assert found.score("second", "force.z").rms_error <= 7.8
    assert found.mass == pytest.approx(33.9, rel=0.03)
    assert is_consistent(np.array([row.value for row in found.inertial_parameters]))


def test_rows_that_are_exactly_zero_leave_the_others_their_weight(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    """A simulator's log of a robot at rest: nothing lateral at all, nothing missed, and still a fit."""
    still = {name: np.zeros(len(logs[0])) for name in logs[0].columns}
    for name in still:
        if name.endswith(("linear_acceleration.z", "force.z")):
            still[name] += float(logs[0].column(name).mean())
        if name.endswith("orientation.w"):
            still[name] += 1.0
    found = identify_inertia(robot, [logs[0].with_columns(still)])
    assert "unexcited" in {note.code for note in found.notes}
    values = np.array([[row.value, row.cad] for row in found.inertial_parameters])
    assert np.isfinite(values).all()


def test_all_of_a_result_is_as_it_is_kept(result: DynamicsResult) -> None:
    text = lines_of(result.to_dict(), "created", "plantar", "robot_model", "path", "sha256")
    assert_as_kept(f"{text}{result}", Path(__file__).parent / "kept" / "inertia.txt", share=1e-4, least=1e-6)

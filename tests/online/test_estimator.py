"""The estimator of controllers: against the batch tool tick by tick, on known feet, and on sensors that fail."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import example_robots
from biped import SLIPPING, TRUTH, record, sway, times
from biped_robot import write_robot
from plantar.contact.deflection import bush_states
from plantar.conventions import ROTATIONAL_AXES
from plantar.errors import DataError, LogError, RobotError, SettingsError
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import AxisModel, DelayEstimate, LinearEquivalent, Parameter
from plantar.robot.model import RobotModel, load_robot


@pytest.fixture
def robot(tmp_path: Path) -> RobotModel:
    return load_robot(write_robot(tmp_path))


def with_columns(log: MotionLog, **columns: np.ndarray) -> MotionLog:
    return MotionLog(log.name, log.time, {**log.columns, **columns})


def without(log: MotionLog, part: str) -> MotionLog:
    return MotionLog(
        log.name, log.time, {name: values for name, values in log.columns.items() if part not in name}
    )


def expect_truth(replay: Replay, stiffness: float, damping: float) -> None:
    for row in replay.parameters:
        if row.axis != "z" and row.name in ("stiffness", "damping"):
            truth = getattr(TRUTH[row.foot, row.axis], row.name)
            assert row.value == pytest.approx(truth, rel=stiffness if row.name == "stiffness" else damping), (
                row
            )


def test_each_tick_is_what_the_batch_tool_computes(tmp_path: Path) -> None:
    robot = load_robot(example_robots.talos_file(tmp_path))
    rng, samples, joints = np.random.default_rng(0), 50, len(robot.joint_names)
    position, velocity = rng.uniform(-0.5, 0.5, (samples, joints)), rng.normal(size=(samples, joints))
    attitude, gyroscope = rng.normal(size=(samples, 4)), rng.normal(size=(samples, 3))
    wrenches = {foot: rng.normal(0, 30, (samples, 6)) + [0, 0, 400, 0, 0, 0] for foot in robot.feet}
    batch = bush_states(robot, position, velocity, attitude, gyroscope, wrenches)
    estimator = FootEstimator(robot)
    for i in range(samples):
        found = estimator.step(
            1e-3 * i,
            position[i],
            {foot: wrench[i] for foot, wrench in wrenches.items()},
            velocity=velocity[i],
            attitude=attitude[i],
            angular_velocity=gyroscope[i],
        )
        for foot, now in found.items():
            state = batch[foot]
            assert [now.pitch.deflection, now.roll.deflection] == pytest.approx(
                state.deflection[i], abs=1e-10
            )
            assert [now.pitch.rate, now.roll.rate] == pytest.approx(state.rate[i], abs=1e-10)
            assert [now.pitch.torque, now.roll.torque] == pytest.approx(state.torque[i], abs=1e-10)
            assert now.load == pytest.approx(state.force_z[i], abs=1e-10)
            if np.isfinite(state.cop[i]).all():
                assert now.centre_of_pressure == pytest.approx(state.cop[i], abs=1e-10)


def test_a_known_compliance_moves_the_torques_to_the_loaded_centre(robot: RobotModel) -> None:
    """A slide of 40 kN/m that carries F_z lifts the centre by z, about which F_x and F_y turn."""
    log, compliance = record(sway(duration=2.0)), 1 / 40e3
    result = FeetResult(
        "biped", (), {}, "kelvin_voigt", (), (), (), (), (), compliance=dict.fromkeys(robot.feet, compliance)
    )
    plain, moved = (FootEstimator(robot, one, wrench_delay=0.0).replay(log) for one in (None, result))
    assert robot.imu is not None
    for foot in robot.feet:
        x, y, z = log.wrench(robot.feet[foot].wrench.name)[:, :3].T  # in the bush's axes
        lift = compliance * z
        pitch = plain.column(foot, "pitch.deflection")
        changes = {"pitch": -lift * x, "roll": np.cos(pitch) * lift * y}
        for axis, change in changes.items():
            name = f"{axis}.torque"
            found = moved.column(foot, name) - plain.column(foot, name)
            np.testing.assert_allclose(found, change, atol=1e-9)
            assert np.abs(change).max() > 0.01


def test_what_a_batch_fit_has_found_misplaced_is_put_right(robot: RobotModel) -> None:
    """Torque of the load, of the horizontal force, of the other axis and of yaw, as the fit had it beside."""
    log, aside, above, turned, leans = record(sway(duration=60.0)), 0.01, 0.03, 0.1, -0.05
    plain = FootEstimator(robot, wrench_delay=0.0).replay(log)
    alone = LinearEquivalent(400.0, 20.0)
    found = tuple(
        AxisModel(foot, axis, "kelvin_voigt", "", alone, (aside, above), turned=turned, leans=leans)
        for foot in robot.feet
        for axis in ROTATIONAL_AXES
    )
    result = FeetResult("biped", (), {}, "kelvin_voigt", (), (), (), (), (), models=found)
    told = FootEstimator(robot, result, wrench_delay=0.0).replay(log)
    for foot in robot.feet:
        x, y, z = log.wrench(robot.feet[foot].wrench.name)[:, :3].T  # in the bush's axes
        sensor = (
            robot.frame(robot.feet[foot].bush)[1].inverse()
            * robot.frame(robot.feet[foot].wrench.placement)[1]
        )
        yaw = (
            log.wrench(robot.feet[foot].wrench.name)[:, 3:]
            + np.cross(sensor.translation, np.array([x, y, z]).T)
        )[:, 2]
        for axis, other, across in (("pitch", "roll", x), ("roll", "pitch", -y)):
            torque, others = (plain.column(foot, f"{one}.torque") for one in (axis, other))
            wanted = torque - (aside * z + above * across + turned * others + leans * yaw)
            np.testing.assert_allclose(told.column(foot, f"{axis}.torque"), wanted, atol=1e-9)


def test_known_feet_are_found(robot: RobotModel) -> None:
    replay = FootEstimator(robot, wrench_delay=0.0).replay(record(sway(duration=60.0)))
    expect_truth(replay, 1e-3, 2e-3)
    assert {row.verdict for row in replay.parameters if row.axis != "z"} == {"usable"}
    assert replay.estimate("left").contact is Contact.STANCE
    assert replay.estimate("left").flags == 0
    assert replay.estimate("left").pitch.offset == pytest.approx(TRUTH["left", "pitch"].offset, abs=0.05)


def test_it_goes_on_from_what_it_has_learnt(robot: RobotModel) -> None:
    estimator = FootEstimator(robot, wrench_delay=0.0)
    estimator.replay(record(sway(seed=1, duration=40.0)))
    short = estimator.replay(record(sway(seed=2, duration=5.0)))
    expect_truth(short, 2e-3, 5e-3)
    assert short.estimate("left", 0).flags & Flag.TIME_FAULT


def test_a_log_in_pieces_is_the_same_log(robot: RobotModel) -> None:
    log = without(record(sway(duration=20.0)), "orientation")  # the accelerometer in its place
    whole = FootEstimator(robot, wrench_delay=0.0).replay(log)
    pieces = list(FootEstimator(robot, wrench_delay=0.0).replay_in_pieces(log, 3.0))
    assert [len(piece.time) for piece in pieces] == [300, 600, 900, 1200, 1500, 1800, 2001]
    for piece in pieces:
        np.testing.assert_array_equal(piece.rows, whole.rows[: len(piece.time)])
        assert (piece.latency > 0).all()


def test_rates_come_from_the_attitude_where_no_gyroscope_is(robot: RobotModel) -> None:
    log = without(record(sway(duration=60.0)), "angular_velocity")
    expect_truth(FootEstimator(robot, wrench_delay=0.0).replay(log), 2e-3, 1e-2)


@pytest.mark.parametrize("gyroscope", [True, False])
def test_a_quaternion_and_its_negative_are_one_attitude(robot: RobotModel, gyroscope: bool) -> None:
    log = record(sway(duration=10.0))
    if not gyroscope:
        log = without(log, "angular_velocity")
    names = [f"imu.chest.orientation.{part}" for part in "wxyz"]
    signs = np.where(np.arange(len(log)) % 3 == 1, -1.0, 1.0)
    turned = with_columns(log, **{name: signs * log.column(name) for name in names})
    plain, other = FootEstimator(robot).replay(log), FootEstimator(robot).replay(turned)
    np.testing.assert_allclose(other.rows, plain.rows, rtol=1e-9, atol=1e-12)


def test_a_gyroscope_beside_an_attitude_tells_the_rates(robot: RobotModel) -> None:
    """One that reads nothing leaves the joints' rates alone: they are not the bushes'."""
    log = record(sway(duration=20.0))
    nothing = {name: 0 * column for name, column in log.columns.items() if ".angular_velocity." in name}
    still, told, bare = (
        FootEstimator(robot, wrench_delay=0.0).replay(each).rows
        for each in (with_columns(log, **nothing), log, without(log, "angular_velocity"))
    )
    apart = np.nanmax(np.abs(still - told)[-1])
    assert apart > 10 * np.nanmax(np.abs(bare - told)[-1]) > 0


def test_gyroscope_and_accelerometer_stand_for_an_attitude(robot: RobotModel) -> None:
    log = without(record(sway(duration=120.0)), "orientation")
    replay = FootEstimator(robot, wrench_delay=0.0).replay(log)
    expect_truth(replay, 3e-2, 5e-2)


def test_a_told_delay_leaves_the_damping_right(robot: RobotModel) -> None:
    motion, late = sway(duration=60.0), 0.008
    log, later = record(motion), record(motion, at=times(motion) - late)
    log = with_columns(log, **{name: values for name, values in later.columns.items() if "wrench" in name})
    expect_truth(FootEstimator(robot, wrench_delay=late).replay(log), 2e-3, 1e-2)
    untold = FootEstimator(robot).replay(log)
    for row in untold.parameters:
        if row.axis == "z":
            continue
        truth = getattr(TRUTH[row.foot, row.axis], row.name)
        assert row.interval95 is not None
        assert row.interval95[0] < truth < row.interval95[1], "a delay that is not known widens the interval"
        if row.name == "damping":
            assert row.value is not None
            assert row.value < 0.95 * truth


def test_a_batch_results_hysteresis_and_delay_are_used(robot: RobotModel) -> None:
    rows = [
        Parameter(foot, axis, name, "", value, 0.05 * value, None, None, "usable", "")
        for (foot, axis), law in SLIPPING.items()
        for name, value in (("slip_angle", law.angle), ("slip_torque", law.slip))
    ]
    delay = DelayEstimate(wrench_delay=0.0, std=0.0, measured=True)
    result = FeetResult("biped", (), {}, "elastoplastic", tuple(rows), (), (), (), (), sensor_delay=delay)
    log = record(sway(duration=90.0, truth=SLIPPING))
    replay = FootEstimator(robot, result).replay(log)
    expect_truth(replay, 0.02, 0.05)
    slip = [row for row in replay.parameters if row.name == "slip_torque"]
    assert len(slip) == 4
    plain = FootEstimator(robot, wrench_delay=0.0).replay(log)
    assert plain.estimate("left").pitch.stiffness.value > 1.05 * TRUTH["left", "pitch"].stiffness
    assert plain.estimate("left").flags & Flag.PITCH_MEMORY, "and what is not told is seen"
    assert not plain.estimate("left").pitch.identified
    said = [row for row in plain.parameters if (row.foot, row.axis) == ("left", "pitch")]
    assert said
    assert all(row.verdict != "usable" for row in said)
    assert all("hysteresis" in row.reason for row in said)
    assert not replay.estimate("left").flags & Flag.PITCH_MEMORY


def test_what_does_not_move_is_not_known(robot: RobotModel) -> None:
    still = sway(duration=60.0)
    quiet = replace(still, ankles={foot: (lambda t: 0.0 * t, lambda t: 0.0 * t) for foot in still.ankles})
    quiet = replace(quiet, torso=tuple((lambda t: 0.0 * t,) * 3))
    log = record(quiet)
    rng = np.random.default_rng(0)
    noisy = {name: values + 1e-5 * rng.normal(size=len(log)) for name, values in log.columns.items()}
    last = FootEstimator(robot).replay(with_columns(log, **noisy)).estimate("left")
    assert not last.pitch.identified
    assert last.flags & Flag.PITCH_UNKNOWN


@pytest.mark.parametrize(
    "column", ["imu.chest.orientation.x", "wrench.left.torque.y", "joint.left_ankle_pitch.position"]
)
def test_values_that_are_missing_harm_nothing(robot: RobotModel, column: str) -> None:
    log = record(sway(duration=60.0))
    values = log.columns[column].copy()
    values[2000:2100] = np.nan
    replay = FootEstimator(robot, wrench_delay=0.0).replay(with_columns(log, **{column: values}))
    assert np.isfinite(replay.rows).all()
    flags = replay.column("left", "flags").astype(int)
    assert (flags[2000:2100] & Flag.INPUT_MISSING).all()
    assert not (flags[2200:] & ~(Flag.PITCH_UNKNOWN | Flag.ROLL_UNKNOWN)).any(), "well a second later"
    expect_truth(replay, 1e-3, 3e-3)


def test_a_frozen_force_sensor_is_seen(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    columns = {name: values.copy() for name, values in log.columns.items() if name.startswith("wrench.left")}
    for values in columns.values():
        values[2000:2300] = values[2000]
    replay = FootEstimator(robot, wrench_delay=0.0).replay(with_columns(log, **columns))
    flags = replay.column("left", "flags").astype(int)
    assert (flags[2015:2300] & Flag.FROZEN).all()
    assert not (replay.column("right", "flags")[2000:2300].astype(int) & Flag.FROZEN).any()
    assert not (flags[2400:] & Flag.FROZEN).any()


def test_an_encoder_that_never_moves_while_the_other_legs_does_is_frozen(robot: RobotModel) -> None:
    log, dead = record(sway(duration=40.0)), "joint.left_ankle_roll.position"
    estimator = FootEstimator(robot, wrench_delay=0.0)
    replay = estimator.replay(with_columns(log, **{dead: np.full(len(log), 0.01)}))
    assert replay.estimate("left").flags & Flag.FROZEN
    assert not replay.estimate("left").roll.identified
    assert not replay.estimate("right").flags & Flag.FROZEN
    assert replay.estimate("right").roll.identified
    still = record(sway(duration=10.0, seed=3))
    again = estimator.replay(with_columns(still, **{dead: np.full(len(still), 0.02)}))
    assert again.estimate("left", 5).flags & Flag.FROZEN, "nobody has mended it in between"
    assert not estimator.replay(still).estimate("left").flags & Flag.FROZEN, "until it moves"


def test_a_joint_that_stands_in_both_legs_is_not_frozen(robot: RobotModel) -> None:
    log = record(sway(duration=20.0))
    still = {f"joint.{leg}_leg_z.position": np.zeros(len(log)) for leg in ("left", "right")}
    replay = FootEstimator(robot, wrench_delay=0.0).replay(with_columns(log, **still))
    assert not (replay.column("left", "flags").astype(int) & Flag.FROZEN).any()


def test_a_foot_that_never_stands_is_said_to(robot: RobotModel) -> None:
    log = record(sway(duration=20.0, lifts=(("left", -1.0, 30.0),)))
    replay = FootEstimator(robot).replay(log)
    assert np.isfinite(replay.rows).all()
    last = replay.estimate("left")
    assert last.contact is Contact.AIR
    assert last.flags & Flag.NEVER_LOADED
    assert not last.pitch.identified
    assert replay.estimate("right").contact is Contact.STANCE
    said = {row.value for row in replay.parameters if row.foot == "left"}
    assert said == {None}, "no number without any data"
    assert all(row.verdict == "unidentifiable" for row in replay.parameters if row.foot == "left")


def test_a_step_more_lands_and_lifts(robot: RobotModel) -> None:
    log = record(sway(duration=30.0, lifts=(("left", 10.0, 15.0),)))
    contact = FootEstimator(robot).replay(log).column("left", "contact")
    assert (contact[1050:1450] == Contact.AIR).all()
    assert (contact[200:980] == Contact.STANCE).all()
    assert (contact[1550:] == Contact.STANCE).all()


def test_what_cannot_be_used_is_said_in_a_line(robot: RobotModel) -> None:
    with pytest.raises(SettingsError, match=r"^value 3\.0: wrench_delay is not valid"):
        FootEstimator(robot, wrench_delay=3.0)
    for taken, refused in (({"wrench_delay": -0.1}, {"wrench_delay": -0.101}), ({"cutoff": 0.1}, {"cutoff": 0.099}),
                           ({"wrench_delay": 0.1}, {"wrench_delay": 0.101})):  # fmt: skip
        FootEstimator(robot, **taken)  # type: ignore[arg-type]
        with pytest.raises(SettingsError):
            FootEstimator(robot, **refused)  # type: ignore[arg-type]
    with pytest.raises(RobotError, match="the estimator needs an IMU"):
        FootEstimator(replace(robot, imu=None))
    with pytest.raises(LogError, match=r"^sway, column 'wrench\.left\.force\.x': is missing"):
        FootEstimator(robot).replay(without(record(sway(duration=2.0)), "wrench.left"))
    for part in ("angular_velocity", "linear_acceleration"):  # each needed where there is no attitude
        log = without(without(record(sway(duration=2.0)), "orientation"), part)
        with pytest.raises(LogError, match=rf"^sway, column 'imu\.chest\.{part}\.x': is missing"):
            FootEstimator(robot).replay(log)
    estimator, forces = FootEstimator(robot), {foot: np.zeros(6) for foot in robot.feet}
    with pytest.raises(DataError, match=r"^position: an array of shape \(1,\) \(valid: \(11,\)\)$"):
        estimator.step(0.0, [0.0], forces)
    with pytest.raises(
        DataError, match=r"^no wrench of foot 'right' \(valid: one for each of left, right\)$"
    ):
        estimator.step(0.0, np.zeros(len(robot.joint_names)), {"left": np.zeros(6)})


def test_each_wrench_is_that_of_the_foot_it_is_named_by(robot: RobotModel) -> None:
    still, level = np.zeros(len(robot.joint_names)), [1.0, 0.0, 0.0, 0.0]
    for order in (list(robot.feet), list(robot.feet)[::-1]):
        forces = {
            foot: np.array([0.0, 0.0, 100.0 if foot == "left" else 300.0, 0.0, 0.0, 0.0]) for foot in order
        }
        found = FootEstimator(robot).step(0.0, still, forces, attitude=level)
        assert [found["left"].load, found["right"].load] == pytest.approx([100.0, 300.0])


def test_without_any_imu_reading_nothing_is_trusted(robot: RobotModel) -> None:
    estimator = FootEstimator(robot)
    forces = {foot: np.array([0.0, 0.0, 300.0, 0.0, 0.0, 0.0]) for foot in robot.feet}
    found = estimator.step(0.0, np.zeros(len(robot.joint_names)), forces)
    assert all(foot.flags & Flag.INPUT_MISSING for foot in found.values())

"""Joints that bend beyond their encoders: an arm sweep of the twin, read before gears."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from before_gears import before_gears, torques_in
from feet_trials import without
from moments import fit_moments
from plantar.conventions import GRAVITY, NORMAL95
from plantar.dynamics import Contact
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion, inertial_signals
from plantar.dynamics.motion import Motion
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import known_delay
from plantar.sensors.moments.bending_odds import bending_odds
from plantar.sensors.moments.bent_joints import (
    BENT,
    USUAL,
    JointBending,
    joint_bending,
    joint_bending_notes,
    put_straight,
)
from plantar.sensors.moments.joint_torques import carrying_joints, joint_torques, torques_along
from plantar.sensors.moments.law_bending import bending_torques, by_bending
from plantar.sensors.moments.law_rows import BAND, law_rows
from plantar.sensors.moments.moment_fit import MomentFit, Part
from plantar.sensors.moments.sensor_errors import BENDING, compliance_columns, prior_deviations
from plantar.sensors.newton_euler import CUTOFF, newton_euler_residuals
from plantar.sensors.newton_sides import carried
from plantar.signals.filters import low_pass
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2
from twin_samples import walked

COMPLIANCE = 1e-4  # rad/(N.m)
LEGS = [f"{side}LEG_JOINT{place}" for side in "LR" for place in range(6)]
CARRY = [*LEGS, "CHEST_JOINT0", "CHEST_JOINT1"]
ANKLES = [name for name in LEGS if name[-1] in "45"]


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


@pytest.fixture(scope="module")
def sweep(twin: RobotModel) -> MotionLog:
    return checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)


def found(twin: RobotModel, log: MotionLog, *, steps: bool = False) -> JointBending:
    [residual] = newton_euler_residuals(twin, log)
    return joint_bending(twin, fit_moments(twin, [residual], [log.name] if steps else (), BENDING))


def of(twin: RobotModel, bending: JointBending, name: str) -> tuple[float, float]:
    """Compliance of a joint, and its deviation."""
    place = twin.joint_names.index(name)
    return float(bending.compliances[place]), float(np.sqrt(bending.covariance[place, place]))


def test_stiff_joints_stay_as_they_are_read(twin: RobotModel, sweep: MotionLog) -> None:
    bending = found(twin, sweep)
    assert not bending.found
    assert not bending.covariance.any()
    assert bending.mean is not None
    assert bending.std is not None
    assert abs(bending.mean) < NORMAL95 * bending.std < COMPLIANCE
    assert joint_bending_notes(twin, bending) == []
    assert not bending.compliances.any()


def test_moments_alone_show_no_bending(twin: RobotModel, sweep: MotionLog) -> None:
    """Without an accelerometer no horizontal force shows how a sensor is tilted."""
    bending = found(twin, without(before_gears(twin, sweep, COMPLIANCE, CARRY), "linear_acceleration"))
    assert not bending.found
    assert bending.mean == pytest.approx(0.0, abs=1e-9)


def test_joints_that_bend_are_found_and_logs_put_right(twin: RobotModel, sweep: MotionLog) -> None:
    bent = before_gears(twin, sweep, COMPLIANCE, CARRY)
    bending = found(twin, bent)
    assert bending.found
    for name in CARRY:
        value, std = of(twin, bending, name)
        assert value == pytest.approx(COMPLIANCE, abs=2.5 * std)
        assert std < COMPLIANCE
    assert set(bending.by_joint(twin)) == set(CARRY)
    straight = put_straight(twin, bent, bending.compliances, known_delay(0.0))
    for name in ("LLEG_JOINT3", "LLEG_JOINT4", "RLEG_JOINT4"):
        right, read, now = (log.column(f"joint.{name}.position") for log in (sweep, bent, straight))
        left = np.abs(1 - of(twin, bending, name)[0] / COMPLIANCE) * np.abs(read - right)
        assert np.allclose(np.abs(now - right), left, atol=1e-4)
    (note,) = joint_bending_notes(twin, bending)
    assert (note.code, note.severity) == (BENT, "info")
    assert all(name in note.text for name in [*LEGS[:6], *CARRY[-2:]])


def test_ankles_alone_that_bend_are_told_from_knees(twin: RobotModel) -> None:
    walk = checked(twin, walked())
    bending = found(twin, before_gears(twin, walk, 2 * COMPLIANCE, ANKLES), steps=True)
    ankle, knee = (of(twin, bending, name) for name in ("LLEG_JOINT4", "LLEG_JOINT3"))
    assert ankle[0] == pytest.approx(2 * COMPLIANCE, abs=2.5 * ankle[1])
    assert ankle[0] > 3 * abs(knee[0])


def test_nothing_bends_against_its_load(twin: RobotModel, sweep: MotionLog) -> None:
    """What looks so is another fault, and no log is put right by it."""
    assert not found(twin, before_gears(twin, sweep, -COMPLIANCE, CARRY)).found


def test_walks_show_it_too(twin: RobotModel) -> None:
    walk = checked(twin, walked())
    assert not found(twin, walk, steps=True).found
    bending = found(twin, before_gears(twin, walk, COMPLIANCE, CARRY), steps=True)
    value, std = of(twin, bending, "LLEG_JOINT3")
    assert value == pytest.approx(COMPLIANCE, abs=3 * std)
    assert std < 0.2 * COMPLIANCE


def test_what_the_robot_file_allows_for_is_all_that_is_known_without_moments(
    twin: RobotModel, sweep: MotionLog
) -> None:
    """And more than what is known with them."""
    unsure = replace(twin, uncertainty=replace(twin.uncertainty, joint_compliance=COMPLIANCE))
    alone = joint_bending(unsure, None)
    assert not alone.found
    assert np.allclose(alone.covariance, COMPLIANCE**2)
    assert alone.mean is None
    told = found(unsure, sweep)
    knee = of(unsure, told, "LLEG_JOINT3")[1]
    assert 0 < knee < 0.5 * COMPLIANCE


def test_the_law_changes_as_with_joints_that_are_read_otherwise(twin: RobotModel, sweep: MotionLog) -> None:
    """Against both sides anew, of a log whose knees are read as if they bent the other way; slow parts aside."""
    knees = carrying_joints(twin)[3]
    [residual] = newton_euler_residuals(twin, sweep)
    equation = equation_of(twin.floating_model)
    names = [twin.joint_names[joint] for joint in knees]
    rows = []
    for log in (sweep, before_gears(twin, sweep, -COMPLIANCE, names)):
        signals = inertial_signals(twin, log, CUTOFF)
        motion = inertial_motion(twin, equation, signals, residual.kept)
        contacts = [Contact(*twin.frame(foot.wrench.placement)) for foot in twin.feet.values()]
        transfers = [equation.base_transfer(motion.positions, contact) for contact in contacts]
        predicted = equation.base_wrenches(motion, residual.parameters[None])[0]
        rows.append(predicted - np.sum(carried(transfers, residual.readings), axis=0))
    slope, slow = (
        by_bending(twin, residual, [knees], bending_torques(twin, residual, quick))[0]
        for quick in (True, False)
    )
    changed = (rows[1] - rows[0]) / COMPLIANCE
    for row in (0, 2, 4):  # forward, up, pitch: where knees act
        assert np.std(slope[:, row] - changed[:, row]) < 0.1 * np.std(changed[:, row])
    # Of one that stands, what bends is hardly accelerated, and the torques' noise is not magnified by it.
    still, moving = (low_pass(one[:, 2], residual.pair.period, BAND) for one in (slow, slope))
    assert np.std(still - moving) < 0.3 * np.std(moving)
    assert np.std(slow[:, 2] - still) < 0.8 * np.std(slope[:, 2] - moving)


def test_noise_of_forces_bends_no_joint(twin: RobotModel) -> None:
    """It stands in what the joints bend by and in what is missing: its square had bent knees by 0.4 rad."""
    tilt = checked(twin, play_all(["Tilt3"], twin, PAPER, "sensors", [0])[0][0].log)
    [residual] = newton_euler_residuals(twin, tilt)
    fit = fit_moments(twin, [residual], (), BENDING)
    columns = compliance_columns(twin)
    variances = np.sum([np.diag(part.covariance)[columns] for part in fit.parts], axis=0)
    assert (np.abs(fit.values[columns]) < 2 * np.sqrt(variances)).all()


def test_legs_are_alike_joint_by_joint_and_the_trunk_carries_the_imu(twin: RobotModel) -> None:
    names = [[twin.joint_names[joint] for joint in joints] for joints in carrying_joints(twin)]
    legs = [[f"LLEG_JOINT{place}", f"RLEG_JOINT{place}"] for place in range(6)]
    assert names == [*legs, ["CHEST_JOINT0"], ["CHEST_JOINT1"]]


def test_torques_of_a_foot_turn_the_joints_of_its_own_leg(twin: RobotModel, sweep: MotionLog) -> None:
    still = sweep.positions(twin)[:1]
    up = np.zeros((1, 12))
    up[0, 2] = 300.0
    resting = Motion(np.zeros((1, 9)), still, np.zeros_like(still), np.zeros_like(still))
    (torques,) = joint_torques(twin, resting, None, up)
    turned = {twin.joint_names[place] for place in np.flatnonzero(np.abs(torques) > 1e-6)}
    assert turned
    assert turned < {name for name in LEGS if name.startswith(next(iter(twin.feet))[0].upper())}


def test_torques_along_a_log_are_those_of_pinocchio(twin: RobotModel, sweep: MotionLog) -> None:
    """Of encoders that are filtered already: links' torques take what is slower than a cutoff of them."""
    names = [f"joint.{name}.position" for name in twin.joint_names]
    smooth = low_pass(low_pass(sweep.positions(twin), sweep.period, 3.0), sweep.period, 3.0)
    quiet = sweep.with_columns(dict(zip(names, smooth.T, strict=True)))
    for log in (quiet, without(quiet, "angular_velocity", "linear_acceleration", "orientation")):
        assert np.allclose(torques_along(twin, log)[200:-200], torques_in(twin, log)[200:-200], atol=1e-5)


@pytest.mark.parametrize(("mean", "some"), [(0.0, False), (5e-5, True)])
def test_joints_of_which_one_alone_seems_to_bend_are_stiff(twin: RobotModel, mean: float, some: bool) -> None:
    """As where an encoder slips: five deviations in one joint, and none in all together."""
    columns, count = compliance_columns(twin), len(prior_deviations(twin))
    values, std = np.zeros(count), np.full(count, 1e-5)
    values[columns], std[columns.start + 2] = mean, 5e-5
    values[columns.start + 2] += 2.5e-4
    assert joint_bending(twin, MomentFit(values, [Part(np.diag(std**2), 39.0)])).found == some


@pytest.mark.parametrize(("mean", "some"), [(1.5e-5, False), (2.5e-5, True)])
def test_what_a_wrong_urdf_does_as_well_tells_nothing(twin: RobotModel, mean: float, some: bool) -> None:
    """However well it is known: 0.008 and 0.014 rad with this robot's weight at a metre."""
    columns, count = compliance_columns(twin), len(prior_deviations(twin))
    values = np.zeros(count)
    values[columns] = mean
    assert joint_bending(twin, MomentFit(values, [Part(1e-16 * np.eye(count), 39.0)])).found == some


@pytest.mark.parametrize(
    ("mean", "left", "found"),
    [(0.0, False, False), (2.2e-5, True, False), (4e-5, True, True), (-2.2e-5, False, False)],
)
def test_what_is_neither_shown_nor_excluded_is_left_open(
    twin: RobotModel, mean: float, left: bool, found: bool
) -> None:
    """Logs stay as they are, and joints may bend as far as they may about stiff ones."""
    columns, count, load = compliance_columns(twin), len(prior_deviations(twin)), twin.mass * GRAVITY
    values = np.zeros(count)
    values[columns] = mean
    bending = joint_bending(twin, MomentFit(values, [Part((1.5e-5) ** 2 * np.eye(count), 1e9)]))
    assert bending.found == found
    every, legs, ankles = np.ones(8), np.repeat([1.0, 0.0], [6, 2]), np.repeat([0.0, 1.0, 0.0], [4, 2, 2])
    covariance = (1.5e-5 * load) ** 2 * np.eye(8) + USUAL**2 * (1 + np.eye(8))
    odds = bending_odds(load * mean * every, covariance, (every, legs, ankles), 0.0)
    square = odds.covariance[3, 3] + (0.0 if found else odds.mean[3] ** 2)
    variance = of(twin, bending, "LLEG_JOINT3")[1] ** 2
    assert variance == pytest.approx(square / load**2 if left else 0.0, rel=1e-6)


def test_rows_of_a_walk_change_as_what_it_misses_does(twin: RobotModel) -> None:
    """Of few samples each second, at motion as quick as a walk's: derivatives of these had been a fifth too small."""
    walk = checked(twin, walked())
    names = [twin.joint_names[joint] for joint in carrying_joints(twin)[1]]
    stiff, bent = (
        list(law_rows(twin, newton_euler_residuals(twin, log)[0], True))
        for log in (walk, before_gears(twin, walk, 1e-6, names))
    )
    column = 1 + range(*compliance_columns(twin).indices(len(stiff[0].signals[0])))[1]
    for row in (1, 3):  # to the side, roll: where hips act that roll
        changed = (bent[row].signals[:, 0] - stiff[row].signals[:, 0]) / 1e-6
        slope = stiff[row].signals[:, column]
        assert slope @ changed == pytest.approx(changed @ changed, rel=0.03)


@pytest.mark.parametrize(("mean", "some"), [(1e-5, False), (3e-5, True)])
def test_a_joint_that_hardly_carries_objects_to_little(twin: RobotModel, mean: float, some: bool) -> None:
    """A yaw joint that seems to push, by nearly four deviations, is another error."""
    columns, count = compliance_columns(twin), len(prior_deviations(twin))
    values, std = np.zeros(count), np.full(count, 1e-5)
    values[columns], std[columns.start] = mean, 4e-5
    values[columns.start] = -1.5e-4
    assert joint_bending(twin, MomentFit(values, [Part(np.diag(std**2), 39.0)])).found == some


def test_what_logs_were_put_right_by_is_part_of_what_they_show(twin: RobotModel) -> None:
    """Moments of logs that were put straight show what is left: nothing, of compliances that were right."""
    count, joints = len(prior_deviations(twin)), len(twin.joint_names)
    fit = MomentFit(np.zeros(count), [Part((1e-7) ** 2 * np.eye(count), 39.0)])
    assert not joint_bending(twin, fit).found
    bending = joint_bending(twin, fit, np.full(joints, COMPLIANCE))
    for name in CARRY:
        assert of(twin, bending, name)[0] == pytest.approx(COMPLIANCE, rel=0.1)
    assert bending.mean == pytest.approx(COMPLIANCE)


@pytest.mark.parametrize("trunk", [0.0, 3.5e-5])
def test_legs_bend_whatever_the_trunk_does(twin: RobotModel, trunk: float) -> None:
    """A trunk that is known to be stiff hides no legs that bend: 0.02 rad, with this robot's weight at a metre."""
    columns, count = compliance_columns(twin), len(prior_deviations(twin))
    values, std = np.zeros(count), np.full(count, 1e-5)
    values[columns], values[columns.stop - 2 : columns.stop] = 3.5e-5, trunk
    std[columns.stop - 2 : columns.stop] = 1e-6
    assert joint_bending(twin, MomentFit(values, [Part(np.diag(std**2), 39.0)])).found


def test_where_no_wrench_is_known_joints_bend_as_beside_it(twin: RobotModel, sweep: MotionLog) -> None:
    """A jump would seem to accelerate the links."""
    force = next(name for name in sweep.columns if name.endswith("force.z"))
    gap = sweep.column(force).copy()
    gap[2000:2040] = np.nan
    compliances = np.full(len(twin.joint_names), COMPLIANCE)
    whole, holed = (
        put_straight(twin, log, compliances, known_delay(0.0)).positions(twin)
        for log in (sweep, sweep.with_columns({force: gap}))
    )
    assert np.abs(holed - whole).max() < 0.1 * np.abs(whole - sweep.positions(twin)).max()


def test_links_that_bend_are_accelerated_by_it(twin: RobotModel) -> None:
    """Of joints that bend three times as far as harmonic drives do: torques of encoders alone are a tenth off."""
    walk, compliances = checked(twin, walked()), np.zeros(len(twin.joint_names))
    compliances[[twin.joint_names.index(name) for name in CARRY]] = 3 * COMPLIANCE
    bent = before_gears(twin, walk, 3 * COMPLIANCE, CARRY)
    straight = put_straight(twin, bent, compliances, known_delay(0.0))
    inside = slice(100, -100)
    right, read, now = (log.positions(twin)[inside] for log in (walk, bent, straight))
    assert np.std(now - right) < 0.01 * np.std(read - right)

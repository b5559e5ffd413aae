"""Gains of torques from the moments of a moving robot: an arm sweep of the twin, its torques scaled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from feet_trials import without
from moments import fit_moments
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.sensors.moments.law_rows import law_rows
from plantar.sensors.moments.moment_errors import moment_errors, row_products
from plantar.sensors.moments.moment_fit import MomentFit, Part, solved
from plantar.sensors.moments.sensor_errors import STIFF, compliance_columns, prior_deviations
from plantar.sensors.moments.torque_gains import TorqueGain, torque_gain_notes, torque_gains
from plantar.sensors.newton_euler import newton_euler_residuals
from plantar.signals.resampling import shifted
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2
from twin_samples import walked

EDGE = 0.3
SHORTEST = 8.0


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


@pytest.fixture(scope="module")
def sweep(twin: RobotModel) -> MotionLog:
    return checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)


def found(
    twin: RobotModel, log: MotionLog, gains: Mapping[str, float], *, steps: bool = False
) -> Mapping[str, TorqueGain]:
    columns = {name: log.column(name) for name in log.columns}
    scaled = {
        name: values * next((gain for part, gain in gains.items() if part in name), 1.0)
        for name, values in columns.items()
        if name.startswith("wrench.")
    }
    [residual] = newton_euler_residuals(twin, log.with_columns(scaled))
    return torque_gains(twin, fit_moments(twin, [residual], [log.name] if steps else ()))


def test_torques_that_balance_the_motion_are_right(twin: RobotModel, sweep: MotionLog) -> None:
    assert found(twin, sweep, {}) == {}
    assert found(twin, sweep, {"wrench.": 1.1}) == {}  # forces too: the weight shows that, not the balance


def test_a_robot_that_is_as_its_file_says_needs_no_draws_of_another(
    twin: RobotModel, sweep: MotionLog
) -> None:
    exact = replace(twin, uncertainty=EXACT)
    ideal = checked(twin, play_all(["Myrand5"], twin, PAPER, "ideal", [0])[0][0].log)
    assert found(exact, ideal, {}) == {}
    assert found(exact, sweep, {".torque.": 1.1})["pitch"].mean == pytest.approx(0.1, abs=0.03)


@pytest.mark.parametrize("left_out", ["no column", "linear_acceleration"])
@pytest.mark.parametrize("gain", [0.85, 1.15])
def test_the_gain_of_all_torques_is_found(
    twin: RobotModel, sweep: MotionLog, gain: float, left_out: str
) -> None:
    """With and without an accelerometer: forces say how the robot accelerates."""
    gains = found(twin, without(sweep, left_out), {".torque.": gain})
    assert "pitch" in gains  # one sweep shows it best: the robot leans forward more than aside
    for each in gains.values():
        assert each.mean == pytest.approx(gain - 1, abs=2.5 * each.std)
    assert gains["pitch"].std < 0.04


@pytest.mark.parametrize("unit", [1 / 9.80665, 8.851])
def test_torques_in_another_unit_than_forces_are_found(
    twin: RobotModel, sweep: MotionLog, unit: float
) -> None:
    """Of kgf.m or lbf.in beside newtons: the prior of a gain would hide what is so far off."""
    gains = found(twin, sweep, {".torque.": unit})
    assert gains["pitch"].mean == pytest.approx(unit - 1, rel=0.25)
    assert gains["pitch"].reach > 0.7


def test_without_an_accelerometer_no_acceleration_enters(twin: RobotModel, sweep: MotionLog) -> None:
    """Moments about the centre of mass: three rows, which whatever the root may do leaves as they are."""
    [residual] = newton_euler_residuals(twin, without(sweep, "linear_acceleration"))
    still = replace(twin, uncertainty=EXACT)  # of another URDF the centre of mass is elsewhere
    before = [row.signals for row in law_rows(still, residual, False)]
    signals = residual.signals
    push = np.sin(np.arange(len(signals.proper)) * signals.period)[:, None] * [1.0, 2.0, -0.5]
    pushed = replace(residual, signals=replace(signals, proper=signals.proper + push))
    after = [row.signals for row in law_rows(still, pushed, False)]
    assert len(before) == 3
    np.testing.assert_allclose(after, before, atol=1e-9 * np.abs(before).max())
    accelerated = replace(residual, signals=replace(signals, by_encoders=None))
    assert len([*law_rows(still, accelerated, False)]) == 6


@pytest.mark.parametrize(
    ("gains", "axes"),
    [
        ({}, set()),
        ({".torque.": 1.12}, {"pitch", "roll"}),
        ({"left_foot.torque.": 0.85}, {"pitch", "roll"}),
        ({"left_foot.torque.y": 1.2}, {"pitch"}),
        ({".torque.x": -1.0}, {"roll"}),
    ],
)
@pytest.mark.parametrize("left_out", ["no column", "linear_acceleration"])
def test_a_walk_shows_each_foots_gain(
    twin: RobotModel, gains: Mapping[str, float], axes: set[str], left_out: str
) -> None:
    told = found(twin, without(checked(twin, walked()), left_out), gains, steps=True)
    assert set(told) == axes
    for axis in axes:
        for foot, share in told[axis].shares.items():
            column = f"wrench.{foot}_foot.torque.{'y' if axis == 'pitch' else 'x'}"
            gain = next((gain for part, gain in gains.items() if part in column), 1.0)
            assert share == pytest.approx(gain - 1, abs=0.06)


def test_feet_that_nothing_tells_apart_are_not_told_against_each_other(twin: RobotModel) -> None:
    """A moment that nothing explains passes for one foot's torques too small and the other's too large."""
    same, other = np.ones((2, 2)), np.array([[1.0, -1.0], [-1.0, 1.0]])
    part = Part(np.kron(np.eye(2), 0.03**2 * same + 0.12**2 * other), 1e6)
    assert torque_gains(twin, MomentFit(np.array([0.6, -0.6, 0.0, 0.0]), [part])) == {}


def test_feet_that_are_told_apart_are_judged_each_by_itself(twin: RobotModel) -> None:
    """One foot's torques too small and the other's too large by as much leave their mean right."""
    part = Part(0.02**2 * np.eye(4), 1e6)
    found = torque_gains(twin, MomentFit(np.array([0.25, -0.25, 0.0, 0.0]), [part]))
    assert set(found) == {"pitch"}
    assert found["pitch"].mean == pytest.approx(0.0, abs=1e-9)
    assert [*found["pitch"].shares.values()] == pytest.approx([-0.2, 1 / 3])


@pytest.mark.parametrize(("roll", "axes"), [(0.035, {"pitch", "roll"}), (0.0, {"pitch"})])
def test_the_other_axis_is_in_doubt_unless_it_looks_right(
    twin: RobotModel, roll: float, axes: set[str]
) -> None:
    """An amplifier that bends makes all torques too small, and hardly so in the axis that moves less."""
    part = Part(0.0167**2 * np.eye(4), 1e6)
    assert set(torque_gains(twin, MomentFit(np.array([0.06, 0.06, roll, roll]), [part]))) == axes


def test_gains_are_known_to_a_hundredth_at_best(twin: RobotModel) -> None:
    """A robot file that calls gains exact is believed that far: each foot's may be off by 1 %, their mean by 0.7."""
    exact, part = replace(twin, uncertainty=EXACT), Part(1e-8 * np.eye(4), 1e6)
    found = torque_gains(exact, MomentFit(np.array([0.2, 0.2, 0.0, 0.0]), [part]))
    assert found["pitch"].std == pytest.approx(0.01 / np.sqrt(2), rel=1e-3)


def test_no_log_shows_no_gain(twin: RobotModel) -> None:
    assert torque_gains(twin, fit_moments(twin, [], ())) == {}


def test_one_axis_of_one_foot_is_told_from_the_others(twin: RobotModel, sweep: MotionLog) -> None:
    gains = found(twin, sweep, {"left_foot.torque.y": 1.25})
    assert all(axis == "pitch" or gain.std > 0.1 for axis, gain in gains.items()), (
        "one sweep hardly shows roll"
    )
    shares = gains["pitch"].shares
    assert shares["left"] > 0.15 > abs(shares["right"])
    assert gains["pitch"].reach >= shares["left"]


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_an_imu_that_is_turned_is_told_from_torques(twin: RobotModel, sweep: MotionLog, axis: int) -> None:
    """Its readings turn with it; what joints do to the moments does not."""
    assert twin.imu is not None
    turn, placement = 0.05 * np.eye(3)[axis], twin.imu.placement
    turned = replace(placement, rpy=(np.array(placement.rpy) + turn).tolist())
    told = replace(twin, imu=replace(twin.imu, placement=turned))
    [residual] = newton_euler_residuals(told, sweep)
    values, _ = solved([moment_errors(told, residual, False)], prior_deviations(told, bending=STIFF))
    mount = compliance_columns(told).start
    np.testing.assert_allclose(values[mount - 3 : mount], -turn, atol=0.004)
    assert torque_gains(told, fit_moments(told, [residual], ())) == {}


@pytest.mark.parametrize("seed", [0, 1])
def test_the_noise_of_the_feet_s_sensors_is_no_gain_and_no_crosstalk(
    twin: RobotModel, sweep: MotionLog, seed: int
) -> None:
    """Five newtons of it stand in columns and in what is missing: multiplied with themselves they would make a force
    along x show in the torque about z by 9 to 12 mm, three times what crosstalk may be."""
    random, names = np.random.default_rng(seed), [name for name in sweep.columns if ".force." in name]
    noisy = {name: sweep.column(name) + 5 * random.normal(size=len(sweep)) for name in names}
    [residual] = newton_euler_residuals(twin, sweep.with_columns(noisy))
    values, parts = solved([moment_errors(twin, residual, False)], prior_deviations(twin, bending=STIFF))
    np.testing.assert_allclose(values[:4], 0.0, atol=0.2)  # of one foot against the other, which look alike
    mean = np.kron(np.eye(2), [0.5, 0.5])
    std = np.sqrt(np.diag(mean @ sum(part.covariance for part in parts)[:4, :4] @ mean.T))
    assert (std < [0.03, 0.2]).all()
    assert (np.abs(mean @ values[:4]) < 2.5 * std).all()
    channels = [pair for pair in np.ndindex(6, 6) if pair[0] >= 3 or pair[1] < 3]
    place = 7 + channels.index((5, 0))  # behind gain, place and turn of a sensor
    np.testing.assert_allclose(values[4:-9].reshape(2, -1)[:, place], 0.0, atol=0.006)


def test_the_noise_of_an_accelerometer_makes_no_link_lighter_and_no_torque_too_large(
    twin: RobotModel, sweep: MotionLog
) -> None:
    """It stands in what is predicted and in what each link adds to it: multiplied with each other they pass for links
    that weigh too much, and then all forces and torques read too much."""
    names = [name for name in sweep.columns if "linear_acceleration" in name]
    channels = [pair for pair in np.ndindex(6, 6) if pair[0] >= 3 or pair[1] < 3]
    shares = []
    for seed in (0, 1):
        random = np.random.default_rng(seed)
        noisy = {name: sweep.column(name) + 0.1 * random.normal(size=len(sweep)) for name in names}
        [residual] = newton_euler_residuals(twin, sweep.with_columns(noisy))
        fit = solved([moment_errors(twin, residual, False)], prior_deviations(twin, bending=STIFF))
        for foot in range(2):  # pitch: alone, with all channels, and with its own one
            own = 4 + foot * (7 + len(channels))
            shares.append(fit.values[[foot, own, own + 7 + channels.index((4, 4))]].sum())
    assert abs(np.mean(shares)) < 0.006


def test_coarse_encoders_make_no_link_lighter(twin: RobotModel, sweep: MotionLog) -> None:
    """Accelerations of steps of 12 bits grow with the frequency: taken for white, their noise is most of what links
    move, and with links that seem to stand still all gains are as good as any."""
    step = 2 * np.pi / 2**12
    names = [name for name in sweep.columns if name.endswith(".position")]
    coarse = {name: step * np.round(sweep.column(name) / step) for name in names}
    assert found(twin, sweep.with_columns(coarse), {}) == {}
    links = []
    for log in (sweep, sweep.with_columns(coarse)):
        [residual] = newton_euler_residuals(twin, log)
        products = np.sum(row_products(twin, residual, False).products, axis=1)
        links.append(
            np.diagonal(products, axis1=1, axis2=2)[:, 1 + len(prior_deviations(twin, bending=STIFF)) : -12]
        )
    moved = links[0] > 0.001 * links[0].max(axis=1, keepdims=True)
    np.testing.assert_allclose((links[1] / links[0])[moved], 1.0, atol=0.15)


def test_a_late_wrench_is_no_gain_of_torques(twin: RobotModel, sweep: MotionLog) -> None:
    """Ten milliseconds, told from torques by all six of its channels."""
    names = [name for name in sweep.columns if name.startswith("wrench.")]
    late = shifted(sweep.stack(names), sweep.period, -0.01)
    [residual] = newton_euler_residuals(twin, sweep.with_columns(dict(zip(names, late.T, strict=True))))
    values, _ = solved([moment_errors(twin, residual, False)], prior_deviations(twin, bending=STIFF))
    np.testing.assert_allclose(values[-6:-4], 0.01, atol=0.001)
    assert torque_gains(twin, fit_moments(twin, [residual], ())) == {}


def test_an_interval_reaches_as_far_as_one_foot_alone_can_be_off() -> None:
    assert TorqueGain(0.05, 0.01, {"left": 0.6, "right": -0.4}).reach == pytest.approx(2 * (0.05 + 0.0196))
    shares = {"left": -0.06, "right": -0.04}
    assert TorqueGain(-0.05, 0.02, shares).reach == pytest.approx(2 * (0.05 + 0.0392))
    assert TorqueGain(-0.05, 0.02, shares, apart=True).reach == pytest.approx(0.06 + 0.0392)


def test_the_warning_names_axis_and_size() -> None:
    (note,) = torque_gain_notes({"roll": TorqueGain(0.1, 0.02, {"left": 0.12, "right": 0.08})}).values()
    assert note.severity == "warning"
    assert "roll" in note.text
    assert "1.10 ± 0.04 times" in note.text
    assert "may be off by 28 %" in note.text
    (note,) = torque_gain_notes({"roll": TorqueGain(1.4, 0.0, {"left": -2.0, "right": 0.0}, True)}).values()
    assert "the left's read -1.00 times and the right's read 1.00 times what they should" in note.text
    assert "Check sign, unit and calibration" in note.text
    small = {"roll": TorqueGain(0.05, 0.01, {"left": 0.1, "right": 0.0})}
    assert torque_gain_notes(small)["roll"].severity == "info"
    told_apart = {"roll": small["roll"]._replace(apart=True)}
    assert torque_gain_notes(told_apart)["roll"].severity == "warning"


@pytest.mark.parametrize(("off", "axes"), [(2.9, set()), (3.2, {"pitch", "roll"}), (3.8, {"pitch", "roll"})])
def test_one_foot_that_is_off_about_both_axes_shows_in_both_together(
    twin: RobotModel, off: float, axes: set[str]
) -> None:
    """The left foot's gain is `off` deviations away about each axis: 3.6 would show about one, 3.0 about both."""
    deviation = 0.05
    values = -off * deviation * np.array([1.0, 0.0, 1.0, 0.0])
    same, other = np.ones((2, 2)), np.array([[1.0, -1.0], [-1.0, 1.0]])  # which foot it is hardly shows
    known = np.kron(np.eye(2), deviation**2 / 2 * same + other)
    part = Part(known - twin.uncertainty.wrench_gain**2 * np.eye(4), 1e6)
    assert set(torque_gains(twin, MomentFit(values, [part]))) == axes


@pytest.mark.parametrize(("roll", "axes"), [(0.4, {"pitch"}), (0.6, {"pitch", "roll"}), (-0.6, {"pitch"})])
def test_torques_that_are_wrong_about_one_axis_are_in_doubt_about_the_other(
    twin: RobotModel, roll: float, axes: set[str]
) -> None:
    """Unless that one's share, here less sure, is nearer to none."""
    same, other = np.ones((2, 2)), np.array([[1.0, -1.0], [-1.0, 1.0]])
    part = Part(np.kron(np.diag([0.01, 0.05]) ** 2, same) + np.kron(np.eye(2), other), 1e6)
    found = torque_gains(twin, MomentFit(0.1 * np.array([1.0, 1.0, roll, roll]), [part]))
    assert set(found) == axes


@pytest.mark.parametrize("stretch", [1.0, 1.0 - 1e-12, 1.0 + 1e-12])
def test_the_shortest_log_is_told_by_its_samples(twin: RobotModel, sweep: MotionLog, stretch: float) -> None:
    """Seconds that are added up from periods are never just as many."""
    start = len(sweep) // 2

    def lasting(seconds: float) -> MotionLog:
        part = sweep.select(slice(start, start + round((seconds + 2 * EDGE + 0.1) / sweep.period)))
        return replace(part, time=stretch * part.time)

    [residual] = newton_euler_residuals(twin, lasting(SHORTEST))
    assert len(residual.pair.predicted) * residual.pair.period == pytest.approx(SHORTEST)
    assert newton_euler_residuals(twin, lasting(SHORTEST - 1.0)) == []

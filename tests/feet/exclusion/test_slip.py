"""Soles that slide are left out in their seconds: together, apart, into an impact; standing ones are not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway
from biped_robot import FEET, write_robot
from feet_trials import noisy, without
from plantar.contact.reasons import Reason
from plantar.contact.slip_indicator import SlipIndicator
from plantar.feet.exclusion.slip import _shared, without_slip
from plantar.feet.exclusion.sole_velocity import _drift, sole_motion
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording, filtered_recording
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel, load_robot

DEFAULT_CUTOFF = 5.0

STANDING = noisy(record(sway(duration=25.0)), 1)
TIME, PERIOD = STANDING.time, STANDING.period
START, END = 12.0, 12.5
SLIDES, APART = Reason.SOLE_SLIDES.value, Reason.SOLES_APART.value


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return load_robot(write_robot(tmp_path_factory.mktemp("biped")))


def way(distance: float) -> np.ndarray:
    """How far a sole has slid, (N,) [m]: it starts and stops gently within START to END."""
    share = np.clip((TIME - START) / (END - START), 0, 1)
    return distance * share**2 * (3 - 2 * share)


def accelerated(log: MotionLog, acceleration: np.ndarray) -> MotionLog:
    """The log of a robot whose IMU is accelerated besides, (N, 3) [m/s²], in the world: soles and all."""
    names = [f"imu.chest.linear_acceleration.{axis}" for axis in "xyz"]
    turned = Rotation.from_quat(log.stack([f"imu.chest.orientation.{a}" for a in "wxyz"]), scalar_first=True)
    inside = turned.inv().apply(acceleration)
    return log.with_columns(dict(zip(names, (log.stack(names) + inside).T, strict=True)))


def carried(log: MotionLog, distance: float) -> MotionLog:
    """The log of a robot that slides on both soles by `distance` [m]."""
    push = np.gradient(np.gradient(way(distance), PERIOD), PERIOD)
    return accelerated(log, np.column_stack([0.8 * push, -0.6 * push, 0.0 * push]))


def struck(seconds: tuple[float, ...], seed: int, size: float = 1.5) -> np.ndarray:
    """Acceleration (N, 3) [m/s²] of blows that ring for a quarter of a second, faster than samples resolve."""
    ring, random = np.zeros((TIME.size, 3)), np.random.default_rng(seed)
    for blow in seconds:
        rings = (blow <= TIME) & (blow + 0.25 > TIME)
        ring[rings] = random.normal(0, size, (rings.sum(), 3))
    return ring


def reasons(robot: RobotModel, log: MotionLog) -> dict[str, np.ndarray]:
    """Why samples of each foot are left out, (N,), '' where they are not."""
    recording = prepared(robot, log)
    contacts = without_slip(robot, recording).contacts
    said = {foot: [None, *(why.text for why in one.reasons)] for foot, one in contacts.items()}
    return {foot: np.array(said[foot], object)[one.code] for foot, one in contacts.items()}


def prepared(robot: RobotModel, log: MotionLog) -> Recording:
    return filtered_recording(prepare(robot, checked(robot, log), "fit"), DEFAULT_CUTOFF)


def slips(reason: np.ndarray) -> np.ndarray:
    return np.array([str(one).startswith("slip") for one in reason])


@pytest.mark.parametrize("distance", [0.006, -0.012])
def test_both_soles_that_slide_together_show_in_the_acceleration(robot: RobotModel, distance: float) -> None:
    found = reasons(robot, carried(STANDING, distance))
    slides = np.abs(np.gradient(way(distance), PERIOD)) > 0.008
    for foot in FEET:
        slipped = slips(found[foot])
        assert set(found[foot][slipped]) == {SLIDES}
        assert slipped[slides].mean() > 0.9
        assert not slipped[(START - 0.1 > TIME) | (END + 0.1 < TIME)].any()


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_slide_that_ends_in_a_blow_is_found_to_its_end(robot: RobotModel, seed: int) -> None:
    """The floor holds again and stops the robot within 30 ms, with a blow that makes the velocity jump."""
    stop = np.clip((END - TIME) / 0.03, 0, 1)
    speed = 0.05 * np.clip((TIME - START) / 0.1, 0, 1) * stop
    push = np.gradient(speed, PERIOD)
    pushed = np.column_stack([push, 0.5 * push, 0.0 * push]) + struck((END,), seed)
    found = reasons(robot, accelerated(STANDING, pushed))
    for foot in FEET:
        assert slips(found[foot])[(START + 0.05 < TIME) & (END - 0.04 > TIME)].all()
        assert not slips(found[foot])[(START - 0.1 > TIME) | (END + 0.1 < TIME)].any()


@pytest.mark.parametrize("accelerometer", [True, False])
def test_soles_that_slide_apart_are_seen_by_the_closed_chain(robot: RobotModel, accelerometer: bool) -> None:
    name = "joint.left_leg_x.position"
    log = STANDING.with_columns({name: STANDING.columns[name] + way(0.003)})
    found = reasons(robot, log if accelerometer else without(log, "linear_acceleration"))
    middle = (START + 0.1 < TIME) & (END - 0.1 > TIME)
    for foot in FEET:
        assert set(found[foot][middle]) == {APART}
        assert not slips(found[foot])[(START - 0.1 > TIME) | (END + 0.1 < TIME)].any()


@pytest.mark.parametrize(("why", "slides"), [(Reason.ON_THE_EDGE, False), (Reason.OUTLIER, True)])
def test_a_sole_that_rolls_on_its_edge_does_not_slide(robot: RobotModel, why: Reason, slides: bool) -> None:
    """Its place is computed for a level sole: what it seems to do against the other foot says nothing of that one."""
    name = "joint.left_leg_x.position"
    log = without(STANDING.with_columns({name: STANDING.columns[name] + way(0.003)}), "linear_acceleration")
    rolls = (START - 0.3 < TIME) & (END + 0.3 > TIME)
    contacts = without_slip(robot, prepared(robot, log).without("left", rolls, why)).contacts
    said = [reason.text for reason in contacts["right"].reasons]
    assert any(text.startswith("slip") for text in said) == slides


def test_without_an_accelerometer_a_slide_in_common_stays_unseen(robot: RobotModel) -> None:
    blind = without(carried(STANDING, 0.012), "linear_acceleration")
    assert not any(slips(reason).any() for reason in reasons(robot, blind).values())


@pytest.mark.parametrize("seed", [2, 3])
def test_standing_soles_do_not_slide_nor_do_impacts_make_them(robot: RobotModel, seed: int) -> None:
    """Blows while it stands: the integrated acceleration jumps by centimetres a second."""
    log = noisy(record(sway(seed=seed, duration=25.0)), seed)
    for one in (log, accelerated(log, struck((6.0, 13.0, 19.0), seed))):
        assert not any(slips(reason).any() for reason in reasons(robot, one).values())


def test_the_velocity_is_that_of_the_soles_with_its_deviation(robot: RobotModel) -> None:
    """Of an IMU that is tilted by 0.2 deg, which drifts; the exact one of a slide."""
    tilted = accelerated(carried(STANDING, 0.01), np.outer(np.ones(TIME.size), [0.035, -0.02, 0.0]))
    recording = prepared(robot, tilted)
    flat = {foot: contact.standing for foot, contact in recording.contacts.items()}
    motion = sole_motion(robot, recording, flat, np.zeros(TIME.size))
    assert motion is not None
    true = np.outer(np.gradient(way(0.01), PERIOD), [0.8, -0.6])
    inner = (TIME > 0.2) & (TIME[-1] - 0.2 > TIME)
    for foot in FEET:
        error = (motion.velocity[foot] - true)[inner]
        assert np.std(error / motion.deviation[foot][inner][:, None]) == pytest.approx(1.0, abs=0.35)
        assert np.abs(error).max() < 0.006


@pytest.mark.parametrize("noise", [0.002, 0.02])
def test_the_noise_of_a_velocity_is_read_off_its_differences(noise: float) -> None:
    """White noise of either component, beside a drift and a slide that move no median."""
    seen = noise * np.random.default_rng(1).normal(size=(TIME.size, 2)) + 0.01 * TIME[:, None]
    seen[1000:1100] += 0.5
    none = np.zeros((TIME.size, 2))
    assert _drift(seen, none[None], none[:, 0], none, PERIOD)[2] == pytest.approx(noise, rel=0.05)


def test_a_gyroscope_takes_the_attitudes_noise_off(robot: RobotModel) -> None:
    """An attitude three times as noisy, whose noise alone would be 12 mm/s: steps of it that no rate shows."""
    random = np.random.default_rng(5)
    names = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
    spoiled = STANDING.stack(names) + random.normal(0, 3e-4, (TIME.size, 4))
    log = STANDING.with_columns(dict(zip(names, spoiled.T, strict=True)))
    recording = prepared(robot, log)
    flat = {foot: contact.standing for foot, contact in recording.contacts.items()}
    motion = sole_motion(robot, recording, flat, np.zeros(TIME.size))
    assert motion is not None
    assert np.nanstd(motion.velocity["left"]) < 0.004


@pytest.mark.parametrize("rate", [3, 10, 25])
def test_slow_logs_of_standing_soles_show_no_slide(robot: RobotModel, rate: int) -> None:
    """The lag between compared velocities is shorter than a sample there."""
    slow = STANDING.select(slice(None, None, round(1 / rate / PERIOD)))
    assert not any(slips(reason).any() for reason in reasons(robot, slow).values())


def test_what_the_other_foot_does_counts_while_both_stand() -> None:
    """In a step the foot in the air is quick, and the one that stands need not slide for that."""
    both = np.array([True, True, False, False])
    left = SlipIndicator(np.array([0.001, 0.03, 0.001, np.nan]), np.full(4, 0.001))
    right = SlipIndicator(np.array([0.02, 0.01, 0.5, 0.5]), np.full(4, 0.002))
    shared = _shared({"left": left, "right": right}, "left", both)
    np.testing.assert_array_equal(shared.speed, [0.02, 0.03, 0.001, np.nan])
    np.testing.assert_array_equal(shared.deviation, [0.002, 0.001, 0.001, 0.001])

"""What the estimator leaves out: edges, impacts, slides; zeros from the air; the slide that a load compresses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import TRUTH, VERTICAL, record, sway, times
from biped_robot import write_robot
from feet_trials import noisy
from plantar.conventions import GRAVITY
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel, load_robot

DAMAGE = slice(2000, 2200)  # samples at 100 Hz


@pytest.fixture
def robot(tmp_path: Path) -> RobotModel:
    return load_robot(write_robot(tmp_path))


def spoilt(log: MotionLog, column: str, by: np.ndarray | float, samples: slice = DAMAGE) -> MotionLog:
    values = log.columns[column].copy()
    values[samples] += by
    return MotionLog(log.name, log.time, {**log.columns, column: values})


def replayed(robot: RobotModel, log: MotionLog) -> Replay:
    return FootEstimator(robot, wrench_delay=0.0).replay(log)


def told(replay: Replay, flag: Flag) -> np.ndarray:
    return (replay.column("left", "flags").astype(int) & flag) > 0


def expect_unharmed(replay: Replay) -> None:
    found = replay.estimate("left").pitch
    truth = TRUTH["left", "pitch"]
    assert found.stiffness.value == pytest.approx(truth.stiffness, rel=1e-3)
    assert found.damping.value == pytest.approx(truth.damping, rel=3e-3)


def test_at_the_edge_nothing_is_learnt(robot: RobotModel) -> None:
    push = 60.0  # N·m: more than half a sole's length times the load, and none of the bush's
    replay = replayed(robot, spoilt(record(sway(duration=60.0)), "wrench.left.torque.y", push))
    edge = told(replay, Flag.EDGE)
    assert edge[DAMAGE].all()
    assert edge.sum() == 200
    expect_unharmed(replay)


def test_behind_an_edge_rows_wait_until_the_delay_has_passed_too(robot: RobotModel) -> None:
    """Torques that are read 0.1 s early wait for the angles: for as long rows behind an edge still hold the push."""
    motion, late = sway(duration=60.0), -0.1
    log, later = record(motion), record(motion, at=times(motion) - late)
    log = log.with_columns({name: values for name, values in later.columns.items() if "wrench" in name})
    replay = FootEstimator(robot, wrench_delay=late).replay(spoilt(log, "wrench.left.torque.y", 60.0))
    found, truth = replay.estimate("left").pitch, TRUTH["left", "pitch"]
    assert found.stiffness.value == pytest.approx(truth.stiffness, rel=1e-5)
    assert found.damping.value == pytest.approx(truth.damping, rel=1e-5)


def test_behind_an_edge_a_log_whose_time_begins_anew_teaches_at_once(robot: RobotModel) -> None:
    estimator = FootEstimator(robot, wrench_delay=0.0)
    log = record(sway(duration=60.0))
    estimator.replay(spoilt(log, "wrench.left.torque.y", 60.0, slice(5000, 5200)))
    again = estimator.replay(spoilt(log, "wrench.left.torque.y", 2.0, slice(None)))
    assert again.estimate("left", 1000).pitch.offset == pytest.approx(
        TRUTH["left", "pitch"].offset + 2.0, abs=0.1
    )


def test_a_torque_that_turns_over_for_some_seconds_is_no_other_ground(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    turned = slice(4000, 4400)
    torque = log.column("wrench.left.torque.y")[turned]
    replay = replayed(robot, spoilt(log, "wrench.left.torque.y", -2 * torque, turned))
    doubted = told(replay, Flag.CONTRADICTION)
    assert doubted[4100:4400].mean() > 0.5
    assert not doubted[:4000].any()
    assert not doubted[4500:].any(), "a second after the fault's end"
    assert not told(replay, Flag.GROUND_CHANGED).any()
    assert replay.estimate("left").pitch.stiffness.value == pytest.approx(
        TRUTH["left", "pitch"].stiffness, rel=0.01
    )


def test_an_impact_is_left_out(robot: RobotModel) -> None:
    shaken = 40.0 * np.random.default_rng(0).normal(size=200)
    replay = replayed(robot, spoilt(record(sway(duration=60.0)), "wrench.left.force.z", shaken))
    impact = told(replay, Flag.IMPACT)
    assert impact[2010:2200].mean() > 0.9
    assert not impact[:1990].any()
    assert not impact[2250:].any()
    expect_unharmed(replay)


def test_degrees_are_no_radians(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    column = "joint.left_ankle_pitch.position"
    values = log.columns[column]
    degrees = 400.0 + np.degrees(values[DAMAGE]) - values[DAMAGE]  # a multi-turn encoder's zero
    replay = replayed(robot, spoilt(log, column, degrees))
    assert told(replay, Flag.INPUT_MISSING)[DAMAGE].all()
    assert not told(replay, Flag.INPUT_MISSING | Flag.NOT_STANDING)[DAMAGE.stop + 100 :].any()
    expect_unharmed(replay)


def test_a_sole_that_lies_flat_is_not_steep(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    replay = replayed(robot, spoilt(log, "joint.left_ankle_pitch.position", 0.7))
    assert told(replay, Flag.NOT_STANDING)[DAMAGE].all()
    expect_unharmed(replay)


def test_a_slide_is_left_out(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    slid = 0.01 * (1 - np.cos(np.pi * np.arange(200) / 199)) / 2
    values = log.columns["joint.left_leg_x.position"].copy()
    values[DAMAGE] += slid
    values[DAMAGE.stop :] += slid[-1]
    moved = MotionLog(log.name, log.time, {**log.columns, "joint.left_leg_x.position": values})
    slip = told(replayed(robot, moved), Flag.SLIP)
    assert slip[2050:2150].all()
    assert not slip[:2000].any()
    assert not slip[2240:].any()


def test_a_swing_shows_the_zero(robot: RobotModel) -> None:
    lifts = tuple(("left", start, start + 3.0) for start in (10.0, 20.0, 30.0))
    log = record(sway(duration=40.0, lifts=lifts))
    zero = 25.0 + 0.1 * np.random.default_rng(0).normal(
        size=len(log)
    )  # N; without noise it would count as frozen
    replay = replayed(robot, spoilt(log, "wrench.left.force.z", zero, slice(None)))
    load, contact = replay.column("left", "load"), replay.column("left", "contact")
    assert load[500] == pytest.approx(25.0 + 294.0, abs=60.0), "no zero is known before the first swing"
    assert abs(load[2150]) < 3.0, "in the second swing the first one's zero is taken off"
    assert (contact[2050:2250] == Contact.AIR).all()
    assert (contact[2400:2950] == Contact.STANCE).all()


def test_a_known_compliance_moves_the_bushs_centre(robot: RobotModel) -> None:
    log = record(sway(duration=30.0))
    result = FeetResult(
        "biped",
        (),
        {},
        "kelvin_voigt",
        (),
        (),
        (),
        (),
        (),
        compliance=dict.fromkeys(robot.feet, 1 / VERTICAL),
    )
    known, unknown = FootEstimator(robot, result).replay(log), FootEstimator(robot).replay(log)
    moved = known.column("left", "pitch.torque") - unknown.column("left", "pitch.torque")
    assert np.abs(moved).max() > 0.05
    deflection = known.column("left", "pitch.deflection")
    model = TRUTH["left", "pitch"].torque(deflection, np.gradient(deflection, log.period))
    wrong, right = (np.std(one.column("left", "pitch.torque") - model) for one in (unknown, known))
    assert right < 0.2 * wrong


def test_a_compliance_that_nobody_told_is_learnt(robot: RobotModel) -> None:
    replay = replayed(robot, record(sway(duration=60.0)))
    for foot in replay.feet:
        found = replay.estimate(foot)
        assert found.compliance.value == pytest.approx(1 / VERTICAL, rel=0.01)
        half = found.compliance.half_width
        assert 0.1 < half / found.compliance.value < 0.5, "what no model has is part of it"
        assert found.compression == pytest.approx(found.load / VERTICAL, rel=0.06)


@pytest.mark.parametrize("axis", "xy")
def test_of_two_axes_the_surer_one_tells_the_compliance(robot: RobotModel, axis: str) -> None:
    """Roll's torque is noise, or pitch's is: 10 N·m of it, a hundred times what a compliance moves."""
    log = record(sway(duration=60.0))
    for place, foot in enumerate(robot.feet):
        noise = 10.0 * np.random.default_rng(place).standard_normal(len(log))
        log = spoilt(log, f"wrench.{foot}.torque.{axis}", noise, slice(None))
    replay = replayed(robot, log)
    for foot in replay.feet:
        assert replay.estimate(foot).compliance.value == pytest.approx(1 / VERTICAL, rel=0.01)


def test_a_foot_zeroed_under_load_stands_always(robot: RobotModel) -> None:
    feet = {name: replace(foot, contact="always") for name, foot in robot.feet.items()}
    log = record(sway(duration=30.0))
    for foot in feet:
        log = spoilt(log, f"wrench.{foot}.force.z", -290.0, slice(None))
    replay = replayed(replace(robot, feet=feet), log)
    assert (replay.column("left", "contact")[1:] == Contact.STANCE).all()
    assert replay.estimate("left").pitch.identified


@pytest.mark.parametrize("seed", [2, 3])
def test_a_slide_that_is_softer_than_expected_is_as_unsure_as_it_was_drawn_back(
    robot: RobotModel, seed: int
) -> None:
    """Sensors with noise show it badly, and it lies four deviations from what was expected of it."""
    expected = 0.003 / (robot.mass * GRAVITY)
    assert expected * VERTICAL < 0.25
    replay = replayed(robot, noisy(record(sway(duration=60.0)), seed))
    for foot in ("left", "right"):
        found = replay.estimate(foot).compliance
        assert found is not None
        assert found.value < 0.8 / VERTICAL
        assert abs(found.value - 1 / VERTICAL) < found.half_width

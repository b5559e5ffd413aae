"""Walks on the twin: the robot stays up, steps from foot to foot, and its logs show the bushes that it walks on."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from kept_texts import assert_as_kept, described
from plantar.conventions import rotation_from_quaternion
from plantar.errors import MotionError
from plantar.logs.readers import open_log
from plantar.motions import Plan
from plantar.motions.body import Body
from plantar.motions.gait import Gait
from plantar.motions.stance import stand
from plantar.motions.walk import walk_plan
from plantar.robot.model import load_robot
from plantar.twin import PAPER, write_campaign
from plantar.twin.keep import plan_arrays, plan_from
from plantar.twin.presets import preset_named
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from plantar.twin.sensing.exact import bush_forces
from plantar.twin.sensing.logger import BASE
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout
from plantar.twin.walking.control import WalkingControl
from twin_samples import roll, short

WORLD = Physics(settle=0.5)


@cache
def walk() -> Plan:
    """Two steps of 12 cm, without the rest before and after."""
    body = Body(hrp2.robot())
    gait = Gait(step=0.12, period=0.8, turn=0.0, steps=2, trial=3)
    plan = walk_plan(body, "Walk12", stand(body, hrp2.postures().standing, {}), gait)
    return short(plan, 1.8, 5.8)


@cache
def walked() -> Rollout:
    return roll(walk(), WORLD)


def load(rollout: Rollout, foot: str) -> np.ndarray:
    return -rollout.sensors[f"{foot}.force"][:, 2]  # N, on the robot


def test_a_walk_stays_upright_and_lands_from_foot_to_foot() -> None:
    plan, rollout = walk(), walked()
    up = rotation_from_quaternion(rollout.base[:, 3:])[:, 2, :]
    lean = np.arccos(np.clip(np.sum(up * plan.base[:, 2, :3], axis=1), -1, 1))
    assert lean.max() < 0.02
    assert rollout.base[-1, :2] == pytest.approx(plan.base[-1, :2, 3], abs=0.02)
    weight = hrp2.robot().mass * 9.81
    single = np.where(load(rollout, "left") < 0.01 * weight, "right", "")
    single[load(rollout, "right") < 0.01 * weight] = "left"
    carried = [str(foot) for foot in single if foot]
    turns = [foot for place, foot in enumerate(carried) if place == 0 or foot != carried[place - 1]]
    assert turns == ["right", "left"]  # the left foot steps first
    total = load(rollout, "left") + load(rollout, "right")
    assert total.max() < 2 * weight  # lands, but does not stamp


def test_a_walk_is_as_it_is_kept() -> None:
    """Its plan, and how large all is that the robot does and feels."""
    plan, rollout = walk(), walked()
    sizes = {
        "joints": size(rollout.positions), "rates": size(rollout.velocities), "efforts": size(rollout.efforts),
        "base": size(rollout.base), "sensors": {name: size(values) for name, values in rollout.sensors.items()},
        "bush": {foot: [size(part[foot]) for part in (rollout.bush, rollout.bush_rates)] for foot in rollout.bush},
    }  # fmt: skip
    kept = Path(__file__).parent / "kept"
    ways = {name: plan.positions[:, place] for place, name in enumerate(plan.joints)}
    assert_as_kept(described({"plan": plan, "ways": ways}), kept / "walk_planned.txt", share=1e-4, least=1e-5)
    assert_as_kept(described(sizes), kept / "walk_played.txt", share=1e-2, least=1e-4)


def size(values: np.ndarray) -> list[float]:
    """Root mean square of each column."""
    return [float(one) for one in np.sqrt(np.mean(values**2, axis=0))]


@pytest.mark.parametrize(("axis", "column"), [("pitch", 1), ("roll", 2)])
def test_the_walk_moves_the_bushes_by_their_law(axis: str, column: int) -> None:
    rollout = walked()
    angle, rate = rollout.bush["right"][:, column], rollout.bush_rates["right"][:, column]
    assert np.ptp(angle) > 0.02
    rows = np.column_stack([angle, rate, np.ones_like(rate)])
    stiffness, damping, _ = np.linalg.lstsq(rows, bush_forces(rollout, "right")[:, column], rcond=None)[0]
    assert stiffness == pytest.approx(getattr(PAPER["right"], f"{axis}_stiffness"), rel=1e-3)
    assert damping == pytest.approx(getattr(PAPER["right"], f"{axis}_damping"), rel=1e-3)


def test_targets_follow_corrections_without_a_corner() -> None:
    """A cubic B-spline's bend is that of its control points at the corrections and straight between them; what a
    corner does to a servo is read with every sample."""
    random, steps = np.random.default_rng(4), 20
    corrections = np.vstack([np.zeros((3, 2)), random.standard_normal((30, 2)), np.ones((6, 2))])
    control = object.__new__(WalkingControl)
    control.estimator = SimpleNamespace(read=lambda sample, data: None)
    control.stabiliser = SimpleNamespace(ask=lambda sample, state: None)
    control.feet = SimpleNamespace(correction=lambda sample, state, asked: corrections[3 + sample])
    control._places, control._last = [0, 1], corrections[:3]
    planned = random.standard_normal((len(corrections) - 3, steps, 2))
    begins, pieces = [], []
    for sample, rows in enumerate(planned):
        begins.append(control.correction)
        pieces.append(control.led(sample, None, rows) - rows)
    assert [piece[0] for piece in pieces] == pytest.approx(np.array(begins), abs=1e-12)
    bend = steps**2 * np.diff(np.concatenate(pieces), 2, axis=0)
    at, between = np.diff(corrections, 2, axis=0), np.arange(len(bend) + 1) / steps
    straight = [np.interp(between, np.arange(len(at)), column) for column in at.T]
    assert bend == pytest.approx(np.transpose(straight)[1:], abs=0.2), (
        "corners of straight lines bend by 20 times"
    )
    assert control.correction == pytest.approx(np.ones(2))


def test_without_its_stabiliser_the_robot_falls(monkeypatch: pytest.MonkeyPatch) -> None:
    """One foot of this rubber is softer than gravity: no plan alone can stand on it."""
    monkeypatch.setattr(WalkingControl, "led", lambda self, sample, data, rows: rows)
    with pytest.raises(MotionError, match=r"t = [\d.]+ s: Walk12: the robot falls") as caught:
        roll(walk(), WORLD)
    assert "\n" not in str(caught.value)


def test_a_plan_comes_back_from_the_cache_as_it_was() -> None:
    plan = walk()
    again = plan_from(plan.name, plan_arrays(plan))
    assert again.walk is not None
    for foot in ("left", "right"):
        assert np.array_equal(again.walk.soles[foot], plan.walk.soles[foot])
        assert np.array_equal(again.walk.stands[foot], plan.walk.stands[foot])
    assert np.array_equal(again.walk.centre, plan.walk.centre)
    assert np.array_equal(again.walk.zmp, plan.walk.zmp)


def test_a_plain_log_holds_what_public_logs_hold(tmp_path) -> None:
    recordings = [record(walked(), hrp2.robot(), WORLD, preset_named("plain_log"), seed) for seed in (1, 2)]
    robot = load_robot(write_campaign(tmp_path, recordings[:1], None, "plain_log"))
    log = open_log(tmp_path / "Walk12.parquet", robot)
    assert log.period == pytest.approx(0.02)
    assert robot.imu.name == BASE
    kinds = {name.split(".")[2] for name in log.columns if name.startswith("imu.")}
    assert kinds == {"orientation"}
    assert not any(name.endswith(".effort") for name in log.columns)
    attitude = np.column_stack([log.columns[f"imu.{BASE}.orientation.{axis}"] for axis in "wxyz"])
    up = rotation_from_quaternion(attitude)[:, 2, :]
    true = rotation_from_quaternion(walked().base[::4, 3:])[:, 2, :]
    assert np.arccos(np.clip(np.sum(up * true, axis=1), -1, 1)).max() < 0.02
    air = []
    for recording in recordings:
        columns = recording.log.columns
        lifted = load(walked(), "left")[::4] < 1.0
        lifted &= np.convolve(~lifted, np.ones(9), "same") == 0  # clocks differ by some milliseconds
        assert lifted.sum() > 10
        for axis, low, high in (("z", -80, -25), ("x", -25, -15), ("y", -25, -15)):
            read = columns[f"wrench.left_foot.force.{axis}"][lifted]
            assert low - 8 < read.mean() < high + 8
        air.append(columns["wrench.left_foot.force.z"][lifted].mean())
    assert abs(air[0] - air[1]) > 1.0  # otherwise in each recording
    drawn = recordings[0].truth.facts["drawn"]
    assert len({drawn[f"{device}.clock"] for device in ("joint", "imu.base", "wrench.left_foot")}) == 3


def test_a_device_late_by_its_clock_shows_in_the_log() -> None:
    recording = record(walked(), hrp2.robot(), WORLD, preset_named("plain_log"), 6)
    rollout, joint = walked(), "RLEG_JOINT3"
    exact, rate = (
        values[::4, rollout.joints.index(joint)] for values in (rollout.positions, rollout.velocities)
    )
    error = recording.log.columns[f"joint.{joint}.position"] - exact
    clock = recording.truth.facts["drawn"]["joint.clock"]
    assert abs(clock) > 1.5e-3
    assert error @ rate / (rate @ rate) == pytest.approx(clock, abs=8e-4)

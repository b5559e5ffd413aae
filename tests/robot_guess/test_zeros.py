"""Zeros of force sensors are taken off before a first robot file is checked against a walk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from example_robots import TALOS
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.save import save_log
from plantar.robot_guess import guess_robot_file
from plantar.robot_guess.zeros import _load, without_zeros
from standing_robot import talos_sways

SENSORS = {"left": "left", "right": "right"}
WEIGHT = 880.0  # N
ZERO = {"left": [-15.0, 8.0, -50.0, 25.0, -4.0, 1.0], "right": [6.0, 12.0, 40.0, -20.0, 3.0, 0.0]}


def stepping(log: MotionLog, zero: dict[str, list[float]] | None = None) -> MotionLog:
    """The log of a robot that lifts its feet in turn for half a second, its sensors with zeros of their own.

    What the lifted foot carried is held by nobody: the other foot's load and centre of pressure stay.
    """
    turn = np.floor(log.time / 0.5).astype(int) % 4
    shares = {"left": np.array([1.0, 1.0, 1.0, 0.0])[turn], "right": np.array([1.0, 0.0, 1.0, 1.0])[turn]}
    columns = {}
    for foot, share in shares.items():
        wrench = log.wrench(foot) * share[:, None] + (zero or {}).get(foot, [0.0] * 6)
        for k, part in enumerate(f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"):
            columns[f"wrench.{foot}.{part}"] = wrench[:, k]
    return log.with_columns(columns)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_a_lifted_foot_reads_is_taken_off_whatever_the_sensors_axes(sign: float) -> None:
    # An axis points the other way too.
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]) * sign
    log = talos_sways(TALOS, wrench_turn=turn)
    (tared,), (remark,) = without_zeros([stepping(log, ZERO)], SENSORS, WEIGHT)
    for foot in ZERO:
        np.testing.assert_allclose(tared.wrench(foot), stepping(log).wrench(foot), atol=1e-9)
    assert "left 53 N, right 42 N" in remark.text
    assert not remark.doubt


def test_nothing_is_taken_off_where_both_feet_stand() -> None:
    log = talos_sways(TALOS)
    without_left = MotionLog(
        "none", log.time, {name: values for name, values in log.columns.items() if "left" not in name}
    )
    assert without_zeros([log, without_left], SENSORS, WEIGHT) == ([log, without_left], [])


def test_a_zero_does_not_speak_against_the_outline(tmp_path: Path) -> None:
    save_log(stepping(talos_sways(TALOS), ZERO), tmp_path / "walk.csv")
    text = guess_robot_file(TALOS, [tmp_path / "walk.csv"], tmp_path / "robot.yaml")
    assert "leaves its outline" not in text
    assert "balance gravity to 0.0 cm" in text
    assert "taken off as their zeros" in text


def test_the_largest_zero_of_all_logs_is_told() -> None:
    time = np.arange(0, 17.0, 0.02)
    stands = np.mod(time, 2.0) < 1.0
    logs = []
    for number, zero in enumerate((20.0, 45.0, 30.0)):
        columns = {name: np.zeros(time.size) for name in wrench_columns("left")}
        columns["wrench.left.force.z"] = np.where(stands, WEIGHT, 0.0) + zero
        logs.append(MotionLog(f"walk_{number}", time, columns))
    tared, (remark,) = without_zeros(logs, {"left": "left"}, WEIGHT)
    assert "left 45 N" in remark.text
    for log in tared:
        np.testing.assert_allclose(
            log.column("wrench.left.force.z"), np.where(stands, WEIGHT, 0.0), atol=1e-9
        )


def test_a_zero_that_drifts_is_taken_off_where_it_was() -> None:
    """By half a newton a second: what is told is its middle."""
    time = np.arange(0, 60.0, 0.02)
    stands, zero = np.mod(time, 2.0) < 1.0, 20.0 + 0.5 * (time - 30.0)
    columns = {name: np.zeros(time.size) for name in wrench_columns("left")}
    columns["wrench.left.force.x"] = zero
    columns["wrench.left.force.z"] = np.where(stands, WEIGHT, 0.0)
    (tared,), (remark,) = without_zeros([MotionLog("walk", time, columns)], {"left": "left"}, WEIGHT)
    assert tared.column("wrench.left.force.x") == pytest.approx(np.zeros(time.size), abs=0.1)
    assert "left 20 N" in remark.text


def test_the_load_is_along_the_usual_force_under_load() -> None:
    """Of six samples three carry more than half of the largest: their middle decides."""
    force = np.array(
        [[0, 0, 1], [9, 0, 0], [0, -60, 80], [0, -66, 88], [0, -120, 50], [np.nan, 0, 0]], dtype=float
    )
    wrench = np.hstack([force, np.full_like(force, 7.0)])
    usual = np.median(force[2:5], axis=0)
    assert _load(wrench)[:5] == pytest.approx(force[:5] @ usual / np.linalg.norm(usual))
    assert np.isnan(_load(wrench)[5])
    assert _load(np.full((3, 6), np.nan)).shape == (3,)
    assert _load(np.zeros((3, 6))).tolist() == [0.0, 0.0, 0.0]

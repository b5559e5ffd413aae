"""Each limit of the checks of feet and stances, tried just inside and just outside on small logs made by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import WEIGHT
from biped_robot import make_robot, robot_entry
from loaded_log import PERIOD, made
from plantar.conventions import Array
from plantar.faults.air_readings import check_air_readings
from plantar.faults.bush_frames import check_bush_axes, check_bush_link
from plantar.faults.stance import StanceSides
from plantar.robot.model import RobotModel

JOINT = "left_ankle_pitch"
OTHER = "right_ankle_pitch"


@pytest.mark.parametrize(
    ("channel", "value", "others", "seconds", "limit"),
    [(0, 0.029, 1.0, 5.0, None), (0, 0.031, 1.0, 5.0, 0.03), (4, 0.0059, 1.0, 5.0, None), (4, -0.0061, 1.0, 5.0, 0.006),
     (2, 0.149, 0.81, 5.0, 0.03), (2, 0.151, 0.81, 5.0, None), (2, 0.1, 0.79, 5.0, None), (2, 0.1, 0.81, 2.9, None),
     (2, 0.1, 0.81, 3.1, 0.03)],
)  # fmt: skip
def test_what_a_foot_may_read_in_the_air(
    robot: RobotModel, channel: int, value: float, others: float, seconds: float, limit: float | None
) -> None:
    """Values as shares of the weight [1, m], most of the time; a mean would be off by the tenth that reads thrice."""
    air = np.arange(1000) < seconds / PERIOD
    wrench = np.where(air[:, None], value * WEIGHT * np.eye(6)[channel], [0, 0, WEIGHT / 2, 0, 0, 0])
    right = np.zeros((1000, 6))
    right[:, 2] = np.where(air, others, 0.5) * WEIGHT
    loads = {"left": wrench[:, 2].copy(), "right": right[:, 2]}
    wrench[: int(seconds / PERIOD / 10), channel] *= 3
    found = list(check_air_readings(robot, PERIOD, loads, {"left": wrench, "right": right}))
    assert len(found) == (limit is not None)
    assert limit is None or f"value {value * WEIGHT:.4g}: " in found[0].text
    assert limit is None or f"(valid: below {limit * WEIGHT:.2g};" in found[0].text


@pytest.mark.parametrize(("degrees", "count"), [(70.5, 0), (73.0, 2)])
def test_a_bush_whose_x_points_to_the_other_foot(tmp_path: Path, degrees: float, count: int) -> None:
    """From thrice as far before as beside on: tan 71.6 deg."""
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    for foot in feet.values():
        foot["bush"] = {**foot["bush"], "rpy": [0.0, 0.0, float(np.radians(degrees))]}
    assert len(list(check_bush_axes(make_robot(tmp_path, feet=feet), made(1.0, {})))) == count


@pytest.mark.parametrize(("turn", "count"), [(0.019, 0), (0.0214, 1)])
def test_a_joint_below_a_bush(robot: RobotModel, turn: float, count: int) -> None:
    foot = robot.feet["left"]
    above = replace(foot, bush=replace(foot.bush, link="left_ankle"))
    robot = replace(robot, feet={**robot.feet, "left": above})
    angle = np.linspace(-turn / 2, turn / 2, 100)
    found = list(check_bush_link(robot, made(1.0, {"joint.left_ankle_roll.position": angle})))
    assert len(found) == count
    assert not found or "'left_ankle_roll' below it: it moves by 0.021 rad" in found[0].text
    assert not list(
        check_bush_link(robot, made(1.0, {"joint.left_ankle_roll.position": np.full(100, np.nan)}))
    )


def sides(up: Array, push: Array) -> StanceSides:
    return StanceSides(np.zeros((len(up), 2, 6, 3)), up, push)


def tilts(size: float, turn: float = 0.0, noise: float = 0.0) -> Array:
    """Unit vectors (200, 3) that go round up at `size` [rad], turned about it."""
    angle = np.linspace(0.0, 2 * np.pi, 200, endpoint=False)
    level = size * np.column_stack([np.cos(angle + turn), np.sin(angle + turn)])
    level += noise * np.random.default_rng(0).standard_normal((200, 2))
    return np.column_stack([level, np.sqrt(1 - np.sum(level**2, axis=1))])


def test_what_a_stance_weighs_by_hand() -> None:
    up = np.tile([0.0, 0.0, 1.0], (5, 1))
    push = np.tile([np.sin(0.1), 0.0, np.cos(0.1)], (5, 1))
    assert sides(up, push).lean == pytest.approx(0.1)
    arms = np.zeros((5, 2, 6, 3))
    arms[:, 0, 0], arms[:, 1, 4] = [0.01, 0.0, 0.0], [0.02, 0.04, 0.0]
    arms[4] *= 100  # one bad sample moves no median
    assert StanceSides(arms, up, push).misfit == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("up", "push", "compared"),
    [(np.radians(0.48), 1.0, False), (np.radians(0.52), 1.0, True), (0.02, 1.45, True), (0.02, 1.55, False),
     (0.02, 1 / 1.45, True), (0.02, 1 / 1.55, False)],
)  # fmt: skip
def test_tilts_are_compared_where_they_are_large_and_alike(up: float, push: float, compared: bool) -> None:
    turn, spread = sides(tilts(up), tilts(up * push, 0.3)).turn
    assert (
        (turn, spread) == (pytest.approx(0.3, abs=1e-3), pytest.approx(0.0, abs=1e-3))
        if compared
        else (0.0, np.inf)
    )


@pytest.mark.parametrize(("alike", "known"), [(0.92, True), (0.88, False)])
def test_a_turn_s_deviation_is_that_of_a_correlation(alike: float, known: bool) -> None:
    """Of two components each: √(1 - r²) / r / √n; below 0.9 nothing is known."""
    noise = 0.02 * np.sqrt(1 / alike**2 - 1) / np.sqrt(2)
    turn, spread = sides(tilts(0.02), tilts(0.02, 0.3, noise)).turn
    expected = np.sqrt(1 - alike**2) / alike / np.sqrt(200) if known else np.inf
    assert spread == pytest.approx(expected, rel=0.15)
    assert turn == pytest.approx(0.3, abs=0.12)

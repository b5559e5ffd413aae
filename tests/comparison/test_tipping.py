"""A sole of the record that stands on its edge, by forces put where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.comparison.tipping import on_an_edge
from plantar.conventions import rotation_from_rpy
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.twin.robots import hrp2

FRONT, SIDE = 0.1086, 0.069  # m, the sole's half length and width
TIME = 10.0 + np.arange(1000) / 200  # its first sample is not at zero


def standing(forward: float, left: float, load: float = 280.0) -> MotionLog:
    """The left push goes from the sole's middle to a place on it [m] and back, from 2 to 4 s; it leans by 30 N."""
    robot = hrp2.robot()
    share = np.clip(1 - np.abs(TIME - TIME[0] - 3), 0, None)
    columns = {}
    for name, foot in robot.feet.items():
        x, y = (share * forward, share * left) if name == "left" else (0 * share, 0 * share)
        sensor, sole = robot.frame(foot.wrench.placement)[1], robot.frame(foot.sole.placement)[1]
        arm = np.column_stack([x, y, 0 * x]) + sole.translation - sensor.translation
        force = np.tile([30.0, 0.0, load], (TIME.size, 1))
        wrench = np.hstack([force, np.cross(arm, force)]) * foot.wrench.sign
        columns |= dict(zip(wrench_columns(foot.wrench.name), wrench.T, strict=True))
    return MotionLog("sway", TIME, columns)


@pytest.mark.parametrize(("forward", "left"), [(FRONT, 0.0), (-FRONT, 0.0), (0.0, SIDE), (0.0, -SIDE)])
def test_a_sole_that_stands_on_its_edge_is_told_with_its_time(forward: float, left: float) -> None:
    reaches = 2 + 1 - 0.005 / np.hypot(forward, left)
    assert on_an_edge(hrp2.robot(), standing(forward, left)) == pytest.approx(reaches, abs=0.02)


def test_a_sole_that_stands_inside_its_edges_or_in_the_air_is_not() -> None:
    assert on_an_edge(hrp2.robot(), standing(FRONT - 0.01, 0.0)) is None
    assert on_an_edge(hrp2.robot(), standing(FRONT, 0.0, load=5.0)) is None


def test_a_sensor_that_sits_aside_and_turned_says_the_same() -> None:
    robot, log = hrp2.robot(), standing(FRONT, 0.0)
    xyz, rpy, feet, columns = np.array([0.03, -0.04, 0.05]), np.array([0.4, -0.3, 1.1]), {}, {}
    turn = rotation_from_rpy(rpy)
    for name, foot in robot.feet.items():
        place = foot.wrench.placement
        assert not place.rpy.any()
        moved = replace(place, xyz=place.xyz + xyz, rpy=rpy)
        feet[name] = replace(foot, wrench=replace(foot.wrench, placement=moved))
        force, torque = np.split(log.wrench(foot.wrench.name), 2, axis=1)
        torque = torque - foot.wrench.sign * np.cross(xyz, foot.wrench.sign * force)
        read = np.hstack([force @ turn, torque @ turn])
        columns |= dict(zip(wrench_columns(foot.wrench.name), read.T, strict=True))
    found = on_an_edge(replace(robot, feet=feet), replace(log, columns=columns))
    assert found == pytest.approx(on_an_edge(robot, log))


def test_a_sensor_that_reads_the_opposite_says_the_same() -> None:
    robot, log = hrp2.robot(), standing(FRONT, 0.0)
    feet = {
        name: replace(foot, wrench=replace(foot.wrench, sign=-foot.wrench.sign))
        for name, foot in robot.feet.items()
    }
    turned = replace(log, columns={name: -values for name, values in log.columns.items()})
    assert on_an_edge(replace(robot, feet=feet), turned) == on_an_edge(robot, log)


@pytest.mark.parametrize("later", [-0.5, 0.5])
def test_of_two_soles_the_first_that_tips_tells_the_time(later: float) -> None:
    """The right foot stands on the same places as the left one, half a second earlier or later."""
    robot, log = hrp2.robot(), standing(FRONT, 0.0)
    left, right = (wrench_columns(robot.feet[name].wrench.name) for name in ("left", "right"))
    moved = {
        mine: np.roll(log.columns[other], int(200 * later)) for mine, other in zip(right, left, strict=True)
    }
    found = on_an_edge(robot, replace(log, columns={**log.columns, **moved}))
    assert found == pytest.approx(on_an_edge(robot, log) + min(later, 0.0))

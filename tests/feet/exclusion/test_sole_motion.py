"""How soles move under a chest whose motion is known: what sensors and robot file get wrong is no slide."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.conventions import rotation_from_quaternion
from plantar.feet.exclusion import sole_velocity
from plantar.feet.exclusion.sole_velocity import SoleMotion, friction, sole_motion
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel

PERIOD = 0.005
TIME = np.arange(6000) * PERIOD
INSIDE = slice(200, -200)  # filters swing at a log's ends
STILL = np.zeros((TIME.size, 2))
STANDS = np.ones(TIME.size, dtype=bool)
# The chest's way, velocity and acceleration: whole periods in a second, in which the drift's slope is seen to change.
PHASES = 2 * np.pi * np.outer(TIME, [1.0, 2.0]) + [0.0, 1.0]
SIZES = np.array([0.02, 0.01])  # m
WAY, VELOCITY, ACCELERATION = (
    SIZES * np.sin(PHASES), SIZES * [6.2832, 12.566] * np.cos(PHASES), -SIZES * [39.478, 157.91] * np.sin(PHASES),
)  # fmt: skip
RATES = {
    "left": np.column_stack([0.3 * np.sin(4.7 * TIME), 0.2 * np.sin(5.9 * TIME)]),
    "right": np.column_stack([0.2 * np.sin(5.3 * TIME + 2), 0.3 * np.sin(4.1 * TIME + 1)]),
}
HEADING = 0.4


class World:
    """A chest on two feet. What is set beside the defaults: places of soles [m], by how much the acceleration is off
    [m/s²], and the log's lacks."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.places = dict.fromkeys(RATES, STILL - WAY)
        self.acceleration = ACCELERATION
        self.flat = dict.fromkeys(RATES, STANDS)
        self.unrest = np.zeros(TIME.size)
        self.patch = monkeypatch

    def found(self) -> SoleMotion | None:
        upright = np.tile([1.0, 0, 0, 0], (TIME.size, 1))
        told = (upright, self.acceleration, np.zeros((TIME.size, 3)))
        self.patch.setattr(sole_velocity, "_inertial", lambda *_: told)
        bushes = {
            foot: SimpleNamespace(
                sole_position=np.zeros((TIME.size, 3)), heading=np.full(TIME.size, HEADING), rate=rate
            )
            for foot, rate in RATES.items()
        }
        recording: Any = SimpleNamespace(period=PERIOD, bushes=bushes, places=self.places)
        return sole_motion(None, recording, self.flat, self.unrest)  # type: ignore[arg-type]

    def speed(self, foot: str) -> np.ndarray:
        """Of a sole (N,) [m/s]."""
        found = self.found()
        assert found is not None
        return np.hypot(*found.velocity[foot].T)


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> World:
    return World(monkeypatch)


def given_to(name: str, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What the function of that name is called with, which it does as ever."""
    told: list[Any] = []
    function = getattr(sole_velocity, name)
    monkeypatch.setattr(sole_velocity, name, lambda *given: told.append(given) or function(*given))
    return told


def late_imu(world: World) -> None:
    world.acceleration = ACCELERATION - 0.004 * np.gradient(ACCELERATION, PERIOD, axis=0)


def tilted_by_its_acceleration(world: World) -> None:
    """A filter that takes slow accelerations for tilt lets gravity in as the chest's velocity does."""
    world.acceleration = ACCELERATION + 0.15 * VELOCITY


def wrong_heights(world: World) -> None:
    """Both bush centres in another height than told, so that soles seem to turn with the bushes' rates."""
    c, s = np.cos(HEADING), np.sin(HEADING)
    for foot, height in (("left", 0.01), ("right", -0.02)):
        pitch, roll = (np.cumsum(RATES[foot], axis=0) * PERIOD * height).T
        world.places[foot] = world.places[foot] + np.column_stack(
            [c * pitch - s * roll, s * pitch + c * roll]
        )


@pytest.mark.parametrize("wrong", [late_imu, tilted_by_its_acceleration])
@pytest.mark.parametrize("foot", ["left", "right"])
def test_what_the_imu_gets_wrong_is_no_slide(wrong: Callable[[World], None], foot: str, world: World) -> None:
    right = world.speed(foot)[INSIDE].max()
    wrong(world)
    assert right < 2e-4
    assert world.speed(foot)[INSIDE].max() < 5e-4, "a tenth of what it would be"


def test_a_bush_at_another_height_moves_no_sole_under_all_feet_together(world: World) -> None:
    """Also where one foot is in the air for a while, and the other speaks alone."""
    wrong_heights(world)
    world.flat["right"] = (TIME < 10) | (TIME > 18)
    found = world.found()
    assert found is not None
    alone = ~world.flat["right"] & (np.abs(TIME - 14) < 3)
    assert np.hypot(*found.velocity["left"][alone].T).max() < 2e-4
    both = sum(np.nan_to_num(found.velocity[foot]) for foot in RATES)[(TIME > 2) & (TIME < 9)]
    assert np.hypot(*both.T).max() < 4e-4


def test_a_foot_in_the_air_tells_nothing_of_the_others(world: World) -> None:
    swings = (TIME > 10) & (TIME < 12)
    world.places["right"] = (
        world.places["right"] + np.where(swings, np.sin(np.pi * (TIME - 10) / 2) ** 2, 0)[:, None]
    )
    world.flat["right"] = ~swings
    found = world.found()
    assert found is not None
    assert np.isnan(found.velocity["right"][swings]).all()
    assert np.hypot(*found.velocity["left"][INSIDE].T).max() < 2e-4


def test_where_no_foot_stands_the_chest_s_own_velocity_is_no_drift(
    world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hop."""
    seen = given_to("_drift", monkeypatch)
    hops = np.abs(TIME - 15) < 0.5
    world.flat = dict.fromkeys(RATES, ~hops)
    assert np.nanmax(world.speed("left")[INSIDE]) < 2e-4
    assert np.isfinite(seen[0][0]).all(axis=1).tolist() == (~hops).tolist()
    world.flat = dict.fromkeys(RATES, ~STANDS)
    assert world.found() is None


def test_without_an_acceleration_there_is_no_velocity(world: World) -> None:
    world.acceleration = world.acceleration.copy()
    world.acceleration[3000:3010] = np.nan
    found = world.found()
    assert found is not None
    for velocity in found.velocity.values():
        assert np.isnan(velocity[3000:3010]).all()
        assert np.isfinite(velocity[3010:-200]).all()
    assert all(np.isfinite(deviation).all() for deviation in found.deviation.values())


@pytest.mark.parametrize(("hertz", "passes"), [(5.0, 0.0), (20.0, 0.5), (60.0, 1.0)])
def test_shaking_is_what_no_robot_that_stands_does_on_purpose(
    hertz: float, passes: float, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Above 20 Hz. All of the acceleration is strain."""
    to_drift, to_deviation = (given_to(name, monkeypatch) for name in ("_drift", "_deviation"))
    shaken = np.sin(2 * np.pi * hertz * TIME)
    world.acceleration = np.repeat(shaken[:, None], 2, axis=1)
    world.unrest = np.where(np.abs(TIME - 5) < 1, 9.0, 0.0)
    world.found()
    (_, _, unrest, shaking, _), strain = to_drift[0], to_deviation[0][3]
    assert shaking[INSIDE, 0] @ shaken[INSIDE] / (shaken[INSIDE] @ shaken[INSIDE]) == pytest.approx(
        passes, abs=0.01
    )
    np.testing.assert_array_equal(unrest, world.unrest)
    assert strain[INSIDE].mean() == pytest.approx(1.0, rel=0.03)


@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_friction_is_the_force_along_the_floor_over_the_load_of_what_stands(heading: float) -> None:
    """Feet of 300 and 100 N; where one is in the air, or one's force is not known, the other alone."""
    force = {"left": [30.0, -10.0, 300.0], "right": [-2.0, 6.0, 100.0]}
    bushes = {
        foot: SimpleNamespace(
            wrench=np.tile([*own, 0, 0, 0], (4, 1)), deflection=np.zeros((4, 2)), heading=np.full(4, heading),
            force_z=np.full(4, own[2]),
        )
        for foot, own in force.items()
    }  # fmt: skip
    bushes["left"].force_z[2] = np.nan
    recording: Any = SimpleNamespace(time=np.arange(4.0), bushes=bushes)
    flat = {"left": np.array([True, True, True, False]), "right": np.array([True, False, True, False])}
    turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
    expected = np.array([[28 / 400, -4 / 400], [0.1, -1 / 30], [-0.02, 0.06]]) @ turn.T
    found = friction(recording, flat)
    np.testing.assert_allclose(found[:3], expected, rtol=1e-12)
    assert np.isnan(found[3]).all()


def test_readings_are_turned_into_the_world(robot: RobotModel) -> None:
    """By the orientation as it is normed; without an accelerometer's every axis there is no acceleration."""
    assert robot.imu is not None
    imu, orientation = robot.imu.name, np.array([0.9, 0.1, -0.3, 0.2])
    turn = rotation_from_quaternion(orientation / np.linalg.norm(orientation))
    acceleration, rates = np.array([1.0, -2.0, 9.81]), np.array([0.1, 0.2, -0.3])
    columns = {
        **dict(zip(imu_columns(imu, "orientation"), np.tile(orientation, (400, 1)).T, strict=True)),
        **dict(zip(imu_columns(imu, "angular_velocity"), np.tile(turn.T @ rates, (400, 1)).T, strict=True)),
        **dict(
            zip(
                imu_columns(imu, "linear_acceleration"),
                np.tile(turn.T @ acceleration, (400, 1)).T,
                strict=True,
            )
        ),
    }
    log = MotionLog("still", TIME[:400], columns)
    recording: Any = SimpleNamespace(log=log)
    unit, read, turned = sole_velocity._inertial(robot, recording)
    np.testing.assert_allclose(unit, np.tile(orientation / np.linalg.norm(orientation), (400, 1)))
    assert read is not None
    np.testing.assert_allclose(read, np.tile(acceleration[:2], (400, 1)), atol=1e-9)
    np.testing.assert_allclose(turned[5:-5], np.tile(rates, (390, 1)), atol=1e-9)
    del columns[imu_columns(imu, "linear_acceleration")[2]]
    recording = SimpleNamespace(log=MotionLog("still", TIME[:400], columns))
    assert sole_velocity._inertial(robot, recording)[1] is None


def test_an_acceleration_counts_from_the_middle_of_its_sample(world: World) -> None:
    """Velocities that are half a sample late would pass for noise of 0.6 mm/s: exact ones have the least, 0.2."""
    found = world.found()
    assert found is not None
    assert all(deviation[INSIDE].max() < 3e-4 for deviation in found.deviation.values())

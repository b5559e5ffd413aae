"""A force sensor whose axes are not the robot file's is told with its turn; one that is right, or a gain, is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from moments import fit_moments
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.moments.moment_fit import MomentFit, Part
from plantar.sensors.moments.sensor_errors import turn_columns
from plantar.sensors.moments.sensor_turns import (
    TURNED,
    sensor_turn_notes,
)
from plantar.sensors.newton_euler import newton_euler_residuals
from plantar.twin.robots import hrp2
from twin_samples import walked

LEAST = 0.05


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


def fitted(
    robot: RobotModel, turns: dict[str, tuple[float, float, float]], gain: float = 1.0
) -> tuple[RobotModel, MomentFit]:
    """What a walk shows, with force sensors turned about their axes [rad] by a wrong robot file."""
    feet = dict(robot.feet)
    for foot, turn in turns.items():
        wrench = feet[foot].wrench
        rotation = wrench.placement.rotation @ pin.exp3(np.array(turn))
        placement = replace(wrench.placement, rpy=pin.rpy.matrixToRpy(rotation))
        feet[foot] = replace(feet[foot], wrench=replace(wrench, placement=placement))
    wrong, log = replace(robot, feet=feet), checked(robot, walked())
    torques = [name for name in log.columns if ".torque." in name]
    read: MotionLog = log.with_columns({name: gain * log.column(name) for name in torques})
    [residual] = newton_euler_residuals(wrong, read)
    fit = fit_moments(wrong, [residual], [log.name])
    assert fit is not None
    return wrong, fit


def told(
    robot: RobotModel, turns: dict[str, tuple[float, float, float]], gain: float = 1.0
) -> dict[str, Note]:
    return sensor_turn_notes(*fitted(robot, turns, gain))


def test_sensors_that_are_as_the_file_says_are_not_told(twin: RobotModel) -> None:
    assert told(twin, {}) == {}
    assert told(twin, {"left": (0.0, 0.0, 0.3 * LEAST)}) == {}
    assert told(twin, {}, gain=1.1) == {}


@pytest.mark.parametrize(("turn", "axis"), [((0.0, 0.0, 0.14), "z"), ((0.0, 0.0, -0.1), "z")])
def test_one_that_is_turned_is_told_with_its_turn(
    twin: RobotModel, turn: tuple[float, float, float], axis: str
) -> None:
    notes = told(twin, {"right": turn})
    assert set(notes) == {"right"}
    note = notes["right"]
    assert (note.code, note.severity) == (TURNED, "warning")
    size = float(note.text.split("turned by ")[1].split()[0])
    assert size == pytest.approx(-np.degrees(sum(turn)), abs=2.0)
    assert f"about its {axis} axis" in note.text
    assert "encoders" in note.text, "a joint of the leg that reads from a wrong zero turns it alike"


def test_all_of_a_turn_is_found_though_delays_are_told_without_it(twin: RobotModel) -> None:
    """What the load makes of it is taken off Newton's law before; the fit of the moments sees it again."""
    wrong, fit = fitted(twin, {"right": (0.0, 0.03, 0.0), "left": (0.0, -0.03, 0.0)})
    right, left = (fit.values[turn_columns(wrong)[foot]][1] for foot in ("right", "left"))
    assert right - left == pytest.approx(-0.06, abs=0.01)


def test_a_turn_that_is_hardly_known_is_not_told(twin: RobotModel) -> None:
    values = np.zeros(100)
    values[turn_columns(twin)["left"].stop - 1] = 4 * LEAST
    fits = [MomentFit(values, [Part(std**2 * np.eye(100), 1e6)]) for std in (0.05, 0.03, 0.005)]
    assert [set(sensor_turn_notes(twin, fit)) for fit in fits] == [set(), set(), {"left"}]
    assert sensor_turn_notes(twin, None) == {}

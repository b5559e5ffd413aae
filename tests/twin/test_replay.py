"""What the twin takes from a result: each axis' own model, or the spring and damper nearest to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from biped import record, sway
from biped_robot import Frame, Mounting, make_robot
from plantar.errors import DataError, MotionError, PlantarError
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import AxisModel, FeetResult, Parameter
from plantar.results.feet_rows import LinearEquivalent
from plantar.robot.model import RobotModel
from plantar.twin import replay as room
from plantar.twin.replay import chest_attitude, feet_of, pitch_and_roll, plan_of
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.mjcf import SERVO_ANGLE

VALUES = {
    ("pitch", "stiffness"): 480.0,
    ("pitch", "damping"): 24.0,
    ("pitch", "slip_torque"): 5.0,
    ("pitch", "slip_angle"): 0.02,
    ("roll", "stiffness"): 350.0,
    ("roll", "damping"): 28.0,
    ("roll", "gamma"): 0.5,
    ("z", "stiffness"): -1.0,
}
LINEAR = LinearEquivalent(stiffness=300.0, damping=20.0)


def found(roll_model: str) -> FeetResult:
    parameters = tuple(
        Parameter("left", axis, name, "", value, 1.0, None, None, "usable", "")  # type: ignore[arg-type]
        for (axis, name), value in VALUES.items()
    )
    models = (
        AxisModel("left", "pitch", "elastoplastic", "", LinearEquivalent(500.0, 30.0)),
        AxisModel("left", "roll", roll_model, "", LINEAR),
    )
    return FeetResult(
        robot="biped", inputs=(), settings={}, model="elastoplastic", parameters=parameters, offsets=(),
        phases=(), validation=(), notes=(), models=models,
    )  # fmt: skip


def test_each_axis_is_played_by_its_own_model() -> None:
    bush = feet_of(found("kelvin_voigt"))["left"]
    assert (bush.pitch_stiffness, bush.pitch_slip_torque, bush.pitch_slip_angle) == (480.0, 5.0, 0.02)
    assert (bush.roll_stiffness, bush.roll_damping, bush.roll_slip_torque) == (350.0, 28.0, 0.0)
    assert bush.z_stiffness > 0, "a stiffness that is none is not played"


def test_a_model_without_an_element_is_played_by_its_spring_and_damper() -> None:
    bush = feet_of(found("bouc_wen"))["left"]
    assert (bush.roll_stiffness, bush.roll_damping) == (LINEAR.stiffness, LINEAR.damping)
    assert bush.pitch_slip_torque == 5.0


def test_a_missing_number_is_named() -> None:
    result = found("kelvin_voigt")
    less = tuple(row for row in result.parameters if (row.axis, row.name) != ("roll", "damping"))
    with pytest.raises(PlantarError, match=r"^the result has no roll_damping of the left foot$"):
        feet_of(replace(result, parameters=less))
    with pytest.raises(PlantarError, match=r"^the result has no roll_damping of the left foot$"):
        feet_of(replace(result, parameters=tuple(row for row in result.parameters if row.axis == "pitch")))


def test_a_damping_below_zero_is_played_as_it_is() -> None:
    """Only a vertical stiffness below zero is none: its axis may be left to the twin."""
    result = found("kelvin_voigt")
    below = tuple(
        replace(row, value=-2.0) if (row.axis, row.name) == ("roll", "damping") else row
        for row in result.parameters
    )
    assert feet_of(replace(result, parameters=below))["left"].roll_damping == -2.0


def test_a_servo_that_gives_is_told_to_go_further(robot: RobotModel) -> None:
    """So that under the recorded effort it stands where the recorded joint did: at its limit, by SERVO_ANGLE."""
    log, joint = record(sway(duration=2.0)), "left_ankle_pitch"
    limit = next(body.effort for body in describe(robot).bodies[1:] if body.joint == joint)
    plans = [
        plan_of(robot, log.with_columns({f"joint.{joint}.effort": np.full(len(log), effort)})).positions
        for effort in (0.0, 0.5 * limit)
    ]
    place = robot.joint_names.index(joint)
    np.testing.assert_allclose((plans[1] - plans[0])[:, place], 0.5 * SERVO_ANGLE, rtol=1e-6)
    assert not np.delete(plans[1] - plans[0], place, axis=1).any()
    unread = np.full(len(log), np.nan)
    silent = plan_of(robot, log.with_columns({f"joint.{joint}.effort": unread})).positions
    np.testing.assert_array_equal(silent, plans[0], "an effort that is never read bends nothing")


@pytest.mark.parametrize("rpy", [(np.pi, 0.0, 0.3), (0.0, np.pi / 2, 0.0), (0.2, -0.1, 2.0)])
def test_pitch_and_roll_are_the_robots_however_the_imu_is_mounted(
    rpy: tuple[float, float, float], robot: RobotModel, tmp_path: Path
) -> None:
    """Upside down roll turned over at 180 degrees, and on its side pitch and roll were none."""
    usual = pitch_and_roll(chest_attitude(robot, record(sway()))[:, 2, :])
    turned = Mounting(imu=Frame(rpy=rpy))
    mounted = make_robot(tmp_path, turned)
    found = pitch_and_roll(chest_attitude(mounted, record(sway(), turned))[:, 2, :])
    np.testing.assert_allclose(found, usual, atol=1e-9)
    assert 0.01 < np.abs(usual).max() < 0.3


@dataclass(frozen=True)
class Named:
    name: str


def test_every_motion_is_played_on_every_candidates_feet_and_those_that_fall_are_left_out(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []

    def roll_each(jobs: list[Any], of: Any, progress: Any) -> list[Any]:
        asked.extend((plan.name, world.bushes) for plan, world in jobs)
        return [
            MotionError("falls") if plan.name == "sway on soft" else f"rolled {plan.name}" for plan, _ in jobs
        ]

    hands: list[Any] = []
    monkeypatch.setattr(room, "plan_of", lambda _, log, hand: hands.append(hand) or Named(log.name))
    monkeypatch.setattr(room, "record_of", lambda _, log, plan: (f"record of {log.name}", plan.name))
    monkeypatch.setattr(room, "roll_each", roll_each)
    monkeypatch.setattr(room, "beside", lambda _, plan, *given: (plan.name, *given))
    logs: Any = [Named("squat"), Named("sway")]
    bushes: Any = {"left": "bush"}
    led: Any = {"sway": "hand"}
    found = room.replay(robot, logs, {"rigid": None, "soft": bushes}, led)
    assert asked == [
        ("squat on rigid", None), ("sway on rigid", None), ("squat on soft", bushes), ("sway on soft", bushes),
    ]  # fmt: skip
    assert hands == [None, "hand"]
    assert found == [
        (motion, feet, f"rolled {motion} on {feet}", (f"record of {motion}", motion))
        for motion, feet in (("squat", "rigid"), ("sway", "rigid"), ("squat", "soft"))
    ]  # fmt: skip


def test_a_chest_is_scored_up_to_a_moment_and_a_torque_behind_the_first_second() -> None:
    time = 5.0 + np.arange(5.0)
    chest = np.array([[0.0, 0.0], [3.0, 1.0], [3.0, 1.0], [9.0, 9.0], [9.0, 9.0]])
    one = room.Replayed(
        "m", "soft", time, {("left", "roll"): np.array([9.0, 9.0, 1.0, -2.0, 3.0])}, {("left", "roll"): np.zeros(5)},
        chest, np.zeros((5, 2)),
    )  # fmt: skip
    assert one.chest_error(2.0) == pytest.approx((np.sqrt(6.0), np.sqrt(2 / 3)))
    assert one.torque_error("left", "roll") == pytest.approx(2.0)


@pytest.mark.parametrize(("last", "count"), [(0.995, 200), (0.9949, 199), (0.99999999, 200), (1.0, 201)])
def test_a_plan_ends_with_the_last_sample_at_200_hz(last: float, count: int) -> None:
    time = room.plan_times(MotionLog("m", np.array([3.0, 3.0 + last]), {"joint.a.position": np.zeros(2)}))
    assert (time.size, time[0], time[-1]) == (count, 0.0, pytest.approx((count - 1) / 200))


def test_a_foot_that_carries_nothing_is_no_stance(robot: RobotModel) -> None:
    """A record of a robot that hangs: its feet carry a hundredth of its weight."""
    log = record(sway("sway", duration=2.0))
    hangs = log.with_columns({f"wrench.{foot}.force.z": np.full(len(log), 1.0) for foot in ("left", "right")})
    with pytest.raises(DataError, match=r"^sway: no foot carries the robot$"):
        plan_of(robot, hangs)
    lifted = log.with_columns({"wrench.right.force.z": np.full(len(log), 1.0)})
    assert plan_of(robot, lifted).standing == {"left"}
    assert set(plan_of(robot, lifted).stance) == {"left"}
    assert set(plan_of(robot, log).stance) == {"left", "right"}


def test_a_record_without_an_attitude_cannot_be_compared(robot: RobotModel) -> None:
    log = record(sway("sway", duration=1.0))
    blind = log.without([f"imu.chest.orientation.{axis}" for axis in "wxyz"])
    with pytest.raises(DataError, match=r"^sway: holds no attitude to compare with$"):
        chest_attitude(robot, blind)


@pytest.mark.parametrize(
    ("column", "what"),
    [
        ("imu.chest.orientation.x", "the attitudes"), ("wrench.right.torque.y", "the wrenches"),
        ("joint.left_ankle_roll.position", "the joints"),
    ],
)  # fmt: skip
def test_a_record_with_a_hole_is_refused_with_its_time(column: str, what: str, robot: RobotModel) -> None:
    log = record(sway("sway", duration=2.0))
    hole = log.column(column).copy()
    hole[120:180] = np.nan
    cut = log.with_columns({column: hole})
    with pytest.raises(DataError) as refused:
        room.record_of(robot, cut, plan_of(robot, cut))
    assert str(refused.value) == (
        f"sway, t = 1.195 s: {what} have a gap: what is played must be recorded throughout (valid: gaps of 0.2 s "
        f"or less)"
    )

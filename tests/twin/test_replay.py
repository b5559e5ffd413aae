"""What the twin takes from a result: each axis' own model, or the spring and damper nearest to it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import Frame, Mounting, make_robot
from plantar.errors import PlantarError
from plantar.results.feet import AxisModel, FeetResult, Parameter
from plantar.results.feet_rows import LinearEquivalent
from plantar.robot.model import RobotModel
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

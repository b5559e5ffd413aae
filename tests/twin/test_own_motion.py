"""A table of joint positions as a plan: where the robot starts, at which times, and what cannot be played."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from plantar.errors import LogError, MotionError
from plantar.robot.model import RobotModel
from plantar.twin.own_motion import own_plan


def table(
    folder: Path, seconds: float = 2.0, begin: float = 5.0, name: str = "joint", **columns: float
) -> Path:
    """Joints that start at a value and swing by a tenth of a radian, 100 Hz."""
    time = np.arange(round(seconds * 100) + 1) / 100.0
    values = {joint: value + 0.1 * np.sin(3.0 * time) for joint, value in columns.items()}
    head = ",".join(
        ["time", *(f"{name}.{joint}.position" for joint in values), "imu.chest.angular_velocity.x"]
    )
    rows = np.column_stack([begin + time, *values.values(), 0 * time])
    path = folder / "mine.csv"
    path.write_text(
        head + "\n" + "\n".join(",".join(f"{value:.17g}" for value in row) for row in rows) + "\n"
    )
    return path


def test_the_robot_starts_on_flat_soles_at_200_hz(robot: RobotModel, tmp_path: Path) -> None:
    start = {
        "left_leg_z": 0.02,
        "right_leg_z": 0.025,
        "left_ankle_pitch": 0.3,
        "right_ankle_pitch": 0.3,
        "neck": 0.0,
    }
    plan = own_plan(table(tmp_path, **start), robot)
    assert plan.name == "mine"
    assert plan.joints == robot.joint_names
    np.testing.assert_allclose(plan.time, np.arange(401) / 200.0, atol=1e-12)
    for place, joint in enumerate(plan.joints):
        wanted = start[joint] + 0.1 * np.sin(3.0 * plan.time) if joint in start else 0.0 * plan.time
        np.testing.assert_allclose(plan.positions[:, place], wanted, atol=1e-6)
    assert plan.standing == frozenset(("left", "right"))
    assert np.array_equal(plan.base[0], plan.base[-1])
    base, lowest = pin.SE3(plan.base[0]), []
    model, data = robot.model, robot.model.createData()
    pin.forwardKinematics(model, data, robot.configuration(plan.positions[0]))
    for name, foot in robot.feet.items():
        joint, seat = robot.frame(foot.sole.placement)
        sole = base * data.oMi[joint] * seat
        np.testing.assert_allclose(sole.rotation[:, 2], [0, 0, 1], atol=1e-9)
        lowest.append(sole.translation[2])
        assert plan.stance[name][2, 3] == pytest.approx(0.0, abs=0.006)
    assert lowest[0] == pytest.approx(0.0, abs=1e-9), "the first foot by name stands on the floor"
    assert abs(lowest[1]) < 0.01


@pytest.mark.parametrize(
    ("lifted", "said"), [(0.009, None), (0.012, "the first row has one foot 12 mm above the other")]
)
def test_feet_have_to_be_level(lifted: float, said: str | None, robot: RobotModel, tmp_path: Path) -> None:
    path = table(tmp_path, left_leg_z=lifted, right_leg_z=0.0)
    if said is None:
        own_plan(path, robot)
    else:
        with pytest.raises(MotionError, match=rf"mine.csv: {said} \(valid: level feet, within 10 mm\)"):
            own_plan(path, robot)


@pytest.mark.parametrize("seconds", [0.99, 1.0])
def test_a_motion_lasts_a_second_at_least(seconds: float, robot: RobotModel, tmp_path: Path) -> None:
    path = table(tmp_path, seconds, neck=0.0)
    if seconds < 1:
        with pytest.raises(LogError, match=r"mine\.csv: lasts 0\.99 s \(valid: 1 to 3600 s\)$"):
            own_plan(path, robot)
    else:
        assert own_plan(path, robot).time[-1] == pytest.approx(1.0)


def test_what_holds_no_joint_or_a_gap_is_told_with_its_time(robot: RobotModel, tmp_path: Path) -> None:
    with pytest.raises(
        LogError,
        match=r"mine\.csv: holds no position of a joint of this robot \(valid: columns such as "
        r"'joint\.left_leg_x\.position'\)$",
    ):
        own_plan(table(tmp_path, name="body", neck=0.0), robot)
    path = table(tmp_path, neck=0.0)
    lines = path.read_text().splitlines()
    lines[31] = lines[31].split(",")[0] + ",,0"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(
        LogError, match=r"mine\.csv, t = 5\.3 s: a joint has no position \(valid: a number in every row\)$"
    ):
        own_plan(path, robot)

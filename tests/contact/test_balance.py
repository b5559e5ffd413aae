"""The zero-moment point, against a cart on a table, statics and the twin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar.contact.balance import (
    Balance,
    flat_soles,
    measured_balance,
    planned_wrench,
    require_balance,
    sole_outlines,
    zero_moment_point,
)
from plantar.contact.polygon import separation
from plantar.errors import DataError, MotionError
from plantar.logs.motion_log import MotionLog
from plantar.motions import planned_balance
from plantar.robot.model import load_robot
from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import exact_columns
from twin_samples import plan, short, tilted

SQUARE = {"left": np.array([[0.1, 0.2], [-0.1, 0.2], [-0.1, -0.2], [0.1, -0.2]])}


@pytest.fixture(scope="module")
def log() -> MotionLog:
    robot = hrp2.robot()
    columns = exact_columns(tilted(), robot, cut_feet(describe(robot), robot))
    return MotionLog("Tilt3", tilted().time, columns)


def test_a_cart_on_a_table() -> None:
    """One mass at height h: zmp = x - h/g·ẍ, whatever its velocity."""
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")
    model.appendBodyToJoint(
        joint, pin.Inertia(7.0, np.array([0.1, 0.0, 0.3]), np.zeros((3, 3))), pin.SE3.Identity()
    )
    q = np.array([[0.4, -0.2, 0.5, 0, 0, 0, 1.0]])
    v, a = np.array([[0.7, 0.3, 0, 0, 0, 0.0]]), np.array([[1.5, -0.8, 0, 0, 0, 0.0]])
    zmp = zero_moment_point(planned_wrench(model, q, v, a), 1.0)
    assert zmp[0] == pytest.approx([0.5 - 0.8 / 9.81 * 1.5, -0.2 + 0.8 / 9.81 * 0.8])


def test_margin_inside_and_outside() -> None:
    zmp = np.array([[0.0, 0.0], [0.08, 0.0], [0.13, 0.0], [np.nan, np.nan]])
    balance = Balance("m", np.arange(4.0), zmp, SQUARE)
    assert balance.margin[:3] == pytest.approx([0.1, 0.02, -0.03])
    assert np.isnan(balance.margin[3])
    assert balance.worst() == pytest.approx((2.0, -0.03))


def test_leaving_the_polygon_says_when_and_by_how_much() -> None:
    zmp = np.array([[0.0, 0.0], [0.0, 0.22]])
    with pytest.raises(
        MotionError,
        match=r"^t = 1 s: m: the zero-moment point leaves the support polygon by 20\.0 mm \(valid: at "
        r"least 5 mm inside\)$",
    ):
        require_balance(Balance("m", np.arange(2.0), zmp, SQUARE))
    near = Balance("m", np.arange(2.0), 0.9 * zmp, SQUARE)
    with pytest.raises(
        MotionError,
        match=r"^t = 1 s: m: the zero-moment point comes within 2\.0 mm of the support polygon's border "
        r"\(valid: at least 5 mm inside\)$",
    ):
        require_balance(near)
    require_balance(near, least=0.001)


def test_the_polygon_is_the_hull_of_the_soles_that_stand() -> None:
    robot = hrp2.robot()
    both = Balance("m", np.zeros(1), np.zeros((1, 2)), sole_outlines(robot, plan("Tilt1").stance))
    assert np.ptp(both.polygon, axis=0) == pytest.approx([0.2172, 0.19 + 0.138], abs=1e-6)
    one = Balance("m", np.zeros(1), np.zeros((1, 2)), sole_outlines(robot, plan("Manual_left_roll").stance))
    assert np.ptp(one.polygon, axis=0) == pytest.approx([0.2172, 0.138], abs=1e-6)


def test_standing_still_the_plan_stands_under_the_centre_of_mass() -> None:
    robot, still = hrp2.robot(), short(plan("Tilt3"), 0.0, 1.0)
    model = robot.floating_model
    q = pin.neutral(model)
    q[:7] = pin.SE3ToXYZQUAT(pin.SE3(still.base[0]))
    for name, value in zip(still.joints, still.positions[0], strict=True):
        q[model.joints[model.getJointId(name)].idx_q] = value
    centre = pin.centerOfMass(model, model.createData(), q)
    assert planned_balance(robot, still).zmp[10] == pytest.approx(centre[:2], abs=1e-5)


def test_measured_from_the_feet_is_what_the_moving_mass_demands(log: MotionLog) -> None:
    """From the true root pose and the encoders: the centre of mass, less height over gravity times acceleration."""
    robot, rollout = hrp2.robot(), tilted()
    model = robot.floating_model
    data = model.createData()
    centre = np.empty((len(log), 3))
    for row in range(len(log)):
        w, x, y, z = rollout.base[row, 3:]
        q = pin.neutral(model)
        q[:7] = [*rollout.base[row, :3], x, y, z, w]
        for name in robot.joint_names:
            q[model.joints[model.getJointId(name)].idx_q] = log.columns[f"joint.{name}.position"][row]
        centre[row] = pin.centerOfMass(model, data, q)
    haste = np.gradient(np.gradient(centre, 0.005, axis=0), 0.005, axis=0)
    expected = centre[:, :2] - centre[:, 2:] / (9.80665 + haste[:, 2:]) * haste[:, :2]
    measured = measured_balance(robot, log, plan("Tilt3").stance)
    assert np.abs(measured.zmp - expected)[5:-5].max() < 2.5e-3  # the limbs' own turning is left out
    assert np.ptp(measured.polygon, axis=0) == pytest.approx([0.2172 + 0.1, 0.19 + 0.138], abs=1e-6)


def test_without_a_plan_the_soles_stand_as_the_encoders_say(log: MotionLog) -> None:
    robot = hrp2.robot()
    soles = flat_soles(robot, log.positions(robot)[0])
    apart = soles["right"][:2, 3] - soles["left"][:2, 3]
    assert apart == pytest.approx([0.1, -0.19], abs=2e-3)
    stance = plan("Tilt3").stance
    middle = (stance["left"][:2, 3] + stance["right"][:2, 3]) / 2
    ours, theirs = measured_balance(robot, log, soles=None), measured_balance(robot, log, stance)
    assert ours.zmp == pytest.approx(theirs.zmp - middle, abs=2e-3)


def test_a_sensor_that_reads_the_opposite_gives_the_same_point(log: MotionLog, tmp_path) -> None:
    file = hrp2.write(tmp_path)
    file.write_text(file.read_text().replace("name: right_foot", "name: right_foot\n      sign: -1"))
    flipped = {name: -values for name, values in log.columns.items() if name.startswith("wrench.right")}
    ours = measured_balance(load_robot(file), log.with_columns(flipped), soles=None)
    assert ours.zmp == pytest.approx(measured_balance(hrp2.robot(), log, soles=None).zmp)


def test_a_sensor_that_is_mounted_upside_down_gives_the_same_point(log: MotionLog) -> None:
    """Half a turn about its x axis: it reads the load along -z."""
    robot = hrp2.robot()
    right = robot.feet["right"]
    np.testing.assert_array_equal(right.wrench.placement.rpy, np.zeros(3))
    placed = replace(right.wrench.placement, rpy=np.array([np.pi, 0.0, 0.0]))
    turned = replace(right, wrench=replace(right.wrench, placement=placed))
    flipped = {
        name: -values
        for name, values in log.columns.items()
        if name.startswith(f"wrench.{right.wrench.name}.") and name[-1] in "yz"
    }
    ours = measured_balance(
        replace(robot, feet={**robot.feet, "right": turned}), log.with_columns(flipped), soles=None
    )
    assert ours.zmp == pytest.approx(measured_balance(robot, log, soles=None).zmp)
    assert set(ours.outlines) == {"left", "right"}


def test_a_robot_in_the_air_has_no_balance(log: MotionLog) -> None:
    empty = {name: 0 * values for name, values in log.columns.items() if name.startswith("wrench.")}
    with pytest.raises(DataError, match=r"^Tilt3: no foot carries the robot$"):
        measured_balance(hrp2.robot(), log.with_columns(empty), soles=None)


def test_what_is_less_than_a_twentieth_of_the_weight_carries_nobody(log: MotionLog) -> None:
    """10 N on each foot of a robot of some 50 kg: a sensor's zero, no load."""
    robot = hrp2.robot()
    twentieth = 0.05 * robot.mass * 9.80665
    for share, carries in ((10.0 / twentieth, False), (0.95, False), (1.05, True)):
        pressed = {
            name: np.full(len(log), share * twentieth) if name.endswith("force.z") else 0 * values
            for name, values in log.columns.items()
            if name.startswith("wrench.")
        }
        if carries:
            assert np.isfinite(measured_balance(robot, log.with_columns(pressed), soles=None).zmp).all()
        else:
            with pytest.raises(DataError, match=r"^Tilt3: no foot carries the robot$"):
                measured_balance(robot, log.with_columns(pressed), soles=None)


def test_polygons_are_apart_or_overlap_by_a_width() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert separation(square, square + [1.5, 0.3]) == pytest.approx(0.5)
    assert separation(square, square + [0.0, 0.9]) == pytest.approx(-0.1)
    bar = (square - 0.5) * [4.0, 0.2]
    assert separation(bar, bar[:, ::-1]) < 0  # a cross: no corner of either lies in the other

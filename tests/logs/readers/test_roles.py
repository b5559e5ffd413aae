"""Units of what a log holds: every one by its definition."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.errors import LogError
from plantar.logs.readers.roles import UNITS, factor, role_columns

KILOPOND = 9.80665  # N: a kilogramme's weight by definition
SI = {
    "time": {"s": 1, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "position": {"rad": 1, "deg": pi / 180, "m": 1, "mm": 1e-3},
    "velocity": {"rad/s": 1, "deg/s": pi / 180, "m/s": 1, "mm/s": 1e-3},
    "joint acceleration": {"rad/s^2": 1, "deg/s^2": pi / 180},
    "acceleration": {"m/s^2": 1, "g": 9.80665},
    "force": {"N": 1, "kN": 1000, "kgf": KILOPOND},
    "torque": {"N.m": 1, "N.mm": 1e-3, "kN.m": 1000, "kgf.cm": KILOPOND * 0.01},
    "ratio": {"1": 1},
}


def test_every_unit_is_what_its_definition_says() -> None:
    assert {unit for units in SI.values() for unit in units} == set(UNITS)
    for quantity, units in SI.items():
        for unit, size in units.items():
            assert factor(unit, quantity, "role", Path("a.csv")) == pytest.approx(size, rel=1e-12), unit
    for written in ("N·m", "Nm", " N.m "):
        assert factor(written, "torque", "role", Path("a.csv")) == 1


def test_a_unit_of_another_quantity_is_refused_with_those_that_fit() -> None:
    with pytest.raises(
        LogError,
        match=r"^robot\.yaml, value 'kgf': columns\.x: no such unit of torque \(valid: N\.m, N\.mm, "
        r"kN\.m, kgf\.cm\)$",
    ):
        factor("kgf", "torque", "columns.x", Path("robot.yaml"))


def test_a_whole_wrench_takes_no_unit_and_a_half_of_it_does() -> None:
    values = np.arange(1.0, 7.0)[None]
    for role in ("wrench.l", "wrench.l.torque_first"):
        with pytest.raises(LogError, match=r"value 'kN': wrench\.l.*have no unit in common"):
            role_columns(role, values, (), Path("a.log"), unit="kN")
    half = role_columns("wrench.l.force", values[:, :3], (), Path("a.log"), unit="kN")
    assert half["wrench.l.force.z"][0] == 3000


def test_roll_pitch_and_yaw_take_unit_and_sign() -> None:
    turned = role_columns(
        "imu.a.orientation.rpy", np.array([[-90.0, 0, 0]]), (), Path("a.log"), unit="deg", sign=-1.0
    )
    assert [turned[f"imu.a.orientation.{axis}"][0] for axis in "wx"] == pytest.approx([0.5**0.5] * 2)


def test_unit_and_sign_go_into_the_columns_in_their_order() -> None:
    values = np.arange(1.0, 7.0)[None]
    path = Path("a.log")
    moved = role_columns("joints.position", values[:, :2], ["a", "b"], path, unit="deg", sign=-1.0)
    assert {name: column[0] for name, column in moved.items()} == pytest.approx(
        {"joint.a.position": -pi / 180, "joint.b.position": -2 * pi / 180}
    )
    for role, force, torque in (
        ("wrench.l", (1, 2, 3), (4, 5, 6)),
        ("wrench.l.torque_first", (4, 5, 6), (1, 2, 3)),
    ):
        found = role_columns(role, values, (), path, sign=-1.0, unit=None)
        assert [found[f"wrench.l.force.{axis}"][0] for axis in "xyz"] == [-value for value in force]
        assert [found[f"wrench.l.torque.{axis}"][0] for axis in "xyz"] == [-value for value in torque]


def test_roll_pitch_and_yaw_together_are_turns_about_fixed_axes() -> None:
    """First about x, then about the world's y, then about its z, by a library's composition."""
    angles = np.random.default_rng(3).uniform(-1.4, 1.4, (20, 3))
    found = role_columns("imu.a.orientation.rpy", angles, (), Path("a.log"), unit=None)
    read = np.column_stack([found[f"imu.a.orientation.{axis}"] for axis in "xyzw"])
    np.testing.assert_allclose(
        Rotation.from_quat(read).as_matrix(), Rotation.from_euler("xyz", angles).as_matrix(), atol=1e-12
    )


def test_both_orders_of_a_quaternion_go_to_their_own_columns() -> None:
    values = np.array([[0.1, 0.2, 0.3, 0.4]])
    for order in ("wxyz", "xyzw"):
        found = role_columns(f"imu.a.orientation.{order}", values, (), Path("a.log"), unit=None)
        assert [found[f"imu.a.orientation.{axis}"][0] for axis in order] == values[0].tolist()


def test_a_vector_of_another_length_is_refused_with_both_lengths() -> None:
    for role, length in (("imu.a.angular_velocity", 3), ("wrench.l", 6), ("imu.a.orientation.wxyz", 4)):
        with pytest.raises(LogError, match=rf"the log has {length - 1} values a sample, not {length}"):
            role_columns(role, np.zeros((2, length - 1)), (), Path("a.log"), unit=None)
    with pytest.raises(
        LogError,
        match=r"^a\.log: joints\.position: the log has 3 values a sample, not 2 \(valid: "
        r"columns\.joints in the robot file, in the log's order\)$",
    ):
        role_columns("joints.position", np.zeros((2, 3)), ["a", "b"], Path("a.log"), unit=None)

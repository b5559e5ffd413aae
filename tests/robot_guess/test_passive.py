"""Axes of force sensors by the feet that push back: a robot that sways on springs while a hand pushes it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import Array
from plantar.robot_guess.biped import Limb
from plantar.robot_guess.feet import Sole
from plantar.robot_guess.imu import Mount
from plantar.robot_guess.passive import _squares, that_push_back
from plantar.robot_guess.seat import Seat
from plantar.robot_guess.stance import Stance

STIFFNESS, LOAD = 500.0, 400.0  # N.m/rad, N
COUNT = 400  # samples of two logs
SIDES = ("left", "right")
POSES = dict.fromkeys(SIDES, np.eye(4))
MOUNT = Mount("chest", np.eye(3), False, "")


def about(axis: int, degrees: float) -> Array:
    return np.asarray(pin.exp3(np.radians(degrees) * np.eye(3)[axis]))


def swaying(size: float, stiffness: float = STIFFNESS) -> Stance:
    """A robot of one rigid body, root axes those of its soles, that tilts by `size` [rad] on its two bushes."""
    random = np.random.default_rng(0)
    tilt = size * random.standard_normal((COUNT, 3)) * [1, 1, 0]
    up = np.array([pin.exp3(-one)[:, 2] for one in tilt])
    still = np.tile(np.eye(3), (COUNT, 1, 1))
    logs = np.repeat([0, 1], COUNT // 2)
    load = LOAD + 50 * random.standard_normal(COUNT)
    zeros = np.array([[3.0, -5.0, 0.0], [-8.0, 2.0, 0.0]])
    wrench = np.hstack([load[:, None] * up, -stiffness * tilt + 0.02 * load[:, None] + zeros[logs]])
    return Stance(
        rotations=dict.fromkeys(SIDES, still),
        places=dict.fromkeys(SIDES, np.zeros((COUNT, 3))),
        centre=np.zeros((COUNT, 3)),
        up=np.tile([0.0, 0.0, 1.0], (COUNT, 1)),
        loaded=dict.fromkeys(SIDES, np.ones(COUNT, dtype=bool)),
        wrenches=dict.fromkeys(SIDES, wrench),
        felt=up,
        carriers={"chest": np.tile(np.eye(4), (COUNT, 1, 1))},
        logs=logs,
    )


def seats(rotation: Array, sign: int = 1) -> dict[str, Seat]:
    return dict.fromkeys(SIDES, Seat("foot", np.zeros(3), rotation, "", True, 0.0, sign=sign))


SOLES = [
    Sole(
        Limb("foot", (), np.zeros(3), np.eye(3), side), np.eye(3), np.zeros((4, 2)), -0.1, 0.0, 0.0, "", True
    )
    for side in SIDES
]
RIGHT = seats(np.eye(3))
OPTIONS = [
    seats(about(2, 180)),
    RIGHT,
    seats(about(2, 90)),
    seats(about(2, -90)),
    seats(about(0, 180), sign=-1),
    seats(about(1, 180), sign=-1),
]


def test_only_axes_in_which_every_foot_pushes_back_are_left() -> None:
    (found,) = that_push_back(OPTIONS, SOLES, swaying(0.02), MOUNT, POSES)
    assert found is RIGHT


def test_the_tilt_is_seen_in_the_axes_of_the_imu() -> None:
    stance = swaying(0.02)
    assert stance.felt is not None
    turned = replace(stance, felt=stance.felt @ about(2, 180))
    (found,) = that_push_back(OPTIONS, SOLES, turned, replace(MOUNT, rotation=about(2, 180)), POSES)
    assert found is RIGHT
    (found,) = that_push_back(OPTIONS, SOLES, turned, MOUNT, POSES)
    assert found is OPTIONS[0]


@pytest.mark.parametrize("stance", [swaying(0.0), swaying(0.02, stiffness=0.0)])
def test_feet_that_do_not_give_tell_nothing(stance: Stance) -> None:
    assert that_push_back(OPTIONS, SOLES, stance, MOUNT, POSES) == OPTIONS


def test_without_an_imu_all_are_left() -> None:
    assert that_push_back(OPTIONS, SOLES, swaying(0.02), None, POSES) == OPTIONS
    assert that_push_back(OPTIONS, SOLES, replace(swaying(0.02), felt=None), MOUNT, POSES) == OPTIONS


def test_what_a_sensor_reads_is_moved_to_the_ankle() -> None:
    """From two metres above, where the leaning load turns the foot by more than its rubber holds."""
    stance, place = swaying(0.02), np.array([0.03, -0.04, 2.0])
    wrench = stance.wrenches["left"].copy()
    wrench[:, 3:] -= np.cross(place, wrench[:, :3])
    above = replace(stance, wrenches=dict.fromkeys(SIDES, wrench))
    options = [{side: replace(seat, xyz=place) for side, seat in seats.items()} for seats in OPTIONS]
    (found,) = that_push_back(options, SOLES, above, MOUNT, POSES)
    assert found is options[1]
    carried = {side: np.block([[np.eye(3), place[:, None]], [np.zeros(3), 1.0]]) for side in SIDES}
    (found,) = that_push_back(OPTIONS, SOLES, above, MOUNT, carried)
    assert found is RIGHT, "by the pose of its link"


def test_squares_within_logs_beside_the_load() -> None:
    """A log of 30 samples that follows its tilt with 2 N·m/rad, one of 20 with 7, each with a zero of its own.

    What the load explains is taken off both, and no stiffness is below zero.
    """
    random = np.random.default_rng(0)
    sizes, logs = (30, 20), np.repeat([4, 9], [30, 20])
    parts = [np.linalg.qr(random.standard_normal((size, 3)))[0] for size in sizes]
    parts = [
        np.linalg.qr(part - part.mean(axis=0))[0] for part in parts
    ]  # of no mean, square to each other, of size 1
    tilt, load, rest = (np.concatenate([part[:, k] for part in parts]) for k in range(3))
    stiffness, zero = np.array([2.0, 7.0])[(logs == 9).astype(int)], np.where(logs == 4, 100.0, -50.0)
    moment = stiffness * tilt + 3.0 * load + 0.5 * rest + zero
    signals = np.column_stack([moment, tilt + 0.2 * load, 600.0 + load])
    rows = np.ones(50, dtype=bool)
    before, after = _squares(signals, rows, logs)
    assert before == pytest.approx(2**2 + 7**2 + 2 * 0.5**2)
    mean = (2.0 + 7.0) / 2
    assert after == pytest.approx((2 - mean) ** 2 + (7 - mean) ** 2 + 2 * 0.5**2)
    signals[:, 1] *= -1
    assert _squares(signals, rows, logs) == pytest.approx((before, before))
    assert _squares(signals, logs == 4, logs) == pytest.approx((2**2 + 0.5**2, 2**2 + 0.5**2))
    assert _squares(signals, np.arange(50) < 19, logs) == (0.0, 0.0)

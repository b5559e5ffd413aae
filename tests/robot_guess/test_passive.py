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
from plantar.robot_guess.passive import that_push_back
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

"""How an IMU is turned on its link, by gravity and by how it tilts: right angles, the smallest turn, another link."""

from __future__ import annotations

import re

import numpy as np
import pytest

from plantar.conventions import Array, rotation_from_rpy
from plantar.robot_guess.imu import Mount, right_angles, turned_to_gravity
from plantar.robot_guess.stance import Stance

PHASES = np.arange(200) / 20.0
# A robot that tilts by 3 degrees about y and by 1.5 about x: up, seen from its links.
UP = np.column_stack([0.052 * np.sin(PHASES), 0.026 * np.cos(1.7 * PHASES), np.ones(200)])
TURNED = r"the first link; turned by right angles, as its tilts show \("
UP /= np.linalg.norm(UP, axis=1)[:, None]


def stance(felt: Array | None, up: Array = UP, **links: Array) -> Stance:
    """As an IMU feels it, on links that are turned so in the root (3, 3); the torso is not."""
    carriers = {}
    for link, turn in {"torso": np.eye(3), **links}.items():
        carriers[link] = np.tile(np.eye(4), (200, 1, 1))
        carriers[link][:, :3, :3] = turn
    return Stance({}, {}, np.zeros((200, 3)), up, {}, {}, felt, carriers, np.zeros(200, np.intp))


def mount(*others: str, guess: bool = True) -> Mount:
    return Mount("torso", np.eye(3), guess, "the first link", others, 0.1)


@pytest.mark.parametrize(
    ("rpy", "guess", "said"),
    [
        ((0, 0, 0), False, r"the first link; up by the IMU and by the soles are 0\.0 deg apart"),
        ((0, 0, 180), True, TURNED + r"as it is, tilts another way\)"),
        ((0, 0, 90), True, TURNED + r"as it is, tilts another way\)"),
        ((180, 0, 0), True, TURNED + r"as it is, 17\d\.\d deg off gravity\)"),
        ((0, 90, 90), True, TURNED + r"as it is, (?:89|90|91)\.\d deg off gravity\)"),
    ],
)
def test_an_imu_turned_by_right_angles(rpy: tuple[float, float, float], guess: bool, said: str) -> None:
    turn = rotation_from_rpy(np.radians(rpy))
    found = turned_to_gravity(mount(guess=False), stance(UP @ turn))
    np.testing.assert_allclose(found.rotation, turn, atol=1e-12)
    assert (found.guess, found.link, found.spread) == (guess, "torso", 0.1)
    assert re.fullmatch(said, found.reason)
    np.testing.assert_allclose(rotation_from_rpy(found.rpy), turn, atol=1e-9)


def test_a_robot_that_stands_still_shows_no_turn_about_the_vertical() -> None:
    """Upside down by the roll, the smaller turn among those that gravity allows."""
    still = np.tile([0.0, 0.0, 1.0], (200, 1))
    found = turned_to_gravity(mount(), stance(-still, still))
    np.testing.assert_allclose(found.rotation @ [0, 0, -1.0], [0, 0, 1.0], atol=1e-12)
    assert found.reason == (
        "the first link; turned by right angles, its turn about the vertical is not seen in the logs "
        "(as it is, 180.0 deg off gravity)"
    )
    given = mount()
    assert turned_to_gravity(given, stance(None)) is given, "without an accelerometer nothing is known"


def test_an_imu_that_is_turned_by_no_right_angle_gets_the_smallest_turn() -> None:
    turn = rotation_from_rpy(np.radians([30.0, 0.0, 0.0]))
    found = turned_to_gravity(mount(), stance(UP @ turn))
    assert found.reason == (
        "the first link; turned by 30 deg to agree with gravity, its turn about the vertical unknown"
    )
    usual, goal = np.median(UP @ turn, axis=0), np.median(UP, axis=0)
    np.testing.assert_allclose(found.rotation @ usual, goal, atol=1e-3)
    np.testing.assert_allclose(np.degrees(np.arccos((np.trace(found.rotation) - 1) / 2)), 30.0, atol=0.5)
    np.testing.assert_allclose(found.rotation @ found.rotation.T, np.eye(3), atol=1e-12)
    assert found.guess


def test_the_link_that_tilts_as_the_imu_does_is_taken_where_the_link_was_a_guess() -> None:
    """The IMU sits on the pelvis, which hangs by 10 degrees; the waist between them is like the torso."""
    hangs = rotation_from_rpy(np.radians([0.0, 10.0, 0.0]))
    made = stance(UP @ hangs, pelvis=hangs, waist=np.eye(3))
    found = turned_to_gravity(mount("waist", "pelvis"), made)
    assert (found.link, found.others) == ("pelvis", ())
    assert found.reason.endswith("; pelvis tilts as the IMU does, torso does not")
    sure = turned_to_gravity(mount("waist", "pelvis", guess=False), made)
    assert (sure.link, sure.others) == ("torso", ("waist", "pelvis"))
    slanted = rotation_from_rpy(np.radians([0.0, 4.0, 0.0]))
    hardly = turned_to_gravity(mount("pelvis"), stance(UP @ hangs, pelvis=slanted))
    assert (hardly.link, hardly.others) == ("torso", ("pelvis",)), (
        "six degrees are not clearly fewer than ten"
    )
    alike = turned_to_gravity(mount("waist", "pelvis"), stance(UP, pelvis=hangs, waist=np.eye(3)))
    assert (alike.link, alike.others) == ("torso", ("waist",)), "either may be meant"


def test_turns_by_right_angles_are_twenty_four_and_come_smallest_first() -> None:
    turns = right_angles()
    assert len({tuple(turn.ravel()) for turn in turns}) == 24
    np.testing.assert_array_equal(turns[0], np.eye(3))
    assert [round(float(np.trace(turn))) for turn in turns] == [3] + 6 * [1] + 8 * [0] + 9 * [-1]
    assert all(np.linalg.det(turn) == pytest.approx(1.0) for turn in turns)

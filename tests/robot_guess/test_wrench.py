"""Signs and axes of force sensors that a standing robot shows."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.robot_guess.seat import ORIGIN, Seat
from plantar.robot_guess.stance import Stance
from plantar.robot_guess.wrench import SOLE_AXES, _turned, moment_arms, seats_by_log

SIDES, SAMPLES = ("left", "right"), 60
DOWN = np.diag([1.0, -1.0, -1.0])  # the foot's axes in an ankle link whose z points down


def standing(reads: float, about_y: float = 0.0) -> Stance:
    """Two feet at rest, 0.2 m apart, 0.9 m under the centre of mass; each sensor `reads` a force along its z [N]."""
    wrench = np.tile([0.0, 0.0, reads, 0.0, about_y, 0.0], (SAMPLES, 1))
    return Stance(
        rotations={side: np.tile(DOWN.T, (SAMPLES, 1, 1)) for side in SIDES},
        places={
            side: np.tile([0.0, y, -0.9], (SAMPLES, 1)) for side, y in zip(SIDES, (0.1, -0.1), strict=True)
        },
        centre=np.zeros((SAMPLES, 3)),
        up=np.tile([0.0, 0.0, 1.0], (SAMPLES, 1)),
        loaded={side: np.ones(SAMPLES, dtype=bool) for side in SIDES},
        wrenches=dict.fromkeys(SIDES, wrench),
        felt=None,
        carriers={},
        logs=np.zeros(SAMPLES, dtype=np.intp),
    )


@pytest.mark.parametrize(("reads", "of_the_foot"), [(300.0, True), (-300.0, False)])
def test_of_axes_that_tell_the_same_those_without_a_turned_sign_are_taken(
    reads: float, of_the_foot: bool
) -> None:
    """The link's z points down: a sensor that reads a positive load reads in the foot's axes, with its sign."""
    seats = {
        side: Seat(side, np.zeros(3), np.eye(3), f"at the ankle's origin, in {ORIGIN}", True, 0.0, 0.05)
        for side in SIDES
    }
    soles = [
        SimpleNamespace(limb=SimpleNamespace(side=side, link=side), upright=DOWN, depth=-0.05)
        for side in SIDES
    ]
    poses = {side: np.eye(4) for side in SIDES}
    found, left = seats_by_log(seats, soles, standing(reads), None, poses)  # type: ignore[arg-type]
    for side in SIDES:
        assert found[side].sign == 1
        np.testing.assert_allclose(found[side].rotation, DOWN if of_the_foot else np.eye(3), atol=1e-12)
        assert ("the foot's axes" in found[side].reason) is of_the_foot
    assert left == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("given", [(), ("left",), ("left", "right")])
def test_axes_that_messages_give_keep_on_all_feet(given: tuple[str, ...]) -> None:
    """Only where all are guessed the foot's axes are tried; of the link's the reading points down."""
    seats = {
        side: Seat(side, np.zeros(3), np.eye(3), f"at the ankle's origin, in {ORIGIN}", side not in given, 0.0, 0.05)
        for side in SIDES
    }  # fmt: skip
    soles = [
        SimpleNamespace(limb=SimpleNamespace(side=side, link=side), upright=DOWN, depth=-0.05)
        for side in SIDES
    ]
    poses = {side: np.eye(4) for side in SIDES}
    found, _ = seats_by_log(seats, soles, standing(300.0), None, poses)  # type: ignore[arg-type]
    for side in SIDES:
        np.testing.assert_allclose(found[side].rotation, np.eye(3) if given else DOWN, atol=1e-12)
        assert found[side].sign == (-1 if given else 1)


def test_a_torque_of_the_feet_is_a_moment_arm_of_the_load() -> None:
    """3 N·m about y at each foot of 300 N: the load passes 1 cm beside the centre of mass."""
    seats = {side: Seat(side, np.zeros(3), DOWN, "", True, 0.0) for side in SIDES}
    arms = moment_arms(seats, standing(300.0, 3.0), {side: np.eye(4) for side in SIDES})
    np.testing.assert_allclose(arms, np.tile([0.0, 0.01, 0.0], (SAMPLES, 1)), atol=1e-12)


def test_axes_that_are_the_feets_are_seen_from_the_ankle() -> None:
    """An ankle that is turned in the world, on a foot whose axes are turned in it."""
    ankle, upright = (Rotation.from_rotvec(turn).as_matrix() for turn in ([0.2, -0.1, 0.4], [0.0, 0.0, 0.7]))
    pose = np.eye(4)
    pose[:3, :3] = ankle
    seat = Seat("left", np.zeros(3), np.eye(3), f"at the ankle's origin, in {ORIGIN}", True, 0.0, 0.05)
    sole = SimpleNamespace(upright=upright)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for turn, words in ((np.eye(3), SOLE_AXES), (quarter, "axes turned by right angles")):
        found = _turned({"left": seat}, {"left": sole}, {"left": pose}, turn)["left"]  # type: ignore[dict-item]
        np.testing.assert_allclose(ankle @ found.rotation, upright @ turn, atol=1e-12)
        assert found.reason == f"at the ankle's origin, in {words}"

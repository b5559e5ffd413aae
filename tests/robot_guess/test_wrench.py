"""Signs and axes of force sensors that a standing robot shows."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.robot_guess.seat import ORIGIN, Seat
from plantar.robot_guess.stance import Stance
from plantar.robot_guess.wrench import SOLE_AXES, _turned, _with_signs, moment_arms, seats_by_log

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


@pytest.mark.parametrize(("double", "taken"), [(25, 25), (19, SAMPLES)])
def test_moments_are_those_of_both_feet_where_they_stand_long_enough(double: int, taken: int) -> None:
    """Of a foot in the air nobody knows what the other one balances; better than nothing where there is no more."""
    stance = standing(300.0, 3.0)
    loaded = {"left": np.ones(SAMPLES, dtype=bool), "right": np.arange(SAMPLES) < double}
    seats = {side: Seat(side, np.zeros(3), DOWN, "", True, 0.0) for side in SIDES}
    arms = moment_arms(seats, replace(stance, loaded=loaded), {side: np.eye(4) for side in SIDES})
    assert arms.shape == (taken, 3)


@pytest.mark.parametrize("reads", [300.0, -300.0])
def test_axes_that_messages_give_may_lean_and_guessed_ones_may_not(reads: float) -> None:
    """By 40 degrees from up; a foot that never carries keeps its sign."""
    lean = DOWN @ Rotation.from_euler("y", 40, degrees=True).as_matrix()
    stance = standing(reads)
    soles = [SimpleNamespace(limb=SimpleNamespace(side=side), upright=DOWN) for side in SIDES]
    poses = {side: np.eye(4) for side in SIDES}
    given, guessed = (
        {side: Seat(side, np.zeros(3), lean, "", guess, 0.0, sign=-1) for side in SIDES}
        for guess in (False, True)
    )
    found = _with_signs(given, soles, stance, poses)  # type: ignore[arg-type]
    assert found is not None
    assert {seat.sign for seat in found.values()} == {1 if reads > 0 else -1}
    assert _with_signs(guessed, soles, stance, poses) is None  # type: ignore[arg-type]
    air = replace(stance, loaded={**stance.loaded, "left": np.zeros(SAMPLES, dtype=bool)})
    found = _with_signs(given, soles, air, poses)  # type: ignore[arg-type]
    assert found is not None
    assert (found["left"].sign, found["right"].sign) == (-1, 1 if reads > 0 else -1)


@pytest.mark.parametrize(("sway", "turned"), [(0.02, True), (0.008, False)])
def test_other_axes_are_believed_where_they_halve_a_change_of_a_centimetre(sway: float, turned: bool) -> None:
    """The centre of mass sways forward; torques about y hold it, which these sensors call x."""
    load, wave = 300.0, sway * np.sin(2 * np.pi * np.arange(SAMPLES) / SAMPLES)
    wrench = np.zeros((SAMPLES, 6))
    wrench[:, 2], wrench[:, 3] = load, -load * wave
    stance = replace(
        standing(load),
        rotations=dict.fromkeys(SIDES, np.tile(np.eye(3), (SAMPLES, 1, 1))),
        centre=np.column_stack([wave, 0 * wave, 0 * wave]),
        wrenches=dict.fromkeys(SIDES, wrench),
    )
    seats = {
        side: Seat(side, np.zeros(3), np.eye(3), f"at the ankle's origin, in {ORIGIN}", True, 0.0)
        for side in SIDES
    }
    soles = [SimpleNamespace(limb=SimpleNamespace(side=side), upright=np.eye(3)) for side in SIDES]
    found, left = seats_by_log(seats, soles, stance, None, dict.fromkeys(SIDES, np.eye(4)))  # type: ignore[arg-type]
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for side in SIDES:
        np.testing.assert_allclose(found[side].rotation, quarter if turned else np.eye(3), atol=1e-12)
    assert (left < 1e-12) is turned

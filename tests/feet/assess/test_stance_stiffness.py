"""Stiffness by stance and by walk: right where the truth is known, apart where one walk differs, none without steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from plantar.contact.stances import Stances
from plantar.feet.assess.stance_stiffness import stance_stiffness, walk_stiffness
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording, Role, filtered_recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.settings import FeetSettings
from plantar.robot.model import RobotModel

LAW = TRUTH["left", "pitch"]
STANCE = 1.5  # s
JUMPS = 4.0  # N·m, deviation of the stances' offsets


def walked(robot: RobotModel, seed: int, role: Role = "fit", stiffer: float = 0.0) -> Recording:
    """A sway cut into stances of the left foot, each with an offset of its own; `stiffer` [N·m/rad] adds to its K."""
    log = record(sway(f"walk_{seed}", seed, duration=12.0))
    recording = filtered_recording(prepare(robot, checked(robot, log), role), 5.0)
    number = (recording.time // STANCE).astype(np.intp)
    jumps = JUMPS * np.random.default_rng(seed).normal(size=number.max() + 1)[number]
    bush = recording.bushes["left"]
    torque = bush.torque + np.column_stack([jumps + stiffer * bush.deflection[:, 0], 0 * jumps])
    weight = 0.5 + 0.4 * np.sin(np.pi * recording.time / STANCE) ** 2
    return replace(
        recording,
        bushes={**recording.bushes, "left": replace(bush, torque=torque)},
        stances={"left": Stances(number, weight), "right": None},
    )


def fitted(recordings: Sequence[Recording]) -> AxisFit:
    fits = [recording for recording in recordings if recording.role == "fit"]
    found = fit_axis(fits, "left", "pitch", FeetSettings(model="kelvin_voigt"))
    assert found is not None
    return found


@pytest.fixture(scope="module")
def walks(robot: RobotModel) -> list[Recording]:
    return [walked(robot, 1), walked(robot, 2), walked(robot, 3, "validate", stiffer=60.0)]


def test_each_stance_tells_the_stiffness_whatever_its_offset(walks: list[Recording]) -> None:
    fit = fitted(walks)
    rows = stance_stiffness(walks, fit)
    assert [sum(row.motion == f"walk_{k}" for row in rows) for k in (1, 2, 3)] == [8, 8, 8]
    seen = [row for row in rows if row.role == "fit"]
    assert np.median([row.stiffness for row in seen]) == pytest.approx(LAW.stiffness, rel=0.02)
    assert all(0.0 < row.end - row.start < STANCE for row in rows)
    assert sum(row.share for row in seen) == pytest.approx(1.0)
    together = sum(row.share * row.stiffness for row in seen)
    assert together == pytest.approx(fit.values[0], rel=0.01)


def test_a_stance_that_hardly_moves_says_little(walks: list[Recording]) -> None:
    bush = walks[0].bushes["left"]
    still = np.where(walks[0].time[:, None] < STANCE, 0.1, 1.0)
    calm = replace(
        walks[0], bushes={**walks[0].bushes, "left": replace(bush, deflection=still * bush.deflection)}
    )
    before, after = (stance_stiffness([one, walks[1]], fitted(walks)) for one in (walks[0], calm))
    assert after[0].share < 0.02 * before[0].share


def test_a_walk_alone_tells_its_own_stiffness_and_how_well(walks: list[Recording]) -> None:
    rows = walk_stiffness(walks, fitted(walks))
    assert [(row.motion, row.role, row.stances) for row in rows] == [
        ("walk_1", "fit", 8), ("walk_2", "fit", 8), ("walk_3", "validate", 8),
    ]  # fmt: skip
    for row, extra in zip(rows, (0.0, 0.0, 60.0), strict=True):
        assert row.stiffness == pytest.approx(LAW.stiffness + extra, rel=0.02)
        low, high = row.interval95
        assert low < row.stiffness < high
        assert high - low < 0.1 * row.stiffness


def test_what_noise_of_the_angle_takes_off_a_walk_is_given_back(walks: list[Recording]) -> None:
    """At least by the share of the angle's square within stances that is noise; other columns explain some of it."""
    walk = walks[0]
    angle, number = walk.bushes["left"].deflection[:, 0], (walk.time // STANCE).astype(np.intp)
    means = np.bincount(number, angle) / np.bincount(number)
    noise = 0.02 * float(np.mean((angle - means[number]) ** 2))
    told = replace(walk, noise={**walk.noise, "left": np.array([[noise, noise], [0.0, 0.0]])})
    plain = replace(walk, noise={**walk.noise, "left": np.zeros((2, 2))})
    (without,), (given,) = (walk_stiffness([one], fitted([plain])) for one in (plain, told))
    assert given.stiffness > without.stiffness / (1 - 0.02)
    assert given.stiffness < 2.0 * without.stiffness


def test_a_foot_that_stands_has_neither(robot: RobotModel, walks: list[Recording]) -> None:
    standing = [replace(walk, stances={"left": None, "right": None}) for walk in walks]
    fit = fitted(standing)
    assert stance_stiffness(standing, fit) == []
    assert walk_stiffness(standing, fit) == []


def test_two_stances_are_no_walk(walks: list[Recording]) -> None:
    number = (walks[0].time > 6.0).astype(np.intp)
    two = replace(walks[0], stances={"left": Stances(number, np.ones(len(number))), "right": None})
    fit = fitted(walks)
    assert walk_stiffness([two], fit) == []
    assert len(stance_stiffness([two], fit)) == 2

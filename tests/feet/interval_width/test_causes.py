"""The size of what no residual shows, by hand: how far a unit of it moves a number, times how little is known of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import special

from biped import WEIGHT, bush_force, deflection, deflection_rate, record, sway, times
from biped_robot import AS_USUAL, FEET
from feet_trials import AXES, LINEAR, codes, noisy
from plantar.estimation.slow_drift import drift_basis
from plantar.feet.identify import identify_feet
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel

Torque = Callable[[np.ndarray, np.ndarray], np.ndarray]  # of pitch (N,) and of the force at the bush (N, 3)

SOFT_RUBBER = 1e-5  # m/N: deviation of a vertical compliance that no log shows
FEWEST_COSINES = 4  # of a recording of 20 s: degrees of freedom of its own deviations
# No weight moves: the vertical compliance stays unknown.
MOTIONS = [sway(name, seed, shift=0.0) for seed, name in enumerate(("first", "second"), 5)]


@pytest.fixture(scope="module")
def found(robot: RobotModel) -> FeetResult:
    logs = [noisy(record(motion), seed) for seed, motion in enumerate(MOTIONS)]
    return identify_feet(robot, logs, settings=LINEAR)


@pytest.fixture(scope="module")
def alone(robot: RobotModel) -> FeetResult:
    return identify_feet(robot, [noisy(record(MOTIONS[0]), 0)], settings=LINEAR)


def limits(result: FeetResult) -> dict[tuple[str, str, str], dict[str, Any]]:
    """What is said of each parameter's causes."""
    return {(row["foot"], row["axis"], row["name"]): row for row in result.to_dict()["diagnosis"]}


def added(result: FeetResult, foot: str, axis: str, name: str, cause: str) -> float:
    """The deviation that one cause adds to a parameter."""
    shares = limits(result)[foot, axis, name]["variance_shares"]
    return float(np.sqrt(shares[cause]) * result.parameter(foot, axis, name).std)


def effects(axis: str, foot: str, torque: Torque) -> list[np.ndarray]:
    """How far K and C of both motions together move, (2,), when one motion's torque changes so: one for each motion.

    Dense least squares, each motion's own offset and slow drift beside deflection and rate.
    """
    designs, changes = [], []
    for place, motion in enumerate(MOTIONS):
        t = times(motion)
        t = t[(t > 0.3) & (t < motion.duration - 0.3)]
        both = (deflection(motion, AS_USUAL, foot, t), deflection_rate(motion, AS_USUAL, foot, t))
        slow = np.column_stack([np.ones(len(t)), drift_basis(t)])
        own = np.zeros((len(t), slow.shape[1] * len(MOTIONS)))
        own[:, place * slow.shape[1] : (place + 1) * slow.shape[1]] = slow
        designs.append(np.column_stack([*(one[:, AXES.index(axis)] for one in both), own]))
        changes.append(torque(both[0][:, 0], bush_force(motion, AS_USUAL, foot, t)))
    found = []
    for place in range(len(MOTIONS)):
        response = np.concatenate([one if k == place else 0 * one for k, one in enumerate(changes)])
        found.append(np.linalg.lstsq(np.vstack(designs), response, rcond=None)[0][:2])
    return found


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("foot", FEET)
def test_an_unknown_vertical_compliance_widens_by_what_its_moment_arm_moves(
    found: FeetResult, foot: str, axis: str
) -> None:
    """A slide compressed by c·Fz moves the centre up by as much, and the horizontal force turns about it."""

    def moment(pitch: np.ndarray, force: np.ndarray) -> np.ndarray:
        x, y, z = force.T
        return -z * x if axis == "pitch" else np.cos(pitch) * z * y

    assert "z_unknown" in codes(found)
    expected = SOFT_RUBBER * np.abs(np.sum(effects(axis, foot, moment), axis=0))
    assert expected[0] == pytest.approx(SOFT_RUBBER * (WEIGHT / 2) ** 2, rel=0.3), (
        "c·Fz² of stiffness, roughly"
    )
    assert added(found, foot, axis, "stiffness", "moment arm") == pytest.approx(expected[0], rel=0.05)


@pytest.mark.parametrize("foot", FEET)
def test_the_zero_of_the_yaw_torque_widens_roll_by_no_more_than_the_others_zeros(
    found: FeetResult, foot: str
) -> None:
    """Roll's torque is cos(pitch)·τx - sin(pitch)·τz, and τz's zero at most as large as the other torques', in each
    log; here the motions show it to be smaller."""
    zeros = [row.value for row in found.offsets if (row.foot, row.axis) == (foot, "roll")]
    assert len(zeros) == len(MOTIONS)
    each = effects("roll", foot, lambda pitch, _: np.sin(pitch))
    expected = np.sqrt(np.mean(np.square(zeros))) * np.linalg.norm(each, axis=0)
    for place, name in enumerate(("stiffness", "damping")):
        size = added(found, foot, "roll", name, "yaw torque zero")
        assert 0 < size < 0.6 * expected[place]
        assert "yaw torque zero" not in limits(found)[foot, "pitch", name]["variance_shares"]


def test_variances_add_up(found: FeetResult) -> None:
    rows = limits(found)
    assert len(rows) == 8
    for row in rows.values():
        assert sum(row["variance_shares"].values()) == pytest.approx(1.0, abs=1e-6)


def test_causes_of_known_size_add_degrees_of_freedom(alone: FeetResult) -> None:
    """Welch and Satterthwaite: where noise, of few degrees of freedom, has a share s of the variance, ν / s²."""
    ratios = []
    for (foot, axis, name), row in limits(alone).items():
        parameter = alone.parameter(foot, axis, name)
        own = [
            row["variance_shares"][cause] for cause in ("noise", "model") if cause in row["variance_shares"]
        ]
        freedom = FEWEST_COSINES / own[0] ** 2
        low, high = parameter.interval95
        assert (high - low) / 2 / parameter.std == pytest.approx(special.stdtrit(freedom, 0.975), rel=1e-3)
        ratios.append((high - low) / 2 / parameter.std)
    assert min(ratios) < 2.1 < 2.7 < max(ratios), "some rows live on noise alone, some on what is known"

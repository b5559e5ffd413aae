"""What force sensors' errors make of the load is told from pushes and delays, and taken off Newton's law."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.load_errors import FootLoads, _prior, load_errors
from plantar.sensors.newton_sides import NewtonSides, longest_closed, moving
from plantar.signals.filters import differentiate, low_pass

PERIOD, COUNT, WEIGHT = 0.025, 1200, 900.0
UPRIGHT = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])


def sides(
    errors: Array, push: float = 0.0, late: float = 0.0, steps: float = 0.45
) -> tuple[NewtonSides, Array]:
    """A robot that steps from foot to foot once a second, with the share `steps` of its weight, and its trunk's motion.

    Feet read `errors` (2, 6) of their load, all `late` [s]; somebody pushes by `push` [N] sideways, which shifts the
    load as well.
    """
    random, time = np.random.default_rng(0), PERIOD * np.arange(COUNT)
    trunk = low_pass(random.standard_normal((COUNT, 6)) * 200, PERIOD, 1.5)
    pushed = push * low_pass((np.sin(0.9 * time) > 0.8).astype(float)[:, None], PERIOD, 2.0)[:, 0]
    share = (
        low_pass((np.sin(np.pi * time) > 0)[:, None] * 0.9 + 0.05, PERIOD, 4.0)[:, 0] + 4 * pushed / WEIGHT
    )
    feet = []
    for part in (share, 1 - share):
        wrench = trunk / 2
        wrench[:, 1] += pushed / 2
        wrench[:, 2] += part * WEIGHT
        feet.append(wrench)
    true = np.array(feet)
    read = true + np.linalg.norm(true[..., :3], axis=2)[..., None] * errors[:, None]
    changes = np.array([differentiate(one, PERIOD) for one in read])
    read = read - late * changes
    rows = FootLoads.of(*(np.hstack([*each]) for each in (read, changes)))
    transfers = [np.tile(np.eye(6), (COUNT, 1, 1))] * 2
    predicted = moving([trunk], PERIOD, BAND)[0]
    return NewtonSides(rows, transfers, predicted, np.zeros_like(trunk), PERIOD, BAND), true


BAND = (0.05, np.inf)  # Hz
TURNED = np.array([[0.015, -0.02, 0.004, 0.003, 0.0, -0.002], [-0.01, 0.018, -0.006, 0.0, 0.004, 0.001]])


@pytest.mark.parametrize("late", [0.0, 0.02])
def test_turned_sensors_that_are_late_close(late: float) -> None:
    """Without that their steps would pass for pushes: half of the forces would be missing."""
    found = sides(TURNED, late=late)[0].closed(Uncertainty(), "walk", 300)
    assert found is not None
    assert found.calm.stop - found.calm.start > 0.9 * COUNT
    pair = found.pair
    missing = pair.measured - pair.predicted + late * pair.rate
    assert np.std(missing[100:-100, :2]) < 0.1 * np.std(pair.predicted[:, :2])


def test_errors_are_found_as_they_are() -> None:
    """What both feet read alike of a weight that does not change passes for a zero's drift, and stays."""
    law = sides(TURNED)[0]
    loads = law.loads
    columns = np.array([moving([*one], PERIOD, BAND) for one in loads.columns(law.transfers)])
    measured = moving([loads.readings.reshape(COUNT, 2, 6).sum(axis=1)], PERIOD, BAND)[0]
    found = load_errors(Uncertainty(), UPRIGHT, columns, [0 * measured], measured - law.predicted, PERIOD)
    np.testing.assert_allclose(found[0] - found[1], TURNED[0] - TURNED[1], atol=1e-4)


def test_a_push_that_shifts_the_load_is_no_sensors_error() -> None:
    """A push of 100 N shifts 400 N from foot to foot: no honest sensor turns so far as to make one of the other."""
    found = sides(np.zeros((2, 6)), push=100.0, steps=0.0)[0].closed(Uncertainty(), "pushed", 1)
    assert found is not None
    assert found.calm.stop - found.calm.start < 7.0 / PERIOD, "somebody pushes every seven seconds"
    assert np.abs(found.taken[:, 1]).max() < 30.0


def test_without_errors_nothing_is_taken() -> None:
    found = sides(np.zeros((2, 6)))[0].closed(Uncertainty(), "walk", 300)
    assert found is not None
    assert np.abs(found.taken).max() < 1e-6 * WEIGHT


def test_loads_and_their_changes_belong_together() -> None:
    """The size of a force and its derivative, whatever the sensor's axes."""
    law, true = sides(np.zeros((2, 6)))
    loads = law.loads
    np.testing.assert_allclose(loads.loads, np.linalg.norm(true[..., :3], axis=2).T, rtol=1e-12)
    standing = loads.loads[2:-2] > 0.3 * WEIGHT
    slopes = differentiate(loads.loads, PERIOD)[2:-2]
    np.testing.assert_allclose(
        loads.steps[2:-2][standing], slopes[standing], atol=0.02 * np.abs(slopes).max()
    )
    np.testing.assert_allclose(loads.directions, UPRIGHT, atol=0.05)
    np.testing.assert_array_equal(loads.changes_without(np.zeros((2, 6))), loads.changes)
    left = loads.changes_without(np.eye(2, 6)).reshape(COUNT, 2, 6)
    np.testing.assert_allclose(loads.changes.reshape(COUNT, 2, 6)[:, 0, 0] - left[:, 0, 0], loads.steps[:, 0])


def test_what_a_robot_file_allows_is_a_gain_along_the_load_and_a_turn_across_it() -> None:
    """By hand: a gain of 10 %, crosstalk of 2 %, a mount turned by 0.02 rad; torques from crosstalk alone."""
    uncertainty = Uncertainty(wrench_gain=0.1, wrench_crosstalk=0.02)
    along = np.array([0.6, 0.0, 0.8])
    across = np.array([0.8, 0.0, -0.6])
    allowed = _prior(uncertainty, along)
    assert along @ allowed[:3, :3] @ along == pytest.approx(0.1**2)
    assert across @ allowed[:3, :3] @ across == pytest.approx(0.02**2 + 0.02**2)
    assert along @ allowed[:3, :3] @ across == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(allowed[3:, 3:], 0.02**2 * np.eye(3))
    assert not allowed[:3, 3:].any()


def test_what_calm_seconds_miss_is_compared_with_what_is_usual() -> None:
    """A robot that hardly moves for 14 of 30 s: what is missed there is small, if not beside what moves."""
    random, calm = np.random.default_rng(4), np.arange(COUNT) >= 640
    predicted = random.standard_normal((COUNT, 6)) * np.where(calm, 1.0, 100.0)[:, None]
    missed = random.standard_normal((COUNT, 6)) * np.where(calm, 1.0, 10.0)[:, None]
    still = np.zeros_like(predicted)
    assert longest_closed(predicted + missed, still, predicted, PERIOD) == slice(0, COUNT)
    missed[320:400] *= 5.0  # 2 s in which half of the force is not explained
    assert longest_closed(predicted + missed, still, predicted, PERIOD) == slice(400, COUNT)

"""A place that is free to be another: its prior against a joint least squares, and what recordings then differ by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from feet_trials import LINEAR, noisy
from plantar.estimation import Block, fit_blocks
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width.between_recordings import axis_differences
from plantar.feet.place.freed_place import FreedPlace
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.prepare import prepare_all
from plantar.feet.regression.regression_data import tangent_blocks
from plantar.robot.model import RobotModel

SPREAD = PlaceSpread(0.003, 0.003, 0.01)


def test_a_place_is_drawn_to_the_files_by_a_deviation_each() -> None:
    """Two numbers and one of the place, that is three deviations away in the data and none in the file."""
    random = np.random.default_rng(0)
    columns = random.standard_normal((500, 3))
    columns[:, 2] += 0.7 * columns[:, 0]
    response = columns @ [5.0, 2.0, 3.0] + 20.0 * random.standard_normal(500)
    fit = fit_blocks([Block("one", columns, response, 0.01)])
    values, covariance = FreedPlace([columns[:, 2:]], np.array([-0.5])).drawn(fit)
    information = np.linalg.inv(fit.covariance[:3, :3])
    prior = np.diag([0.0, 0.0, 1.0])
    expected = np.linalg.solve(information + prior, information @ fit.values + prior @ [0.0, 0.0, -0.5])
    np.testing.assert_allclose(values, expected)
    np.testing.assert_allclose(covariance, np.linalg.inv(information + prior))


def test_a_fit_that_cannot_tell_the_place_stays_as_it_is() -> None:
    fit = fit_blocks([Block("one", np.eye(50)[:, :3], np.arange(50.0), 0.01)])
    blurred = replace(fit, condition_number=1e7)
    values, covariance = FreedPlace([np.zeros((50, 1))], np.array([2.0])).drawn(blurred)
    np.testing.assert_array_equal(values, fit.values)
    np.testing.assert_array_equal(covariance, fit.covariance[:3, :3])


def test_the_file_is_as_far_from_the_fit_as_the_fit_moved(robot: RobotModel) -> None:
    ready = prepare_all(robot, [record(sway("sway_3", 3))], [], LINEAR, lambda _: None)
    fit = fit_axis(ready.fitted, "left", "pitch", LINEAR)
    assert fit is not None
    fit = replace(fit, moment_arms=(0.006, -0.003), turned=0.02)
    blocks = tangent_blocks(ready.fitted, fit)
    place = FreedPlace.of(fit, ready.fitted, blocks, replace(SPREAD, height=0.003))
    assert len(place.file) == place.torques[0].shape[1] > 2
    # Aside by two deviations, lower by one where the other axis expects one more, turned by two.
    assert {round(float(each), 6) for each in place.file} <= {-2.0, 2.0, 0.0}
    assert place.torques[0].shape[0] == len(blocks[0].response)


def test_a_place_that_is_wrong_does_not_blur_what_recordings_differ_by(robot: RobotModel) -> None:
    """Of two recordings the second is 4 % stiffer; the fit has the sensor turned and the bush too high."""
    logs = []
    for seed, own in enumerate((0.0, 0.04), 3):
        truth = {key: replace(law, stiffness=(1 + own) * law.stiffness) for key, law in TRUTH.items()}
        logs.append(noisy(record(sway(f"sway_{seed}", seed, truth=truth)), seed))
    ready = prepare_all(robot, logs, [], LINEAR, lambda _: None)
    fit = fit_axis(ready.fitted, "left", "pitch", LINEAR)
    assert fit is not None
    turned = replace(fit, turned=0.02, moment_arms=(0.0, 0.01))
    held, freed = (axis_differences(turned, ready.fitted, False, place) for place in (None, SPREAD))
    assert held is not None
    assert freed is not None
    assert freed.differences.shares[0] == pytest.approx(0.04, abs=0.004)
    assert freed.differences.resolution < 0.3 * held.differences.resolution

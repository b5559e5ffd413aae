"""Deviations of a regularised fit, and the scores beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import small_biped
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.whole_body.covariance import uncertainty
from plantar.whole_body.dataset import Body, prepare_whole
from plantar.whole_body.equations import Calibration, inertial_samples
from plantar.whole_body.folds import Samples
from plantar.whole_body.inertia import identify_inertia
from plantar.whole_body.regularised_fit import RegularisedFit, RegularisedProblem
from plantar.whole_body.settings import DynamicsSettings


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return small_biped.robot(tmp_path_factory.mktemp("biped"))


@pytest.fixture(scope="module")
def log(robot: RobotModel) -> MotionLog:
    """Of a robot that is as its URDF says, with 0.5 N of noise."""
    return small_biped.record(robot, robot.floating_model, "one", 1, 15.0, 0.5)


@pytest.fixture(scope="module")
def samples(robot: RobotModel, log: MotionLog) -> Samples:
    body = Body.of(robot, floating=True)
    return inertial_samples(body, prepare_whole(body, log, DynamicsSettings()), Calibration(np.eye(3)))


@pytest.fixture(scope="module")
def fit(robot: RobotModel, samples: Samples) -> RegularisedFit:
    body = Body.of(robot, floating=True)
    return RegularisedProblem.of(body.equation, body.base, body.prior, [samples]).solve()


@pytest.mark.parametrize("unit", [1e-3, 20.0])
def test_deviations_do_not_depend_on_the_weights_unit(
    fit: RegularisedFit, samples: Samples, unit: float
) -> None:
    """All weights times u and the regularisation times u² is the same problem."""
    same = replace(
        fit,
        weights={row: unit * weight for row, weight in fit.weights.items()},
        regularisation=unit**2 * fit.regularisation,
        triangle=unit * fit.triangle,
    )
    expected, found = uncertainty(fit, [samples]), uncertainty(same, [samples])
    assert (expected.base > 0).all()
    np.testing.assert_allclose(found.base, expected.base, rtol=1e-4)
    assert found.freedom == expected.freedom


def test_a_larger_regularisation_is_not_taken_for_knowledge(fit: RegularisedFit, samples: Samples) -> None:
    """A fit held at a wrong CAD by force shows little of the truth: what it says of its error must not vanish."""
    weak, strong = (
        uncertainty(replace(fit, regularisation=factor * fit.regularisation), [samples])
        for factor in (1.0, 100.0)
    )
    assert np.median(strong.base / weak.base) > 0.3


def test_the_cad_is_scored_against_what_was_measured(robot: RobotModel, log: MotionLog) -> None:
    """The CAD is right here: it misses what the sensors' noise is, as the fit does."""
    found = identify_inertia(robot, [log])
    table = found.residuals.to_pydict()
    for row in found.validation:
        missed = np.array(table[f"{row.axis}.measured"]) - np.array(table[f"{row.axis}.predicted"])
        assert row.rms_error == pytest.approx(np.sqrt(np.mean(missed**2)), rel=1e-9)
        assert row.cad_rms_error == pytest.approx(row.rms_error, rel=0.2)


def test_recordings_add_up(fit: RegularisedFit, samples: Samples) -> None:
    """The same one twice: twice the variance of the scores, and twice the cosines that it rests on."""
    once, twice = (uncertainty(fit, [samples] * count) for count in (1, 2))
    assert twice.freedom == 2 * once.freedom
    assert (twice.base >= once.base).all()
    assert (twice.base <= np.sqrt(2) * once.base * (1 + 1e-9)).all()
    assert (twice.base > 1.1 * once.base).any()

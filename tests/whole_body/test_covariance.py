"""Deviations of a regularised fit, and the scores beside it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import small_biped
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.whole_body import covariance as room
from plantar.whole_body.covariance import score_covariance, uncertainty, uncertainty_from
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


def made_fit(sizes: list[float], apart: np.ndarray, regularisation: float) -> RegularisedFit:
    """Independent numbers without noise, known with `sizes`, of a robot that is `apart` from its CAD at 0."""
    square = np.square(sizes)
    return SimpleNamespace(  # type: ignore[return-value]
        base=Grouping(len(sizes)),
        prior=SimpleNamespace(cad=np.zeros(len(sizes)), spread=np.eye(len(sizes))),
        inertial=square * apart / (square + regularisation),
        extras={},
        regularisation=regularisation,
        triangle=np.column_stack([np.diag(sizes), np.array(sizes) * apart]),
    )


class Grouping(list[int]):
    """Base parameters that are the parameters themselves."""

    def __init__(self, size: int) -> None:
        super().__init__(range(size))
        self.grouping = np.eye(size)


@pytest.mark.parametrize("regularisation", [1.0, 25.0])
def test_what_the_data_decide_says_how_far_the_rest_may_be_from_the_cad(regularisation: float) -> None:
    """Of four numbers the logs show two: the others are as unsure as those two are from the CAD, root mean square."""
    apart = np.array([3.0, -4.0, 0.5, 0.25])
    fit = made_fit([1e3, 1e3, 1e-3, 1e-3], apart, regularisation)
    trust = uncertainty_from(fit, [(np.zeros((4, 4)), 3.0), (np.zeros((4, 4)), 4.0)])
    assert trust.base[2:] == pytest.approx(np.full(2, np.sqrt((3.0**2 + 4.0**2) / 2)), rel=1e-3)
    assert trust.base[:2] == pytest.approx(trust.base[2:] * regularisation / (1e6 + regularisation), rel=1e-3)
    assert trust.freedom == 7.0


def test_scatter_of_the_scores_goes_through_the_inverse_twice() -> None:
    fit = made_fit([2.0, 4.0], np.zeros(2), 1.0)
    trust = uncertainty_from(fit, [(np.diag([9.0, 16.0]), 3.0), (np.diag([16.0, 9.0]), 4.0)])
    assert trust.base == pytest.approx([5.0 / (4 + 1), 5.0 / (16 + 1)]), (
        "deviations of sums add up in squares"
    )


class Instants(list[float]):
    """A motion of which nothing is known but which samples it has."""

    def select(self, rows: slice) -> Instants:
        return Instants(self[rows])


def test_scores_are_weighted_columns_times_residuals(monkeypatch: pytest.MonkeyPatch) -> None:
    """A row of the base and one of a joint that has two terms of its own; three samples, two at a time."""
    monkeypatch.setattr(room, "CHUNK", 2)
    monkeypatch.setattr(room, "cosine_covariance", lambda scores, seconds: (scores, seconds))
    base = Grouping(2)
    base.masks = "masks"  # type: ignore[attr-defined]
    columns = {
        0: np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
        7: np.array([[10.0, 20.0, 30.0], [0.0, 1.0, -1.0]]),
    }

    def regressor(motion: Instants, masks: str) -> dict[int, np.ndarray]:
        assert masks == "masks"
        return {row: values[:, [int(time) for time in motion]] for row, values in columns.items()}

    fit = SimpleNamespace(
        base=base,
        extras={7: np.zeros(2)},
        weights={0: 2.0, 7: 0.5},
        equation=SimpleNamespace(regressor=regressor),
        predict=lambda samples: {0: np.array([1.0, 1.0, 1.0]), 7: np.array([0.0, 4.0, 0.0])},
    )
    measured = {
        0: np.array([2.0, 0.0, 4.0]),
        7: np.array([8.0, 0.0, 4.0]),
    }  # misses by 1, -1, 3 and by 8, -4, 4
    own = {7: (np.array([1.0, 1.0, 1.0]), np.array([-2.0, 3.0, 5.0]))}
    samples = Samples("a", np.arange(3.0), Instants([0.0, 1.0, 2.0]), measured, own, 0.25)  # type: ignore[arg-type]
    scores, seconds = score_covariance(fit, samples)  # type: ignore[arg-type]
    assert seconds == 0.75  # type: ignore[comparison-overlap]
    assert scores.tolist() == [
        [4 * 1.0 + 10 * 2.0, 4 * 4.0 + 0.0, 2.0, -2 * 2.0],
        [-4 * 2.0 - 20 * 1.0, -4 * 5.0 - 1.0, -1.0, 3 * -1.0],
        [12 * 3.0 + 30 * 1.0, 12 * 6.0 - 1.0, 1.0, 5 * 1.0],
    ]


def test_each_row_has_its_own_deviations() -> None:
    """Two parameters, then terms of two rows: one of row 9, two of row 7, in the order in which the fit has them."""
    fit = made_fit([1e3, 1e3], np.zeros(2), np.inf)
    fit = SimpleNamespace(**vars(fit))  # type: ignore[assignment]
    fit.extras = {9: np.zeros(1), 7: np.zeros(2)}  # type: ignore[misc]
    fit.triangle = np.diag([1e3, 1e3, 2.0, 4.0, 8.0, 0.0])[:5]  # type: ignore[misc]
    scatter = np.diag([0.0, 0.0, 1.0, 36.0, 16.0])
    trust = uncertainty_from(fit, [(scatter, 3.0)])
    assert list(trust.extras) == [9, 7]
    assert trust.extras[9] == pytest.approx([1 / 4])
    assert trust.extras[7] == pytest.approx([6 / 16, 4 / 64])
    assert trust.base == pytest.approx([0.0, 0.0])

"""Folds, weights and verdicts of whole-body fits beside dense sums and at their limits."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, patch

import numpy as np
import pytest

from plantar.dynamics.stream import RowFactor
from plantar.robot.model import RobotModel
from plantar.whole_body import folds as folding
from plantar.whole_body import regularised_fit
from plantar.whole_body.folds import Folds, pooled
from plantar.whole_body.joints import _above_sensors, _judge
from plantar.whole_body.regularised_fit import (
    REGULARISATIONS,
    HeldOutError,
    RegularisedProblem,
    chosen_regularisation,
)

RANDOM = np.random.default_rng(5)


class _Base:
    """Three parameters that are their own base."""

    grouping = np.eye(3)

    def __len__(self) -> int:
        return 3


def dense(rows: int, extras: int) -> np.ndarray:
    """Rows of [base columns, extras, measured], (n, 3 + extras + 1)."""
    return RANDOM.normal(size=(rows, 3 + extras + 1))


def factor(rows: np.ndarray, extras: int) -> RowFactor:
    return RowFactor(np.linalg.qr(rows, mode="r"), np.arange(3), extras, len(rows))


@pytest.fixture
def problem() -> tuple[list[dict[int, np.ndarray]], Folds]:
    """Two folds of 20 and 30 samples: row 0 without extras, row 7 with two, of which the second is not negative."""
    parts = [{0: dense(count, 0), 7: dense(count, 2)} for count in (20, 30)]
    factors = [{row: factor(rows, 2 * (row == 7)) for row, rows in part.items()} for part in parts]
    return parts, Folds(_Base(), factors, (1,))  # type: ignore[arg-type]


def test_errors_are_means_over_the_samples_of_all_folds(
    problem: tuple[list[dict[int, np.ndarray]], Folds],
) -> None:
    parts, folds = problem
    x = RANDOM.normal(size=5)
    assert {row: list(values) for row, values in folds.extras_of(x).items()} == {0: [], 7: [*x[3:]]}
    missed = {row: [part[row] @ [*x[: 3 + 2 * (row == 7)], -1.0] for part in parts] for row in (0, 7)}
    for row, extras in ((0, x[:3]), (7, x)):
        assert folds.error([0, 1], row, x) == pytest.approx(np.mean(np.concatenate(missed[row]) ** 2)), extras
    each = [np.mean(missed[row][1] ** 2) for row in (0, 7)]
    weighted = np.mean([each[0] * 4.0, each[1] * 0.25])
    assert folds.weighted_error([1], x, {0: 2.0, 7: 0.5}) == pytest.approx(weighted)
    assert folds.but(0) == [1]
    triangle = folds.triangle([0, 1], {0: 2.0, 7: 0.5})
    first = np.vstack([part[0] for part in parts])
    wide = np.hstack([first[:, :3], np.zeros((50, 2)), first[:, 3:]])
    stacked = np.vstack([2.0 * wide, 0.5 * np.vstack([part[7] for part in parts])])
    assert triangle.T @ triangle == pytest.approx(stacked.T @ stacked)


def test_extras_beside_known_parameters_are_least_squares_some_of_them_bounded(
    problem: tuple[list[dict[int, np.ndarray]], Folds],
) -> None:
    parts, folds = problem
    rows, inertial = np.vstack([part[7] for part in parts]), np.array([0.5, -1.0, 2.0])
    target = rows[:, 5] - rows[:, :3] @ inertial
    free = np.linalg.lstsq(rows[:, 3:5], target, rcond=None)[0]
    found = folds.with_known([0, 1], inertial)
    assert found[:3] == pytest.approx(inertial)
    if free[1] >= 0:
        assert found[3:] == pytest.approx(free)
    else:
        assert found[4] == pytest.approx(0.0, abs=1e-9)
        assert found[3] == pytest.approx(rows[:, 3] @ target / (rows[:, 3] @ rows[:, 3]))


def test_extras_beside_known_parameters_are_judged_by_the_fold_that_they_have_not_seen(
    problem: tuple[list[dict[int, np.ndarray]], Folds], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows weigh as they miss with all folds."""
    _, folds = problem
    inertial = np.array([0.5, -1.0, 2.0])
    monkeypatch.setattr(Folds, "triangle", lambda *_: None)
    made = RegularisedProblem(None, SimpleNamespace(cad=inertial), folds)  # type: ignore[arg-type]
    (found,) = made.with_known(inertial).held_out
    whole = folds.with_known([0, 1], inertial)
    weights = {row: folds.error([0, 1], row, whole) ** -0.5 for row in (0, 7)}
    other = [folds.weighted_error([own], folds.with_known([1 - own], inertial), weights) for own in (0, 1)]
    assert found.errors == pytest.approx(np.array(other))


def test_pooled_factors_hold_all_samples() -> None:
    parts = [dense(count, 1) for count in (10, 15)]
    whole = pooled([factor(part, 1) for part in parts])
    rows = np.vstack(parts)
    assert (whole.samples, whole.extras) == (25, 1)
    assert whole.upper.T @ whole.upper == pytest.approx(rows.T @ rows)
    one = factor(parts[0], 1)
    assert pooled([one]) is one


@pytest.mark.parametrize(("recordings", "each"), [(1, 6), (2, 3), (4, 2), (6, 1), (7, 1)])
def test_about_six_folds_of_all_recordings(
    monkeypatch: pytest.MonkeyPatch, recordings: int, each: int
) -> None:
    lengths: list[int] = []

    def counted(*args: Any) -> dict[int, Any]:
        lengths.append(args[2])
        return {0: SimpleNamespace(extras=2)}

    monkeypatch.setattr(folding, "factors_of", counted)
    sample = SimpleNamespace(
        measured={0: None}, time=np.zeros(60), positive={0: (False, True)}, extras={0: (1, 2)},
        select=lambda rows: rows.stop - rows.start,
    )  # fmt: skip
    made = Folds.of(None, None, [sample] * recordings)  # type: ignore[arg-type, list-item]
    assert lengths == [60 // each] * each * recordings
    assert made.positive == (1,)


def test_a_row_weighs_as_one_over_what_it_misses_down_to_rounding() -> None:
    errors = {0: 4.0, 1: 0.81e-10, 2: 1.21e-10}
    folds = SimpleNamespace(
        rows=(0, 1, 2), base=None, error=lambda every, row, x: errors[row], __len__=lambda: 1
    )
    problem = RegularisedProblem.__new__(RegularisedProblem)
    problem.folds, problem.every = folds, range(1)  # type: ignore[assignment]
    assert problem._weights(np.zeros(1)) == pytest.approx({0: 0.5, 1: 1e5, 2: 1 / 1.1e-5})


@pytest.mark.parametrize(("excess", "chosen"), [(0.99, 100.0), (1.01, 10.0)])
def test_the_largest_weight_within_one_standard_error(excess: float, chosen: float) -> None:
    best = np.array([1.0, 2.0, 3.0, 4.0])
    more = np.array([1.0, -1.0, 1.0, -1.0])
    error = float(more.std(ddof=1)) / 2
    tried = [
        HeldOutError(1.0, best + 9),
        HeldOutError(10.0, best),
        HeldOutError(100.0, best + more + excess * error),
    ]
    assert chosen_regularisation(tried) == chosen
    assert chosen_regularisation([]) == 10.0


@pytest.mark.parametrize(
    ("term", "value", "interval", "torque", "still", "said"),
    [
        ("viscous", 5.0, (4.05, 5.95), 0.0, False, ("usable", "the interval is narrow")),
        (
            "viscous",
            5.0,
            (3.95, 6.05),
            0.0,
            False,
            ("weak", "the interval is 21 % of the value to each side"),
        ),
        ("viscous", 5.0, (0.0, 10.0), 0.0, False, ("unidentifiable", "zero lies in the interval")),
        ("viscous", 5.0, (4.9, 5.1), 0.0, True, ("unidentifiable", "the joint hardly moves")),
        ("offset", 5.0, (4.9, 5.1), 0.0, True, ("usable", "the interval is narrow")),
        (
            "offset",
            0.1,
            (-0.39, 0.59),
            10.0,
            False,
            ("usable", "the interval is narrow beside the joint's torque"),
        ),
        ("offset", 0.1, (-0.41, 0.61), 10.0, False, ("unidentifiable", "zero lies in the interval")),
        ("offset", -5.0, (-6.0, -4.0), 0.0, False, ("usable", "the interval is narrow")),
        ("coulomb", -1.0, (-2.0, 0.0), 0.0, False, ("unidentifiable", "zero lies in the interval")),
        ("stiffness", -1.0, (-1.1, -0.9), 0.0, False, ("unidentifiable", "negative, which is impossible")),
        ("inertia", 0.0, (-1.0, 1.0), 0.0, False, ("unidentifiable", "zero lies in the interval")),
    ],
)
def test_a_joint_s_term_is_judged(
    term: str, value: float, interval: tuple[float, float], torque: float, still: bool, said: tuple[str, str]
) -> None:
    """A fifth of the value, or of an offset a twentieth of the torque."""
    assert _judge(term, value, interval, torque, still) == said


@pytest.mark.parametrize(("worst", "tried"), [(11.0, 7), (12.1, 5)])
def test_larger_weights_are_tried_until_one_misses_three_times_the_least(worst: float, tried: int) -> None:
    """A weight that misses a little more than the one before it ends nothing."""
    missed = dict(zip(REGULARISATIONS, (5.0, 4.0, 4.5, 4.2, worst, 11.9, 12.1, 4.0), strict=True))
    problem = RegularisedProblem.__new__(RegularisedProblem)
    made: Any = problem
    made.folds, made.every, made.base, made.prior = MagicMock(), range(2), None, None
    made.folds.__len__.return_value = 2
    made._regularised = lambda normal, weight: missed[weight]
    made._held_out = lambda fits, weights: np.array(fits)
    with patch.object(regularised_fit, "normal_of"):
        found = problem._errors({}, lambda said: None)
    assert [one.regularisation for one in found] == list(REGULARISATIONS[:tried])


def test_zeros_of_a_feet_s_sensors_count_in_the_joints_above_them(robot: RobotModel) -> None:
    """Of a robot that is bolted down nothing follows from its feet."""
    above = {f"{foot}_{joint}" for foot in ("left", "right") for joint in (
        "leg_x", "leg_y", "leg_z", "ankle_pitch", "ankle_roll")}  # fmt: skip
    assert above <= _above_sensors(robot)
    assert "neck" not in _above_sensors(robot)
    assert _above_sensors(replace(robot, base="fixed")) == frozenset()

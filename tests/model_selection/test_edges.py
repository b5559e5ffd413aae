"""Which samples, pieces and models count: at their limits, on stubs made by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from bush_data_sets import Rubber, campaign
from plantar.model_selection.cross_validation import folds_of
from plantar.model_selection.data_sets import DataSet, StepColumns
from plantar.model_selection.model_fit import ModelFit, fit_model
from plantar.model_selection.selection import ModelScore, _adds, _caution, _hardly_shown
from plantar.models import BushMotion, Elastoplastic, Hardening, KelvinVoigt, StandardLinearSolid


@pytest.fixture(scope="module")
def fit() -> ModelFit:
    return fit_model(KelvinVoigt(), campaign(0, Rubber())[:1], shared_offset=False)


def moved(*squares: float) -> list[SimpleNamespace]:
    """Recordings of ten used samples whose deflections have these squares about their means."""
    return [
        SimpleNamespace(
            base=np.sqrt(one / 10) * np.tile([[1.0], [-1.0]], (5, 1)) + 7.0, used=np.ones(10, dtype=bool)
        )
        for one in squares
    ]


@pytest.mark.parametrize(
    ("squares", "whole"), [((1.0, 1.0, 1.98), True), ((1.0, 1.0, 2.02), False), ((1.0, 1.0), False)]
)
def test_whole_recordings_are_held_out_where_there_are_three_and_none_has_half(
    squares: tuple[float, ...], whole: bool
) -> None:
    folds, found = folds_of(moved(*squares))  # type: ignore[arg-type]
    assert found == whole
    expected = list(range(len(squares))) if whole else None
    for place, fold in enumerate(folds):
        assert list(fold) == ([expected[place]] * 10 if expected else [0, 0, 1, 1, 2, 2, 3, 3, 4, 4])


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_a_share_of_each_stance_s_mean_is_taken_off(share: float) -> None:
    rows = np.array([[1.0], [3.0], [10.0], [14.0], [18.0]])
    columns = StepColumns(np.zeros(5, dtype=np.intp), np.zeros((5, 1)), share)
    means = np.array([2.0, 2.0, 14.0, 14.0, 14.0])
    expected = rows[:, 0] - share * (means - rows.mean())
    assert columns.centred(rows, np.array([0, 0, 1, 1, 1]))[:, 0] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("period", "cutoff", "steps", "stride"),
    [(0.005, 5.0, False, 5), (0.005, 15.0, False, 1), (0.005, 14.0, False, 2), (0.005, 5.0, True, 1),
     (0.002, 5.0, True, 3), (0.002, 2.5, True, 6)],
)  # fmt: skip
def test_seven_samples_of_a_cycle_are_kept_and_32_in_stances(
    period: float, cutoff: float, steps: bool, stride: int
) -> None:
    """Of the filter's cutoff; a tone of four times as much is halved, since slower ones are what is fitted, and in
    stances one of six times, where the path turns quickly."""
    time = period * np.arange(6000)
    tone = np.sin(2 * np.pi * (6 if steps else 4) * cutoff * time)
    columns = StepColumns(np.zeros(6000, dtype=np.intp), np.zeros((6000, 1)), 1.0) if steps else None
    data = DataSet("a", BushMotion(tone, tone, period), tone, np.ones(6000, dtype=bool), columns, tone)
    thin = data.thinned(cutoff)
    assert len(thin.torque) == -(-6000 // stride)
    assert thin.motion.period == pytest.approx(period * stride)
    assert (thin is data) == (stride == 1)
    if stride > 1:
        at = tone[::stride][100:-100]
        assert thin.torque[100:-100] == pytest.approx(0.5 * at, abs=0.01)
        assert thin.motion.rate[100:-100] == pytest.approx(0.5 * at, abs=0.01)
        assert np.array_equal(thin.drift, tone[::stride])  # type: ignore[arg-type]


def score(model: object, error: float, fit: ModelFit, refused: str | None = None) -> ModelScore:
    return ModelScore(model, error, fit, refused)  # type: ignore[arg-type]


@pytest.mark.parametrize(("error", "refused"), [(0.69, False), (0.71, True)])
def test_what_hardly_slips_must_gain_three_tenths(error: float, refused: bool, fit: ModelFit) -> None:
    """Beyond 0.8 of what motions reach; the widest that is tried is 1.3 times it."""
    linear = score(KelvinVoigt(), 1.0, fit)
    for angle, hardly in ((0.81, True), (0.79, False)):
        stub = SimpleNamespace(shape=np.array([angle]), limits=np.array([[0.02], [1.3]]))
        found = _hardly_shown(score(Elastoplastic(), error, stub), linear)  # type: ignore[arg-type]
        assert (found.refused is not None) == (refused and hardly)
        if found.refused:
            assert found.refused == "slip_angle 0.81 is hardly reached by these motions"
    told = score(Elastoplastic(), error, fit, "before")
    assert _hardly_shown(told, linear) is told


@pytest.mark.parametrize(("deviations", "adds"), [(4.1, True), (-4.1, True), (3.9, False)])
def test_an_added_term_is_four_deviations_from_none(deviations: float, adds: bool, fit: ModelFit) -> None:
    rich = replace(fit, model=Hardening(), values=np.array([400.0, 20.0, deviations * 0.5]),
                   covariance=np.diag([1e6, 1e6, 0.25]))  # fmt: skip
    assert _adds(rich, fit) == adds


@pytest.mark.parametrize(("error", "told"), [(0.69, True), (0.71, False)])
def test_a_rejected_model_is_told_of_from_three_tenths_on(error: float, told: bool, fit: ModelFit) -> None:
    even = np.linspace(0.9, 1.1, 8)
    scores = [score(KelvinVoigt(), 1.0, fit), score(Elastoplastic(), error, fit, "is not passive")]
    found = _caution(scores, [even, error**2 * even], 0, 0.1, whole=True)
    assert (found is not None) == told
    assert found is None or found.startswith(
        "elastoplastic predicts held-out motion better (0.69 against 1 rms) but is not passive; stiffness"
    )
    small = _caution(
        [scores[0], replace(scores[1], refused=None)], [even, error**2 * even], 0, 0.5, whole=True
    )
    assert small is None or "but by too little for steps as short as these" in small


@pytest.mark.parametrize(
    ("error", "time", "softer", "relaxing", "told"),
    [
        (0.89, 4.0, 0.10, 50.0, True),
        (0.91, 4.0, 0.10, 50.0, False),  # gains less than a model that is chosen
        (0.89, 3.9, 0.10, 50.0, False),  # as slow as motions can show
        (0.89, 4.0, 0.06, 50.0, False),  # as the attitude's wander makes it
        (0.89, 4.0, 0.10, -50.0, False),  # not passive
    ],
)
def test_rubber_that_yields_more_slowly_than_motions_show_is_told_of_from_a_tenth_on(
    error: float, time: float, softer: float, relaxing: float, told: bool, fit: ModelFit
) -> None:
    solid = replace(
        fit, model=StandardLinearSolid(), values=np.array([(1 - softer) * fit.values[0], fit.values[1], relaxing]),
        shape=np.array([time]), limits=np.array([[0.05], [4.0]]),
    )  # fmt: skip
    even = np.linspace(0.9, 1.1, 8)
    scores = [score(KelvinVoigt(), 1.0, fit), ModelScore(solid.model, error, solid, "too slow")]
    found = _caution(scores, [even, error**2 * even], 0, 0.1, whole=True)
    assert (found is not None) == told
    assert found is None or found.startswith(
        "rubber that goes on yielding for 4 s or longer predicts held-out"
    )


def test_a_torque_where_no_angle_is_known_does_not_pass_the_filter() -> None:
    """Beside a gap of the angle it would spread into samples that a fit takes."""
    count, period, gap = 6000, 0.001, slice(2000, 2500)
    angle, torque = np.sin(0.01 * np.arange(count)), np.zeros(count)
    angle[gap], torque[gap] = np.nan, 1e3
    thin = DataSet("a", BushMotion(angle, angle, period), torque, np.isfinite(angle)).thinned(5.0)
    known = np.isfinite(thin.motion.deflection)
    assert 0 < known.sum() < len(known)
    np.testing.assert_array_equal(np.isfinite(thin.torque), known)
    np.testing.assert_allclose(thin.torque[known], 0.0, atol=1e-9)

"""Which law of the bush is chosen for recordings whose rubber is known, and what is told where none can be."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from bush_data_sets import (
    Rubber,
    campaign,
    error_percent,
    largest_torque,
    recorded,
    sway,
    tilt,
    unseen,
    unseen_error,
)
from plantar.model_selection import selection
from plantar.model_selection.model_fit import fit_model
from plantar.model_selection.selection import _clear, choose_model
from plantar.models import Elastoplastic, Hardening, KelvinVoigt

JENKINS = Rubber(slip_torque=5.0, slip_angle=0.01)


@pytest.mark.parametrize("seed", range(4))
def test_hysteresis_is_chosen_and_spring_and_damper_come_back(seed: int) -> None:
    rng = np.random.default_rng(seed)
    share, slip_angle = rng.uniform(0.07, 0.2), rng.uniform(0.005, 0.02)
    plain = largest_torque(campaign(seed, Rubber()))
    rubber = Rubber(slip_torque=share * plain, slip_angle=slip_angle)
    data_sets = campaign(seed, rubber)
    choice = choose_model(data_sets, shared_offset=False, before=None)
    assert choice.fit.model.name in ("elastoplastic", "iwan", "bouc_wen")
    stiffness, damping = error_percent(choice.fit, rubber)
    assert stiffness < 1
    assert damping < 3
    assert error_percent(choice.equivalent, rubber)[0] > 4  # what the linear law makes of it
    assert error_percent(choice.equivalent, rubber)[1] > 30
    others = unseen(seed, rubber)
    assert unseen_error(choice.fit, others) < 0.5 * unseen_error(choice.equivalent, others)


@pytest.mark.parametrize("seed", range(4))
def test_without_hysteresis_the_linear_law_is_kept(seed: int) -> None:
    choice = choose_model(campaign(seed, Rubber()), shared_offset=False, before=None)
    assert choice.fit.model.name == "kelvin_voigt"
    assert choice.fit is choice.equivalent
    assert choice.caution is None
    assert sum(score.chosen for score in choice.ranking) == 1


@pytest.mark.parametrize(("whole", "slow"), [(True, True), (True, False), (False, True)])
def test_a_choice_says_whether_a_spring_that_creeps_is_what_predicts_better(
    whole: bool, slow: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where whole recordings are held out; a caution of another kind says nothing of it."""
    fits = {"better": object()}
    monkeypatch.setattr(selection, "_clearly_better", lambda *_, whole: SimpleNamespace(fit=fits["better"]))
    monkeypatch.setattr(selection, "_creeps", lambda fit, chosen: slow and fit is fits["better"])
    monkeypatch.setattr(selection, "_caution", lambda *_, whole: "told")
    folds = selection.folds_of
    monkeypatch.setattr(selection, "folds_of", lambda prepared: (folds(prepared)[0], whole))
    choice = choose_model(campaign(1, Rubber()), [KelvinVoigt()], shared_offset=False, before=None)
    assert (choice.caution, choice.creeps) == ("told", slow and whole)


@pytest.mark.parametrize(
    ("rubber", "name"),
    [
        (Rubber(hardening=8000.0), "hardening"),
        (Rubber(coulomb=3.0), "coulomb"),
        (JENKINS, "elastoplastic"),
        (Rubber(slip_torque=5.0, slip_angle=0.01, hardening=8000.0), "hardening_elastoplastic"),
        (Rubber(slip_torque=5.0, sharpness=1.0), "bouc_wen"),
        (Rubber(slip_torque=5.0, sharpness=2.0), "bouc_wen"),
    ],
)
def test_the_law_that_made_the_data_is_chosen(rubber: Rubber, name: str) -> None:
    choice = choose_model(campaign(3, rubber), shared_offset=False, before=None)
    assert choice.fit.model.name == name
    stiffness, damping = error_percent(choice.fit, rubber)
    assert stiffness < 1
    assert damping < 3


def test_small_motions_never_give_a_confident_wrong_spring() -> None:
    """Nothing slips at a third of the slip angle: the sum of both springs is all there is to see."""
    rng = np.random.default_rng(0)
    paths = [sway(rng, 0.0035, 0.5), sway(rng, 0.003, 0.8), tilt(rng, 0.003)]
    data_sets = [recorded(rng, f"small_{i}", path, JENKINS) for i, path in enumerate(paths)]
    fit = fit_model(Elastoplastic(), data_sets, shared_offset=False)
    assert fit.doubts or not fit.model.possible(fit.values)
    choice = choose_model(data_sets, shared_offset=False, before=None)
    assert choice.fit.model.name == "kelvin_voigt"
    both = JENKINS.stiffness + JENKINS.slip_torque / JENKINS.slip_angle
    assert choice.fit.value("stiffness") == pytest.approx(both, rel=0.03)
    assert choice.reach < JENKINS.slip_angle  # up to there it holds


def test_motions_that_just_slip_show_the_spring_behind() -> None:
    """The element slips in the widest turns alone: spring and damper would come out twice as stiff."""
    rng = np.random.default_rng(0)
    paths = [sway(rng, 0.0095, 0.5), sway(rng, 0.007, 0.8), tilt(rng, 0.0095)]
    choice = choose_model(
        [recorded(rng, f"medium_{i}", path, JENKINS) for i, path in enumerate(paths)],
        shared_offset=False,
        before=None,
    )
    assert choice.fit.model.name == "elastoplastic"
    low, high = choice.fit.interval95("stiffness")
    assert low < JENKINS.stiffness < high < 1.3 * JENKINS.stiffness
    assert choice.fit.value("slip_angle") == pytest.approx(JENKINS.slip_angle, rel=0.02)


def test_an_element_that_hardly_slips_must_gain_much() -> None:
    rng = np.random.default_rng(0)
    paths = [sway(rng, 0.0085, 0.5), sway(rng, 0.006, 0.8), tilt(rng, 0.0085)]
    choice = choose_model(
        [recorded(rng, f"medium_{i}", path, JENKINS) for i, path in enumerate(paths)],
        shared_offset=False,
        before=None,
    )
    assert choice.fit.model.name == "kelvin_voigt"
    hardly = next(score for score in choice.ranking if score.model.name == "elastoplastic")
    assert hardly.refused is not None
    assert "hardly reached" in hardly.refused


def test_whole_recordings_are_held_out_where_they_can_stand_for_one_another() -> None:
    rng = np.random.default_rng(8)
    data_sets = [recorded(rng, f"sway_{i}", sway(rng, 0.08, 0.4 + 0.1 * i), JENKINS) for i in range(4)]
    choice = choose_model(data_sets, shared_offset=False, before=None)
    assert choice.held_out == "whole recordings"
    assert choice.fit.model.name == "elastoplastic"
    alone = choose_model(data_sets[:1], shared_offset=False, before=None)
    assert "parts" in alone.held_out
    assert alone.fit.model.name == "elastoplastic"


def test_a_gain_that_is_real_but_small_keeps_the_simpler_law() -> None:
    """A weak cubic term is well told from nothing, yet predicts held-out motion hardly better."""
    data_sets = campaign(1, Rubber(hardening=200.0))
    choice = choose_model(data_sets, [KelvinVoigt(), Hardening()], shared_offset=False, before=None)
    hardening = next(score for score in choice.ranking if score.model.name == "hardening")
    assert hardening.refused is None
    assert hardening.held_out_rms < choice.ranking[-1].held_out_rms
    assert choice.fit.model.name == "kelvin_voigt"


@pytest.mark.parametrize(
    ("terms", "clear"), [(("stiffness", "damping"), False), (("stiffness", "damping", "more"), True)]
)
def test_another_shape_must_gain_as_much_as_any_and_a_term_told_from_zero_need_not(
    terms: tuple[str, ...], clear: bool
) -> None:
    """It predicts better by a hundredth, a fiftieth is asked for; the term was told from zero before."""
    scores = [
        SimpleNamespace(model=SimpleNamespace(name=name, elaborates=of, terms=has), held_out_rms=rms)
        for name, of, has, rms in (
            ("plain", None, ("stiffness", "damping"), 1.0),
            ("rich", "plain", terms, 0.99),
        )
    ]
    errors = [np.full(9, 1.0), np.full(9, 0.98)]
    assert _clear(scores, errors, 0.02, simple=0, rich=1) is clear  # type: ignore[arg-type]

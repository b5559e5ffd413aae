"""Rows of table 1: Student's intervals, the evidence of all motions behind the verdict, rows without a number."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from made_recording import FOOT, PERIOD, made_recording, predicted_torque, swayed
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances
from plantar.feet.assess import parameter_rows
from plantar.feet.assess.parameter_rows import axis_rows, missing_rows, unseen_rows
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.models import MODELS, BushModel, Elastoplastic, KelvinVoigt
from plantar.results.feet import Parameter, ValidationRow

NOISY = 0.13

STD = np.array([4.0, 1.0])


def fit_of(model: BushModel | None = None, values: tuple[float, ...] = (400.0, 20.0)) -> AxisFit:
    model = model or KelvinVoigt()
    std = np.resize(STD, model.size)
    return AxisFit(
        foot=FOOT, axis="pitch", model=model, values=np.array(values), shape=np.full(len(model.shape_terms), 0.01),
        covariance=np.diag(std**2), freedom=np.full(model.size, 6.0), white_std=std / 10, offset_std={},
        equivalent=(values[0], values[1]), choice=None, reason="",
    )  # fmt: skip


def recording(name: str = "sway", count: int = 3000) -> Recording:
    angle = swayed(count)
    return made_recording(name, angle, 400.0 * angle + 20.0 * np.gradient(angle, PERIOD))


def rows_of(
    one: Recording, fit: AxisFit, missed: float = 0.0, contradicted: ValidationRow | None = None
) -> list[Parameter]:
    """The rows where the prediction misses `missed` of the torque."""
    torque = one.bushes[FOOT].torque[:, 0]
    predicted = predicted_torque((1 - missed) * torque)
    return axis_rows(fit, [one], {(one.name, FOOT, "pitch"): predicted}, contradicted)


def test_numbers_and_intervals_are_the_fits() -> None:
    stiffness, damping = rows_of(recording(), fit_of())
    half = float(stats.t.ppf(0.975, 6.0)) * STD
    assert (stiffness.name, stiffness.value, stiffness.std, stiffness.unit) == (
        "stiffness",
        400.0,
        4.0,
        "N.m/rad",
    )
    assert stiffness.interval95 == pytest.approx((400 - half[0], 400 + half[0]))
    assert damping.interval95 == pytest.approx((20 - half[1], 20 + half[1]))
    assert stiffness.relative_std_percent == pytest.approx(0.1)
    assert {row.verdict for row in (stiffness, damping)} == {"usable"}
    assert "30 s used" in stiffness.reason


def test_what_the_model_misses_and_what_is_left_out_count() -> None:
    assert rows_of(recording(), fit_of(), missed=0.5)[0].verdict == "weak"  # 75 % of the variance
    assert rows_of(recording(), fit_of(), missed=0.9)[0].verdict == "unidentifiable"
    one = recording()
    less = one.without(FOOT, np.arange(3000) > 200, Reason.IMPACT)
    assert "only 2.0 s of samples" in rows_of(less, fit_of())[0].reason


def test_a_drift_that_the_fit_leaves_free_is_nothing_missed() -> None:
    one = recording()
    slow = 10 * np.ptp(one.bushes[FOOT].torque[:, 0]) * np.linspace(-1, 1, 3000)
    predicted = {(one.name, FOOT, "pitch"): predicted_torque(one.bushes[FOOT].torque[:, 0] + slow)}
    assert axis_rows(fit_of(), [one], predicted, None)[0].verdict == "usable"


def test_a_motion_as_slow_as_drift_is_judged_by_all_it_shows() -> None:
    """A lean in half a minute that is missed is no drift: beside it, what is left would be explained."""
    time = PERIOD * np.arange(3000)
    angle = 0.02 * np.cos(2 * np.pi * time / time[-1]) + swayed(3000) / 100
    one = made_recording("lean", angle, 400.0 * angle)
    missed = 400.0 * 0.02 * np.cos(2 * np.pi * time / time[-1])
    predicted = {(one.name, FOOT, "pitch"): predicted_torque(one.bushes[FOOT].torque[:, 0] - missed)}
    assert axis_rows(fit_of(), [one], predicted, None)[0].verdict == "unidentifiable"


def test_a_motion_that_contradicts_the_others_is_named() -> None:
    bad = ValidationRow("direct", "squat", FOOT, "pitch", 3.5, 3.5, 9.0, 1.0, 4.0, 100)
    assert "misses squat" in rows_of(recording(), fit_of(), contradicted=bad)[0].reason
    assert "misses" not in rows_of(recording(), fit_of())[0].reason


def test_a_lean_matters_to_a_model_with_memory_alone() -> None:
    leaning = recording().without(FOOT, np.arange(3000) < 600, Reason.OUTSIDE_THE_SOLE)
    assert "leans" not in rows_of(leaning, fit_of())[0].reason
    rows = rows_of(leaning, fit_of(Elastoplastic(), (400.0, 20.0, 5.0)))
    assert "leans for 20 % of the time" in rows[0].reason
    assert [row.name for row in rows] == ["stiffness", "damping", "slip_torque", "slip_angle"]
    each = np.arange(3000) // 300
    steps = replace(leaning, stances={FOOT: Stances(each, np.ones(3000))})
    assert "leans" not in rows_of(steps, fit_of(Elastoplastic(), (400.0, 20.0, 5.0)))[0].reason


def test_a_foot_without_samples_has_rows_that_say_why() -> None:
    for rows, words in (
        (unseen_rows(FOOT, "roll", []), "no samples"),
        (missing_rows("left", "roll", "why"), "why"),
    ):
        assert [row.name for row in rows] == ["stiffness", "damping"]
        assert {(row.value, row.verdict, row.axis) for row in rows} == {(None, "unidentifiable", "roll")}
        assert words in rows[0].reason


@pytest.mark.parametrize(("torque", "verdict"), [(40.0, "usable"), (30.0, "weak"), (4.0, "unidentifiable")])
def test_a_slip_angle_is_worth_no_more_than_its_slip_torque(torque: float, verdict: str) -> None:
    """Of 4 ± 10 N·m at 10 ± 0.3 mrad nothing is known, of 30 ± 10 N·m little, of 40 ± 10 N·m all."""
    fit = fit_of(Elastoplastic(), (400.0, 20.0, torque))
    places = [fit.names.index(name) for name in ("slip_torque", "slip_angle")]
    std = np.array([4.0, 1.0, 4.0, 1.0])
    std[places[1]] = 1.2e-4
    rows = rows_of(
        recording(), replace(fit, covariance=np.diag(std**2), freedom=np.full(4, 6.0), white_std=std)
    )
    assert [rows[place].verdict for place in places] == [verdict, verdict]
    why = {
        "weak": "its slip torque is hardly known",
        "unidentifiable": "its slip torque is not told from zero",
    }
    assert rows[places[1]].reason == why.get(verdict, rows[places[1]].reason)
    assert rows[places[1]].value == 0.01


def test_an_angle_that_is_not_known_stays_so_beside_a_torque_that_hardly_is() -> None:
    fit = fit_of(Elastoplastic(), (400.0, 20.0, 30.0))
    std = np.array([4.0, 1.0, 4.0, 0.05])
    rows = rows_of(
        recording(), replace(fit, covariance=np.diag(std**2), freedom=np.full(4, 6.0), white_std=std)
    )
    assert [row.verdict for row in rows] == ["usable", "usable", "weak", "unidentifiable"]
    assert "slip torque" not in rows[3].reason, "its own reason"


@pytest.mark.parametrize(("slid", "verdict"), [(0.24, "weak"), (0.26, "usable")])
def test_an_element_that_slips_one_way_alone_may_be_larger(
    monkeypatch: pytest.MonkeyPatch, slid: float, verdict: str
) -> None:
    monkeypatch.setattr(parameter_rows, "slid_back", lambda *_: slid)
    rows = rows_of(
        recording(), replace(fit_of(Elastoplastic(), (400.0, 20.0, 40.0)), covariance=np.eye(4) * 1e-9)
    )
    assert [row.verdict for row in rows] == [verdict, "usable", verdict, verdict]
    way = "the rubber slips one way only: sway the robot forward and backward by larger angles"
    assert all((rows[place].reason == way) is (verdict == "weak") for place in (0, 2))


@pytest.mark.parametrize(("share", "verdict"), [(0.9, "usable"), (1.1, "weak")])
def test_what_a_memory_misses_is_noise_of_its_angle(share: float, verdict: str) -> None:
    """A misfit of 0.13 x 400 N.m/rad x 0.01 rad, rms, is noise of 13 % of the slip angle; a spring has none."""
    one = recording()
    torque = one.bushes[FOOT].torque[:, 0]
    missed = share * NOISY * 400.0 * 0.01 * np.sqrt(2) * np.sin(np.arange(len(torque)))
    predicted = {(one.name, FOOT, "pitch"): predicted_torque(torque + missed)}
    memory, spring = (
        axis_rows(fit, [one], predicted, None)
        for fit in (fit_of(Elastoplastic(), (400.0, 20.0, 400.0)), fit_of())
    )
    told = [row for row in memory if row.name != "slip_angle"]  # of which `fit_of` knows nothing
    assert {row.verdict for row in told} == {verdict}
    assert all("of the slip angle" in row.reason for row in told) is (verdict == "weak")
    assert ("attitude" in (memory[0].advice or "")) is (verdict == "weak")
    assert {row.verdict for row in spring} == {"usable"}


@pytest.mark.parametrize(("lost", "verdict"), [(0.27, "usable"), (0.33, "weak"), (-0.33, "usable")])
def test_a_spring_that_softens_as_it_bends_may_be_a_sole_that_tips(lost: float, verdict: str) -> None:
    """K - 3h·q² at the largest angle; a spring that hardens is rubber."""
    one = recording()
    largest = float(np.abs(one.bushes[FOOT].deflection[:, 0]).max())
    fit = fit_of(MODELS["hardening"], (400.0, 20.0, -lost * 400.0 / (3 * largest**2)))
    rows = rows_of(one, replace(fit, covariance=1e-6 * fit.covariance))
    assert {row.verdict for row in rows} == {verdict}
    assert all(("sole: polygon" in row.reason) is (verdict == "weak") for row in rows)
    assert ("outline" in (rows[0].advice or "")) is (verdict == "weak")

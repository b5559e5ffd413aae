"""A richer model has to change stiffness or damping by more than they are unsure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import SLIPPING, record, sway
from feet_trials import PUNCTUAL, noisy
from plantar.feet.fit.worth import hardly_matters, in_place_of, tells_no_more, too_sure
from plantar.feet.identify import identify_feet
from plantar.feet.regression.axis import AxisFit
from plantar.models import Elastoplastic, HardeningElastoplastic, KelvinVoigt
from plantar.robot.model import RobotModel


def rich(stiffness: float, damping: float) -> AxisFit:
    """An elastoplastic fit whose stiffness is known to ± 4 and whose damping to ± 2."""
    return AxisFit(
        foot="left", axis="pitch", model=Elastoplastic(), values=np.array([stiffness, damping, 3.0]),
        shape=np.array([0.02]), covariance=np.diag([4.0, 1.0, 1.0, 1e-6]), freedom=np.full(4, 1e6),
        white_std=np.ones(4), offset_std={}, equivalent=(400.0, 20.0), choice=None, reason="",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("stiffness", "damping", "needless"),
    [
        (400.0, 20.0, True),
        (396.5, 21.5, True),
        (394.0, 20.0, False),
        (404.5, 20.0, False),
        (400.0, 17.0, False),
    ],
)
def test_both_numbers_have_to_agree(stiffness: float, damping: float, needless: bool) -> None:
    spring = replace(
        rich(400.0, 20.0), model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0)
    )
    assert hardly_matters(rich(stiffness, damping), spring) == needless
    reason = in_place_of(rich(stiffness, damping), spring).reason
    assert f"stiffness by {100 * abs(stiffness / 400 - 1):.2g} %" in reason


@pytest.mark.parametrize(
    ("stiffness", "variance", "sure"), [(345.0, 4.0, False), (335.0, 4.0, True), (335.0, 1600.0, False)]
)
def test_a_spring_that_is_sure_and_far_off_does_not_stand_in_for_a_model_that_is_unsure(
    stiffness: float, variance: float, sure: bool
) -> None:
    """Rubber that hardly slips: spring and element cannot be told apart, and a spring alone would not say so."""
    spring = replace(
        rich(400.0, 20.0), model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),
        covariance=np.diag([variance, 1.0]), freedom=np.full(2, 1e6),
    )  # fmt: skip
    unsure = replace(rich(stiffness, 20.0), covariance=np.diag([1e4, 1.0, 1.0, 1e-6]))
    assert hardly_matters(unsure, spring)
    assert too_sure(unsure, spring) == sure


def models(robot: RobotModel, gain: float) -> dict[tuple[str, str], tuple[str, str]]:
    """By foot and axis, the model and the reason, of rubber that slips inside, beside force sensors known to `gain`."""
    logs = [noisy(record(sway(f"sway_{seed}", seed, truth=SLIPPING)), seed) for seed in (3, 4)]
    unsure = replace(robot, uncertainty=replace(robot.uncertainty, wrench_gain=gain))
    result = identify_feet(unsure, logs, settings=PUNCTUAL)
    for row in result.models:
        assert [tried.model for tried in row.ranking if tried.chosen] == [row.model]
    return {(row.foot, row.axis): (row.model, row.reason) for row in result.models}


def test_a_memory_that_changes_the_numbers_stays_and_one_that_hardly_does_goes(robot: RobotModel) -> None:
    sure, unsure = models(robot, 0.0), models(robot, 3.0)
    assert {model for model, _ in sure.values()} == {"elastoplastic"}
    for model, reason in unsure.values():
        assert model == "kelvin_voigt"
        assert "elastoplastic changes stiffness by" in reason


@pytest.mark.parametrize(
    ("hardening", "slip_torque", "more"),
    [
        (0.0, 3.0, False),
        (-1900.0, 3.0, False),
        (2100.0, 3.0, True),
        (-2100.0, 3.0, True),
        (0.0, 4.9, False),
        (0.0, 5.1, True),
    ],
)
def test_a_term_that_is_not_told_from_zero_and_moves_no_number_tells_no_more(
    hardening: float, slip_torque: float, more: bool
) -> None:
    both = replace(
        rich(400.0, 20.0), model=HardeningElastoplastic(),
        values=np.array([400.0, 20.0, slip_torque, hardening]),
        covariance=np.diag([4.0, 1.0, 1.0, 1e6, 1e-6]), freedom=np.full(5, 1e6),
    )  # fmt: skip
    assert tells_no_more(both, rich(400.0, 20.0)) != more
    assert not tells_no_more(rich(400.0, 20.0), rich(400.0, 20.0))  # adds nothing


def test_rubber_that_slips_is_not_called_a_spring_because_a_cube_beside_it_is_unsure(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("plantar.feet.fit.axis_fit.CANDIDATES", ("kelvin_voigt", "hardening_elastoplastic"))
    logs = [noisy(record(sway(f"sway_{seed}", seed, truth=SLIPPING)), seed) for seed in (3, 4)]
    result = identify_feet(robot, logs, settings=PUNCTUAL)
    assert {row.model for row in result.models} == {"elastoplastic"}
    assert all("hardening_elastoplastic adds is no more than errors" in row.reason for row in result.models)

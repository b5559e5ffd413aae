"""A motion contradicts a model that holds in others where more is missed than an attitude's drift can make."""

from __future__ import annotations

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.feet.assess.contradiction import DRIFT_PERIOD, contradiction, missed_motions
from plantar.feet.assess.scores import score_axis
from plantar.feet.fit.axis import FittedModel
from plantar.feet.fit.axis_fit import fit_axis
from plantar.results.feet import ValidationRow

STIFFNESS, COUNT = 400.0, 6000
TIME = PERIOD * np.arange(COUNT)


def scored(motion: str, error: float, constant: float) -> ValidationRow:
    return ValidationRow("direct", motion, "left", "pitch", error, error, 4 * constant, 1.0, constant, 1000)


def test_motions_that_are_missed_although_the_liveliest_is_not() -> None:
    lively, quiet = scored("sway", 0.3, 17.0), scored("squat", 1.0, 1.1)
    assert missed_motions([lively, quiet, scored("tilt", 0.2, 2.4)]) == []  # the squat hardly loads the axis
    bad, worst = scored("lean", 1.5, 2.3), scored("tilt", 4.1, 2.3)
    assert missed_motions([lively, quiet, bad, worst]) == [bad, worst]
    assert (
        missed_motions([scored("sway", 9.0, 17.0), worst]) == []
    )  # where nothing holds, nothing contradicts
    assert missed_motions([]) == []


def found(error: Array) -> ValidationRow | None:
    """What contradicts a fit of a lively motion: a quieter, unseen one whose torque is off by `error` (n,) [N·m]."""
    lively, quiet = swayed(COUNT), swayed(COUNT, 0.006, seed=1)
    seen = made_recording("sway", lively, STIFFNESS * lively)
    unseen = made_recording("Myrand5", quiet, STIFFNESS * quiet + error, role="validate")
    fit = fit_axis([seen], FOOT, "pitch", LINEAR)
    assert fit is not None
    fitted: FittedModel = fit
    scores, predictions = score_axis([seen, unseen], fitted)
    assert error.any() == bool(missed_motions(scores))  # as it is, each of these errors is missed
    return contradiction(scores, fitted, [seen, unseen], predictions)


def test_a_motion_that_fits_contradicts_nothing() -> None:
    assert found(np.zeros(COUNT)) is None


@pytest.mark.parametrize("times", [2.0, 3.0])
def test_drift_is_no_contradiction(times: float) -> None:
    """The attitude wanders: by a line, and by a swing that is slower than any motion asked for."""
    drift = 3.0 * TIME / TIME[-1] + np.cos(2 * np.pi * TIME / (1.5 * DRIFT_PERIOD))
    assert found(times * drift) is None


@pytest.mark.parametrize("frequency", [0.1, 0.3])
def test_what_is_quicker_than_drift_is_named_with_what_is_missed_beside_it(frequency: float) -> None:
    swing = 5.0 * np.sin(2 * np.pi * frequency * TIME)
    row = found(swing + 8.0 * TIME / TIME[-1])
    assert row is not None
    assert row.motion == "Myrand5"
    assert row.mean_abs_error == pytest.approx(np.mean(np.abs(swing)), rel=0.1)
    assert row.zero_mean_abs > 0.5 * row.mean_abs_error

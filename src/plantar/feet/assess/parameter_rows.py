"""The rows of table 1: each number of a fitted model with its interval, verdict, reason and advice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.contact.reasons import TIPPING
from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.estimation import relative_std_percent
from plantar.estimation.orthonormal import without
from plantar.estimation.slow_drift import drift_basis, drift_beside
from plantar.feet.assess.left_out import why_unseen
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.assess.verdicts import SWAY, Evidence, judge, judge_term
from plantar.feet.fit.half_turns import slid_back
from plantar.feet.fit.hidden_memory import has_memory
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.prediction import Prediction
from plantar.models import KelvinVoigt
from plantar.results.feet import Parameter, ValidationRow, Verdict

# Slip angles that an element must slide back by to be seen from both sides: beside one that is an eighth larger, less
# would be no slide, and a fit that ends at the smallest element which explains the motion shows none.
ROUND_SLID = 0.25


def axis_rows(
    fit: AxisFit,
    recordings: Sequence[Recording],
    predictions: Predictions,
    contradicted: ValidationRow | None,
) -> list[Parameter]:
    """Every parameter of one axis; `predictions` are those of the fit's own recordings.

    contradicted: the score of a motion, seen or not, that the model misses although it holds in others.
    """
    # What follows from it for the numbers stands in the warning, `model_caution`.
    caution = None
    if fit.choice is not None and fit.choice.caution is not None:
        caution = fit.choice.caution.partition("; ")[0]
    evidence = replace(_evidence(fit, recordings, predictions), contradicted=contradicted, caution=caution)
    rows = []
    for place, term in enumerate(fit.names):
        value, std = float(fit.numbers[place]), float(fit.std[place])
        interval = fit.interval(place)
        if place < 2:
            verdict, reason, advice = judge(fit.foot, fit.axis, term, value, interval, evidence)
        else:
            verdict, reason, advice = judge_term(value, interval, evidence)
        # What the slipping part does not have, the spring has.
        if (
            term in ("stiffness", "slip_torque")
            and verdict == "usable"
            and slid_back(fit, recordings) < ROUND_SLID
        ):
            verdict = "weak"
            reason = f"the rubber slips one way only: {SWAY[fit.axis]} by larger angles"
        unit = fit.model.unit(term, fit.axis)
        relative = relative_std_percent(value, float(fit.white_std[place]))
        rows.append(
            Parameter(fit.foot, fit.axis, term, unit, value, std, interval, relative, verdict, reason, advice)
        )
    return [_beside_its_torque(row, rows) if row.name in fit.model.shape_terms else row for row in rows]


def _beside_its_torque(row: Parameter, rows: Sequence[Parameter]) -> Parameter:
    """An element's angle no surer than its torque: of an element that hardly shows, the angle that was searched may be
    any."""
    torque: Verdict = next((one.verdict for one in rows if one.name == "slip_torque"), "usable")
    if torque == "usable" or row.verdict in (torque, "unidentifiable"):
        return row
    why = "not told from zero" if torque == "unidentifiable" else "hardly known"
    return replace(row, verdict=torque, reason=f"its slip torque is {why}")


def unseen_rows(foot: str, axis: Axis, recordings: Sequence[Recording]) -> list[Parameter]:
    """Stiffness and damping of a foot that no log shows."""
    return missing_rows(foot, axis, *why_unseen(recordings, foot))


def missing_rows(foot: str, axis: Axis, reason: str, advice: str = "") -> list[Parameter]:
    """Stiffness and damping without values, and why."""
    model = KelvinVoigt()
    return [
        Parameter(
            foot, axis, term, model.unit(term, axis), None, None, None, None, "unidentifiable", reason, advice
        )
        for term in model.terms
    ]


def _evidence(fit: AxisFit, recordings: Sequence[Recording], predictions: Predictions) -> Evidence:
    column = ROTATIONAL_AXES.index(fit.axis)
    seconds = moved = missed = leans = loaded = softened = 0.0
    varied = left = 0.0
    samples = 0
    for recording in recordings:
        predicted = predictions.get((recording.name, fit.foot, fit.axis))
        if predicted is None:
            continue
        used, bush = recording.used(fit.foot) & np.isfinite(predicted.torque), recording.bushes[fit.foot]
        angle, torque = bush.deflection[used, column], bush.torque[used, column]
        samples += len(angle)
        softened = max(softened, _softened(fit, angle))
        contact = recording.contacts[fit.foot]
        loaded += float(contact.loaded.sum()) * recording.period
        if recording.stances[fit.foot] is None:  # each step unloads the rubber, and its path starts anew
            leans += float((contact.loaded & contact.left_out_for(TIPPING)).sum()) * recording.period
        seconds += len(angle) * recording.period
        moved += float(np.sum((angle - angle.mean()) ** 2))
        missed += float(np.sum((torque - predicted.torque[used]) ** 2))
        quick = _beside_drift(fit, recording, predicted, used & recording.rows(fit.foot))
        varied, left = varied + quick[0], left + quick[1]
    noise = 0.0
    if fit.slip_angle is not None and all(each.stances[fit.foot] is None for each in recordings):
        noise = float(np.sqrt(missed / max(samples, 1))) / abs(float(fit.values[0])) / fit.slip_angle
    stiffness, damping = (float(value) for value in fit.numbers[:2])
    negative = stiffness > 0 and damping + 2 * float(fit.std[1]) < 0
    return Evidence(
        seconds,
        float(np.sqrt(moved / max(samples, 1))),
        1 - left / varied if varied else 0.0,
        -damping / stiffness if negative else 0.0,
        leaning=leans / loaded if has_memory(fit.model) and loaded else 0.0,
        noise=noise,
        softened=softened,
    )


def _beside_drift(
    fit: AxisFit, recording: Recording, predicted: Prediction, rows: Mask
) -> tuple[float, float]:
    """Squares of a torque, and of what a model misses of it, beside the drift that its fit leaves free: an attitude
    made of a gyroscope alone drifts by more than a foot bends."""
    column = ROTATIONAL_AXES.index(fit.axis)
    bush = recording.bushes[fit.foot]
    torque, angle = bush.torque[rows, column], bush.deflection[rows, column]
    varied, missed = torque - torque.mean(), torque - predicted.torque[rows]
    if recording.stances[fit.foot] is None:
        slow = drift_beside(angle, drift_basis(recording.time[rows]))
        varied, missed = without(slow, varied), without(slow, missed)
    return float(varied @ varied), float(missed @ missed)


def _softened(fit: AxisFit, angle: Array) -> float:
    """The share of its slope at rest that a spring with a cubic term has lost at the largest of angles (n,) [rad]."""
    if "hardening" not in fit.model.terms or not len(angle):
        return 0.0
    cubic = float(fit.values[fit.model.terms.index("hardening")])
    return -3 * cubic * float(np.max(angle**2)) / abs(float(fit.values[0]))

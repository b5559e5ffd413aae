"""Whether motions turn an element of the rubber's memory round: only then is its slip torque seen.

An element that slips one way has to be bent back by two slip angles before it slips the other way. A path that spans
less shows at most one side of the loop, and how much of the torque is the spring's and how much the element's is a
guess that the smallest error of sensors or mounts decides. A foot that stands tells the spring beside an element that
slips one way alone, but not how large the element is: twice as large, begun elsewhere, it slips as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import Array
from plantar.feet.fit.hidden_memory import SLIPS, SMALL
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.model_columns import path_of
from plantar.models import KelvinVoigt

ROUND = 2.0  # slip angles from one end of a path to the other
STILL = 1e-6  # slip angles from sample to sample: rounding
HARDLY_TURNED = (
    "stances bend the foot by {:.1f} slip angles from end to end, where a full loop of hysteresis needs two: stiffness "
    "and slip torque can hardly be told apart (record longer steps, or stand and sway)"
)
SHORT = (
    "stances bend the foot by {:.2g} rad from end to end: hysteresis that needs more would not show; in larger motions "
    "the stiffness may be smaller (record longer steps, or stand and sway)"
)


def slip_angles_spanned(fit: AxisFit, recordings: Sequence[Recording], *, used: bool = False) -> float | None:
    """How many slip angles the path of a usual stance spans, or those of its samples that are `used`; None of a foot
    that stands and a model without one."""
    if fit.slip_angle is None or (spanned := _spanned(fit, recordings, used=used)) is None:
        return None
    return spanned / fit.slip_angle


def _spanned(fit: AxisFit, recordings: Sequence[Recording], *, used: bool = False) -> float | None:
    """From end to end of a usual stance [rad]; None of a foot that stands in all of them."""
    walks = [each for each in recordings if each.stances[fit.foot] is not None and each.name in fit.offsets]
    spans = list[float]()
    for walk in walks:
        path = path_of(walk, fit.foot, fit.axis, fit.imu_turned)
        for run in path.runs:
            angles = path.deflection[run][walk.used(fit.foot)[run]] if used else path.deflection[run]
            spans.append(float(np.ptp(angles)) if len(angles) else 0.0)
    return float(np.median(spans)) if spans else None


def slid_back(fit: AxisFit, recordings: Sequence[Recording]) -> float:
    """How many slip angles a standing foot's element slides at most after it slid the other way, while the foot stands.

    An element that is larger by half of that would slide one way alone. Infinite of a model without one, of a foot that
    steps, and where no state of it is known.
    """
    if fit.slip_angle is None or "slip_torque" not in fit.model.terms:
        return np.inf
    place, ways = fit.model.terms.index("slip_torque"), list[float]()
    for recording in recordings:
        if recording.stances[fit.foot] is not None:
            return np.inf
        starts = fit.initial_states.get(recording.name)
        path = path_of(recording, fit.foot, fit.axis, fit.imu_turned)
        if starts is None or len(starts) != len(path.runs):
            continue
        slider = path.deflection - fit.slip_angle * fit.model.columns(path, fit.shape, starts)[:, place]
        ways += [_back(slider[run] / fit.slip_angle) for run in path.runs]
    return max(ways, default=np.inf)


def _back(slider: Array) -> float:
    """The longest way that a slider's path (n,) goes on in one sense after it went the other way."""
    steps = np.diff(slider)
    steps = steps[np.abs(steps) > STILL]
    turns = np.flatnonzero(np.sign(steps[1:]) != np.sign(steps[:-1])) + 1
    ways = np.abs(np.add.reduceat(steps, turns)) if turns.size else np.zeros(1)
    return float(ways.max())


def cautioned_if_hardly_turned(fit: AxisFit, recordings: Sequence[Recording]) -> AxisFit:
    """The fit, with a caution where the stances of a walk do not turn its element round, or would not turn one round
    that spring and damper hide: until it slips, it is a part of the spring."""
    if fit.choice is None or fit.choice.caution is not None:
        return fit
    if isinstance(fit.model, KelvinVoigt):
        stands = any(each.stances[fit.foot] is None and each.name in fit.offsets for each in recordings)
        spanned, caution, least = _spanned(fit, recordings), SHORT, ROUND * SLIPS
        spanned = None if stands and fit.choice.reach >= SMALL else spanned
    else:
        spanned, caution, least = slip_angles_spanned(fit, recordings), HARDLY_TURNED, ROUND
    if spanned is None or spanned >= least:
        return fit
    return replace(fit, choice=replace(fit.choice, caution=caution.format(spanned)))

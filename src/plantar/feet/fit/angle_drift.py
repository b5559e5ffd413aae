"""How an attitude drifts, as a memory feels it.

An angle that drifts by d adds -K d to a spring's torque, which slow columns of each recording take up. An element slips
by the angle itself: where motions hardly make it slip, half a milliradian moves a tenth of the stiffness from the
spring to the element or back. So the slow torque that a fit leaves is read as a drift of the angle, and the fit made
again with it off the path that the memory follows. A torque whose zero drifts looks the same and is read the same way:
attitudes drift by far more.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.estimation import effect_of, influences_of
from plantar.estimation.slow_drift import drift_beside
from plantar.feet.fit.corrections import NEGLIGIBLE
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AngleDrift, AxisFit
from plantar.feet.regression.model_columns import model_columns
from plantar.feet.regression.regression_data import blocks_of, recordings_of
from plantar.feet.regression.tangent import Tangent

ROUNDS = 6  # at most
HALFWAY = 0.5  # from one round's drift to the next: fit and drift answer each other with the opposite, nearly as large


def beside_drift(
    fit: AxisFit, recordings: Sequence[Recording], again: Callable[[AxisFit], AxisFit]
) -> AxisFit:
    """A memory's fit to a foot that stands, the drifts off its path where they matter; `again` fits beside them."""
    for _ in range(ROUNDS):
        drifts = {
            name: _halfway(fit.drifts.get(name), drift) for name, drift in _drifts(fit, recordings).items()
        }
        if not _matters(Tangent.of(fit, recordings, False), drifts):
            break
        fit = again(replace(fit, drifts=drifts))
    return fit


def _halfway(before: AngleDrift | None, now: AngleDrift) -> AngleDrift:
    angle = 0.0 if before is None else before.angle
    return now._replace(angle=angle + HALFWAY * (now.angle - angle))


def _drifts(fit: AxisFit, recordings: Sequence[Recording]) -> dict[str, AngleDrift]:
    """By recording, the drift of the angle that would add the slow torque which a fit leaves."""
    found, blocks = {}, blocks_of(recordings, fit.foot, fit.axis, fit=fit)
    for block, recording in zip(blocks, recordings_of(blocks, recordings), strict=True):
        missed = block.response - block.regressor @ fit.values
        rows = recording.rows(fit.foot)
        deflection = recording.bushes[fit.foot].deflection[rows, ROTATIONAL_AXES.index(fit.axis)]
        slow = drift_beside(deflection, recording.drift(fit.foot))
        found[block.label] = AngleDrift(recording.time[rows], -(slow @ (slow.T @ missed)) / fit.values[0])
    return found


def _matters(tangent: Tangent, drifts: Mapping[str, AngleDrift]) -> bool:
    """Whether a number of the fit would move by a share of its deviation with other drifts."""
    fit = tangent.fit
    other = replace(fit, drifts=drifts)

    def torque(recording: Recording, one: AxisFit) -> Array:
        columns = model_columns(recording, fit.foot, fit.axis, one)
        return np.asarray((columns @ fit.values)[recording.rows(fit.foot)])

    changes = [np.nan_to_num(torque(one, other) - torque(one, fit)) for one in tangent.recordings]
    return bool((np.abs(effect_of(influences_of(tangent.blocks), changes)) > NEGLIGIBLE * fit.std).any())

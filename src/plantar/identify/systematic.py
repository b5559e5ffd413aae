"""Causes of error that no residual shows: each widens the intervals by how far it would move the fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.estimation import effect_of
from plantar.estimation.intervals import pooled_freedom
from plantar.identify.axis_fit import AxisFit, blocks_of
from plantar.identify.height import Height
from plantar.identify.latency import Latency
from plantar.identify.recording import Recording, lever_effect
from plantar.signals import differentiate


@dataclass(frozen=True)
class Cause:
    """One cause: how far a unit of it moves the law's values (k,), its deviation and that one's degrees of freedom."""

    name: str
    effect: Array
    std: float
    freedom: float = np.inf

    @property
    def share(self) -> Array:
        """Deviation that it adds to each value, (k,)."""
        return np.abs(self.effect) * self.std


def systematic_causes(
    fit: AxisFit, recordings: Sequence[Recording], latency: Latency, vertical: Height, shared: bool
) -> list[Cause]:
    """The wrenches' delay, the lever of the compressed slide, and for roll the zero of the yaw torque."""
    foot, column = fit.foot, ROTATIONAL_AXES.index(fit.axis)
    blocks = blocks_of(recordings, foot, fit.axis, drift=not shared, fit=fit)
    served = {recording.name: recording for recording in recordings}
    parts = [(served[block.label], served[block.label].used(foot)) for block in blocks]

    def moved_by(changes: Sequence[Array]) -> Array:
        return effect_of(blocks, changes, shared_offset=shared)

    rates = [differentiate(one.bushes[foot].torque[:, column], one.period)[used] for one, used in parts]
    levers = [lever_effect(one.bushes[foot], one.period, one.cutoff)[used, column] for one, used in parts]
    causes = [
        Cause("delay", moved_by([np.nan_to_num(rate) for rate in rates]), latency.std, latency.freedom),
        Cause("lever", moved_by(levers), vertical.compliance_std[foot], vertical.freedom),
    ]
    if fit.axis == "roll":
        # Roll's torque is cos(pitch)·τ_x - sin(pitch)·τ_z: the zero of τ_z, as large as the others', does not stay a
        # constant. Each recording has its own.
        usual = float(np.sqrt(np.mean(np.square(list(fit.offsets.values())))))
        sines = [np.sin(one.bushes[foot].deflection[used, 0]) for one, used in parts]
        effects = np.array(
            [moved_by([s if i == j else 0 * s for j, s in enumerate(sines)]) for i in range(len(sines))]
        )
        causes.append(Cause("yaw torque zero", np.sqrt(np.sum(effects**2, axis=0)), usual))
    return causes


def widened(fit: AxisFit, causes: Sequence[Cause]) -> AxisFit:
    """The fit with the causes inside its covariance."""
    covariance, freedom = fit.covariance.copy(), fit.freedom
    for cause in causes:
        added = np.zeros(len(covariance))
        added[: len(cause.effect)] = cause.effect * cause.std
        variances = np.array([np.diag(covariance), added**2])
        freedom = pooled_freedom(variances, np.vstack([freedom, np.full_like(added, cause.freedom)]))
        covariance = covariance + np.outer(added, added)
    return replace(fit, covariance=covariance, freedom=freedom)

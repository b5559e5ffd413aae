"""What imperfect angles do to the fit of one axis: noise draws values towards zero, a wrong zero bends a cube."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.estimation import LinearFit, fit_blocks
from plantar.estimation.errors_in_variables import attenuation, offsets_moved
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import blocks_of
from plantar.models import KelvinVoigt
from plantar.notes import Note

NOISE_DOUBT = 0.3  # of what noise takes off: it may not be white
NEGLIGIBLE, TINY = 0.1, 1e-3  # of a deviation and of a value: a smaller bias is not worth a correction


def over_stances(fit: AxisFit, recordings: Sequence[Recording]) -> AxisFit:
    """The fit with its linear parameters found anew over weighted stances, whose offsets are drawn together.

    Shape and memory stay as they are. Deviations are the larger ones of both fits.
    """
    size = len(fit.values)
    found, anew = _linear_anew(fit, recordings)
    freedom = fit.freedom.copy()
    freedom[:size] = np.where(found.std > fit.std[:size], found.freedom[:size], freedom[:size])
    offset_std = {label: found.offset_std(label) for label in found.offsets}
    return replace(anew.at_place(found.common_nuisance), freedom=freedom, offset_std=offset_std)


def about_true_zero(fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> AxisFit:
    """The fit with an unknown zero of the deflection in each recording, where its model's shape depends on it.

    The memory stays as it is; linear parameters and offsets are found anew.
    """
    if not fit.model.zero_matters or shared:
        return fit
    found, anew = _linear_anew(fit, recordings)
    offset_std = {label: max(std, found.offset_std(label)) for label, std in fit.offset_std.items()}
    return replace(anew, offset_std=offset_std)


def _linear_anew(fit: AxisFit, recordings: Sequence[Recording]) -> tuple[LinearFit, AxisFit]:
    """Linear parameters and offsets found anew, and the fit with them: its deviations are the larger ones of both."""
    size = len(fit.values)
    found = fit_blocks(blocks_of(recordings, fit.foot, fit.axis, fit=fit))
    wider = np.ones(len(fit.covariance))
    wider[:size] = np.maximum(1.0, found.std / fit.std[:size])
    covariance = fit.covariance * np.outer(wider, wider)
    return found, replace(fit, values=found.values, covariance=covariance, offsets=found.offsets)


def with_best_offsets(fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> AxisFit:
    """The fit of a standing foot with the offsets that its other parameters leave: the corrections before it are of
    first order, and a place and a stiffness that both move leave a constant of second order."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, fit=fit)
    if blocks[0].stances is not None:
        return fit
    missed = {block.label: block.response - block.regressor @ fit.values for block in blocks}
    if shared:
        missed = dict.fromkeys(missed, np.concatenate(list(missed.values())))
    return replace(fit, offsets={label: float(np.mean(left)) for label, left in missed.items()})


def unattenuated(fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> AxisFit:
    """The fit without the bias of noisy regressors; as it is where that is small."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, drift=not shared, fit=fit)
    taken, size = attenuation(blocks, fit.values, shared_offset=shared), len(fit.values)
    where = f"{fit.foot} {fit.axis}"
    if taken is None:
        text = f"{where}: angles and rates are mostly noise; stiffness and damping may be too small by any factor"
        return replace(fit, notes=(*fit.notes, Note("noisy_regressors", "warning", text)))
    if np.all(np.abs(taken) < np.maximum(NEGLIGIBLE * fit.std[:size], TINY * np.abs(fit.values))):
        return fit
    added = np.zeros(len(fit.covariance))
    added[:size] = NOISE_DOUBT * taken
    moved = offsets_moved(blocks, taken, shared_offset=shared)
    share = ", ".join(
        f"{name} {100 * part / value:+.2g} %"
        for name, part, value in zip(fit.model.terms, taken, fit.values, strict=True)
        if value
    )
    text = f"{where}: noise in angles and rates had made the values too small; corrected: {share}"
    values = fit.values + taken
    linear = isinstance(fit.model, KelvinVoigt)
    return replace(
        fit,
        values=values,
        covariance=fit.covariance + np.outer(added, added),
        offsets={label: offset + moved[label] for label, offset in fit.offsets.items()},
        offset_std={
            label: float(np.hypot(std, NOISE_DOUBT * moved[label])) for label, std in fit.offset_std.items()
        },
        equivalent=(float(values[0]), float(values[1])) if linear else fit.equivalent,
        notes=(*fit.notes, Note("noisy_regressors", "info", text)),
    )

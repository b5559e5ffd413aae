"""One axis of one foot: the law that its motions ask for, fitted to all of them (eq. 4 to 7)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.estimation import Block, LinearFit, fit_linear
from plantar.estimation.errors_in_variables import attenuation, offsets_moved
from plantar.estimation.law_choice import LawChoice, choose_law
from plantar.estimation.law_fit import LawFit, fit_law
from plantar.estimation.law_trials import Trial
from plantar.identify.recording import Recording
from plantar.identify.settings import AUTOMATIC, FeetSettings
from plantar.models import LAWS, KelvinVoigt, Law, Motion
from plantar.notes import Note
from plantar.signals import low_pass

FEWEST_SAMPLES = 50  # of one recording, for it to take part in a fit
LEAST_EXPLAINED = 0.5  # of the torque's variance by spring and damper: below it no law of the bush will help
FULLY_EXPLAINED = 0.997  # above it no richer law could gain what its own parameters cost
SHORT_STANCE = 5.0  # s: the usual stance of walking is shorter, and tells nothing of a memory
NEGLIGIBLE, TINY = 0.1, 1e-3  # of a deviation and of a value: a smaller bias is not worth a correction
NOISE_DOUBT = 0.3  # of what noise takes off: it may not be white
CANDIDATES = (
    "kelvin_voigt", "hardening", "coulomb", "elastoplastic", "hardening_elastoplastic", "bouc_wen",
    "standard_linear_solid",
)  # fmt: skip


@dataclass(frozen=True)
class AxisFit:
    """A fitted law. `values` (k,) as `law.terms`, `shape` (s,) as `law.shape_terms`; `covariance`, `freedom` and
    `white_std` run over both. `starts`: where the law's memory begins in each recording's runs. `equivalent`: K and C
    of spring and damper over the same motions."""

    foot: str
    axis: Axis
    law: Law
    values: Array
    shape: Array
    covariance: Array
    freedom: Array
    white_std: Array
    offsets: Mapping[str, float]
    offset_std: Mapping[str, float]
    starts: Mapping[str, Array]
    equivalent: tuple[float, float]
    choice: LawChoice | None
    reason: str
    notes: tuple[Note, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        return (*self.law.terms, *self.law.shape_terms)

    @property
    def numbers(self) -> Array:
        """Values and shape, (k + s,)."""
        return np.concatenate([self.values, self.shape])

    @property
    def std(self) -> Array:
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    def to_dict(self) -> dict[str, Any]:
        """The law, why it was chosen, and what the others would have missed by."""
        stiffness, damping = self.equivalent
        content: dict[str, Any] = {
            "foot": self.foot,
            "axis": self.axis,
            "law": self.law.name,
            "reason": self.reason,
            "linear_equivalent": {"stiffness": stiffness, "damping": damping},
        }
        if self.choice is not None:
            content |= {
                "held_out": self.choice.held_out,
                "ranking": [
                    {"law": score.law.name, "held_out_rms": score.held_out_rms, "parameters": score.parameters,
                     "refused": score.refused, "chosen": score.chosen}
                    for score in self.choice.ranking
                ],
            }  # fmt: skip
        return content


def fit_axis(
    recordings: Sequence[Recording], foot: str, axis: Axis, settings: FeetSettings
) -> AxisFit | None:
    """The law asked for, or the one that predicts held-out motions; None where no recording has samples that serve.

    What noise in angles and rates takes off its values is given back, where that matters.
    """
    fit = _fitted(recordings, foot, axis, settings)
    return fit and _unattenuated(fit, recordings, settings.offset == "shared")


def _unattenuated(fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> AxisFit:
    """The fit without the bias of noisy regressors; as it is where that is small."""
    blocks = blocks_of(recordings, fit.foot, fit.axis, drift=not shared, fit=fit)
    taken, size = attenuation(blocks, fit.values, shared_offset=shared), len(fit.values)
    where = f"{fit.foot} {fit.axis}"
    if taken is None:
        text = f"{where}: angles and rates are mostly noise; stiffness and damping come out too small by any factor"
        return replace(fit, notes=(*fit.notes, Note("noisy_regressors", "warning", text)))
    if np.all(np.abs(taken) < np.maximum(NEGLIGIBLE * fit.std[:size], TINY * np.abs(fit.values))):
        return fit
    added = np.zeros(len(fit.covariance))
    added[:size] = NOISE_DOUBT * taken
    moved = offsets_moved(blocks, taken, shared_offset=shared)
    share = ", ".join(
        f"{name} {100 * part / value:+.2g} %"
        for name, part, value in zip(fit.law.terms, taken, fit.values, strict=True)
        if value
    )
    text = f"{where}: noise in angles and rates had drawn values towards zero; given back: {share}"
    values = fit.values + taken
    linear = isinstance(fit.law, KelvinVoigt)
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


def _fitted(recordings: Sequence[Recording], foot: str, axis: Axis, settings: FeetSettings) -> AxisFit | None:
    shared = settings.offset == "shared"
    blocks = blocks_of(recordings, foot, axis, drift=not shared)
    if not blocks:
        return None
    linear = fit_linear(blocks, shared_offset=shared)
    if settings.model == KelvinVoigt.name:
        return _of_linear(foot, axis, linear, None, "asked for")
    trials = [trial_of(recording, foot, axis) for recording in recordings if recording.name in linear.offsets]
    if settings.model != AUTOMATIC:
        fit = fit_law(LAWS[settings.model], trials, settings.cutoff, shared_offset=shared)
        return _of_law(foot, axis, fit, linear, None, "asked for")
    explained = _explained(linear, blocks)
    if not LEAST_EXPLAINED < explained < FULLY_EXPLAINED:
        return _of_linear(foot, axis, linear, None, _untried(explained))
    laws = [LAWS[name] for name in CANDIDATES if not LAWS[name].remembers or _remembers(trials)]
    choice = choose_law(trials, laws, settings.cutoff, shared_offset=shared)
    if choice.fit.law.name == KelvinVoigt.name:
        return _of_linear(foot, axis, linear, choice, choice.reason)
    return _of_law(foot, axis, choice.fit, linear, choice, choice.reason)


def blocks_of(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    *,
    drift: bool = True,
    fit: AxisFit | None = None,
) -> list[Block]:
    """Eq. 6 for each recording in which the foot has enough samples that serve, in the columns of a fit's law.

    `drift` adds a line in time to each recording's offset: the IMU's attitude drifts slowly.
    """
    column = ROTATIONAL_AXES.index(axis)
    blocks = []
    for recording in recordings:
        used, bush = recording.used(foot), recording.bushes[foot]
        if used.sum() < FEWEST_SAMPLES or (fit is not None and recording.name not in fit.offsets):
            continue
        time = recording.time[used]
        nuisance = (time - time.mean())[:, None] if drift else None
        regressor = law_columns(recording, foot, axis, fit)[used]
        noise = np.zeros(regressor.shape[1])
        noise[:2] = recording.noise[foot][:, column]
        torque = bush.torque[used, column]
        blocks.append(Block(recording.name, regressor, torque, recording.period, nuisance, noise))
    return blocks


def law_columns(
    recording: Recording, foot: str, axis: Axis, fit: AxisFit | None, starts: Array | None = None
) -> Array:
    """Regressor (N, k) of a fit's law along a recording, Kelvin-Voigt's without one; NaN in the air."""
    motion = motion_of(recording, foot, axis)
    if fit is None or isinstance(fit.law, KelvinVoigt):
        return np.column_stack([motion.deflection, motion.rate])
    starts = fit.starts.get(recording.name) if starts is None else starts
    if starts is None or len(starts) != len(motion.runs):
        starts = fit.law.starts(motion, fit.shape)
    columns = fit.law.columns(motion, fit.shape, starts)
    columns[:, 2:] = low_pass(columns[:, 2:], recording.period, recording.cutoff)
    return columns


def motion_of(recording: Recording, foot: str, axis: Axis) -> Motion:
    """Deflection and rate of one axis, NaN where the foot does not stand: a bush in the air forgets."""
    column, bush = ROTATIONAL_AXES.index(axis), recording.bushes[foot]
    away = ~recording.contacts[foot].loaded
    deflection, rate = bush.deflection[:, column].copy(), bush.rate[:, column].copy()
    deflection[away] = rate[away] = np.nan
    return Motion(deflection, rate, recording.period)


def trial_of(recording: Recording, foot: str, axis: Axis) -> Trial:
    """One recording of one axis, as the laws take it."""
    torque = recording.bushes[foot].torque[:, ROTATIONAL_AXES.index(axis)]
    return Trial(recording.name, motion_of(recording, foot, axis), torque, recording.used(foot))


def _explained(fit: LinearFit, blocks: Sequence[Block]) -> float:
    """Share of the torque's variance, within recordings, that spring and damper explain."""
    varied = sum(float(np.sum((block.response - block.response.mean()) ** 2)) for block in blocks)
    missed = sum(float(residual @ residual) for residual in fit.residuals.values())
    return 1 - missed / varied if varied > 0 else 0.0


def _untried(explained: float) -> str:
    share = f"spring and damper explain {100 * explained:.4g} % of the torque's variance"
    if explained >= FULLY_EXPLAINED:
        return f"{share}: no richer law is needed"
    return f"{share}: something else than the bush makes this torque, and no richer law was tried"


def _remembers(trials: Sequence[Trial]) -> bool:
    """Whether stances last long enough for a law with memory: each begins with an unknown state."""
    stances = [run for trial in trials for run in trial.motion.runs]
    seconds = sum(
        (run.stop - run.start) * trial.motion.period for trial in trials for run in trial.motion.runs
    )
    return bool(stances) and seconds / len(stances) > SHORT_STANCE


def _of_linear(foot: str, axis: Axis, fit: LinearFit, choice: LawChoice | None, reason: str) -> AxisFit:
    size = len(fit.values)
    return AxisFit(
        foot, axis, KelvinVoigt(), fit.values, np.zeros(0), fit.covariance[:size, :size], fit.freedom[:size],
        fit.white_std, fit.offsets, {label: fit.offset_std(label) for label in fit.offsets}, {},
        (float(fit.values[0]), float(fit.values[1])), choice, reason,
    )  # fmt: skip


def _of_law(
    foot: str, axis: Axis, fit: LawFit, linear: LinearFit, choice: LawChoice | None, reason: str
) -> AxisFit:
    return AxisFit(
        foot, axis, fit.law, fit.values, fit.shape, fit.covariance, fit.freedom, fit.white_std, fit.offsets,
        fit.offset_std, fit.starts, (float(linear.values[0]), float(linear.values[1])), choice, reason,
    )  # fmt: skip

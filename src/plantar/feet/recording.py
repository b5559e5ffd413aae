"""A log made ready for eq. 6: even samples, bush angles, rates and torques, contact, and what is left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from plantar.contact.deflection import BushState
from plantar.contact.phases import FootContact
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances
from plantar.conventions import FORCE, Array, Mask
from plantar.estimation.errors_in_variables import noise_after_filter
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.signals.filters import SHORTEST_RUN, low_pass
from plantar.signals.segments import run_ends

FILTER_EDGE = 1.0  # of the filter's period, left out where a run of samples begins or ends
SHORTEST_STANCE_RUN = 8  # samples of a stance, for it to be filtered by itself

Role = Literal["fit", "validate"]


@dataclass(frozen=True)
class Recording:
    """One log with each foot's bush state, as measured and filtered, and its contact. Arrays run over `time` (N,).

    `cutoff` [Hz] is that of `bushes`, infinite before they are filtered. `stances`: of feet that step, else None.
    `noise` (2, 2) of each foot: variance of white noise that is left in deflection and rate, of pitch and roll.
    `places` (N, 2) of each foot: of the sole from the IMU [m] in the attitude as recorded, which slides are judged by.
    """

    log: MotionLog
    role: Role
    cutoff: float
    raw: Mapping[str, BushState]
    bushes: Mapping[str, BushState]
    contacts: Mapping[str, FootContact]
    stances: Mapping[str, Stances | None]
    noise: Mapping[str, Array]
    places: Mapping[str, Array]
    notes: tuple[Note, ...]

    @property
    def name(self) -> str:
        return self.log.name

    @property
    def time(self) -> Array:
        return self.log.time

    @property
    def period(self) -> float:
        return self.log.period

    def used(self, foot: str) -> Mask:
        """Samples of this foot that are used."""
        return self.contacts[foot].used

    def without(self, foot: str, samples: Mask, reason: Reason, detail: str = "") -> Recording:
        """The same recording with these samples of one foot left out."""
        contact = self.contacts[foot].without(samples, reason, detail)
        return replace(self, contacts={**self.contacts, foot: contact})


def filtered_recording(recording: Recording, cutoff: float) -> Recording:
    """The recording with angles, rates and torques filtered at `cutoff` [Hz], without samples that the filter loses."""
    period, noise = recording.period, {}
    smooth = {}
    for name, state in recording.raw.items():
        stances = recording.stances[name]
        if stances is None:
            smooth[name] = filtered(state, period, cutoff)
        else:  # each stance by itself: a filter must not carry what the foot does in the air into it
            smooth[name] = filtered(_within(state, stances), period, cutoff, SHORTEST_STANCE_RUN)
        values = np.column_stack([smooth[name].deflection, smooth[name].rate, smooth[name].torque])
        valid = np.asarray(np.isfinite(values).all(axis=1))
        recording = recording.without(name, ~valid, Reason.NOT_RECORDED)
        if stances is None:
            edges = run_ends(valid, round(FILTER_EDGE / cutoff / period))
            recording = recording.without(name, edges, Reason.FILTER_EDGE)
        noise[name] = _noise(state, period, cutoff)
    return replace(recording, cutoff=cutoff, bushes=smooth, noise=noise)


def filtered(state: BushState, period: float, cutoff: float, shortest: int = SHORTEST_RUN) -> BushState:
    """The state with angles, rates and torques through one zero-phase filter: the law between them stays."""
    values = low_pass(np.column_stack([state.deflection, state.rate, state.torque]), period, cutoff, shortest)
    return replace(state, deflection=values[:, 0:2], rate=values[:, 2:4], torque=values[:, 4:6])


def _within(state: BushState, stances: Stances) -> BushState:
    """The state, NaN in the air."""
    away = np.where(stances.number < 0, np.nan, 0.0)[:, None]
    return replace(
        state, deflection=state.deflection + away, rate=state.rate + away, torque=state.torque + away
    )


def _noise(state: BushState, period: float, cutoff: float) -> Array:
    """Variance (2, 2) of the noise left in deflection and rate (rows) of pitch and roll (columns)."""
    angles = np.hstack([state.deflection, state.rate])
    return noise_after_filter(angles, state.torque, period, cutoff).reshape(2, 2)


def moved_centre(recording: Recording, compliance: Mapping[str, float]) -> Recording:
    """The recording with torques about the bush's centre where its z slide has carried it.

    Under a load F_z the slide is compressed by z = compliance·F_z, so that pitch and roll turn about a point z higher
    in the ankle: torque' = torque - z e_z × force. Left out, K comes out too large by F_z²·compliance.
    """
    bushes = {
        foot: replace(
            bush,
            torque=bush.torque
            + compliance[foot] * moment_arm_effect(bush, recording.period, recording.cutoff),
        )
        for foot, bush in recording.bushes.items()
    }
    return replace(recording, bushes=bushes)


def moment_arm_effect(bush: BushState, period: float, cutoff: float) -> Array:
    """Change of pitch and roll torque for each m/N of vertical compliance, (N, 2) [N·m per m/N], filtered alike."""
    x, y, z = bush.wrench[:, FORCE].T
    return low_pass(np.column_stack([-z * x, np.cos(bush.deflection[:, 0]) * z * y]), period, cutoff)

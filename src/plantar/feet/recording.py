"""A log made ready for eq. 6: even samples, bush angles, rates and torques, contact, and what is left out."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, cast

import numpy as np

from plantar.contact.deflection import BushState
from plantar.contact.phases import FootContact
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances
from plantar.conventions import FORCE, Array, Mask
from plantar.estimation.errors_in_variables import noise_after_filter
from plantar.estimation.slow_drift import drift_basis
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.results.walk_rows import SwingZero
from plantar.sensors.attitude_scale import AttitudeScale
from plantar.signals.filters import SHORTEST_FITTED_RUN, differentiate, low_pass
from plantar.signals.segments import complete, run_ends

FILTER_EDGE = 1.0  # of the filter's period, left out where a run of samples begins or ends
SAMPLES_PER_CYCLE = 8  # of the cutoff, that a fit takes
WIDE_BAND = 3.0  # cutoffs: at that of a fit nothing is lost, and nothing beyond twice as far is left

Role = Literal["fit", "validate"]


@dataclass(frozen=True)
class Recording:
    """One log with each foot's bush state, as measured and filtered, and its contact. Arrays run over `time` (N,).

    `cutoff` [Hz] is that of `bushes`, infinite before they are filtered. `stances`: of feet that step, else None.
    `noise` (2, 2) of each foot: variance of white noise that is left in deflection and rate, of pitch and roll.
    `places` (N, 2) of each foot: of the sole from the IMU [m] in the attitude as recorded, which slides are judged by.
    `imu_turns` (N, 2, 3) of each foot: see `imu_turn_effects`; filtered as `bushes`.
    `encoder_rates` (N, 2) of each foot: of the deflection, as far as joints turn [rad/s]; filtered as `bushes`.
    `zeros`: of force sensors, as read while their foot swings; they are taken off already.
    `attitude_scale`: what its stances tell of the IMU's; nothing of an attitude that was put right.
    `every`: of how many of the log's samples each is one.
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
    zeros: tuple[SwingZero, ...]
    imu_turns: Mapping[str, Array]
    encoder_rates: Mapping[str, Array]
    attitude_scale: AttitudeScale
    every: int = 1

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

    def rows(self, foot: str) -> Mask:
        """Those of the used samples that a fit takes."""
        return self.thinned(foot, self.used(foot))

    def thinned(self, foot: str, samples: Mask) -> Mask:
        """Those of some samples (N,) that a fit of this foot takes: behind its filter a few of each cycle say all."""
        rows, stride = np.zeros_like(samples), self.stride(foot)
        rows[::stride] = samples[::stride]
        return rows

    def stride(self, foot: str) -> int:
        """Samples from one of `rows` to the next."""
        return max(1, int(1 / (SAMPLES_PER_CYCLE * self.cutoff * self.period)))

    def drift(self, foot: str) -> Array:
        """Orthonormal columns (n, m) of what drifts slowly over `rows`."""
        if ("drift", foot) not in self.kept:
            self.kept["drift", foot] = drift_basis(self.time[self.rows(foot)])
        return cast(Array, self.kept["drift", foot])

    def loads(self, foot: str) -> Array:
        """Forces along the bush's x and y and the vertical, and the torque about its third axis, through the filter of
        the torque, (N, 4); 0 where they are not known: where nothing is used."""
        if ("loads", foot) not in self.kept:
            bush = self.bushes[foot]
            rows = np.column_stack([bush.wrench[:, :2], bush.force_z, bush.wrench[:, 5]])
            smooth = within_stances(rows, self.period, self.cutoff, self.stances[foot])
            self.kept["loads", foot] = np.nan_to_num(smooth)
        return cast(Array, self.kept["loads", foot])

    @cached_property
    def kept(self) -> dict[Hashable, object]:
        """What was worked out of the recording, by its name, once it was asked for: every stage of a fit asks again."""
        return {}

    def decimated(self, foot: str) -> Recording:
        """What a fit of this foot reads, `rows` alone, and nothing else of the log; itself where these are all, or the
        foot steps: turns of a memory's path are quick then.

        What has not passed the fit's filter passes one that is wide enough to leave that one its band.
        """
        stride, bush = self.stride(foot), self.bushes[foot]
        if stride == 1 or self.stances[foot] is not None:
            return self
        rows = slice(None, None, stride)
        loads = np.column_stack([bush.wrench, bush.force_z])
        loads = low_pass(loads, self.period, WIDE_BAND * self.cutoff, every=stride)
        kept = BushState(*(np.ascontiguousarray(values[rows]) for values in vars(bush).values()))
        kept = replace(kept, wrench=loads[:, :6], force_z=loads[:, 6])
        return replace(
            self,
            log=MotionLog(self.name, self.time[rows], {}, self.log.path, self.log.sha256, self.log.notes),
            raw={foot: kept},
            bushes={foot: kept},
            contacts={foot: self.contacts[foot].decimated(rows)},
            stances={foot: None},
            places={},
            imu_turns={name: turns[rows] for name, turns in self.imu_turns.items()},
            encoder_rates={foot: self.encoder_rates[foot][rows]} if self.encoder_rates else {},
            every=stride * self.every,
        )

    def with_imu_turned(self, turn: tuple[float, float, float]) -> Recording:
        """The recording with bush angles and rates as an IMU has seen them that is turned by `turn` [rad] about its own
        axes, to first order (`imu_turns`); as they are where a foot is in the air."""
        change = {foot: effects @ np.array(turn) for foot, effects in self.imu_turns.items()}
        return (
            self._changed(lambda foot, state: _plus(state, change[foot], self.period)) if any(turn) else self
        )

    def with_encoders_later(self, by: float) -> Recording:
        """The recording with bush angles and rates as encoders show them that are read `by` later [s], to first order
        (`encoder_rates`)."""
        if not by or not self.encoder_rates:
            return self
        return self._changed(lambda foot, state: _plus(state, by * self.encoder_rates[foot], self.period))

    def with_wrenches_later(self, by: float) -> Recording:
        """The recording with torques of force sensors that are read `by` later [s], to first order."""

        def later(_: str, state: BushState) -> BushState:
            slope = np.nan_to_num(differentiate(state.torque, self.period))
            return replace(state, torque=state.torque + by * slope)

        return self._changed(later) if by else self

    def _changed(self, change: Callable[[str, BushState], BushState]) -> Recording:
        """The recording with each foot's states changed, as measured and as filtered."""
        raw, bushes = (
            {foot: change(foot, state) for foot, state in states.items()}
            for states in (self.raw, self.bushes)
        )
        return replace(self, raw=raw, bushes=bushes)

    def without(self, foot: str, samples: Mask, reason: Reason, detail: str = "") -> Recording:
        """The same recording with these samples of one foot left out."""
        contact = self.contacts[foot].without(samples, reason, detail)
        return replace(self, contacts={**self.contacts, foot: contact})


def has_steps(recording: Recording) -> bool:
    """Whether a foot steps."""
    return any(stances is not None for stances in recording.stances.values())


def filtered_recording(recording: Recording, cutoff: float) -> Recording:
    """The recording with angles, rates and torques filtered at `cutoff` [Hz], without samples that the filter loses."""
    period, noise = recording.period, {}
    smooth = {}
    for name, state in recording.raw.items():
        stances = recording.stances[name]
        signals = np.column_stack([state.deflection, state.rate, state.torque])
        passed = within_stances(signals, period, cutoff, stances)
        smooth[name], valid = _with_signals(state, passed), complete(passed)
        recording = recording.without(name, ~valid, Reason.NOT_RECORDED)
        if stances is None:
            edges = run_ends(valid, round(FILTER_EDGE / cutoff / period))
            recording = recording.without(name, edges, Reason.FILTER_EDGE)
        noise[name] = noise_after_filter(state.deflection, state.rate, state.torque, period, cutoff)
    turns = {
        name: within_stances(turns.reshape(-1, 6), period, cutoff, recording.stances[name]).reshape(-1, 2, 3)
        for name, turns in recording.imu_turns.items()
    }
    rates = {
        name: within_stances(own, period, cutoff, recording.stances[name])
        for name, own in recording.encoder_rates.items()
    }
    return replace(recording, cutoff=cutoff, bushes=smooth, noise=noise, imu_turns=turns, encoder_rates=rates)


def filtered(state: BushState, period: float, cutoff: float) -> BushState:
    """The state with angles, rates and torques through one zero-phase filter: the model between them stays."""
    signals = np.column_stack([state.deflection, state.rate, state.torque])
    return _with_signals(state, low_pass(signals, period, cutoff))


def _plus(state: BushState, angles: Array, period: float) -> BushState:
    """The state with angles (N, 2) added, and how these change to its rates; as it is where they are NaN."""
    rates = np.nan_to_num(differentiate(angles, period))
    return replace(state, deflection=state.deflection + np.nan_to_num(angles), rate=state.rate + rates)


def _with_signals(state: BushState, signals: Array) -> BushState:
    """The state with other angles, rates and torques, (N, 6)."""
    return replace(state, deflection=signals[:, 0:2], rate=signals[:, 2:4], torque=signals[:, 4:6])


def within_stances(values: Array, period: float, cutoff: float, stances: Stances | None) -> Array:
    """The filter of what eq. 6 ties together, of (N, k). Of a foot that steps, each stance passes by itself and the air
    is NaN: the filter must not carry what the foot does in the air into a stance."""
    if stances is not None:
        values = np.where((stances.number < 0)[:, None], np.nan, values)
    return low_pass(values, period, cutoff, SHORTEST_FITTED_RUN)


def moved_centre(recording: Recording, compliance: Mapping[str, float]) -> Recording:
    """The recording with torques about the bush's centre where its z slide has carried it.

    Under a load F_z the slide is compressed by z = compliance·F_z, so that pitch and roll turn about a point z higher
    in the ankle: torque' = torque - z e_z × force. Left out, K comes out too large by F_z²·compliance.
    """
    bushes = {
        foot: replace(
            bush,
            torque=bush.torque + compliance[foot] * moment_arm_effect(recording, foot),
        )
        for foot, bush in recording.bushes.items()
    }
    return replace(recording, bushes=bushes)


def moment_arm_effect(recording: Recording, foot: str) -> Array:
    """Change of pitch and roll torque for each m/N of vertical compliance, (N, 2) [N·m per m/N], filtered as they are:
    it is known wherever they are."""
    bush = recording.bushes[foot]
    x, y, z = bush.wrench[:, FORCE].T
    effect = np.column_stack([-z * x, np.cos(bush.deflection[:, 0]) * z * y])
    return within_stances(effect, recording.period, recording.cutoff, recording.stances[foot])

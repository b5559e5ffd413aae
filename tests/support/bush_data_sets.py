"""Recordings of one foot axis with a known bush, made without plantar's laws: the state is stepped sample by sample."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.model_selection.data_sets import DataSet
from plantar.model_selection.initial_state import initial_states_of
from plantar.model_selection.model_fit import ModelFit
from plantar.models import BushMotion
from plantar.signals.filters import low_pass

PERIOD = 0.005


@dataclass(frozen=True)
class Rubber:
    """The truth: spring, damper, and beside them an element that slips (sharpness None: Jenkins), a cubic term."""

    stiffness: float = 434.0
    damping: float = 15.89
    slip_torque: float = 0.0
    slip_angle: float = 0.01
    sharpness: float | None = None
    hardening: float = 0.0
    coulomb: float = 0.0

    def torque(self, deflection: np.ndarray, rate: np.ndarray) -> np.ndarray:
        plain = self.stiffness * deflection + self.damping * rate + self.hardening * deflection**3
        plain = plain + self.coulomb * np.tanh(rate / 0.005)
        return plain + self.slip_torque * self.states(deflection)

    def states(self, deflection: np.ndarray) -> np.ndarray:
        state, states, substeps = 0.0, [0.0], 1 if self.sharpness is None else 8
        for step in np.diff(deflection) / self.slip_angle:
            for _ in range(substeps):
                if self.sharpness is None:
                    state = min(max(state + step, -1.0), 1.0)
                else:
                    small = step / substeps
                    state = bouc_wen_step(state, small, self.sharpness)
            states.append(state)
        return np.array(states)


def bouc_wen_step(state: float, step: float, sharpness: float) -> float:
    """One fourth-order Runge-Kutta step of dz = dx (1 - sign(dx) z |z|^(n-1))."""
    way = 1.0 if step >= 0 else -1.0

    def slope(z: float) -> float:
        return step * (1 - way * z * abs(z) ** (sharpness - 1))

    a = slope(state)
    b = slope(state + a / 2)
    c = slope(state + b / 2)
    d = slope(state + c)
    return min(max(state + (a + 2 * b + 2 * c + d) / 6, -1.0), 1.0)


def sway(rng: np.random.Generator, amplitude: float, frequency: float, duration: float = 24.0) -> np.ndarray:
    """A hand that sways the robot: roughly a sine, its size and speed wandering, from rest to rest."""
    time = PERIOD * np.arange(round(duration / PERIOD))
    wander = low_pass(rng.standard_normal((len(time), 2)), PERIOD, 0.15) / 0.05
    phase = 2 * np.pi * np.cumsum(frequency * (1 + 0.1 * np.clip(wander[:, 0], -2, 2))) * PERIOD
    size = amplitude * (1 + 0.12 * np.clip(wander[:, 1], -2, 2))
    fade = np.clip(np.minimum(time - 2, duration - 2 - time) / 2, 0, 1)
    lean = 0.004 * rng.standard_normal()
    return lean + low_pass(size * np.sin(phase) * fade**2 * (3 - 2 * fade), PERIOD, 3.0)


def tilt(
    rng: np.random.Generator, amplitude: float = 0.01, frequency: float = 0.1, duration: float = 44.0
) -> np.ndarray:
    """A slow tilt to and fro, with what the robot's own swaying adds."""
    path = sway(rng, amplitude, frequency, duration)
    ripple = low_pass(rng.standard_normal(len(path)), PERIOD, 2.0)
    return path + 0.03 * amplitude * ripple / ripple.std()


def recorded(
    rng: np.random.Generator, label: str, path: np.ndarray, rubber: Rubber, *, noise: float = 1.0
) -> DataSet:
    """What the sensors say: attitude bias and drift, gyroscope and wrench noise, zeros drawn per recording."""
    time = PERIOD * np.arange(len(path))
    rate = np.gradient(path, PERIOD)
    drift = np.radians(0.03) * rng.standard_normal() * time / time[-1]
    jitter = low_pass(rng.standard_normal(len(path)), PERIOD, 20.0) * 2e-4
    gyro = 0.0013 * rng.standard_normal(len(path))
    bias = np.radians(0.15) * rng.standard_normal()
    torque = rubber.torque(path, rate) + noise * (
        0.5 * rng.standard_normal() + 0.1 * rng.standard_normal(len(path))
    )
    wander = low_pass(rng.standard_normal(len(path)), PERIOD, 0.5)
    torque += noise * 0.1 * wander / wander.std()
    deflection = path + noise * (bias + drift + jitter)
    used = (time > 0.3) & (time < time[-1] - 0.3)
    return DataSet(label, BushMotion(deflection, rate + noise * gyro, PERIOD), torque, used)


def campaign(seed: int, rubber: Rubber, *, noise: float = 1.0) -> list[DataSet]:
    """Two sways of this axis, two tilts, and two recordings in which the axis hardly moves."""
    rng = np.random.default_rng(seed)
    paths = {
        "sway_1": sway(rng, rng.uniform(0.07, 0.14), rng.uniform(0.3, 1.0)),
        "sway_2": sway(rng, rng.uniform(0.05, 0.10), rng.uniform(0.3, 1.0)),
        "tilt_1": tilt(rng),
        "still": tilt(rng, 0.004, 0.5, 24.0),
    }
    return [recorded(rng, name, path, rubber, noise=noise) for name, path in paths.items()]


def unseen(seed: int, rubber: Rubber) -> list[DataSet]:
    """Motions that no fit sees."""
    rng = np.random.default_rng(100_000 + seed)
    paths = [sway(rng, rng.uniform(0.06, 0.12), rng.uniform(0.3, 1.0)), tilt(rng), sway(rng, 0.03, 0.4)]
    return [recorded(rng, f"unseen_{i}", path, rubber) for i, path in enumerate(paths)]


def largest_torque(data_sets: Sequence[DataSet]) -> float:
    """Largest torque about its mean over the trials [N·m]."""
    return max(float(np.max(np.abs(data_set.torque - data_set.torque.mean()))) for data_set in data_sets)


def error_percent(fit: ModelFit, rubber: Rubber) -> tuple[float, float]:
    """Errors of stiffness and damping."""
    return (
        100 * abs(fit.value("stiffness") / rubber.stiffness - 1),
        100 * abs(fit.value("damping") / rubber.damping - 1),
    )


def filtered(data_set: DataSet, cutoff: float) -> tuple[BushMotion, np.ndarray]:
    """Motion and torque as an identification has them."""
    deflection, rate, torque = (
        low_pass(values, PERIOD, cutoff)
        for values in (data_set.motion.deflection, data_set.motion.rate, data_set.torque)
    )
    return BushMotion(deflection, rate, PERIOD), torque


def reconstructed(fit: ModelFit, motion: BushMotion, initial_states: np.ndarray | None) -> np.ndarray:
    """Torque of a fitted law along a filtered motion, without offset."""
    columns = fit.model.columns(motion, fit.shape, initial_states)
    columns[:, 2:] = low_pass(columns[:, 2:], PERIOD, fit.cutoff)
    return np.asarray(columns @ fit.values)


def opened(
    fit: ModelFit, data_set: DataSet, first: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray | None]:
    """Predicted torque of an unseen recording whose samples `first` give its offset, that offset, and its start."""
    motion, torque = filtered(data_set, fit.cutoff)
    initial_states = None
    if fit.model.remembers:
        initial_states = initial_states_of(
            fit.model, fit.values, fit.shape, motion, torque, data_set.used, first, fit.cutoff
        )
    predicted = reconstructed(fit, motion, initial_states)
    offset = float(np.mean((torque - predicted)[first]))
    return predicted + offset, offset, initial_states


def unseen_error(fit: ModelFit, data_sets: list[DataSet]) -> float:
    """Mean absolute error after the first second, which gives the offset."""
    errors = []
    for data_set in data_sets:
        served = np.flatnonzero(data_set.used)
        first = np.zeros(len(data_set.torque), dtype=bool)
        first[served[:200]] = True
        missed = filtered(data_set, fit.cutoff)[1] - opened(fit, data_set, first)[0]
        errors.append(np.mean(np.abs(missed)[served[200:]]))
    return float(np.mean(errors))

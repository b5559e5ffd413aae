"""The bush's vertical stiffness, which the paper leaves out: heights of two standing soles agree (double support).

With the bushes taken as stiff in z, the kinematics put the right sole higher than the left one by

    h = z_L - z_R = F_L/K_L - F_R/K_R + const = s·(1/K_L + 1/K_R) + m·(1/K_L - 1/K_R) + const,

s = (F_L - F_R)/2 and m = (F_L + F_R)/2. Moving weight from foot to foot moves s and shows the sum of the compliances;
their difference shows only where the total m changes as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.contact import DOUBLE, SUPPORTS
from plantar.conventions import STIFFNESS_UNIT, Array
from plantar.deflection import closure
from plantar.estimation import Block, fit_linear, interval95, relative_std_percent
from plantar.identify.recording import Recording
from plantar.notes import Note
from plantar.result import Parameter, Verdict
from plantar.signals import low_pass

FEWEST_SAMPLES = 100  # in double support, of one recording
SEPARABLE = 0.25  # std of the compliances' difference over their sum, at most, to tell the feet apart
USABLE_WIDTH, WEAK_WIDTH = 0.15, 0.5  # half width of the interval over the value

ADVICE = "stand on both feet and shift the weight slowly from foot to foot, nearly all of it, for 30 s or more"


@dataclass(frozen=True)
class Compliances:
    """Sum and difference (left - right) of two feet's vertical compliances [m/N], with their covariance (2, 2)."""

    total: float
    difference: float
    covariance: Array
    freedom: float
    white_std: Array
    separable: bool


def vertical_stiffness(
    recordings: Sequence[Recording], feet: tuple[str, str], cutoff: float
) -> tuple[list[Parameter], Compliances | None, list[Note]]:
    """Rows of axis z for two feet, and the compliances behind them; empty where no log has double support."""
    blocks = [block for recording in recordings if (block := _block(recording, feet, cutoff)) is not None]
    if not blocks:
        return [], None, []
    fit = fit_linear(blocks)
    total, difference = float(fit.values[0]), float(fit.values[1])
    covariance = fit.covariance[:2, :2]
    separable = bool(total > 0 and np.sqrt(covariance[1, 1]) < SEPARABLE * total)
    found = Compliances(total, difference, covariance, float(fit.freedom[0]), fit.white_std[:2], separable)
    notes = []
    if not separable:
        text = "z: only the sum of both feet's compliances shows (the total load hardly changes); both taken as equal"
        notes.append(Note("z_sum_only", "info", text))
    return [_row(foot, side, found) for foot, side in zip(feet, (1.0, -1.0), strict=True)], found, notes


def _block(recording: Recording, feet: tuple[str, str], cutoff: float) -> Block | None:
    """h over [s, m, t] in double support; t is the attitude's drift over the recording, a nuisance."""
    left, right = (recording.bushes[foot] for foot in feet)
    both = recording.used(feet[0]) & recording.used(feet[1])
    both &= recording.contacts[feet[0]].support == SUPPORTS.index(DOUBLE)
    height = closure(left, right).position[:, 2]
    loads = np.column_stack([left.wrench[:, 2], right.wrench[:, 2]])
    values = low_pass(np.column_stack([height, loads]), recording.period, cutoff)
    both &= np.isfinite(values).all(axis=1)
    if both.sum() < FEWEST_SAMPLES:
        return None
    height, left_load, right_load = values[both].T
    regressor = np.column_stack([(left_load - right_load) / 2, (left_load + right_load) / 2])
    drift = np.column_stack([np.ones(len(height)), recording.time[both] - recording.time[both].mean()])
    joint = np.column_stack([regressor, height])
    clear = joint - drift @ np.linalg.lstsq(drift, joint, rcond=None)[0]
    return Block(recording.name, clear[:, :2], clear[:, 2], recording.period)


def _row(foot: str, side: float, found: Compliances) -> Parameter:
    """One foot's stiffness: from sum and difference where they separate, else with both feet alike."""
    weights = np.array([0.5, 0.5 * side if found.separable else 0.0])
    compliance = float(weights @ [found.total, found.difference])
    std = float(np.sqrt(weights @ found.covariance @ weights))
    low, high = interval95(compliance, std, found.freedom)
    unit = STIFFNESS_UNIT["z"]
    if low <= 0:
        reason = "the heights of the soles do not follow the load clearly"
        value = 1 / compliance if compliance > 0 else None
        return Parameter(foot, "z", "stiffness", unit, value, None, None, None, "unidentifiable", reason, ADVICE)
    value, interval = 1 / compliance, (1 / high, 1 / low)
    width = (high - low) / 2 / compliance
    verdict: Verdict = "usable" if width < USABLE_WIDTH else "weak" if width < WEAK_WIDTH else "unidentifiable"
    reason = f"95 % interval of the compliance ±{100 * width:.2g} %"
    if not found.separable:
        verdict = "weak" if verdict == "usable" else verdict
        reason += "; only the sum of both compliances shows, both feet taken as equal"
    white = float(np.sqrt(weights**2 @ found.white_std**2))
    return Parameter(
        foot, "z", "stiffness", unit, value, std * value**2, interval, relative_std_percent(compliance, white),
        verdict, reason, None if verdict == "usable" else ADVICE,
    )  # fmt: skip

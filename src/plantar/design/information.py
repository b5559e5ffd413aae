"""What a motion tells of each bush: the half widths that its deflections and torques promise (eq. 6 and 7)."""

from __future__ import annotations

from typing import Final, Literal, get_args

import numpy as np

from plantar.conventions import NORMAL95, Array
from plantar.design.reach import RATE, Reach
from plantar.design.rubber import NEARBY, SLIP_ANGLE, remembered

Criterion = Literal["widest", "D", "A"]
CRITERIA: Final = get_args(Criterion)
# N·m that a model of real rubber misses by, per independent sample of 0.1 s: sensors of a careful lab are better.
MISSED: Final = 0.1
STEEP: Final = (
    4  # with this power of what is missing widths grow: at two thirds, K came out half as large again
)
TOLD_APART: Final = 2 * SLIP_ANGLE  # rad that a bush bends to either side


def information(reach: Reach, coefficients: Array) -> Array:
    """Information matrices (S, feet, 2, 2, 2) of stiffness and damping of each foot and axis, for each of S bushes.

    An offset, a drift and an element with hysteresis are eliminated, as `identify feet` does.
    """
    bent, rate = reach.of(reach.firm_deflection, coefficients), reach.of(reach.firm_rate, coefficients)
    size = bent.shape[-1]
    element = remembered(bent.reshape(-1, size), (SLIP_ANGLE, NEARBY * SLIP_ANGLE)).reshape(
        *bent.shape[:-1], 2, size
    )
    element[..., 1, :] = (element[..., 1, :] - element[..., 0, :]) / np.log(NEARBY)
    columns = np.concatenate([bent[..., None, :], rate[..., None, :], element], axis=-2)
    line = np.linalg.qr(np.column_stack([np.ones(size), np.linspace(-1.0, 1.0, size)]))[0]
    free = columns - (columns @ line) @ line.T
    whole = 10.0 / RATE / MISSED**2 * free @ np.swapaxes(free, -1, -2)
    # What is known of the element before: it is about as strong as the spring, its angle within a half.
    known = np.outer(reach.stiffness, [1.0, 0.5])
    whole[..., [2, 3], [2, 3]] += 1.0 / known[:, None, None] ** 2
    across = whole[..., :2, 2:]
    return np.asarray(
        whole[..., :2, :2] - across @ np.linalg.solve(whole[..., 2:, 2:], np.swapaxes(across, -1, -2))
    )


def half_widths(reach: Reach, coefficients: Array, known: Array | float = 0.0) -> Array:
    """95 % half widths [share of the value] of stiffness and damping, (S, feet, 2, 2).

    `known`: information (feet, 2, 2, 2) from before. Where a bush bends less than TOLD_APART, `identify feet` may take
    a spring that slips for a part of the stiffness: the motion's own widths grow steeply.
    """
    bend = np.ptp(reach.of(reach.firm_deflection, coefficients), axis=-1) / 2
    missing = np.maximum(TOLD_APART / np.maximum(bend, 1e-6), 1.0)[..., None, None]
    found = information(reach, coefficients) / missing ** (2 * STEEP) + known
    scale = np.sqrt(np.maximum(np.einsum("...ii->...i", found), 1e-12))
    scaled = found / (scale[..., :, None] * scale[..., None, :]) + 1e-9 * np.eye(2)
    deviations = np.sqrt(np.einsum("...ii->...i", np.linalg.inv(scaled))) / scale
    values = np.column_stack([reach.stiffness, reach.damping])[:, None, None]
    return np.asarray(NORMAL95 * deviations / values)


def badness(reach: Reach, coefficients: Array, criterion: Criterion, known: Array | float = 0.0) -> float:
    """What is minimised, the mean over the range of stiffness: the logarithm of the widest relative interval, of the
    volume of all (D) or of their mean square (A)."""
    widths = half_widths(reach, coefficients, known).reshape(len(reach.bushes), -1)
    if criterion == "widest":
        return float(np.log(widths.max(axis=1)).mean())
    if criterion == "D":
        return float(np.log(widths).mean())
    return float(np.log(np.mean(widths**2, axis=1)).mean() / 2)

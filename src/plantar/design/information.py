"""What a motion tells of each bush: the half widths that its deflections and torques promise (eq. 6 and 7)."""

from __future__ import annotations

from typing import Final, Literal, get_args

import numpy as np

from plantar.conventions import NORMAL95, Array
from plantar.design.reach import RATE, Reach
from plantar.models.elastoplastic import jenkins_states
from plantar.models.hysteresis import Branches

Criterion = Literal["widest", "D", "A"]
CRITERIA: Final = get_args(Criterion)
# N·m that a model of real rubber misses by, per independent sample of 0.1 s: sensors of a careful lab are better.
MISSED: Final = 0.1
# Rubber remembers: beside the spring may stand an element that slips after this angle, as strong as the spring is there.
# Motions that bend the bush no farther cannot tell the two apart. The angle itself is unknown, too.
SLIP_ANGLE: Final = 0.01  # rad
NEARBY: Final = 1.05  # times: another angle, whose difference shows what the angle changes


def information(reach: Reach, coefficients: Array) -> Array:
    """Information matrices (S, feet, 2, 2, 2) of stiffness and damping of each foot and axis, for each of S bushes.

    An offset, a drift and an element with hysteresis are eliminated, as `identify feet` does.
    """
    bent, rate = reach.of(reach.deflection, coefficients), reach.of(reach.rate, coefficients)
    size = bent.shape[-1]
    element = remembered(bent.reshape(-1, size)).reshape(*bent.shape[:-1], 2, size)
    columns = np.concatenate([bent[..., None, :], rate[..., None, :], element], axis=-2)
    line = np.linalg.qr(np.column_stack([np.ones(size), np.linspace(-1.0, 1.0, size)]))[0]
    free = columns - (columns @ line) @ line.T
    whole = 10.0 / RATE / MISSED**2 * free @ np.swapaxes(free, -1, -2)
    # What is known before of the element: it is no stronger than the spring, its angle no more than half as large again.
    known = np.stack([np.ones(2) * [1.0, 0.5 * SLIP_ANGLE / SLIP_ANGLE] * k for k in reach.stiffness])
    whole[..., [2, 3], [2, 3]] += 1.0 / known[:, None, None] ** 2
    across = whole[..., :2, 2:]
    return np.asarray(
        whole[..., :2, :2] - across @ np.linalg.solve(whole[..., 2:, 2:], np.swapaxes(across, -1, -2))
    )


def remembered(deflections: Array) -> Array:
    """The stretch of an element that slips, (R, 2, N) [rad], beside deflections (R, N), and how it goes with the logarithm
    of the slip angle."""
    angles = np.array([SLIP_ANGLE, NEARBY * SLIP_ANGLE])
    branches = Branches.of(list(deflections))
    states = jenkins_states(branches, angles, np.zeros((len(deflections), 2))) * angles
    stretch = np.moveaxis(states, 0, -1)  # runs, angles, samples
    return np.stack([stretch[:, 0], (stretch[:, 1] - stretch[:, 0]) / np.log(NEARBY)], axis=1)


def half_widths(reach: Reach, coefficients: Array) -> Array:
    """95 % half widths [share of the value] of stiffness and damping, (S, feet, 2, 2)."""
    found = information(reach, coefficients)
    scale = np.sqrt(np.maximum(np.einsum("...ii->...i", found), 1e-12))
    scaled = found / (scale[..., :, None] * scale[..., None, :]) + 1e-9 * np.eye(2)
    deviations = np.sqrt(np.einsum("...ii->...i", np.linalg.inv(scaled))) / scale
    values = np.column_stack([reach.stiffness, reach.damping])[:, None, None]
    return np.asarray(NORMAL95 * deviations / values)


def badness(reach: Reach, coefficients: Array, criterion: Criterion) -> float:
    """What is minimised, the mean over the range of stiffness: the logarithm of the widest relative interval, of the
    volume of all (D) or of their mean square (A)."""
    widths = half_widths(reach, coefficients).reshape(len(reach.bushes), -1)
    if criterion == "widest":
        return float(np.log(widths.max(axis=1)).mean())
    if criterion == "D":
        return float(np.log(widths).mean())
    return float(np.log(np.mean(widths**2, axis=1)).mean() / 2)

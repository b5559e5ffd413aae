"""What a motion tells of each bush: the half widths that its deflections and torques promise (eq. 6 and 7)."""

from __future__ import annotations

from typing import Final, Literal, get_args

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array
from plantar.design.reach import RATE, Reach, Shares

Criterion = Literal["widest", "D", "A"]
CRITERIA: Final = get_args(Criterion)
# Per independent sample of 0.1 s, as sensors of a careful lab are: torque [N·m], and attitude and encoders [rad].
TORQUE: Final = 0.02
ANGLE: Final = 2e-5
# Rubber remembers: beside the spring may stand an element that slips after this angle, as strong as the spring there.
# Motions that bend the bush no farther cannot tell the two apart.
SLIP_ANGLE: Final = 0.01  # rad


def information(reach: Reach, share: Shares, coefficients: Array) -> dict[tuple[str, str], Array]:
    """Information matrix (2, 2) of stiffness and damping of each foot and axis.

    An offset, a drift and an element with hysteresis are eliminated, as `identify feet` does.
    """
    time = reach.time / reach.time[-1] - 0.5
    bush, response = share.softness, share.response
    per_sample = 10.0 / RATE / (TORQUE**2 + (bush.stiffness * ANGLE) ** 2)
    bent = np.array([np.tensordot(coefficients, response.deflection[foot], 1) for foot in response.torque])
    rate = np.array([np.tensordot(coefficients, response.rate[foot], 1) for foot in response.torque])
    memory = remembered(bent)
    drift = np.linalg.qr(np.column_stack([np.ones(time.size), time]))[0]
    found: dict[tuple[str, str], Array] = {}
    for place, foot in enumerate(response.torque):
        for row, axis in enumerate(ROTATIONAL_AXES):
            columns = np.column_stack([bent[place, row], rate[place, row], memory[place, row]])
            free = columns - drift @ (drift.T @ columns)
            whole = per_sample * free.T @ free
            whole[2, 2] += 1.0 / bush.stiffness**2  # what is known of it before
            found[foot, axis] = whole[:2, :2] - np.outer(whole[:2, 2], whole[2, :2]) / whole[2, 2]
    return found


def remembered(deflection: Array) -> Array:
    """The deflection of an element that slips after SLIP_ANGLE, (..., N), beside deflections (..., N) [rad]."""
    state = np.empty_like(deflection)
    state[..., 0] = 0.0
    step = np.diff(deflection, axis=-1)
    for row in range(step.shape[-1]):
        state[..., row + 1] = np.clip(state[..., row] + step[..., row], -SLIP_ANGLE, SLIP_ANGLE)
    return state


def half_widths(
    found: dict[tuple[str, str], Array], bush_values: tuple[float, float]
) -> dict[tuple[str, str, str], float]:
    """95 % half widths [share of the value] of stiffness and damping."""
    widths = {}
    for (foot, axis), matrix in found.items():
        if np.linalg.cond(matrix) > 1e12:
            deviations = np.full(2, np.inf)
        else:
            deviations = np.sqrt(np.diag(np.linalg.inv(matrix)))
        for name, value, deviation in zip(("stiffness", "damping"), bush_values, deviations, strict=True):
            widths[foot, axis, name] = float(NORMAL95 * deviation / value)
    return widths


def badness(reach: Reach, coefficients: Array, criterion: Criterion) -> float:
    """What is minimised, the mean over the range of stiffness: the logarithm of the widest relative interval, of the
    volume of all (D) or of their mean square (A)."""
    total = 0.0
    for share in reach.shares:
        bush = share.softness
        widths = np.array(
            list(
                half_widths(information(reach, share, coefficients), (bush.stiffness, bush.damping)).values()
            )
        )
        if criterion == "widest":
            total += float(np.log(widths.max()))
        elif criterion == "D":
            total += float(np.log(widths).mean())
        else:
            total += float(np.log(np.mean(widths**2)) / 2)
    return total / len(reach.shares)

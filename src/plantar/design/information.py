"""What a motion tells: half widths of each bush (eq. 6 and 7), of the sensors' delay and of the vertical compliance."""

from __future__ import annotations

from typing import Final, Literal, get_args

import numpy as np

from plantar.conventions import NORMAL95, Array
from plantar.design.reach import FIRM_RATE, RATE, Reach
from plantar.design.rubber import NEARBY, SECANT, remembered
from plantar.estimation.delays.delay import MODEL_ERROR
from plantar.estimation.slow_drift import drift_basis
from plantar.feet.fit.hidden_memory import SLIPS
from plantar.robot.uncertainty import Uncertainty

Criterion = Literal["widest", "D", "A"]
CRITERIA: Final = get_args(Criterion)
# N·m that a model of real rubber misses by, per independent sample of 0.1 s: sensors of a careful lab are better.
MISSED: Final = 0.1
# Bend to either side [rad] at which `identify feet` surely tells an element that slips from the spring: it asks for
# 1.25 times the slip angle, and noise of the attitude moves the corners of the path. With this power of what is missing
# widths grow.
TOLD_APART: Final = 1.4 * SLIPS
STEEP: Final = 8
# Half widths that are wanted: of stiffness and damping [share], delay [s], vertical compliance [share]. The widest is
# the one that is farthest above.
WANTED: Final = (0.005, 0.04)
WANTED_DELAY: Final = 0.001
WANTED_VERTICAL: Final = 0.3
# By which Newton's law misses the vertical force [N] and the moments [N·m] on the ground, per independent sample of
# 0.1 s, with a careful lab's sensors and masses.
UNCLOSED: Final = (0.4, 0.2, 0.2)
# N rms that the motion adds to the weight: beside less, sensors' noise looks like a hand's push.
SEEN_FORCE: Final = 6.0
USUAL_DELAY: Final = Uncertainty.wrench_delay
# Times what is wanted: a stiffness within a third is weak, however near it comes to that.
HOPELESS: Final = 60.0
BEYOND: Final = 0.1  # share of what is wider still
ENOUGH: Final = 0.3  # share of what is narrower than wanted: it is bought last
OTHERS: Final = 0.5  # share of all numbers beside the widest
# m: what encoders and the legs' lengths may be wrong by moves the soles' heights so much.
UNEVEN: Final = 1e-4


def information(reach: Reach, bent: Array, rate: Array) -> Array:
    """Information matrices (..., S, feet, 2, 2, 2) of stiffness and damping of each foot and axis, for each of S
    bushes, of firm bends and rates (..., S, feet, 2, M).

    An offset, a drift in a line and slow cosines, and an element with hysteresis are eliminated, as `identify feet`
    does: a lean that is held for half a minute shows nothing.
    """
    size = bent.shape[-1]
    columns = np.empty((*bent.shape[:-1], 4, size))
    columns[..., 0, :], columns[..., 1, :] = bent, rate
    element = columns[..., 2:, :]
    element[:] = remembered(bent.reshape(-1, size), (SLIPS, NEARBY * SLIPS)).reshape(element.shape)
    element[..., 1, :] = (element[..., 1, :] - element[..., 0, :]) / np.log(NEARBY)
    slow = np.column_stack([np.full(size, size**-0.5), drift_basis(reach.firm_time)])
    slowly = columns @ slow
    free = columns @ np.swapaxes(columns, -1, -2) - slowly @ np.swapaxes(slowly, -1, -2)
    whole = 10.0 / FIRM_RATE / MISSED**2 * free
    # What is known of the element before: it is about as strong as the spring, its angle within a half.
    known = np.outer(reach.stiffness, [1.0, 0.5])
    whole[..., [2, 3], [2, 3]] += 1.0 / known[:, None, None] ** 2
    across = whole[..., :2, 2:]
    shared = np.linalg.solve(whole[..., 2:, 2:], np.swapaxes(across, -1, -2))
    return np.asarray(whole[..., :2, :2] - across @ shared)


def half_widths(
    reach: Reach, coefficients: Array, known: Array | float = 0.0, late: Array | None = None
) -> Array:
    """95 % half widths [share of the value] of stiffness and damping, (..., S, feet, 2, 2).

    `known`: information (feet, 2, 2, 2) from before. Where a bush bends less than TOLD_APART, `identify feet` may take
    a spring that slips for a part of the stiffness: the motion's own widths grow steeply. What the delay of the
    sensors is unsure by, `late` (...) [s] where that was worked out before, times the stiffness of spring and element,
    the damping is unsure by as well.
    """
    bent, rate = (reach.of(part, coefficients) for part in (reach.firm_deflection, reach.firm_rate))
    bend = np.ptp(bent, axis=-1) / 2
    missing = np.maximum(TOLD_APART / np.maximum(bend, 1e-6), 1.0)[..., None, None]
    found = information(reach, bent, rate) / missing ** (2 * STEEP) + known
    scale = np.sqrt(np.maximum(np.einsum("...ii->...i", found), 1e-12))
    scaled = found / (scale[..., :, None] * scale[..., None, :]) + 1e-9 * np.eye(2)
    deviations = np.sqrt(np.einsum("...ii->...i", np.linalg.inv(scaled))) / scale
    values = np.column_stack([reach.stiffness, reach.damping])[:, None, None]
    widths = np.asarray(NORMAL95 * deviations / values)
    firm = reach.stiffness[:, None] + SECANT * reach.element
    late = np.asarray(delay_half_width(reach, coefficients) if late is None else late)[..., None, None]
    widths[..., 1] = np.hypot(widths[..., 1], (late * firm / reach.damping[:, None])[..., None, :])
    return widths


def delay_half_width(reach: Reach, coefficients: Array) -> Array:
    """95 % half widths (...) [s] of the force sensors' delay: Newton's law shows it where vertical force and moments on
    the ground change, and forces are large enough to see that it holds. What any model misses of their amplitude looks
    like a delay as long as that takes: the quicker the motion, the less."""
    forces, rates = reach.of(reach.forces, coefficients), reach.of(reach.wrench_rates, coefficients)
    closed = np.minimum(np.mean(np.sum(forces**2, axis=-2), axis=-1) / SEEN_FORCE**2, 1.0)
    rates = rates / np.array(UNCLOSED)[:, None]
    square = np.sum(rates**2, axis=(-2, -1))
    quick = np.sum(np.gradient(rates, 1 / RATE, axis=-1) ** 2, axis=(-2, -1)) / np.maximum(square, 1e-12)
    shown = closed**STEEP * square * 10.0 / RATE
    variance = 1 / np.maximum(shown, 1e-12) + MODEL_ERROR**2 / np.maximum(quick, 1e-12)
    return np.asarray(NORMAL95 * np.sqrt(1.0 / (1.0 / variance + 1.0 / USUAL_DELAY**2)))


def vertical_half_width(reach: Reach, coefficients: Array) -> Array:
    """95 % half widths (..., S) [share] of the sum of both feet's vertical compliances: load that goes from foot to
    foot presses one sole and frees the other."""
    load = reach.of(reach.load, coefficients)
    moved = np.std(load[..., 0, :] - load[..., -1, :], axis=-1) / reach.vertical
    return np.asarray(NORMAL95 * UNEVEN / np.maximum(moved, 1e-9))


def badness(reach: Reach, coefficients: Array, criterion: Criterion, known: Array | float) -> Array:
    """What is minimised, (...) of motions with coefficients (..., size).

    The mean over the range of stiffness: the logarithm of the widest interval, each as a multiple of what is wanted of
    it, of the volume of all (D) or of their mean square (A).

    Beside the widest, what is narrower than wanted counts little.
    Small soles cannot bend stiff feet far enough for every number. One that is out of reach must not be all that
    counts: beyond HOPELESS a width counts for little, and to the widest a share of all others is added. Where others
    are `known` from before, what is weak comes first.
    """
    late = delay_half_width(reach, coefficients)
    feet = half_widths(reach, coefficients, known, late) / WANTED
    feet = feet.reshape(*feet.shape[:-3], -1)
    vertical = vertical_half_width(reach, coefficients)[..., None] / WANTED_VERTICAL
    delay = np.asarray(late / WANTED_DELAY)[..., None, None]
    widths = np.log(np.concatenate([feet, np.broadcast_to(delay, vertical.shape), vertical], axis=-1))
    hopeless = np.inf if np.any(known) else np.log(HOPELESS)
    widths = np.minimum(widths, hopeless) + BEYOND * np.maximum(widths - hopeless, 0.0)
    if criterion == "widest":
        widths = np.where(widths < 0, ENOUGH * widths, widths)
        return np.asarray(
            np.mean((1 - OTHERS) * widths.max(axis=-1) + OTHERS * widths.mean(axis=-1), axis=-1)
        )
    if criterion == "D":
        return np.asarray(widths.mean(axis=(-2, -1)))
    return np.asarray(np.log(np.mean(np.exp(2 * widths), axis=-1)).mean(axis=-1) / 2)

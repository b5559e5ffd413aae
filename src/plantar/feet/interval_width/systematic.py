"""Causes of error that no residual shows: each widens the intervals by how far it would move the fit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, UNIFORM, Array
from plantar.estimation import Block, fit_blocks
from plantar.estimation.errors_in_variables import slow_attenuation
from plantar.feet.fit.half_turns import ROUND, slip_angles_spanned
from plantar.feet.fit.hidden_memory import element_slope, has_memory, moved_by_memory
from plantar.feet.fit.vertical_stiffness import VerticalStiffness
from plantar.feet.interval_width.between_recordings import Apart, between_recordings
from plantar.feet.interval_width.between_walks import between_walks
from plantar.feet.interval_width.cause import Cause
from plantar.feet.interval_width.yaw_zero import yaw_torque_zero, yaw_zeros
from plantar.feet.recording import Recording, moment_arm_effect
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import beside
from plantar.feet.regression.tangent import Tangent
from plantar.sensors.delays.sensor_delay import SensorDelay
from plantar.signals.filters import differentiate
from plantar.signals.resampling import shifted
from plantar.signals.segments import run_numbers

SUSPECTED = 2.0  # deviations of a term that the model leaves out
STANCE_END = 0.1  # of a stance at either end, without which a fit over stances is made again
# Of the slope of an element found in short stances, what its share of the spring is unsure by; of its slip torque and
# of the damping beside it, what these are: by errors on walks of two simulated robots, less what other causes make of
# them.
SLOPE_UNSURE = 0.003
ELEMENT_UNSURE = 0.012
FEWEST_STANDS = 2  # stances of a foot in one recording, for their zeros to differ
KNOWN = 0.2  # of the stiffness: less sure beside such a term, the motions cannot tell one from the other


def systematic_causes(
    tangent: Tangent, sensor_delay: SensorDelay, vertical: VerticalStiffness
) -> list[Cause]:
    """The wrenches' delay, the moment arm of the compressed slide and errors of the angle; of feet that step the ends
    of stances and what a memory may share with the spring; of others a softening, a hardening that the model leaves
    out, zeros that differ between stances, and for roll the zero of the yaw torque.
    """
    fit, foot, column = tangent.fit, tangent.fit.foot, ROTATIONAL_AXES.index(tangent.fit.axis)
    by_delay = [
        tangent.effect(tangent.rows(late))
        for late in _late_torques(sensor_delay, lambda one: one.bushes[foot].torque[:, column])
    ]
    moment_arms = tangent.rows(lambda one: moment_arm_effect(one, foot)[:, column])
    causes = [
        Cause(
            "delay",
            max(by_delay, key=lambda effect: abs(effect[0])),
            sensor_delay.std,
            sensor_delay.freedom,
        ),
        Cause("moment arm", tangent.effect(moment_arms), vertical.compliance_std[foot], vertical.freedom),
        _angle_errors(tangent),
        *_hidden_memory(fit, steps=tangent.steps),
    ]
    if tangent.steps:
        # The zeros were read in the air, and within a stance no cube is told from how a sole lands and lifts.
        return [*causes, _ends_of_stances(tangent.blocks), *_shared_slope(fit, tangent.recordings)]
    causes += [*_softening(fit), *_suspected_hardening(tangent), *_zeros_of_stances(tangent)]
    if (zeros := yaw_zeros(tangent)) is not None:
        causes.append(yaw_torque_zero(zeros, tangent))
    return causes


def _late_torques(
    sensor_delay: SensorDelay, torque: Callable[[Recording], Array]
) -> list[Callable[[Recording], Array]]:
    """How a recording's torque (N,) changes with its sensor's delay [per s].

    By its slope; where the delay is in doubt, by as far as it may be off, one way and the other: late by a tenth of a
    second, a walk's torque is another one, and stiffness follows it as damping does.
    """
    if not sensor_delay.doubtful:
        return [lambda one: np.nan_to_num(differentiate(torque(one), one.period))]
    reach = NORMAL95 * sensor_delay.std

    def by(time: float, one: Recording) -> Array:
        return np.nan_to_num(shifted(torque(one), one.period, time) - torque(one)) / reach

    return [partial(by, reach), partial(by, -reach)]


def _ends_of_stances(blocks: Sequence[Block]) -> Cause:
    """What a sole that is not flat at the ends of stances may do: at most what the fit moves by without them."""
    inner = []
    for block in blocks:
        assert block.stances is not None, "blocks of a foot that steps"
        kept = np.concatenate(
            [rows[(cut := round(STANCE_END * len(rows))) : len(rows) - cut] for rows in block.stances.split()]
        )
        inner.append(block.part(np.sort(kept)))
    less, whole = fit_blocks(inner), fit_blocks(blocks)
    moved = less.values - whole.values
    # Fewer samples move a fit by chance too, by what deviations differ (J. A. Hausman, Econometrica 46, 1978).
    chance = np.maximum(less.std**2 - whole.std**2, 0.0)
    effect = np.sign(moved) * np.sqrt(np.maximum(moved**2 - chance, 0.0))
    return Cause("ends of stances", effect, UNIFORM)


def _angle_errors(tangent: Tangent) -> Cause:
    """What an attitude that wanders may do: anything from nothing to what would leave the torque that is missed."""
    slope = tangent.fit.equivalent[0]
    effect = slow_attenuation(tangent.blocks, slope, shared_offset=tangent.shared)
    return Cause("angle errors", effect, UNIFORM)


def _shared_slope(fit: AxisFit, recordings: Sequence[Recording]) -> list[Cause]:
    """What a memory that was found in short stances may have taken from the spring, or left to it.

    Until it slips, an element is a spring; each stance begins with a state that nobody knows. Where no stance turns the
    element round, any part of its slope may be the spring's. Where only the way that no fit uses does, as of a sole
    that tips there, its torque and its angle are guesses.
    """
    if "slip_torque" not in fit.model.terms:
        return []
    turned, seen = (_turned_round(fit, recordings, used=used) for used in (False, True))
    place, effect = fit.model.terms.index("slip_torque"), np.zeros(len(fit.numbers))
    effect[0] = (SLOPE_UNSURE if turned else UNIFORM) * element_slope(fit)
    effect[1] = ELEMENT_UNSURE * fit.values[1]  # both make loops
    effect[place] = -(ELEMENT_UNSURE if seen else UNIFORM) * fit.values[place]
    if not seen and fit.slip_angle is not None:
        effect[len(fit.values) + fit.model.shape_terms.index("slip_angle")] = UNIFORM * fit.slip_angle
    return [Cause("memory in stances", effect, 1.0)]


def _turned_round(fit: AxisFit, recordings: Sequence[Recording], *, used: bool) -> bool:
    spanned = slip_angles_spanned(fit, recordings, used=used)
    return spanned is None or spanned >= ROUND


def _hidden_memory(fit: AxisFit, *, steps: bool) -> list[Cause]:
    """What spring and damper may have taken from a memory that the motions do not show well enough."""
    moved = moved_by_memory(fit, steps=steps)
    if not moved.any():
        return []
    effect = np.zeros(len(fit.values))
    effect[: len(moved)] = moved
    return [Cause("hidden memory", effect, UNIFORM)]


def _zeros_of_stances(tangent: Tangent) -> list[Cause]:
    """What one offset may cost where a foot was lifted and put down again: how far the fit moves when each stance has
    an offset of its own, a bound either way.

    It lands elsewhere, turned a little otherwise, on a floor that is not level.
    """
    stances = tangent.rows(lambda one: run_numbers(one.contacts[tangent.fit.foot].loaded))
    if tangent.shared or all(len(np.unique(number)) < FEWEST_STANDS for number in stances):
        return []
    freed = []
    for block, number in zip(tangent.blocks, stances, strict=True):
        own = (number[:, None] == np.unique(number)[1:]).astype(np.float64)
        freed.append(block.with_nuisance(own - own.mean(axis=0)))
    effect = fit_blocks(freed).values - tangent.least_squares.values
    return [Cause("zeros of stances", effect, UNIFORM)]


def _softening(fit: AxisFit) -> list[Cause]:
    """What a spring that loses slope as it bends may owe to its force sensor: rubber hardens, and an amplifier that
    bends is steepest about its zero, where the stiffness is told. Anything from nothing to all of the bend: then the
    spring has its mean slope everywhere. Damping, told over all of it, is as unsure: either slope is the right one."""
    terms = fit.model.terms
    if has_memory(fit.model) or "hardening" not in terms:
        return []
    effect, bends = np.zeros(len(fit.values)), terms.index("hardening")
    if fit.values[bends] >= 0:
        return []
    less = 1 - fit.equivalent[0] / fit.values[0]
    effect[[0, 1, bends]] = less * fit.values[0], less * fit.values[1], fit.values[bends]
    return [Cause("softening", effect, UNIFORM)]


def _suspected_hardening(tangent: Tangent) -> list[Cause]:
    """A cube that the model leaves out and the motions show, though no held-out motion asked for it.

    It hardly matters to the torque, but the spring's slope in the motions' middle is not its mean slope; about the
    angle's zero, which a turned IMU puts anywhere, a cube would say nothing of these motions. Where the slope is less
    outside, it may be the force sensor that bends, and damping moves by the same share. Empty where they are too small
    to tell the two apart.
    """
    fit, blocks = tangent.fit, tangent.blocks
    if any("hardening" in term for term in fit.model.terms):
        return []
    size, extended = blocks[0].regressor.shape[1], []
    middle = float(np.mean(np.concatenate([block.regressor[:, 0] for block in blocks])))
    reach = max(float(np.abs(block.regressor[:, 0] - middle).max()) for block in blocks) or 1.0
    for block in blocks:
        cube, square = (reach * ((block.regressor[:, 0] - middle) / reach) ** power for power in (3, 2))
        wider = beside(replace(block, noise=None), cube[:, None])
        extended.append(wider.with_nuisance((square - square.mean())[:, None]))
    found = fit_blocks(extended, shared_offset=tangent.shared)
    if found.singular:
        return []
    hardening, std = float(found.values[size]), float(found.std[size])
    known = bool(found.std[0] < KNOWN * abs(fit.values[0]))
    if not (known and abs(hardening) > SUSPECTED * std):
        return []
    before = np.zeros(size)
    before[: len(fit.values)] = fit.values
    moved = found.values[:size] - before
    if hardening < 0:
        alike = moved[0] * fit.values[1] / fit.values[0]
        moved[1] = max(moved[1], alike, key=abs)
    return [Cause("hardening", moved / hardening, abs(hardening))]


def robot_causes(tangent: Tangent, wrench_gain: float, apart: Apart) -> list[Cause]:
    """The force sensors' gain, a turned sensor, and recordings that differ: `apart`, as all axes show it."""
    # A torque that reads too large by a share makes every number of the bush too large by it. A sensor turned by ψ
    # reads cos ψ of the torque; where it is the IMU that is turned, all of it, and only moving joints tell them apart.
    turned = 1 - float(np.cos(tangent.fit.turned))
    gain = float(np.hypot(wrench_gain, turned))
    causes = [Cause("sensor gain", tangent.fit.values, gain)] if gain else []
    return causes + (between_walks if tangent.steps else between_recordings)(tangent, apart)

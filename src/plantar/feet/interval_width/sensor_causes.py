"""Sensors that are late, slow or turned: what that makes of spring and damper, as far as motions show it.

An IMU behind a filter of its own is late by some milliseconds, the encoders are not. Where hips or waist turn several
times as fast as the bush, the bush's angle is off by several times what the delay makes of its own rate. Newton's law
shows it in arm sweeps; the fit itself shows it where the joints' motion is not the bush's. Where a foot steps the trunk
hardly leans: joints alone bend the bush, and encoders that are late are as good as force sensors that are early.

A torque behind a slow low-pass has its lag in the delay, but not what the filter takes off: seen at f² over its
corner's, it lacks that share of what it changes by. Slow tilts hardly show it; the steps of a walk move the spring by
some per cent.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, SHOWN, UNIFORM, Array
from plantar.feet.interval_width.cause import Cause
from plantar.feet.place.imu_mount import ImuTurn, imu_columns
from plantar.feet.recording import Recording
from plantar.feet.regression.load_torque import ENCODERS_APART, late_encoder_torque
from plantar.feet.regression.tangent import Tangent
from plantar.sensors.bandwidth import Fading
from plantar.signals.filters import differentiate

LATE_ENCODERS = "encoders' delay"
LOW_PASS = "low-pass"
IMU_TURN = "imu turn"


def encoder_delay_causes(tangent: Tangent, unsure: float) -> list[Cause]:
    """By as much as the motions show encoders and IMU to be apart, none where these do not; of a foot that steps by as
    much as Newton's law leaves `unsure` [s]."""
    wider = with_late_encoders(tangent)
    if wider is None:
        return []
    by_late = tangent.effect([block.regressor[:, -1] for block in wider.blocks])
    if tangent.steps:
        return [Cause(LATE_ENCODERS, by_late, unsure)] if unsure else []
    found = wider.least_squares
    late, std = float(found.values[-1]), float(found.std[-1])
    if found.singular or abs(late) < SHOWN * std:
        return []
    return [Cause(LATE_ENCODERS, by_late, min(abs(late), ENCODERS_APART))]


def with_late_encoders(tangent: Tangent) -> Tangent | None:
    """The tangent with one more column at the end, the torque for each second by which encoders are read later than the
    IMU; None where that is not known."""
    columns = tangent.rows(lambda one: late_encoder_torque(one, tangent.fit)[:, None])
    return tangent.beside(columns) if any(column.any() for column in columns) else None


def fading_causes(tangent: Tangent, found: Fading | None) -> list[Cause]:
    """By anything up to what the `found` low-pass takes off; none without one.

    A gain whose logarithm is s f² makes of a torque τ, for s f² << 1, τ - s/(4π²) d²τ/dt².
    """
    if found is None:
        return []
    foot, column = tangent.fit.foot, ROTATIONAL_AXES.index(tangent.fit.axis)

    def bent(one: Recording) -> Array:
        torque = one.bushes[foot].torque[:, column]
        return np.nan_to_num(differentiate(differentiate(torque, one.period), one.period)) / (2 * np.pi) ** 2

    return [Cause(LOW_PASS, tangent.effect(tangent.rows(bent)), UNIFORM * abs(found.slope))]


def imu_turn_causes(tangent: Tangent, turn: ImuTurn) -> list[Cause]:
    """What is not known of the turn, as far as it moves the fit of a foot that steps; others have it in their place."""
    if not tangent.steps or not turn.covariance.any():
        return []
    effects = tangent.effect(tangent.rows(lambda one: imu_columns(one, tangent.fit)))
    effects = effects @ np.linalg.cholesky(turn.covariance)
    return [Cause(IMU_TURN, np.sqrt(np.sum(effects**2, axis=1)), 1.0)]

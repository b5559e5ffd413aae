"""Encoders that are read at another moment than the IMU: what that makes of spring and damper, where motions show it.

An IMU behind a filter of its own is late by some milliseconds, the encoders are not. Where hips or waist turn several
times as fast as the bush, the bush's angle is off by several times what the delay makes of its own rate. Newton's law
shows it in arm sweeps; the fit itself shows it where the joints' motion is not the bush's. Where a foot steps the trunk
hardly leans: joints alone bend the bush, and encoders that are late are as good as force sensors that are early.
"""

from __future__ import annotations

from plantar.conventions import SHOWN
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.load_torque import ENCODERS_APART, late_encoder_torque
from plantar.feet.regression.tangent import Tangent

NAME = "encoders' delay"


def encoder_delay_causes(tangent: Tangent, unsure: float) -> list[Cause]:
    """By as much as the motions show encoders and IMU to be apart, none where these do not; of a foot that steps by as
    much as Newton's law leaves `unsure` [s]."""
    wider = with_late_encoders(tangent)
    if wider is None:
        return []
    by_late = tangent.effect([block.regressor[:, -1] for block in wider.blocks])
    if tangent.steps:
        return [Cause(NAME, by_late, unsure)] if unsure else []
    found = wider.least_squares
    late, std = float(found.values[-1]), float(found.std[-1])
    if found.singular or abs(late) < SHOWN * std:
        return []
    return [Cause(NAME, by_late, min(abs(late), ENCODERS_APART))]


def with_late_encoders(tangent: Tangent) -> Tangent | None:
    """The tangent with one more column at the end, the torque for each second by which encoders are read later than the
    IMU; None where that is not known."""
    columns = tangent.rows(lambda one: late_encoder_torque(one, tangent.fit)[:, None])
    return tangent.beside(columns) if any(column.any() for column in columns) else None

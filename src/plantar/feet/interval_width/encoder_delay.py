"""Encoders that are read at another moment than the IMU: what that makes of spring and damper, where motions show it.

An IMU behind a filter of its own is late by some milliseconds, the encoders are not. Where hips or waist turn several
times as fast as the bush, the bush's angle is off by several times what the delay makes of its own rate. Newton's law
shows it in arm sweeps; the fit itself shows it where the joints' motion is not the bush's. Where a foot steps the trunk
hardly leans: joints alone bend the bush, and encoders that are late are as good as force sensors that are early.
"""

from __future__ import annotations

from collections.abc import Sequence

from plantar.conventions import SHOWN, Array
from plantar.estimation import Block, effect_of, fit_blocks, influences_of
from plantar.feet.interval_width.cause import Cause
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.load_torque import ENCODERS_APART, late_encoder_torque
from plantar.feet.regression.regression_data import all_beside, recordings_of

NAME = "encoders' delay"


def encoder_delay_causes(
    fit: AxisFit, blocks: Sequence[Block], recordings: Sequence[Recording], unsure: float, shared: bool
) -> list[Cause]:
    """By as much as the motions show encoders and IMU to be apart, none where these do not; of a foot that steps by as
    much as Newton's law leaves `unsure` [s].

    blocks: the recordings' `tangent_blocks`.
    """
    wider = with_late_encoders(fit, blocks, recordings)
    if wider is None:
        return []
    columns = [block.regressor[:, -1] for block in wider]
    if blocks[0].stances is not None:
        return [_cause(blocks, columns, unsure, shared)] if unsure else []
    found = fit_blocks(wider, shared_offset=shared)
    late, std = float(found.values[-1]), float(found.std[-1])
    if found.singular or abs(late) < SHOWN * std:
        return []
    return [_cause(blocks, columns, min(abs(late), ENCODERS_APART), shared)]


def with_late_encoders(
    fit: AxisFit, blocks: Sequence[Block], recordings: Sequence[Recording]
) -> list[Block] | None:
    """The recordings' `tangent_blocks` with one more column at the end, the torque for each second by which encoders
    are read later than the IMU; None where that is not known."""
    chosen = recordings_of(blocks, recordings)
    columns = [late_encoder_torque(one, fit)[one.rows(fit.foot)] for one in chosen]
    if not any(column.any() for column in columns):
        return None
    return all_beside(blocks, [column[:, None] for column in columns])


def _cause(blocks: Sequence[Block], columns: Sequence[Array], std: float, shared: bool) -> Cause:
    return Cause(NAME, effect_of(influences_of(blocks, shared_offset=shared), columns), std)

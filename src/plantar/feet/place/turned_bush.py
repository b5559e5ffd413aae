"""A bush whose own axes are turned about the vertical: the other axis' torque shows in both, with one sign."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, SURE, Axis
from plantar.estimation import Block
from plantar.feet.place.place_notes import BUSH_WORTH_SAYING, STEPS_WORTH_SAYING, turned_bush
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.load_torque import others_torque
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note

STEPS_LEAVE = 0.75  # of the squares that the model of one axis leaves


def turned_bush_note(
    fits: Mapping[Axis, AxisFit], recordings: Sequence[Recording], shared: bool
) -> Note | None:
    """`turned_bush` of one foot's fits, of which both axes must be there."""
    if not set(ROTATIONAL_AXES) <= set(fits):
        return None
    pitch, roll = (fits[axis] for axis in ROTATIONAL_AXES)
    in_pitch, in_roll = (_others_torque(fit, recordings, shared) for fit in (pitch, roll))
    if in_pitch is None or in_roll is None:
        return turned_bush(pitch.foot, pitch.turned, roll.turned, BUSH_WORTH_SAYING)
    (of_roll, left), (of_pitch, also_left) = in_pitch, in_roll
    # A leg that gives way shows some of it as well, but explains little of what the feet's models leave.
    explained = min(left, also_left) < STEPS_LEAVE and of_roll != 0 and of_pitch != 0
    return turned_bush(pitch.foot, of_roll, of_pitch, STEPS_WORTH_SAYING) if explained else None


def _others_torque(fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> tuple[float, float] | None:
    """The share of the other axis' torque that shows in this one, 0 where unsure; None of a foot that stands.

    With it the share that it leaves of what the model leaves, in squares.
    """
    tangent = Tangent.of(fit, recordings, shared)
    if not tangent.steps:
        return None
    tangent = replace(tangent, blocks=[_without_the_other(block) for block in tangent.blocks])
    other = tangent.rows(lambda one: others_torque(one, fit.foot, fit.axis)[:, None])
    alone, found = tangent.least_squares, tangent.beside(other).least_squares
    sure = not found.singular and abs(found.values[-1]) > SURE * found.std[-1]
    return (float(found.values[-1]) if sure else 0.0), found.squares / max(
        alone.squares, np.finfo(float).tiny
    )


def _without_the_other(block: Block) -> Block:
    """The block of a foot that steps without the other axis' torque among its nuisances, their third column."""
    assert block.common_nuisance is not None, "a block of a foot that steps"
    assert block.common_spread is not None, "a block of a foot that steps"
    kept = [0, 1, 3]
    return replace(
        block, common_nuisance=block.common_nuisance[:, kept], common_spread=block.common_spread[kept]
    )

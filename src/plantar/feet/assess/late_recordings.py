"""Recordings whose sensors were later, or earlier, than in the others: a driver set otherwise, another network.

Delays are found from the ground's wrench where nobody holds the robot. A recording in which somebody does may have
another one, and only its damping tells: a delay d takes K·d off it. The fit of all then lies somewhere between the
recordings, by more than its interval, or a memory is made up for what they disagree in. Of walks it may be so within a
recording: where a part of one does not follow from Newton's law, as if somebody pushed, the other part tells the delay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import NORMAL95, SURE
from plantar.estimation import Block, fit_blocks
from plantar.estimation.least_squares import sureness_of_own
from plantar.estimation.linear import fits_of_halves
from plantar.estimation.weighted_mean import weighted_mean
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import beside
from plantar.feet.regression.tangent import Tangent
from plantar.models import BESIDE, KelvinVoigt
from plantar.notes import Note

RECORDING_LATE = "recording_late"
FEWEST = 8  # stances of a recording: four say how much they scatter
TINY = 1e-9  # N.m.s/rad: exact logs have no deviation
RATE = 1
"""The place of the rate, and of damping, in spring and damper."""


def late_recordings(tangent: Tangent, wide: AxisFit) -> list[Note]:
    """A warning of the recording whose damping differs from the others' and moves theirs out of the interval of `wide`.

    The torque is about the place that the fit has found: about another, motions about the other axis show as damping.
    Where a memory leaves less than a damping of its own does, it is the
    memory that makes damping differ. Of a foot that steps, whose landings shake its damping more than delays do, the
    halves of each recording are compared: they have the same landings.
    """
    if tangent.steps:
        return _late_halves(tangent.blocks, wide)
    if tangent.shared or len(tangent.blocks) < 2:
        return []
    blocks = [_spring_and_damper(block) for block in tangent.blocks]
    sureness = sureness_of_own(blocks, RATE)
    most = int(np.argmax(sureness))
    if sureness[most] < SURE:
        return []
    found = fit_blocks([_with_own_damping(each, each is blocks[most]) for each in blocks])
    if abs(found.values[RATE] - fit_blocks(blocks).values[RATE]) < NORMAL95 * wide.std[RATE]:
        return []
    if not isinstance(wide.model, KelvinVoigt) and tangent.least_squares.squares < found.squares:
        return []
    apart, late = found.values[-1], -1e3 * found.values[-1] / found.values[0]
    text = (
        f"{blocks[most].label}: {wide.foot} {wide.axis}: damping is {apart:+.3g} N.m.s/rad beside the other "
        f"recordings', as if its force sensors were {abs(late):.2g} ms {'later' if late > 0 else 'earlier'} against "
        "the IMU than theirs. Record it again with clocks and filters as in the others, or leave it out"
    )
    return [Note(RECORDING_LATE, "warning", text)]


def _late_halves(blocks: Sequence[Block], wide: AxisFit) -> list[Note]:
    """The same of the halves of all recordings of a foot that steps."""
    halves = [
        fits_of_halves(block)
        for block in blocks
        if block.stances is not None and len(block.stances.split()) >= FEWEST
    ]
    if not halves:
        return []
    apart = weighted_mean(
        [last.values[RATE] - first.values[RATE] for first, last in halves],
        [max(np.hypot(first.std[RATE], last.std[RATE]), TINY) for first, last in halves],
    )
    # Half of it is how far the damping of both together is from that of either.
    if abs(apart.value) < max(SURE * apart.std, 2 * NORMAL95 * wide.std[RATE]):
        return []
    late = -1e3 * apart.value / wide.values[0]
    text = (
        f"{wide.foot} {wide.axis}: damping is {apart.value:+.3g} N.m.s/rad in the second halves of the recordings "
        f"beside the first, as if its force sensors were {abs(late):.2g} ms {'later' if late > 0 else 'earlier'} there "
        "against the IMU. Find the moment at which a clock or driver changed, and cut the recordings there"
    )
    return [Note(RECORDING_LATE, "warning", text)]


def _spring_and_damper(block: Block) -> Block:
    return replace(block, regressor=block.regressor[:, : len(BESIDE)], noise=None)


def _with_own_damping(block: Block, own: bool) -> Block:
    return beside(block, block.regressor[:, RATE : RATE + 1] * float(own))

"""Play between an encoder and the foot.

In a gear that carries the foot's torque the angle jumps wherever that changes its sign: torque =
K·(angle - play/2·sign(torque)) + C·rate + offset. It bends every other model: taken for hardening or for a memory, it
makes the spring too soft. In the encoder's own drive the angle stays behind wherever the joint turns round: the sign is
that of the joint's rate, and the damping follows.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import cast

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.estimation import Block, fit_blocks
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside, blocks_of, recordings_of
from plantar.notes import Note
from plantar.signals.filters import differentiate, low_pass

SOFT = 0.1  # of a recording's spread of torque, within which its sign changes: behind a filter it is no step
BETTER = 1.5  # times less is left of the squares than by the model that was found
SURE = 5.0  # deviations of the play
# Likewise where a joint turns round: feet without play leave what they left.
BETTER_TURNING = 1.3
FAST = 98  # percentile of a joint's rate, SOFT times which its sign changes within
CODE = "play"


def play_notes(
    recordings: Sequence[Recording], wide: AxisFit, tangents: Sequence[Block], shared: bool
) -> list[Note]:
    """A warning where play explains a standing foot's torque far better than the model that was found, and moves
    stiffness or damping out of the interval of `wide`.

    tangents: the recordings' `tangent_blocks`.
    """
    if tangents[0].stances is not None:
        return []
    blocks = blocks_of(recordings, wide.foot, wide.axis, drift=not shared)
    column = ROTATIONAL_AXES.index(wide.axis)
    signs = [_sign(one, wide.foot, column)[:, None] for one in recordings_of(blocks, recordings)]
    found = fit_blocks(all_beside(blocks, signs), shared_offset=shared)
    stiffness, loss = float(found.values[0]), -float(found.values[2])
    if stiffness <= 0 or loss < SURE * float(found.std[2]):
        return []
    usual = fit_blocks(tangents, shared_offset=shared)
    if usual.squares < BETTER * found.squares or wide.holds(found.values[:2] - usual.values[:2]):
        return []
    text = (
        f"{wide.foot} {wide.axis}: the angle jumps by {2e3 * loss / stiffness:.2g} mrad where the torque changes its "
        "sign: play between an encoder and the foot, which makes the spring look softer (valid: encoders on the foot's "
        "side of every gear; or keep the torque on one side of zero)"
    )
    return [Note(CODE, "warning", text)]


def _sign(recording: Recording, foot: str, column: int) -> Array:
    """The sign of the torque at the rows of a fit, (n,), smooth about zero."""
    torque = recording.bushes[foot].torque[recording.rows(foot), column]
    return np.asarray(np.tanh(torque / max(SOFT * float(np.std(torque)), 1e-12)))


def encoder_play_notes(
    recordings: Sequence[Recording],
    wide: AxisFit,
    tangents: Sequence[Block],
    joints: Iterable[str],
    shared: bool,
) -> list[Note]:
    """A warning where the angle stays behind at each turn of one of the `joints` between IMU and foot, and that moves
    stiffness or damping out of the interval of `wide`.

    recordings: with all of their logs; tangents: of the same, as they are fitted. Encoders that are late go with the
    joint's rate itself: where that explains more, it is no play.
    """
    if tangents[0].stances is not None:
        return []
    found, joint = fit_blocks(tangents, shared_offset=shared), ""
    left = np.concatenate([found.residuals[block.label] for block in tangents])
    most, rates, signs = 0.0, list[Array](), list[Array]()
    for name in sorted(joints):
        own = [_joint_rate(one, wide.foot, name) for one in recordings_of(tangents, recordings)]
        fast = float(np.percentile(np.abs(np.concatenate(own)), FAST))
        if not fast > 0:  # it stands still, or is not recorded
            continue
        turns = [np.tanh(rate / (SOFT * fast)) for rate in own]
        every = np.concatenate(turns)
        explains = float(every @ left) ** 2 / float(every @ every)
        if explains > most:
            joint, most, rates, signs = name, explains, own, turns
    if not joint:
        return []
    late, play = (
        fit_blocks(all_beside(tangents, [own[:, None] for own in each]), shared_offset=shared)
        for each in (rates, signs)
    )
    behind, stiffness = abs(float(play.values[-1])), abs(float(play.values[0]))
    if behind < SURE * float(play.std[-1]) or found.squares < BETTER_TURNING * play.squares:
        return []
    if late.squares < play.squares or wide.holds(play.values[:2] - found.values[:2]):
        return []
    text = (
        f"{wide.foot} {wide.axis}: the angle stays behind by {2e3 * behind / stiffness:.2g} mrad wherever joint "
        f"'{joint}' turns round: play in its encoder's drive, which makes the damping too small (valid: encoders "
        "without play)"
    )
    return [Note(CODE, "warning", text)]


def _joint_rate(recording: Recording, foot: str, joint: str) -> Array:
    """The joint's rate [rad/s] at the rows of a fit, (n,), through its filter; NaN where it is not recorded."""
    key = ("joint rate", foot, joint)  # both axes ask
    if key not in recording.kept:
        rows, position = recording.rows(foot), recording.log.joint(joint, "position")
        rate = np.full(len(rows), np.nan)
        if position is not None:
            rate = differentiate(low_pass(position, recording.period, recording.cutoff), recording.period)
        recording.kept[key] = rate[rows]
    return cast(Array, recording.kept[key])

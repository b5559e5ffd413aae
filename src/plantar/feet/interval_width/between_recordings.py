"""Recordings that differ by more than each shows of itself: the rubber warms up, the feet stand a little otherwise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import SURE, UNIFORM, Array
from plantar.estimation import Block
from plantar.estimation.errors_in_variables import mostly_error, slow_share
from plantar.estimation.least_squares import values_without_each
from plantar.estimation.random_effects import Differences, resolution, share_between
from plantar.estimation.stance_least_squares import FEWEST_RECORDINGS, jackknife
from plantar.feet.interval_width.cause import Cause
from plantar.feet.interval_width.yaw_zero import YawZeros, fit_beside, yaw_zeros
from plantar.feet.regression.regression_data import all_beside
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note

NAME = "between recordings"
MOST = 0.5  # of what tells a number: a recording that has more tells more than all others together
# Of the stiffness: in a recording that makes less of it, all else that is wrong is divided by a small motion.
TELLS = 0.05
# Share, surely: rubber that warms up does less. It is a warning then.
MUCH = 0.03


class Apart(NamedTuple):
    """By which share recordings differ (standard deviation), known from `others` recordings beside the first.

    shown: the 95 % interval of what the logs themselves show; None where they may as well be alike.
    """

    share: float
    others: int
    shown: tuple[float, float] | None = None


class AxisDifferences(NamedTuple):
    """By how much the `recordings` (names) of one axis differ, beside `usual`, the deviation of its stiffness."""

    differences: Differences
    usual: float
    recordings: frozenset[str]


def recordings_apart(axes: Sequence[AxisDifferences], prior: float, *, exact: bool) -> Apart:
    """By which share of spring and damper recordings differ, at least `prior`, as these axes together show it.

    Before they are compared, by as much as they can be told apart by: motions that show differences badly leave them.
    Of a robot that is `exact`ly what its file says, by no more than its stiffness is unsure by.
    """
    if not axes:
        return Apart(prior, 1)
    usual, sets = float(np.mean([each.usual for each in axes])), [each.differences for each in axes]
    shown = share_between(sets, usual)
    share = shown.share if exact else share_between(sets, resolution(sets)).share
    names = frozenset().union(*(each.recordings for each in axes))
    return Apart(max(prior, share), len(names) - 1, (shown.low, shown.high) if shown.low > usual else None)


def _alone_apart(axis: AxisDifferences) -> Apart:
    """By which share recordings differ as one axis shows it: what it shows badly is left to all axes together."""
    share = share_between([axis.differences], axis.usual).share
    return Apart(share, len(axis.recordings) - 1)


def apart_notes(apart: Apart) -> list[Note]:
    """What recordings differ by, where they do: a result, not a fault, unless it is much."""
    if apart.shown is None:
        return []
    low, high = (100 * end for end in apart.shown)
    text = (
        f"from recording to recording, stiffness and damping differ by a standard deviation of {low:.2g} to "
        f"{high:.2g} % (95 %; from all axes of {apart.others + 1} recordings); the intervals allow for it. Rubber that "
        "warms up or that stood under load before does that; so does a joint between IMU and foot that is read wrongly "
        "in some of them"
    )
    return [Note("between_recordings", "warning" if apart.shown[0] > MUCH else "info", text)]


def axis_differences(tangent: Tangent) -> AxisDifferences | None:
    """Shares by which spring and damper of each recording are beside the first one's: what all share is K's own.

    Of many those are compared that tell the stiffness, of few all are; None where there is nothing to compare.
    """
    if not _comparable(tangent):
        return None
    return differences_of(tangent, effects_of(tangent), yaw_zeros(tangent))


def between_recordings(tangent: Tangent, every: Apart) -> list[Cause]:
    """By how much recordings of a foot that stands move the fit beyond their own deviations.

    From FEWEST_RECORDINGS on refits without one of them each (jackknife) say it, whatever it is that differs. Fewer are
    taken to differ by a share of spring and damper, as this axis shows it, or `every` axis together where that is more;
    so are they for a number that one recording tells more of than all others together: a refit without it is the
    others' noise. Where every axis shows that recordings differ, few that know most of a number differ no less: their
    refits may be alike by chance.
    """
    if not _comparable(tangent):
        return []
    blocks = tangent.blocks
    told = np.array([np.sum(own**2, axis=1) for own in tangent.influences])
    few = (len(blocks) < FEWEST_RECORDINGS) | (told.max(axis=0) > MOST * told.sum(axis=0))
    effects = effects_of(tangent)
    by_share = np.sqrt(np.sum(effects**2, axis=0))
    std, freedom = np.zeros(len(few)), len(blocks) - 1
    if few.any():
        own = differences_of(tangent, effects, yaw_zeros(tangent))
        here = [] if own is None else [_alone_apart(own)]
        apart = max([*here, every], key=lambda each: each.share)
        std, freedom = apart.share * by_share, apart.others
    if not few.all():
        refits = np.diag(jackknife(values_without_each(blocks))[0])
        beyond = np.sqrt(np.maximum(refits - tangent.least_squares.std**2, 0.0))
        if every.shown is not None:
            fewer = by_share > np.abs(effects.sum(axis=0)) / np.sqrt(FEWEST_RECORDINGS)
            beyond = np.where(fewer, np.maximum(beyond, every.share * by_share), beyond)
        std = np.where(few, std, beyond)
    return [Cause(NAME, std, 1.0, freedom)]


def _comparable(tangent: Tangent) -> bool:
    """Whether the recordings of an axis can be told apart: several, each with its own offset. Of many walks the fit's
    own deviation comes from refits without one of them each, which a share of that one does not survive."""
    count = len(tangent.blocks)
    return not tangent.shared and count > 1 and not (count >= FEWEST_RECORDINGS and tangent.steps)


def differences_of(tangent: Tangent, effects: Array, zeros: YawZeros | None = None) -> AxisDifferences | None:
    """Those of the recordings whose `effects` make more than the share TELLS of K; None where it is but one.

    Of few all are compared, however little they tell: nothing else says how far the one that tells most is off. In
    these a zero of the yaw torque passes for a stiffness of their own, so that such `zeros` are free beside them, and
    an angle that wanders for a softer one: who tells less than the share is as unsure as that makes it, and of a foot
    that hardly turns about an axis so are all, which then says nothing. Where one tells nearly all, and what the others
    could show is more than rubber does, and they do not, as of a motion for each axis, the number is as from that one
    alone.
    """
    blocks, stiffness = tangent.blocks, max(abs(float(tangent.fit.values[0])), 1e-300)
    tell = np.flatnonzero(np.abs(effects[:, 0]) > TELLS * stiffness).tolist()
    alone = len(tell) < 2
    if len(blocks) < FEWEST_RECORDINGS:
        tell = list(range(len(blocks)))
    if len(tell) < 2:
        return None
    found = tangent.least_squares
    differences = among(beside_one(blocks, _torques(tangent), tell[0], zeros), tell)
    if mostly_error(blocks, stiffness):
        return None
    little = np.abs(effects[:, 0]) < TELLS * stiffness
    left = {
        block.label: found.residuals[block.label] * one for block, one in zip(blocks, little, strict=True)
    }
    differences = beside_angle_errors(differences, blocks, left, stiffness, tell)
    unsure = np.sqrt(np.diag(differences.covariance))
    if alone and (unsure > np.maximum(MUCH, np.abs(differences.shares) / SURE)).all():
        return None
    usual = float(found.std[0]) / stiffness
    return AxisDifferences(differences, usual, frozenset(blocks[place].label for place in tell))


def beside_angle_errors(
    differences: Differences,
    blocks: Sequence[Block],
    residuals: Mapping[str, Array],
    stiffness: float,
    places: Sequence[int],
) -> Differences:
    """Differences of standing blocks at `places` from the first of these, as unsure as errors of their angles make
    them: they may have drawn a stiffness to zero by any share up to what explains the `residuals` of a fit of all.

    In a recording that hardly moves about an axis the angle is mostly its own error, which no torque follows: its
    stiffness alone is next to none, and what the fit leaves of it says nothing of that.
    """
    if blocks[0].stances is not None:
        return differences
    drawn = [slow_share(blocks[place], residuals[blocks[place].label], stiffness) for place in places]
    first, *others = np.square(UNIFORM * np.array(drawn))
    return differences._replace(covariance=differences.covariance + first + np.diag(others))


def beside_one(
    blocks: Sequence[Block], torques: Sequence[Array], one: int, zeros: YawZeros | None = None
) -> Differences:
    """Shares of `torques`, (n,) of each block, by which every other recording differs from `one`, in their order."""
    others = [place for place in range(len(blocks)) if place != one]
    columns = [np.column_stack(each) for each in zip(*(_alone(torques, own) for own in others), strict=True)]
    values, covariance = fit_beside(zeros, all_beside(blocks, columns))
    own = slice(blocks[0].regressor.shape[1], None)
    return Differences(values[own], covariance[own, own])


def among(found: Differences, places: Sequence[int]) -> Differences:
    """Of all recordings beside the one at `places[0]`, those at the other `places`."""
    own = np.array([place - (place > places[0]) for place in places[1:]])
    return Differences(found.shares[own], found.covariance[np.ix_(own, own)])


def effects_of(tangent: Tangent) -> Array:
    """What each recording's spring and damper add to the numbers, (blocks, k)."""
    each = zip(tangent.influences, _torques(tangent), strict=True)
    return np.array([own @ torque for own, torque in each])


def _torques(tangent: Tangent) -> list[Array]:
    return [block.regressor[:, :2] @ tangent.fit.values[:2] for block in tangent.blocks]


def _alone(torques: Sequence[Array], own: int) -> list[Array]:
    """The torque of one recording, none in the others."""
    return [torque * float(place == own) for place, torque in enumerate(torques)]

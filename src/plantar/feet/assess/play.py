"""Play in the bush, or between an encoder and the foot in a gear that carries the foot's torque.

The angle jumps wherever that changes its sign: torque = K·(angle - play/2·sign(torque - zero)) + C·rate + offset. It
bends every other model: taken for hardening or for a memory, it makes the spring too soft. Play in an encoder's own
drive is `misread_joints`'.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, SURE, Array
from plantar.estimation import Block, fit_blocks
from plantar.estimation.least_squares import factor_of
from plantar.feet.place.misread_joints import BETTER, SOFT
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside
from plantar.feet.regression.tangent import Tangent
from plantar.models import BESIDE
from plantar.notes import Note

CODE = "play"
ZEROS = np.arange(4, 97, 4)  # percentiles of the torque, among which its zero is sought
# Of another axis' play, which this one must stay below to be thought to have none. In small motions jumps are rounder
# and look smaller, to 0.35 of what they are. An axis without play shows 0.15 mrad.
SOME = 0.25
SHOWN = 3.0  # deviations, by which it stays below
VALID = "(valid: a bush and gears without play, or encoders on the foot's side; or keep the torque on one side of zero)"
SIGN = "where the torque changes its sign"


@dataclass(frozen=True)
class Play:
    """What a spring with play, in place of the model that was found, makes of a standing foot's torque.

    By how much the angle jumps [rad] where the torque passes its `zero` [N·m], how many `deviations` that is from none,
    stiffness and damping (2,), and the squares that are left.
    """

    jump: float
    deviations: float
    zero: float
    values: Array
    squares: float

    def surely(self, tangent: Tangent) -> bool:
        """Whether it is told from none, and leaves far less than the model that was found."""
        return self.deviations >= SURE and tangent.least_squares.squares >= BETTER * self.squares


def find_play(tangent: Tangent) -> Play | None:
    """Play of an axis that stands, whether or not another model explains as much; None where nothing jumps that way."""
    if tangent.steps:
        return None
    torques = _torques(tangent)
    zeros = [0.0, *np.percentile(np.concatenate(torques), ZEROS)]
    signs = [_signs(torques, zero) for zero in zeros]
    spring = _spring(tangent)
    together = [np.hstack(own) for own in zip(*signs, strict=True)]
    factor = factor_of(all_beside(spring, together), tangent.shared).factor
    tried = [_by_sign(factor, place, len(zeros)) for place in range(len(zeros))]
    # Noise of the torque makes its own sign, which adds where a spring that plays loses.
    playing = [place for place, (values, _) in enumerate(tried) if values[2] < 0 < values[0]]
    if not playing:
        return None
    place = min(playing, key=lambda place: tried[place][1])
    found = fit_blocks(all_beside(spring, signs[place]), shared_offset=tangent.shared)
    stiffness, loss = float(found.values[0]), -float(found.values[2])
    deviations = loss / float(found.std[2])
    return Play(2 * loss / stiffness, deviations, zeros[place], found.values[:2], found.squares)


def _by_sign(factor: Array, place: int, count: int) -> tuple[Array, float]:
    """Spring, damper and the sign's torque (3,), and the squares that are left, of a fit with one of `count` signs.

    factor: of [spring, damper, signs, offsets, response], which holds the fits with any of these columns.
    """
    both = len(BESIDE)
    columns = factor[:, [*range(both), both + place, *range(both + count, factor.shape[1] - 1)]]
    length = np.maximum(np.linalg.norm(columns, axis=0), np.finfo(float).tiny)
    values = np.linalg.lstsq(columns / length, factor[:, -1])[0] / length
    return values[: both + 1], float(np.sum((factor[:, -1] - columns @ values) ** 2))


def play_notes(tangent: Tangent, wide: AxisFit, other: Play | None = None) -> list[Note]:
    """A warning where play explains a standing foot's torque far better than the model that was found, and moves
    stiffness or damping out of the interval of `wide`.

    other: what the foot's other axis surely has. Play about both is the bush's, whose jumps are rounder than this;
    where this axis does not exclude it, as much as there must not move its numbers either.
    """
    own, usual = find_play(tangent), tangent.least_squares.values[:2]
    if own is None:
        return []
    name = f"{wide.foot} {wide.axis}"
    if own.surely(tangent) and (other is not None or not wide.holds(own.values - usual)):
        text = (
            f"{name}: the angle jumps by {1e3 * own.jump:.2g} mrad {SIGN}: play in the bush, or between an encoder and "
            f"the foot, which makes the spring look softer {VALID}"
        )
        return [Note(CODE, "warning", text)]
    if other is None or own.jump * (1 + SHOWN / own.deviations) < SOME * other.jump:
        return []
    as_much = _values_with(tangent, other.jump, own.zero)
    if wide.holds(as_much - usual):
        return []
    text = (
        f"{name}: about the foot's other axis the angle jumps by {1e3 * other.jump:.2g} mrad {SIGN}, which this one "
        f"does not exclude: with as much play the stiffness is {100 * (as_much[0] / usual[0] - 1):.0f} % larger {VALID}"
    )
    return [Note(CODE, "warning", text)]


def _values_with(tangent: Tangent, jump: float, zero: float) -> Array:
    """Stiffness and damping (2,) of a spring that plays by `jump` [rad]."""
    blocks = [
        replace(block, regressor=block.regressor - np.outer(sign, [jump / 2, 0.0]))
        for block, sign in zip(_spring(tangent), _signs(_torques(tangent), zero), strict=True)
    ]
    return fit_blocks(blocks, shared_offset=tangent.shared).values


def _spring(tangent: Tangent) -> list[Block]:
    """The blocks with the columns of spring and damper alone."""
    both = slice(len(BESIDE))
    return [
        replace(
            block,
            regressor=block.regressor[:, both],
            noise=None if block.noise is None else block.noise[both],
        )
        for block in tangent.blocks
    ]


def _torques(tangent: Tangent) -> list[Array]:
    """The torque at the rows of each block, (n,)."""
    column = ROTATIONAL_AXES.index(tangent.fit.axis)

    def of(recording: Recording) -> Array:
        return recording.bushes[tangent.fit.foot].torque[:, column]

    return tangent.rows(of)


def _signs(torques: list[Array], zero: float) -> list[Array]:
    """On which side of its zero each torque is, (n, 1), smooth about it."""
    return [
        np.tanh((torque - zero) / max(SOFT * float(np.std(torque)), 1e-12))[:, None] for torque in torques
    ]

"""Logs within which a zero jumps: an encoder that slips, an IMU or a force sensor that is zeroed anew, or is loose.

One offset a recording cannot follow that: stiffness and damping bend towards it, or a memory is made up for it. A jump
stands out in what spring and damper leave: the mean changes at one moment as it does at no other, and stays. Of a
sensor that is loose it changes often, to and fro, and shows over brief means.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from plantar.contact.reasons import TIPPING
from plantar.conventions import ROUNDING, Array
from plantar.estimation import Block, LinearFit, fit_blocks
from plantar.feet.exclusion.outliers import WORTH
from plantar.feet.fit.hidden_memory import has_memory
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.model_columns import model_columns
from plantar.feet.regression.regression_data import beside, blocks_of, recordings_of
from plantar.feet.regression.tangent import Tangent
from plantar.model_selection.initial_state import TRIED
from plantar.models import KelvinVoigt
from plantar.notes import Note
from plantar.signals.mean_changes import mean_changes
from plantar.signals.segments import run_numbers

BESIDE, BRIEF = 1.0, 0.3  # s before and after a moment, over which means are compared
FAR = 8.0  # times the usual difference of two such means
EXPLAINS = 0.5  # of the squares that spring and damper leave of the recording
NEARLY_ALL = 0.95  # likewise, of a sensor that is loose: the turns of a memory are not as sharp
CODE = "zero_jump"


def zero_jumps(recordings: Sequence[Recording], fit: AxisFit, shared: bool) -> list[Note]:
    """A warning for each recording in which the zero of one axis jumps while the foot stands.

    Not of a foot that steps: each of its stances has an offset of its own.
    """
    blocks = blocks_of(recordings, fit.foot, fit.axis)
    if blocks[0].stances is not None or shared:
        return []
    jumps = _jumps(fit_blocks(blocks), blocks, recordings, fit.foot)
    if fit.choice is not None and not has_memory(fit.model):
        # A memory that these motions begin to show: its first turn moves the zero of spring and damper, too.
        rows = {block.label: len(block.response) for block in blocks}
        for memory in (score.fit for score in fit.choice.ranking if has_memory(score.model)):
            left = {label: float(np.mean(missed**2)) for label, missed in memory.residuals.items()}
            jumps = {
                label: jump
                for label, jump in jumps.items()
                if label not in left or jump.left < rows[label] * left[label]
            }
    if not isinstance(fit.model, KelvinVoigt):
        # Beside a true memory, its own misfit shows a jump better. A memory that was made up for a jump leaves more
        # than the jump would; one that leaves less is what moves the means of spring and damper's misfit.
        tangent = Tangent.of(fit, recordings, False)
        own, law = tangent.blocks, tangent.least_squares
        left = {label: float(residual @ residual) for label, residual in law.residuals.items()}
        jumps = {label: jump for label, jump in jumps.items() if jump.left < left[label]}
        jumps = _jumps(law, own, recordings, fit.foot) | jumps
        blocks = [block for block in own if block.label in jumps]
        jumps = {
            block.label: jumps[block.label] for block in blocks if not _starts(block, recordings, fit, left)
        }
    return [
        Note(
            CODE,
            "warning",
            f"{label}: t = {jump.time:.1f} s{jump.more}: the zero of {fit.foot} {fit.axis} jumps: an encoder between "
            "IMU and foot slipped, or IMU or force sensor were zeroed anew or are loose (valid: one zero throughout a "
            "log; cut it there)",
        )
        for label, jump in jumps.items()
    ]


def _starts(block: Block, recordings: Sequence[Recording], fit: AxisFit, left: Mapping[str, float]) -> bool:
    """Whether another state of the memory at the start of a log explains most of what the fit has `left` of it.

    An element that just reaches its slip angle, once, slips a little or does not: what nobody knows of its start makes
    a small step there, and a search for it goes by that.
    """
    recording = next(one for one in recordings if one.name == block.label)
    start, rows = fit.initial_states.get(recording.name), recording.rows(fit.foot)
    if start is None:
        return False
    for state in TRIED:
        at, up, down = (
            model_columns(
                recording, fit.foot, fit.axis, fit, np.full(len(start), np.clip(state + by, -1.0, 1.0))
            )[rows]
            for by in (0.0, TRIED[1] - TRIED[0], TRIED[0] - TRIED[1])
        )
        moved = ((up - down) @ fit.values)[:, None]
        started = beside(replace(block, regressor=at, noise=None), moved)
        residual = fit_blocks([started]).residuals[block.label]
        if residual @ residual < (1 - EXPLAINS) * left[block.label]:
            return True
    return False


class _Jump(NamedTuple):
    """Its moment [s], or the first of so many `times`, and the squares that are `left` of the misfit beside all."""

    time: float
    times: int
    left: float

    @property
    def more(self) -> str:
        return f", the first of {self.times} times" if self.times > 1 else ""


def _jumps(
    whole: LinearFit, blocks: Sequence[Block], recordings: Sequence[Recording], foot: str
) -> dict[str, _Jump]:
    """The jump in each recording that has one, in what the blocks' fit leaves."""
    found = {}
    for block, recording in zip(blocks, recordings_of(blocks, recordings), strict=True):
        missed = whole.residuals[block.label]
        places = np.flatnonzero(recording.rows(foot))
        contact = recording.contacts[foot]
        # A foot that was lifted or has tipped meanwhile stands elsewhere. What jumps may look like a slide.
        stands = run_numbers(contact.loaded & ~contact.left_out_for(TIPPING))[places]
        for seconds, most, share in ((BESIDE, 1, EXPLAINS), (BRIEF, len(missed), NEARLY_ALL)):
            rows = sorted(mean_changes(missed, stands, max(1, round(seconds / block.period)), FAR)[:most])
            left = _left_beside(missed, rows, block, share) if rows else None
            if left is not None:
                found[block.label] = _Jump(float(recording.time[places[rows[0]]]), len(rows), left)
                break
    return found


def _left_beside(missed: Array, rows: Sequence[int], block: Block, share: float) -> float | None:
    """What steps at these rows leave of the squares that are `missed` (n,), beside the block's own columns; None where
    they do not explain this share of what these leave, or are small."""
    drift = np.zeros((len(missed), 0)) if block.nuisance is None else block.nuisance
    columns = np.column_stack([block.regressor, drift, missed])
    products = columns.T @ columns
    # A recording's own stiffness explains much of what the common one misses, without any step.
    before, _ = _between(columns, products, [0])
    left, levels = _between(columns, products, [0, *rows])
    # The drift has taken most of a step: only beside it does the step have its size.
    large = float(np.abs(np.diff(levels)).max()) > WORTH * float(np.std(block.response))
    return left if large and left < (1 - share) * before else None


def _between(columns: Array, products: Array, starts: Sequence[int]) -> tuple[float, Array]:
    """The squares that the others leave of the last of the columns (n, k) beside a level in each piece from one of the
    `starts` to the next, and these levels.

    products: of the columns (k, k). Those about the means of pieces follow, so that many steps cost no more than one.
    """
    counts = np.diff([*starts, len(columns)])[:, None]
    sums = np.add.reduceat(columns, starts)
    about = products - sums.T @ (sums / counts)
    scale = np.sqrt(np.maximum(np.diag(about), ROUNDING * np.diag(products) + np.finfo(float).tiny)[:-1])
    inner = about[:-1, :-1] / np.outer(scale, scale)
    solution = np.linalg.pinv(inner, ROUNDING, hermitian=True) @ (about[:-1, -1] / scale)
    coefficients = np.append(-solution / scale, 1.0)
    return float(coefficients @ about @ coefficients), sums @ coefficients / counts[:, 0]

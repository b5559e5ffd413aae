"""The bush's vertical stiffness, which the paper leaves out: heights of two standing soles agree (double support).

With the bushes taken as stiff in z, the kinematics put the right sole higher than the left one by

    h = z_L - z_R = F_L/K_L - F_R/K_R + const = s·(1/K_L + 1/K_R) + m·(1/K_L - 1/K_R) + const,

s = (F_L - F_R)/2 and m = (F_L + F_R)/2. Moving weight from foot to foot moves s and shows the sum of the compliances;
their difference shows only where the total m changes as well, and by more than the force sensors' noise. What the
robot file may be off by moves h with the robot's own motion, and widens both (`sole_height`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from plantar.contact.phases import DOUBLE, SUPPORTS
from plantar.contact.sole_height import height_changes
from plantar.conventions import NORMAL95, STIFFNESS_UNIT, Array, Mask
from plantar.estimation import Block, effect_of, fit_linear, influences_of, interval95, relative_std_percent
from plantar.feet.fit.compliances import ALIKE, Compliances
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.results.feet import Parameter, Verdict
from plantar.results.feet_rows import USABLE_WIDTH, WEAK_WIDTH
from plantar.robot.model import RobotModel
from plantar.signals.filters import low_pass
from plantar.signals.segments import complete

FEWEST_SAMPLES = 100  # in double support, of one recording
RELIABLE = 10.0  # times its noise's variance: that of a load from which a compliance is read
UNKNOWN_COMPLIANCE = 1e-5  # m/N: of 100 kN/m, the order of soft rubber, where nothing is known

UNCLEAR = "the heights of the soles do not follow the load clearly"
UNLIKE = "only the sum of both compliances shows, and pitch or roll of the feet differ"
ADVICE = (
    "stand on both feet and shift the weight slowly from foot to foot, nearly all of it, for 30 s or more"
)
ADVICE_APART = (
    "the total load must change to tell the feet apart: stand on both feet while somebody presses the robot down or "
    "lifts it by a tenth of its weight or more, slowly and several times"
)


@dataclass(frozen=True)
class VerticalStiffness:
    """Rows of axis z, and each foot's compliance [m/N] with its standard deviation, for eq. 6's moment arm; what is
    `found` of both, and the `gains` of their force sensors."""

    parameters: tuple[Parameter, ...]
    notes: tuple[Note, ...]
    compliance: dict[str, float]
    compliance_std: dict[str, float]
    freedom: float
    found: Compliances | None = None
    gains: Mapping[str, float] | None = None

    def of_feet_that_differ(self, share: float) -> VerticalStiffness:
        """The same of feet whose other stiffnesses differ by this share of their sum: so may their compliances."""
        if self.found is None or self.gains is None or share <= self.found.alike:
            return self
        return _of_both(replace(self.found, alike=share), self.gains)


class Heights(NamedTuple):
    """What the soles' heights in one recording tell: `block`, and the changes (n,) of h that each cause makes of it."""

    block: Block
    changes: Mapping[str, Array]


def heights_of(robot: RobotModel, recording: Recording) -> Heights | None:
    """What one recording tells; None where it is nothing."""
    shows = _block(recording, tuple(robot.feet)) if len(robot.feet) == 2 else None
    return shows and Heights(shows[0], dict(height_changes(recording.log, robot, shows[1])))


def fit_vertical_stiffness(
    heights: Sequence[Heights], robot: RobotModel, gains: Mapping[str, float]
) -> VerticalStiffness:
    """Vertical stiffness of two feet; where no log shows it, compliance 0 with the deviation of soft rubber.

    gains: share by which each foot's force sensor may be off, with 95 % probability: stiffness follows it.
    """
    feet = tuple(robot.feet)
    blocks, changes = [own.block for own in heights], [own.changes for own in heights]
    found = (
        _compliances(blocks, [[own[cause] for own in changes] for cause in changes[0]]) if blocks else None
    )
    if found is None or not found.clear:
        text = "z: no log shows the vertical compliance; K of pitch and roll may come out too large by load²·compliance"
        unknown = tuple(_unknown_row(foot) for foot in feet) if len(feet) == 2 else ()
        nothing, soft = dict.fromkeys(feet, 0.0), dict.fromkeys(feet, UNKNOWN_COMPLIANCE)
        return VerticalStiffness(unknown, (Note("z_unknown", "info", text),), nothing, soft, np.inf)
    return _of_both(found, {foot: gains[foot] for foot in feet})


def _of_both(found: Compliances, gains: Mapping[str, float]) -> VerticalStiffness:
    notes = []
    if not found.separable:
        text = "z: only the sum of both feet's compliances shows (the total load hardly changes); both taken as equal"
        notes.append(Note("z_sum_only", "info", text))
    own = {foot: found.of(side) for foot, side in zip(gains, (1.0, -1.0), strict=True)}
    return VerticalStiffness(
        tuple(_row(foot, *own[foot], found, gains[foot]) for foot in gains),
        tuple(notes),
        {foot: value for foot, (value, _) in own.items()},
        {foot: std for foot, (_, std) in own.items()},
        found.freedom,
        found,
        gains,
    )


def _compliances(blocks: Sequence[Block], errors: Sequence[Sequence[Array]]) -> Compliances:
    """Sum and difference; the sum alone where the total load changes in no recording. `errors`: by cause, the changes
    of h in each recording."""
    if any(block.regressor[:, 1].any() for block in blocks):
        fit = fit_linear(blocks)
        return Compliances(
            float(fit.values[0]),
            float(fit.values[1]),
            fit.covariance[:2, :2] + _moved(blocks, errors),
            float(fit.freedom[0]),
            fit.white_std[:2],
        )
    blocks = [replace(block, regressor=block.regressor[:, :1]) for block in blocks]
    fit = fit_linear(blocks)
    total = float(fit.values[0])
    unseen = np.diag([float(fit.covariance[0, 0] + _moved(blocks, errors)[0, 0]), total**2])
    return Compliances(total, 0.0, unseen, float(fit.freedom[0]), np.append(fit.white_std[:1], abs(total)))


def _moved(blocks: Sequence[Block], errors: Sequence[Sequence[Array]]) -> Array:
    """Covariance (k, k) of the values that errors of the heights make."""
    influences = influences_of(blocks)
    effects = [effect_of(influences, changes) for changes in errors]
    size = len(influences[0])
    return np.asarray(sum((np.outer(effect, effect) for effect in effects), np.zeros((size, size))))


def _block(recording: Recording, feet: tuple[str, ...]) -> tuple[Block, Mask] | None:
    """h over [s, m, t] in double support; t is the attitude's drift over the recording, a nuisance; and the rows of the
    recording that it takes.

    None where s hardly moves, m is 0 where it hardly does: a regressor of noise gives no compliance but a wrong one.
    """
    if any(recording.stances[foot] is not None for foot in feet):
        return None  # a sole that lands or lifts is not flat, and its height then says nothing of the load
    cutoff = recording.cutoff
    both, loads, values = _both_stand(recording, feet)
    if both.sum() < FEWEST_SAMPLES:
        return None
    rows = recording.thinned(feet[0], both)
    height, left_load, right_load = values[rows].T
    regressor = np.column_stack([(left_load - right_load) / 2, (left_load + right_load) / 2])
    drift = np.column_stack([np.ones(len(height)), recording.time[rows] - recording.time[rows].mean()])
    joint = np.column_stack([regressor, height])
    clear = joint - drift @ np.linalg.lstsq(drift, joint, rcond=None)[0]
    beyond = (loads[both] - values[both][:, 1:]).sum(
        axis=1
    ) / 2  # above the cut-off: noise, as white below it
    noise = np.var(beyond) * cutoff / max(0.5 / recording.period - cutoff, cutoff)
    moves = np.var(clear[:, :2], axis=0) > RELIABLE * noise
    if not moves[0]:
        return None
    clear[:, 1] *= moves[1]
    stride = recording.stride(feet[0])
    return Block(recording.name, clear[:, :2], clear[:, 2], stride * recording.period, stride), rows


def _both_stand(recording: Recording, feet: tuple[str, ...]) -> tuple[Mask, Array, Array]:
    """Samples (N,) of a block; the loads of both feet (N, 2); height and loads through the fit's filter, (N, 3)."""
    left, right = (recording.bushes[foot] for foot in feet)
    both = recording.used(feet[0]) & recording.used(feet[1])
    both &= recording.contacts[feet[0]].support == SUPPORTS.index(DOUBLE)
    height = right.sole_position[:, 2] - left.sole_position[:, 2]
    # Along the slide for the stiffness, and once more along the vertical for what the compression does to the height.
    upright = (np.cos(bush.deflection.T) for bush in (left, right))
    loads = np.column_stack(
        [bush.wrench[:, 2] * pitch * roll for bush, (pitch, roll) in zip((left, right), upright, strict=True)]
    )
    values = low_pass(np.column_stack([height, loads]), recording.period, recording.cutoff)
    both &= complete(values) & complete(loads)
    return both, loads, values


def _row(foot: str, compliance: float, std: float, found: Compliances, gain: float) -> Parameter:
    """One foot's stiffness: from sum and difference where they separate, else with both feet alike."""
    low, high = interval95(compliance, std, found.freedom)
    unlike = found.alike > ALIKE and not found.separable
    if low <= 0 or compliance <= 0:
        return _unknown_row(foot, UNLIKE if unlike else UNCLEAR)
    width = float(np.hypot((high - low) / 2 / compliance, gain))
    std = float(np.hypot(std, gain / NORMAL95 * compliance))
    value = 1 / compliance
    interval = (value / (1 + width), value / (1 - width) if width < 1 else np.inf)
    verdict: Verdict = (
        "usable" if width < USABLE_WIDTH else "weak" if width < WEAK_WIDTH else "unidentifiable"
    )
    reason = f"95 % interval of the compliance ±{100 * width:.2g} %"
    advice = ADVICE
    if not found.separable:
        advice = ADVICE_APART
        verdict = "weak" if verdict == "usable" else verdict
        reason += (
            f"; {UNLIKE}" if unlike else "; only the sum of both compliances shows, both feet taken as equal"
        )
    white = relative_std_percent(found.total, float(found.white_std[0]))
    return Parameter(
        foot, "z", "stiffness", STIFFNESS_UNIT["z"], value, std * value**2, interval, white, verdict, reason,
        None if verdict == "usable" else advice,
    )  # fmt: skip


def _unknown_row(foot: str, reason: str = UNCLEAR) -> Parameter:
    unit = STIFFNESS_UNIT["z"]
    return Parameter(foot, "z", "stiffness", unit, None, None, None, None, "unidentifiable", reason, ADVICE)

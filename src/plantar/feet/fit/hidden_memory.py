"""What motions leave open about the rubber's memory where spring and damper were kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import Array
from plantar.feet.regression.axis import AxisFit
from plantar.model_selection.selection import ModelChoice, ModelScore
from plantar.models import BESIDE, BushModel, BushMotion, KelvinVoigt, reach
from plantar.models.hysteresis import Hysteretic

# From about this angle on [rad] the twin's rubber slips inside; nobody has measured a real one. Until it slips, an
# element is a spring, too.
SLIPS = 0.01
SMALL = 1.5 * SLIPS  # motions as large tell an element from a spring
ALL_SHOWN = 2.0 * SLIPS  # a spring that explains everything so far is all there is
TOO_SMALL = (
    "bent by {:.2g} rad at most: hysteresis that needs larger motions would not show; in those the stiffness may be "
    "smaller (record larger motions)"
)
UNTIMED = (
    "the sensors' delays are not known, and a delay looks like hysteresis: none was fitted; with hysteresis the "
    "stiffness is smaller"
)
TORN = (
    "the stretches between gaps are too short for hysteresis to show, and it counts as stiffness, which is smaller "
    "without it (record logs without gaps)"
)
NOT_EXCLUDED = (
    "other axes of this robot show hysteresis; the motions about this one neither show nor exclude it: with hysteresis "
    "the stiffness is smaller"
)
UNBELIEVED = "the sensors' delays are not known, and a delay looks like it"


def has_memory(model: BushModel) -> bool:
    """Whether the torque depends on where the bush came from; what a spring that hardens does not know is a zero."""
    return model.remembers and model.fading_memory


def rival(fit: AxisFit) -> ModelScore | None:
    """The best model of a passive bush with a memory that predicts held-out motion better than spring and damper, which
    were kept."""
    if fit.choice is None or has_memory(fit.model):
        return None
    most = fit.choice.spring.held_out_rms
    better = (score for score in fit.choice.ranking if score.held_out_rms < most)
    remembering = (score for score in better if has_memory(score.model))
    return next((score for score in remembering if score.model.possible(score.fit.values)), None)


def element_slope(fit: AxisFit) -> float:
    """Stiffness of a fit's element until it slips [N.m/rad]; 0 of a model without one."""
    if "slip_torque" not in fit.model.terms or fit.slip_angle is None:
        return 0.0
    return abs(float(fit.values[fit.model.terms.index("slip_torque")])) / fit.slip_angle


def slope_share(fit: AxisFit) -> float:
    """Share of stiffness that a fit's element makes in motions too small for it to slip, and spring and damper would
    take for the spring's; 0 of a model without one."""
    slope = element_slope(fit)
    return slope / (slope + abs(float(fit.values[0]))) if slope else 0.0


def moved_by_memory(fit: AxisFit, *, steps: bool) -> Array:
    """How far stiffness and damping may be off (2,), where a caution says that a memory may be hidden.

    By as much as they are others beside the rival, as far as that is known; stiffness by the share that other axes'
    elements would make at least: a rival found in motions too small for these is the noise's. Of a foot that `steps`
    only where other axes show a memory: in short stances, whose first states nobody knows, some rival always comes
    near.
    """
    moved = np.zeros(len(BESIDE))
    if fit.choice is None or fit.choice.caution is None or has_memory(fit.model):
        return moved
    if steps and not fit.hidden_share:
        return moved
    if (found := rival(fit)) is not None:
        both = slice(len(BESIDE))
        moved[:] = np.hypot(fit.choice.equivalent.values[both] - found.fit.values[both], found.fit.std[both])
    moved[0] = max(moved[0], fit.hidden_share * abs(float(fit.values[0])))
    return moved


def may_hide_a_memory(motions: Sequence[BushMotion]) -> bool:
    """Whether motions of a standing foot are so small that a spring which explains them all may not be all there is."""
    return reach(motions) < ALL_SHOWN


def cautioned(choice: ModelChoice, *, timed: bool, steps: bool, torn: bool) -> ModelChoice:
    """The choice with a caution where a memory cannot be believed, or could not show.

    timed: whether it is known when the sensors read; steps: whether the foot steps, of which `half_turns` tells; torn:
    whether another foot's samples lie in runs so short that no memory was tried.
    """
    if not timed:
        choice = _unbelieved(choice)
    if choice.caution is not None:
        return choice
    if not timed:
        return replace(choice, caution=UNTIMED)
    if torn:
        return replace(choice, caution=TORN)
    if isinstance(choice.fit.model, Hysteretic) or steps or choice.reach >= SMALL:
        return choice
    return replace(choice, caution=TOO_SMALL.format(choice.reach))


def only_too_small(choice: ModelChoice) -> bool:
    """Whether nothing is open about a memory but what larger motions would show."""
    return choice.caution == TOO_SMALL.format(choice.reach)


def _unbelieved(choice: ModelChoice) -> ModelChoice:
    """Spring and damper in the place of a memory, which stays in the ranking: `rival` says what it would change."""
    if not has_memory(choice.fit.model):
        return choice
    ranking = tuple(
        replace(
            score,
            chosen=isinstance(score.model, KelvinVoigt),
            refused=UNBELIEVED if has_memory(score.model) else score.refused,
        )
        for score in choice.ranking
    )
    return replace(choice, fit=choice.equivalent, ranking=ranking, reason=UNTIMED)

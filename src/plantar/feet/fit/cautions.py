"""What motions leave open about the rubber's memory where a model without one was chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from plantar.model_selection.selection import ModelChoice
from plantar.models import BushMotion, reach
from plantar.models.hysteresis import Hysteretic

# From about this angle on [rad] the twin's rubber slips inside; nobody has measured a real one. Until it slips, an
# element is a spring, too.
SMALL = 0.01
ALL_SHOWN = 2.0  # times this angle: a spring that explains everything so far is all there is
TOO_SMALL = (
    "bent by {:.2g} rad at most: a memory of the rubber that shows only beyond counts as stiffness; in larger motions "
    "stiffness may be smaller (record larger motions)"
)
UNTIMED = (
    "sensors may be late by any time, which looks like a memory of the rubber: none was looked for, and with one "
    "stiffness is smaller"
)


def may_hide_a_memory(motions: Sequence[BushMotion]) -> bool:
    """Whether motions of a standing foot are so small that a spring which explains them all may not be all there is."""
    return reach(motions) < ALL_SHOWN * SMALL


def cautioned(choice: ModelChoice, *, timed: bool, steps: bool) -> ModelChoice:
    """The choice with a caution where a memory could not be looked for, or could not show.

    timed: whether it is known when the sensors read; steps: whether the foot steps, of which `half_turns` tells.
    """
    if choice.caution is not None:
        return choice
    if not timed:
        return replace(choice, caution=UNTIMED)
    if isinstance(choice.fit.model, Hysteretic) or steps or choice.reach >= SMALL:
        return choice
    return replace(choice, caution=TOO_SMALL.format(choice.reach))

"""Whether a richer model is worth having: one that changes neither stiffness nor damping by more than they are unsure.

A spring that differs from recording to recording, or an attitude that wanders, leaves what a richer model takes up a
little of. It then predicts unseen motions better, and its terms mean nothing.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plantar.feet.fit.hidden_memory import NOT_EXCLUDED
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt
from plantar.results.feet_rows import USABLE_WIDTH


def hardly_matters(fit: AxisFit, spring: AxisFit) -> bool:
    """Whether `spring`, spring and damper alone, has its stiffness and damping inside a richer model's intervals.

    fit: with the deviations of all that is unsure about robot and sensors.
    """
    ends = (fit.interval(place) for place in range(2))
    return all(low < alone < high for (low, high), alone in zip(ends, spring.numbers, strict=True))


def tells_no_more(fit: AxisFit, simpler: AxisFit) -> bool:
    """Whether what a model adds to a `simpler` one is not told from zero, nor moves a number of it.

    Beside noise alone it may well be told; a bush that sits a little elsewhere makes the same torque.

    fit: with the deviations of all that is unsure about robot and sensors.
    """
    alone = dict(zip(simpler.names, simpler.numbers, strict=True))
    if len(alone) == len(fit.names):  # another shape, no term
        return False
    ends = (fit.interval(place) for place in range(len(fit.names)))
    return all(low < alone.get(name, 0.0) < high for name, (low, high) in zip(fit.names, ends, strict=True))


def too_sure(fit: AxisFit, spring: AxisFit) -> bool:
    """Whether `spring` leaves a richer model's stiffness outside its own interval, and far away.

    The richer model then cannot be told well, but the spring alone is not as sure as it claims.

    fit, spring: with the deviations of all that is unsure about robot and sensors.
    """
    low, high = spring.interval(0)
    far = abs(fit.numbers[0] - spring.numbers[0]) > USABLE_WIDTH * abs(spring.numbers[0])
    return bool(far and not low < fit.numbers[0] < high)


def in_place_of(fit: AxisFit, simpler: AxisFit) -> AxisFit:
    """The fit of a simpler model in place of a richer one that hardly matters, with what was tried and why.

    Where motions are too small to tell a memory that other axes have from a spring, it is not excluded by that.
    """
    if isinstance(simpler.model, KelvinVoigt):
        changes = 100 * np.abs(fit.numbers[:2] / simpler.numbers[:2] - 1)
        reason = (
            f"{fit.model.name} changes stiffness by {changes[0]:.2g} % and damping by {changes[1]:.2g} % only, "
            "less than their uncertainty"
        )
    else:
        reason = f"what {fit.model.name} adds is no more than errors of robot file and sensors may make"
    choice = fit.choice and replace(
        fit.choice,
        caution=NOT_EXCLUDED if fit.hidden_share else fit.choice.caution,
        ranking=tuple(
            replace(
                score,
                chosen=score.model.name == simpler.model.name,
                refused="hardly matters" if score.chosen else score.refused,
            )
            for score in fit.choice.ranking
        ),
    )
    return replace(simpler, choice=choice, reason=reason, hidden_share=fit.hidden_share)

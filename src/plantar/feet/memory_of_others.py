"""The bushes of one robot are of one rubber: a memory that other axes show is taken where one shows it less clearly.

In short stances, whose first states nobody knows, a memory must gain much before it is believed. Where another axis
shows it beyond doubt it need not: spring and damper alone would come out too stiff by the element's slope.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.internal_error import gives_up
from plantar.model_selection.selection import ModelScore
from plantar.models import KelvinVoigt


def with_memory_of_others(feet: Mapping[str, FittedFoot]) -> dict[str, FittedFoot]:
    """The feet with a memory in each axis that a `caution` says is nearer to it, and that another axis has."""
    every = [fit for one in feet.values() for fit in one.fits.values()]
    shown = {fit.model.name for fit in every if fit.model.remembers}
    found = {}
    for foot, one in feet.items():
        fits = dict(one.fits)
        for axis, fit in one.fits.items():
            score = _nearer(fit, shown)
            if score is None or axis in one.given_up:
                continue
            with gives_up(axis, one.given_up):
                own = fit_axis(one.thin.fitted, one.foot, axis, one.ready.settings, score.model, one.place)
                fits[axis] = fit if own is None else _in_place_of(fit, own)
        found[foot] = replace(one, fits=fits)
    return found


def _nearer(fit: AxisFit, shown: Collection[str]) -> ModelScore | None:
    """Where a fit of spring and damper is cautioned about: the nearest model of those `shown` that was identified."""
    if fit.choice is None or fit.choice.caution is None or not isinstance(fit.model, KelvinVoigt):
        return None
    return next((s for s in fit.choice.ranking if s.refused is None and s.model.name in shown), None)


def _in_place_of(spring: AxisFit, fit: AxisFit) -> AxisFit:
    """The fit with what was tried before, and why it is chosen after all."""
    assert spring.choice is not None, "an axis whose models were compared"
    ranking = tuple(
        replace(score, chosen=score.model.name == fit.model.name) for score in spring.choice.ranking
    )
    reason = "it predicts held-out motion better, and other axes of this robot show it clearly"
    return replace(fit, choice=replace(spring.choice, ranking=ranking, caution=None), reason=reason)

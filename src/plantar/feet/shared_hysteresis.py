"""Bushes of one robot are of one rubber: hysteresis that other axes show is taken where one shows it less clearly.

In short stances, whose first states nobody knows, a memory must gain much before it is believed. Where another axis
shows it beyond doubt it need not: spring and damper alone would come out too stiff by the element's slope. And where
one axis bends the rubber far enough to show a memory and has none, smaller motions about the other hide none.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES
from plantar.estimation.errors_in_variables import mostly_error
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.half_turns import cautioned_if_hardly_turned
from plantar.feet.fit.hidden_memory import NOT_EXCLUDED, SMALL, has_memory, only_too_small, rival, slope_share
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.internal_error import gives_up
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.model_selection.selection import LEAST_GAIN, ModelChoice, ModelScore
from plantar.models import KelvinVoigt
from plantar.models.hysteresis import SURE_SLIP_ANGLE, Hysteretic
from plantar.results.feet_rows import WEAK_WIDTH

# Times the angle at which elements of other axes slip: in motions that bend an axis less, an element is a spring as
# well, and one that was found there may be taken for none again.
ALIKE = 2.0
FEWEST_HINTS = 3  # axes that may speak for a memory together: of two, both do so by chance in some walks
# Of the stiffness, that a memory takes off it on average: less is no more than other errors do.
WORTH_A_HINT = 0.05
HINTED = (
    "hysteresis predicts held-out steps better about every axis, by {:.0f} % together, about none by enough to be "
    "taken for certain; with hysteresis the stiffness is smaller (record longer steps, or stand and sway)"
)


def with_shared_hysteresis(feet: Mapping[str, FittedFoot]) -> dict[str, FittedFoot]:
    """The feet with a memory that another axis has in each axis that is nearer to it than to spring and damper.

    An axis that neither shows nor excludes it keeps what it has, with a caution, and so does one whose steps are too
    small for its memory.
    """
    every = [fit for one in feet.values() for fit in one.fits.values() if _known(fit, one)]
    shown = {fit.model.name for fit in every if has_memory(fit.model)}
    share = max((slope_share(fit) for fit in every), default=0.0)
    slips = min((_slip_angle(fit) for fit in every), default=np.inf)
    hinted = None if shown else _hinted(feet)
    found = {}
    for foot, one in feet.items():
        fits = dict(one.fits)
        for axis, fit in one.fits.items():
            if fit.choice is None or isinstance(fit.model, Hysteretic) or axis in one.given_up:
                continue
            if hinted is not None and fit.choice.caution is None and _steps(one):
                fits[axis] = replace(fit, choice=replace(fit.choice, caution=hinted))
                continue
            if not shown:
                fits[axis] = _without_needless_caution(fit, fit.choice, one)
                continue
            steps, small = _steps(one), fit.choice.reach * SURE_SLIP_ANGLE < slips < np.inf
            score = None
            if isinstance(fit.model, KelvinVoigt) and (steps or not small):
                score = _nearer(fit.choice, shown, steps=steps)
            if score is None:
                cautioned = _cautioned(fit, fit.choice, shown, steps=steps, small=small)
                fits[axis] = fit if cautioned is None else replace(cautioned, hidden_share=share)
                continue
            with gives_up(axis, one.given_up):
                own = fit_axis(one.thin.fitted, one.foot, axis, one.ready.settings, score.model, one.place)
                fits[axis] = fit if own is None else _in_place_of(fit, own)
        for axis, fit in fits.items():
            if (
                has_memory(fit.model)
                and fit.choice
                and fit.choice.reach < ALIKE * slips < np.inf
                and not _steps(one)
            ):
                fits[axis] = fit = replace(fit, hidden_share=share)
            with gives_up(axis, one.given_up):
                fits[axis] = cautioned_if_hardly_turned(fit, one.thin.fitted)
        found[foot] = replace(one, fits=fits)
    return _with_shared_creep(found)


def _with_shared_creep(feet: Mapping[str, FittedFoot]) -> dict[str, FittedFoot]:
    """The feet, every spring that a memory predicts better cautioned where one axis shows that the rubber creeps."""
    choices = [fit.choice for one in feet.values() for fit in one.fits.values()]
    if not any(choice is not None and choice.caution is not None and choice.creeps for choice in choices):
        return dict(feet)
    return {
        foot: replace(
            one,
            fits={
                axis: replace(fit, choice=replace(fit.choice, caution=NOT_EXCLUDED))
                if fit.choice is not None and fit.choice.caution is None and rival(fit) is not None
                else fit
                for axis, fit in one.fits.items()
            },
        )
        for foot, one in feet.items()
    }


def _without_needless_caution(fit: AxisFit, choice: ModelChoice, foot: FittedFoot) -> AxisFit:
    """The fit of small motions without the caution that larger ones may show a memory, where the other axis of the same
    foot shows none: at the sole's border it strains the rubber as far as larger motions about this one would."""
    if not only_too_small(choice):
        return fit
    across = dict(
        zip(ROTATIONAL_AXES, np.ptp(foot.ready.robot.feet[foot.foot].sole.polygon, axis=0), strict=True)
    )
    shows_none = any(
        other.choice is not None
        and other.choice.caution is None
        and not has_memory(other.model)
        and other.choice.reach * across[axis] >= SMALL * across[fit.axis]
        for axis, other in foot.fits.items()
        if axis != fit.axis and axis not in foot.given_up
    )
    return replace(fit, choice=replace(choice, caution=None)) if shows_none else fit


def _hinted(feet: Mapping[str, FittedFoot]) -> str | None:
    """A caution where every axis of the feet that step is predicted better by a memory, each by too little to be
    believed there and all together by enough: one rubber's memory, and not four accidents.

    Not where stiffness stays what it is, nor where a spring explains all of an axis, about which no model was tried.
    """
    fits = [fit for one in feet.values() if _steps(one) for fit in one.fits.values()]
    missed, softer = list[tuple[float, float]](), list[float]()
    for fit in fits:
        found = rival(fit)
        if fit.choice is None or found is None or found.refused is not None:
            return None
        spring = fit.choice.spring
        missed.append((found.held_out_rms, spring.held_out_rms))
        softer.append(1 - float(found.fit.values[0] / spring.fit.values[0]))
    if len(fits) < FEWEST_HINTS or np.mean(softer) < WORTH_A_HINT:
        return None
    beside, alone = np.linalg.norm(missed, axis=0)
    return HINTED.format(100 * (1 - beside / alone)) if beside < (1 - LEAST_GAIN) * alone else None


def _known(fit: AxisFit, foot: FittedFoot) -> bool:
    """Whether the spring beside a memory is known at all: else that axis tells neither from the other, and nothing to
    others. Of a standing foot that hardly turns about an axis the angle's own errors are its memory."""
    if not has_memory(fit.model):
        return True
    if NORMAL95 * float(fit.std[0]) >= WEAK_WIDTH * abs(float(fit.values[0])):
        return False
    if _steps(foot):
        return True
    tangent = Tangent.of(fit, foot.thin.fitted, False)
    return not mostly_error(tangent.blocks, float(fit.equivalent[0]))


def _steps(foot: FittedFoot) -> bool:
    return any(recording.stances[foot.foot] is not None for recording in foot.thin.fitted)


def _nearer(choice: ModelChoice, shown: Collection[str], *, steps: bool) -> ModelScore | None:
    """The nearest model of those `shown` that was identified; of a standing foot only where a caution asks for it."""
    found = next((s for s in choice.ranking if s.refused is None and s.model.name in shown), None)
    if found is None or (choice.caution is None and not steps):
        return None
    return found if found.held_out_rms < choice.spring.held_out_rms else None


def _slip_angle(fit: AxisFit) -> float:
    """The angle at which the element of a fit slips [rad]; infinite where it has none."""
    if fit.choice is None or not isinstance(fit.model, Hysteretic):
        return np.inf
    return float(fit.choice.fit.shape[0])


def _cautioned(
    fit: AxisFit, choice: ModelChoice, shown: Collection[str], *, steps: bool, small: bool
) -> AxisFit | None:
    """The fit with a caution; None where a memory was identified in motions that show one, and gains nothing there.

    One that gains a little, too little to be chosen, is not excluded: in small motions spring and memory are alike.

    Motions too `small` to bend this axis as far as it takes an element elsewhere to slip show none: what is identified
    in them is the noise's.
    """
    excluded = not isinstance(fit.model, KelvinVoigt) or any(
        score.refused is None
        and score.model.name in shown
        and score.held_out_rms >= choice.spring.held_out_rms
        for score in choice.ranking
    )
    if choice.caution is not None:
        return fit
    if excluded and not steps and not small:
        return None
    return replace(fit, choice=replace(choice, caution=NOT_EXCLUDED))


def _in_place_of(spring: AxisFit, fit: AxisFit) -> AxisFit:
    """The fit with what was tried before, and why it is chosen after all."""
    assert spring.choice is not None, "an axis whose models were compared"
    ranking = tuple(
        replace(score, chosen=score.model.name == fit.model.name) for score in spring.choice.ranking
    )
    reason = "it predicts held-out motion better, and other axes of this robot show it clearly"
    return replace(fit, choice=replace(spring.choice, ranking=ranking, caution=None), reason=reason)

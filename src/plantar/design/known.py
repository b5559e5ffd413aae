"""What an earlier result knows of the feet: where the next motion's stiffness lies, and what is still weak."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array
from plantar.design.rubber import SHARE
from plantar.errors import DataError
from plantar.models import KelvinVoigt
from plantar.results.feet import FeetResult, Parameter

WIDER: Final = 1.1  # the range beyond the intervals: rubber is not the same every day
# Of a weak stiffness, so much is rubber's spring at least: the rest may be an element that these motions made not slip.
SPRING: Final = 0.5
HIDDEN: Final = "hidden memory"  # the share of such an element in a variance, as results call it


@dataclass(frozen=True)
class Known:
    """Stiffness and damping of all feet and axes together (geometric means, of those that are usable where any is)
    [N·m/rad, N·m·s/rad], the range of the stiffness, by (foot, axis) the deviations of both, (2,), infinite where not
    identified or weak, and the stiffness (2,) of the elements that slip beside pitch and roll, None where none was
    found."""

    stiffness: float
    damping: float
    low: float
    high: float
    deviations: dict[tuple[str, str], Array]
    element: Array | None

    @classmethod
    def of(cls, result: FeetResult) -> Known:
        """Raises DataError where a result has no stiffness or damping at all."""
        terms = KelvinVoigt().terms
        values: dict[str, dict[str, list[float]]] = {term: {"usable": [], "weak": []} for term in terms}
        reaches, deviations = list[float](), dict[tuple[str, str], Array]()
        element = _elements(result)
        for row in result.parameters:
            if row.axis not in ROTATIONAL_AXES or row.name not in terms:
                continue
            own = deviations.setdefault((row.foot, row.axis), np.full(2, np.inf))
            if row.verdict not in ("usable", "weak") or row.interval95 is None or not (row.value or 0.0) > 0:
                continue
            low, high = row.interval95
            values[row.name][row.verdict].append(float(row.value or 0.0))
            if row.verdict == "usable":
                own[terms.index(row.name)] = (high - low) / 2 / NORMAL95
            if row.name == terms[0]:
                ends = low, high
                if row.verdict == "weak":
                    ends = _spring_alone(row, ends, result, element)
                reaches += [end for end in ends if end > 0]
        found = {term: of["usable"] or of["weak"] for term, of in values.items()}
        if not all(found.values()):
            message = "the result has no stiffness and damping that could be used"
            raise DataError(message, valid="a result with some, or --stiffness without --after")
        stiffness, damping = (float(np.exp(np.mean(np.log(found[term])))) for term in terms)
        low, high = min(*reaches, stiffness) / WIDER, max(*reaches, stiffness) * WIDER
        return cls(stiffness, damping, low, high, deviations, element)

    @property
    def sure(self) -> list[tuple[str, str]]:
        """The (foot, axis) of which stiffness and damping are usable."""
        return [place for place, own in self.deviations.items() if np.isfinite(own).all()]

    def precision(self, feet: tuple[str, ...]) -> Array:
        """Information (feet, 2, 2, 2) on stiffness and damping of each foot and axis."""
        unknown = np.full(2, np.inf)
        own = [[self.deviations.get((foot, axis), unknown) for axis in ROTATIONAL_AXES] for foot in feet]
        return np.asarray(np.einsum("fai,ij->faij", np.array(own) ** -2.0, np.eye(2)))


def _spring_alone(
    row: Parameter, interval: tuple[float, float], result: FeetResult, element: Array | None
) -> tuple[float, float]:
    """Between what the spring lies of a weak stiffness, by its 95 % `interval` [N·m/rad].

    An element that was not made to slip counts as stiffness: what was found is the sum of both, as sure as the sensors
    are, and the interval, as wide upwards as downwards, says how much of it may be the element's.
    """
    shares = (
        each.variance_shares.get(HIDDEN, 0.0)
        for each in result.diagnosis
        if (each.foot, each.axis, each.name) == (row.foot, row.axis, row.name)
    )
    hidden, (low, high) = next(shares, 0.0), interval
    if element is None or not hidden > 0:
        return SPRING * low, high
    sure = (high - low) / 2 * np.sqrt(max(1.0 - hidden, 0.0))
    return low, float((row.value or 0.0) + sure - element[ROTATIONAL_AXES.index(row.axis)])


def _elements(result: FeetResult) -> Array | None:
    """Stiffness (2,) until they slip of the elements of pitch and roll [N·m/rad], means of all feet; an axis that shows
    none has one in proportion to the other's."""
    values = {
        (row.foot, row.axis, row.name): row.value
        for row in result.parameters
        if row.verdict != "unidentifiable"
    }
    slopes = np.full(len(ROTATIONAL_AXES), np.nan)
    for place, axis in enumerate(ROTATIONAL_AXES):
        found = [
            torque / angle
            for (foot, own, name), torque in values.items()
            if (own, name) == (axis, "slip_torque")
            and torque
            and (angle := values.get((foot, axis, "slip_angle")))
        ]
        slopes[place] = np.mean(found) if found else np.nan
    if np.isnan(slopes).all():
        return None
    return np.where(np.isnan(slopes), np.nanmean(slopes / SHARE) * np.array(SHARE), slopes)

"""What an earlier result knows of the feet: where the next motion's stiffness lies, and what is still weak."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array
from plantar.errors import DataError
from plantar.models import KelvinVoigt
from plantar.results.feet import FeetResult

WIDER: Final = 1.1  # the range beyond the intervals: rubber is not the same every day
# Of a weak stiffness, so much is rubber's spring at least: the rest may be an element that these motions made not slip.
SPRING: Final = 0.5


@dataclass(frozen=True)
class Known:
    """Stiffness and damping of all feet and axes together (geometric means, of those that are usable where any is)
    [N·m/rad, N·m·s/rad], the range of the stiffness, and by (foot, axis) the deviations of both, (2,), infinite where
    not identified or weak."""

    stiffness: float
    damping: float
    low: float
    high: float
    deviations: dict[tuple[str, str], Array]

    @classmethod
    def of(cls, result: FeetResult) -> Known:
        """Raises DataError where a result has no stiffness or damping at all."""
        terms = KelvinVoigt().terms
        values: dict[str, dict[str, list[float]]] = {term: {"usable": [], "weak": []} for term in terms}
        reaches, deviations = list[float](), dict[tuple[str, str], Array]()
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
                reaches += [
                    end for end in (low if row.verdict == "usable" else SPRING * low, high) if end > 0
                ]
        found = {term: of["usable"] or of["weak"] for term, of in values.items()}
        if not all(found.values()):
            message = "the result has no stiffness and damping that could be used"
            raise DataError(message, valid="a result with some, or --stiffness without --after")
        stiffness, damping = (float(np.exp(np.mean(np.log(found[term])))) for term in terms)
        return cls(stiffness, damping, min(reaches) / WIDER, max(reaches) * WIDER, deviations)

    def precision(self, feet: tuple[str, ...]) -> Array:
        """Information (feet, 2, 2, 2) on stiffness and damping of each foot and axis."""
        unknown = np.full(2, np.inf)
        own = [[self.deviations.get((foot, axis), unknown) for axis in ROTATIONAL_AXES] for foot in feet]
        return np.asarray(np.einsum("fai,ij->faij", np.array(own) ** -2.0, np.eye(2)))

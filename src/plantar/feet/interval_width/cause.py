"""A cause of error, and how it widens a fit's intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array
from plantar.estimation.residual_covariance import pooled_freedom
from plantar.feet.regression.axis import AxisFit


@dataclass(frozen=True)
class Cause:
    """One cause: how far a unit of it moves the model's values (k,), or values and shape (k + s,), its deviation and
    that one's degrees of freedom."""

    name: str
    effect: Array
    std: float
    freedom: float = np.inf

    @property
    def share(self) -> Array:
        """Deviation that it adds to each number."""
        return np.abs(self.effect) * self.std


def inflated(fit: AxisFit, causes: Sequence[Cause]) -> AxisFit:
    """The fit with the causes inside its covariance."""
    covariance, freedom = fit.covariance.copy(), fit.freedom
    for cause in causes:
        added = np.zeros(len(covariance))
        added[: len(cause.effect)] = cause.effect * cause.std
        variances = np.array([np.diag(covariance), added**2])
        freedom = pooled_freedom(variances, np.vstack([freedom, np.full_like(added, cause.freedom)]))
        covariance = covariance + np.outer(added, added)
    return replace(fit, covariance=covariance, freedom=freedom)

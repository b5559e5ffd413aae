"""Spring and damper side by side (eq. 4 and 5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from plantar.conventions import Array


@dataclass(frozen=True)
class KelvinVoigt:
    """torque = K·deflection + C·rate + offset; the offset belongs to the recording, not to the bush."""

    name: ClassVar[str] = "kelvin_voigt"
    terms: ClassVar[tuple[str, ...]] = ("stiffness", "damping")

    def regressor(self, deflection: Array, rate: Array) -> Array:
        """Y_JJ without the offset's column: (n,) and (n,) -> (n, 2), `[q q̇]` of eq. 5."""
        return np.column_stack([deflection, rate])

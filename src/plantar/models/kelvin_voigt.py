"""Spring and damper side by side (eq. 4 and 5)."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.bush_model import BushModel, BushMotion


class KelvinVoigt(BushModel):
    """torque = K·deflection + C·rate + offset; the offset belongs to the recording, not to the bush."""

    name: ClassVar[str] = "kelvin_voigt"

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """No columns beside the two: (N, 0, b)."""
        return np.zeros((len(motion), 0, len(shapes)))

"""What a user may choose when inertias or joints are identified."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from plantar.choices import number_in
from plantar.errors import SettingsError
from plantar.signals.filters import LOWEST_CUTOFF


@dataclass(frozen=True)
class DynamicsSettings:
    """What `identify_inertia` and `identify_joints` may be told.

    Args:
        cutoff: zero-phase low-pass on both sides of eq. 1 [Hz], at least 0.1, where accelerations are derived; a log
            that brings its accelerations is taken as it is.
        as_recorded: wrench channels that contradict Newton's law are named in a note, but not corrected.

    Raises:
        SettingsError: a value out of its range.

    Example:
        >>> import plantar
        >>> plantar.DynamicsSettings(cutoff=4.0).as_recorded
        False
    """

    cutoff: float = 3.0
    as_recorded: bool = False

    def __post_init__(self) -> None:
        number_in("cutoff", self.cutoff, LOWEST_CUTOFF, math.inf, "Hz")
        if not isinstance(self.as_recorded, bool):
            raise SettingsError("as_recorded is not valid", value=self.as_recorded, valid="True, False")

    def to_dict(self) -> dict[str, Any]:
        """The settings as they stand in `result.json`."""
        return asdict(self)

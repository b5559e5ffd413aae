"""What a user may choose when inertias or joints are identified."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class DynamicsSettings:
    """`cutoff` [Hz]: zero-phase low-pass on both sides of eq. 1, where accelerations are derived; a log that brings
    its accelerations is taken as it is. `as_recorded`: wrench channels at fault are named, not mended."""

    cutoff: float = 3.0
    as_recorded: bool = False

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)

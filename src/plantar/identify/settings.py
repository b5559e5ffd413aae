"""What a user may choose for `identify feet`; every choice is written into the result."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

OffsetRule = Literal["per-motion", "shared"]


@dataclass(frozen=True)
class FeetSettings:
    """`offset`: one for each recording, or one for all as in the paper. `cutoff` [Hz]: zero-phase low-pass on both
    sides of eq. 6. `edge_margin` [m]: a centre of pressure nearer to the sole's border is left out. `window` [rad]:
    largest deflection from the resting pose that serves; None finds the bend of the torque by itself."""

    offset: OffsetRule = "per-motion"
    model: str = "kelvin_voigt"
    cutoff: float = 5.0
    edge_margin: float = 0.005
    window: float | None = None

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)

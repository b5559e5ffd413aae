"""What a user may choose for `identify feet`; every choice is written into the result."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

OffsetRule = Literal["per-motion", "shared"]
AUTOMATIC = "auto"
DEFAULT_CUTOFF = 5.0  # Hz: sways of a robot are slower, and encoders differentiated are noise above


@dataclass(frozen=True)
class FeetSettings:
    """`offset`: one for each recording, or one for all as in the paper. `model`: a law of the bush, or the one that
    predicts held-out motions best. `cutoff` [Hz]: zero-phase low-pass on both sides of eq. 6; None takes
    DEFAULT_CUTOFF, or less where walks show that angle and torque part below it. `edge_margin` [m]: a
    centre of pressure nearer to the sole's border is left out. `window` [rad]: largest deflection from the resting pose
    that serves; None finds the bend of the torque by itself. `wrench_delay` [s]: how late the force sensors are; None
    estimates it."""

    offset: OffsetRule = "per-motion"
    model: str = AUTOMATIC
    cutoff: float | None = None
    edge_margin: float = 0.005
    window: float | None = None
    wrench_delay: float | None = None

    @property
    def highest_cutoff(self) -> float:
        """The cutoff asked for, or the highest one that may be found [Hz]."""
        return DEFAULT_CUTOFF if self.cutoff is None else self.cutoff

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)

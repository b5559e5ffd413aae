"""What a user may choose for `identify feet`; every choice is written into the result."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Final, Literal, get_args

from plantar.choices import number_in, one_of
from plantar.models import MODELS
from plantar.signals.filters import LOWEST_CUTOFF

OffsetRule = Literal["per-motion", "shared"]
AUTOMATIC: Final = "auto"
MODEL_CHOICES: Final = (AUTOMATIC, *MODELS)
DEFAULT_CUTOFF: Final = 5.0  # Hz: sways of a robot are slower, and encoders differentiated are noise above

LEAST_WINDOW: Final = math.radians(0.01)  # rad: finer than a good encoder
LONGEST_DELAY: Final = 1.0  # s: a sensor that is later has another fault than a delay


@dataclass(frozen=True)
class FeetSettings:
    """What `identify_feet` may be told. The defaults find out by themselves what they can.

    Args:
        offset: "per-motion" gives each recording its own offset, because the zeros of sensors change between
            recordings; "shared" gives one offset to all, as in the paper.
        model: a model of the bush, such as "kelvin_voigt" (spring and damper), or "auto": the one that predicts
            held-out motions best.
        cutoff: zero-phase low-pass on both sides of eq. 6 [Hz], at least 0.1; None takes 5 Hz, or less where walks
            show that angle and torque part below it.
        edge_margin: samples with the centre of pressure nearer than this to the sole's border are left out [m].
        window: largest deflection from the resting pose that is used [rad]; None finds by itself where the torque
            bends.
        wrench_delay: how late the force sensors are against the IMU [s], > 0: late; None estimates it.

    Raises:
        SettingsError: a value that is not one of the choices or out of its range.

    Example:
        >>> import plantar
        >>> plantar.FeetSettings(model="kelvin_voigt", wrench_delay=0.005).wrench_delay
        0.005
        >>> plantar.FeetSettings(offset="shard")
        Traceback (most recent call last):
        ...
        plantar.errors.SettingsError: value 'shard': offset is not a choice (valid: per-motion, shared)
    """

    offset: OffsetRule = "per-motion"
    model: str = AUTOMATIC
    cutoff: float | None = None
    edge_margin: float = 0.005
    window: float | None = None
    wrench_delay: float | None = None

    def __post_init__(self) -> None:
        one_of("offset", self.offset, get_args(OffsetRule))
        one_of("model", self.model, MODEL_CHOICES)
        number_in("cutoff", self.cutoff, LOWEST_CUTOFF, math.inf, "Hz", optional="found from the data")
        number_in("edge_margin", self.edge_margin, 0.0, math.inf, "m")
        number_in("window", self.window, LEAST_WINDOW, math.pi, "rad", optional="found from the data")
        number_in(
            "wrench_delay", self.wrench_delay, -LONGEST_DELAY, LONGEST_DELAY, "s",
            optional="estimated from the data",
        )  # fmt: skip

    @property
    def shared(self) -> bool:
        """Whether all recordings have one offset."""
        return self.offset == "shared"

    @property
    def highest_cutoff(self) -> float:
        """The cutoff asked for, or the highest one that may be found [Hz]."""
        return DEFAULT_CUTOFF if self.cutoff is None else self.cutoff

    def to_dict(self) -> dict[str, Any]:
        """The settings as they stand in `result.json`."""
        return asdict(self)

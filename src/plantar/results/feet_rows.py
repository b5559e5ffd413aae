"""The rows of a feet result: numbers, offsets, scores, and what stands behind them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

from plantar.conventions import Axis
from plantar.logs.motion_log import MotionLog
from plantar.results.stored import row_of

Verdict = Literal["usable", "weak", "unidentifiable"]
USABLE_WIDTH = 0.15  # half width of the 95 % interval over the value, at most
WEAK_WIDTH = 0.5  # likewise: beyond it the value is not told from half or twice as much


@dataclass(frozen=True)
class Input:
    """A log that was used: `role` says for what; `sha256` is None for a log that never was a file."""

    path: str
    sha256: str | None
    role: Literal["fit", "validate"]

    @classmethod
    def of(cls, log: MotionLog, role: Literal["fit", "validate"]) -> Input:
        return cls(str(log.path) if log.path else log.name, log.sha256, role)


@dataclass(frozen=True)
class Parameter:
    """One number of a bush's model. `std` and `interval95` hold with coloured residuals; `relative_std_percent` is the
    paper's, for white ones. None stands where nothing can be computed."""

    foot: str
    axis: Axis
    name: str
    unit: str
    value: float | None
    std: float | None
    interval95: tuple[float, float] | None
    relative_std_percent: float | None
    verdict: Verdict
    reason: str
    advice: str | None = None

    @property
    def half_width(self) -> float | None:
        """Half of the 95 % interval, in `unit`; None where there is no interval."""
        return None if self.interval95 is None else (self.interval95[1] - self.interval95[0]) / 2

    @property
    def half_width_percent(self) -> float | None:
        """Half of the 95 % interval in percent of the value; None where either is missing or the value is 0."""
        half = self.half_width
        return None if half is None or not self.value else 100 * half / abs(self.value)


@dataclass(frozen=True)
class Offset:
    """The model's offset in one recording: it absorbs the zeros of force sensor and attitude there."""

    foot: str
    axis: Axis
    motion: str
    unit: str
    value: float
    std: float


@dataclass(frozen=True)
class ValidationRow:
    """Measured against reconstructed torque over one recording [N·m]. `zero_mean_abs` is the trivial predictor's error:
    the offset alone, found in the same way."""

    kind: Literal["direct", "cross"]
    motion: str
    foot: str
    axis: Axis
    mean_abs_error: float
    rms_error: float
    max_abs: float
    percent_of_max: float | None
    zero_mean_abs: float
    samples: int

    @property
    def has_skill(self) -> bool:
        """Whether the model beats predicting the offset alone."""
        return self.mean_abs_error < self.zero_mean_abs


@dataclass(frozen=True)
class LinearEquivalent:
    """Spring [N·m/rad] and damper [N·m·s/rad] that fit the same motions best."""

    stiffness: float
    damping: float


@dataclass(frozen=True)
class Candidate:
    """One model tried on held-out motions: rms of what it misses [N·m], its number of parameters, and why it was
    refused (None where it was not)."""

    model: str
    held_out_rms: float
    parameters: int
    refused: str | None
    chosen: bool


@dataclass(frozen=True)
class AxisModel:
    """The bush model of one axis of one foot, and why it was chosen.

    `moment_arms` [m]: by how much the logs show the bush's centre aside and above its place; `turned` [rad]: by how
    much the force sensor is turned about the vertical, `leans` about the other axis; `crosstalk` [N.m/N]: of the
    horizontal force that turns the other axis; `imu_turned` [rad]: the turn about each of the IMU's axes that
    puts its angles right, as far as that shows. `held_out` says what was held out, `ranking` holds every model tried;
    both are None where none was compared.
    """

    foot: str
    axis: Axis
    model: str
    reason: str
    linear_equivalent: LinearEquivalent
    moment_arms: tuple[float, float] = (0.0, 0.0)
    held_out: str | None = None
    ranking: tuple[Candidate, ...] | None = None
    turned: float = 0.0
    leans: float = 0.0
    crosstalk: float = 0.0
    imu_turned: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def to_dict(self) -> dict[str, Any]:
        """The entry of `laws` in `result.json`, where a model is called a law."""
        content = {("law" if key == "model" else key): value for key, value in asdict(self).items()}
        if not any(self.moment_arms):
            del content["moment_arms"]
        for name in ("turned", "leans", "crosstalk"):
            if not content[name]:
                del content[name]
        if not any(self.imu_turned):
            del content["imu_turned"]
        if self.ranking is None:
            return {key: value for key, value in content.items() if key not in ("held_out", "ranking")}
        ranking = [asdict(row) for row in self.ranking]
        return content | {"ranking": [{"law": row.pop("model"), **row} for row in ranking]}

    @classmethod
    def from_dict(cls, entry: object, place: str, path: Path | None) -> AxisModel:
        """What `to_dict` wrote; `place` and `path` say in an error where it stands."""
        if not isinstance(entry, Mapping):
            return row_of(cls, entry, place, path)
        content = {("model" if key == "law" else key): value for key, value in entry.items()}
        if isinstance(tried := content.get("ranking"), list):
            content["ranking"] = [
                {**row, "model": row.get("law")} if isinstance(row, Mapping) else row for row in tried
            ]
        return row_of(cls, content, place, path)


@dataclass(frozen=True)
class DelayEstimate:
    """How late the sensors are against the IMU [s], > 0: late; the logs were corrected for it.

    `std` [s] of the wrenches' delay; `measured`: whether any log showed it. `feet` has each foot's own delay where they
    differ, else nothing; `encoder_delay` is that of the joint positions.
    """

    wrench_delay: float
    std: float
    measured: bool
    unit: Literal["s"] = "s"
    feet: Mapping[str, float] = field(default_factory=dict)
    encoder_delay: float = 0.0


@dataclass(frozen=True)
class Diagnosis:
    """What limits one number: `limit` is the largest cause of its variance, `variance_shares` (0 to 1) the share of
    each, `half_width_percent` half of its 95 % interval [% of the value], `advice` what to record against `limit`,
    and `text` all of it in one sentence."""

    foot: str
    axis: Axis
    name: str
    limit: str
    variance_shares: Mapping[str, float]
    half_width_percent: float
    text: str
    advice: str = ""


@dataclass(frozen=True)
class Assumption:
    """What the robot file says may be wrong by `assumed` (a standard deviation, in the unit of `name` there), and what
    the logs show of it: `found` of `what`, with its deviation `std` where it has one. `stiffness_percent` and
    `damping_percent`: the half of the 95 % interval that it alone would make, of the axis where that is largest; None
    where it is counted elsewhere."""

    name: str
    what: str
    assumed: float
    found: float | None
    std: float | None
    stiffness_percent: float | None
    damping_percent: float | None


@dataclass(frozen=True)
class Comparison:
    """The same logs under another choice, such as one shared offset."""

    name: str
    settings: Mapping[str, Any]
    parameters: tuple[Parameter, ...]
    validation: tuple[ValidationRow, ...]

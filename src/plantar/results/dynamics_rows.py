"""The rows of a result of eq. 2 or 3: inertial parameters, base parameters, joint terms, scores."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from plantar.results.feet_rows import Verdict


@dataclass(frozen=True)
class InertialParameter:
    """One of a link's ten parameters about its joint frame, identified and in the URDF."""

    link: str
    name: str
    unit: str
    value: float
    cad: float


@dataclass(frozen=True)
class BaseParameter:
    """One minimal parameter; std and interval95 (Student's) count coloured residuals and the regularisation;
    relative_std_percent is 100·std over the value without its sign."""

    expression: str
    value: float
    std: float
    interval95: tuple[float, float]
    relative_std_percent: float | None


@dataclass(frozen=True)
class JointParameter:
    """One term of one joint."""

    joint: str
    name: str
    unit: str
    value: float
    std: float
    interval95: tuple[float, float]
    verdict: Verdict
    reason: str


@dataclass(frozen=True)
class DynamicsScore:
    """Measured against predicted over one motion, of one wrench axis or one joint; `cad_rms_error` by the URDF alone
    (joints: its inertias and the friction fitted to them are not mixed), `zero_mean_abs` by the fit motions' mean."""

    kind: Literal["direct", "cross"]
    motion: str
    unit: str
    mean_abs_error: float
    rms_error: float
    max_abs: float
    # The file leaves it out where it is None.
    percent_of_max: float | None = field(default=None, kw_only=True)
    zero_mean_abs: float
    cad_rms_error: float
    samples: int
    relative_error_percent: float | None = None
    axis: str | None = None
    joint: str | None = None

    @property
    def has_skill(self) -> bool:
        """Whether the model beats the trivial predictor."""
        return self.mean_abs_error < self.zero_mean_abs

    def to_dict(self) -> dict[str, Any]:
        return {key: value for key, value in asdict(self).items() if value is not None}

"""What an identification of eq. 2 or 3 found, as data: the contract of `result.json` for inertia and joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, Literal

import pyarrow as pa
import pyarrow.parquet as pa_parquet

from plantar import __version__
from plantar.files import atomic_write, write_text
from plantar.notes import Note
from plantar.results.feet import Input, Verdict
from plantar.results.io import dump_json, finite

INERTIA_SCHEMA: Final = "plantar.inertia/1"
JOINTS_SCHEMA: Final = "plantar.joints/1"
URDF: Final = "identified.urdf"  # beside result.json: the robot with the inertias found


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
    """One minimal parameter; std and interval95 (Student's) count coloured residuals and the pull, relative_std_percent
    is 100·std/|value|."""

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
    percent_of_max: float | None
    zero_mean_abs: float
    cad_rms_error: float
    samples: int
    relative_error_percent: float | None
    axis: str | None = None
    joint: str | None = None

    def to_dict(self) -> dict[str, Any]:
        return {key: value for key, value in asdict(self).items() if value is not None}


@dataclass(frozen=True)
class DynamicsResult:
    """Everything `identify inertia` or `identify joints` found; `to_dict` is the contract's JSON.

    urdf: the robot's URDF with the identified inertias; residuals: measured and predicted, sample by sample.
    """

    schema: str
    robot: str
    inputs: tuple[Input, ...]
    settings: Mapping[str, Any]
    rank: int
    condition_number: float
    base_parameters: tuple[BaseParameter, ...]
    inertial_parameters: tuple[InertialParameter, ...]
    parameters: tuple[JointParameter, ...]
    validation: tuple[DynamicsScore, ...]
    notes: tuple[Note, ...]
    urdf: str = field(repr=False)
    residuals: pa.Table = field(repr=False, compare=False)
    created: str = field(default_factory=lambda: datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"))

    @property
    def mass(self) -> float:
        """Identified mass of all links [kg]."""
        return sum(row.value for row in self.inertial_parameters if row.name == "m")

    def score(self, motion: str, place: str) -> DynamicsScore:
        """The validation row of one motion and one axis or joint; KeyError where there is none."""
        for row in self.validation:
            if row.motion == motion and place in (row.axis, row.joint):
                return row
        raise KeyError((motion, place))

    def parameter(self, joint: str, name: str) -> JointParameter:
        """One joint's term; KeyError where there is none."""
        for row in self.parameters:
            if (row.joint, row.name) == (joint, name):
                return row
        raise KeyError((joint, name))

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON; numbers that are not finite become None."""
        content: dict[str, Any] = {
            "schema": self.schema,
            "robot": self.robot,
            "plantar": __version__,
            "created": self.created,
            "inputs": [asdict(row) for row in self.inputs],
            "settings": dict(self.settings),
            "rank": self.rank,
            "condition_number": self.condition_number,
        }
        if self.schema == JOINTS_SCHEMA:
            content["parameters"] = [asdict(row) for row in self.parameters]
        content["base_parameters"] = [asdict(row) for row in self.base_parameters]
        content["inertial_parameters"] = [asdict(row) for row in self.inertial_parameters]
        content["validation"] = [row.to_dict() for row in self.validation]
        content["notes"] = [note.to_dict() for note in self.notes]
        plain: dict[str, Any] = finite(content)
        return plain

    def save(self, directory: Path) -> Path:
        """Write `residuals.parquet`, `identified.urdf` and `result.json`; returns the latter's path."""
        with atomic_write(directory / "residuals.parquet") as handle:
            pa_parquet.write_table(self.residuals, handle, compression="zstd")
        write_text(directory / URDF, self.urdf)
        path = directory / "result.json"
        write_text(path, dump_json(self.to_dict()))
        return path

"""What an identification found, as data: the contract of `result.json` for the feet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import pyarrow as pa
import pyarrow.parquet as pa_parquet

from plantar import __version__
from plantar.contact.phases import Phase
from plantar.conventions import Axis
from plantar.files import atomic_write, write_text
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.results.io import dump_json, finite

Verdict = Literal["usable", "weak", "unidentifiable"]
FEET_SCHEMA = "plantar.feet/1"


@dataclass(frozen=True)
class Input:
    """A log that served: `role` says for what; `sha256` is None for a log that never was a file."""

    path: str
    sha256: str | None
    role: Literal["fit", "validate"]

    @classmethod
    def of(cls, log: MotionLog, role: Literal["fit", "validate"]) -> Input:
        return cls(str(log.path) if log.path else log.name, log.sha256, role)


@dataclass(frozen=True)
class Parameter:
    """One number of a bush's law. `std` and `interval95` hold with coloured residuals; `relative_std_percent` is the
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


@dataclass(frozen=True)
class Offset:
    """The law's offset in one recording: it absorbs the zeros of force sensor and attitude there."""

    foot: str
    axis: Axis
    motion: str
    unit: str
    value: float
    std: float


@dataclass(frozen=True)
class ValidationRow:
    """Measured against reconstructed torque over one recording. `zero_mean_abs` is the trivial predictor's error:
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


@dataclass(frozen=True)
class FeetResult:
    """Everything `identify feet` found; `to_dict` is the contract's JSON."""

    robot: str
    inputs: tuple[Input, ...]
    settings: Mapping[str, Any]
    model: str
    parameters: tuple[Parameter, ...]
    offsets: tuple[Offset, ...]
    phases: tuple[Phase, ...]
    validation: tuple[ValidationRow, ...]
    notes: tuple[Note, ...]
    robot_model: Mapping[str, Any] = field(default_factory=dict)
    extras: Mapping[str, Any] = field(default_factory=dict)
    residuals: pa.Table | None = field(default=None, repr=False, compare=False)
    created: str = field(default_factory=lambda: datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"))

    def parameter(self, foot: str, axis: str, name: str) -> Parameter:
        """One parameter by foot, axis and name; KeyError where there is none."""
        for row in self.parameters:
            if (row.foot, row.axis, row.name) == (foot, axis, name):
                return row
        raise KeyError((foot, axis, name))

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON; numbers that are not finite become None."""
        content = {
            "schema": FEET_SCHEMA,
            "robot": self.robot,
            "plantar": __version__,
            "created": self.created,
            "inputs": [asdict(row) for row in self.inputs],
            "settings": dict(self.settings),
            "model": self.model,
            "parameters": [asdict(row) for row in self.parameters],
            "offsets": [asdict(row) for row in self.offsets],
            "phases": [row.to_dict() for row in self.phases],
            "validation": [asdict(row) for row in self.validation],
            "notes": [note.to_dict() for note in self.notes],
            "robot_model": dict(self.robot_model),
            **self.extras,
        }
        plain: dict[str, Any] = finite(content)
        return plain

    def save(self, directory: Path) -> Path:
        """Write `residuals.parquet`, then `result.json`, each whole or not at all; returns the latter's path."""
        if self.residuals is not None:
            with atomic_write(directory / "residuals.parquet") as handle:
                pa_parquet.write_table(self.residuals, handle, compression="zstd")
        path = directory / "result.json"
        write_text(path, dump_json(self.to_dict()))
        return path

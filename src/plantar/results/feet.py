"""What an identification of the feet found, as data: the contract of `result.json`, written and read back."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import plantar
from plantar.contact.phases import Phase
from plantar.files import write_text
from plantar.notes import Note, listing
from plantar.results import feet_text, text
from plantar.results.feet_rows import (
    Assumption,
    AxisModel,
    Comparison,
    DelayEstimate,
    Diagnosis,
    Input,
    Offset,
    Parameter,
    ValidationRow,
    Verdict,
)
from plantar.results.io import dump_json, finite, read_result, result_path
from plantar.results.residuals import read_table, residuals_path, write_table
from plantar.results.stored import row_of, rows_of, table_of, value_of
from plantar.results.walk_rows import StanceStiffness, SwingZero, WalkStiffness

if TYPE_CHECKING:
    import pyarrow as pa

__all__ = [
    "FEET_SCHEMA", "Assumption", "AxisModel", "Comparison", "DelayEstimate", "Diagnosis", "FeetResult", "Input",
    "Offset", "Parameter", "ValidationRow", "Verdict",
]  # fmt: skip

FEET_SCHEMA: Final = "plantar.feet/1"
# Keys of the file only where there are rows.
_IF_ANY: Final = ("assumptions", "comparisons", "stances", "walks", "swing_zeros")


@dataclass(frozen=True, repr=False)
class FeetResult:
    """Everything `identify_feet` found. `print` it for a table; in a notebook it shows itself.

    Attributes:
        robot: the robot's name. inputs: every log with its SHA-256. settings: what was chosen.
        model: the bush model of most axes; `models` has that of each axis and why it was chosen.
        parameters: stiffness, damping and further terms [SI], each with interval, verdict, reason and advice.
        offsets: of each motion [N·m]. phases: segments of each log, used or with the reason why not.
        validation: errors [N·m] on fitted (direct) and unseen (cross) motions. notes: what was assumed.
        robot_model: path of the URDF and geometry of the feet [m, rad], for exports.
        sensor_delay: how late the sensors are [s]. compliance: of each foot along z [m/N], 0 where not known.
        joint_compliance: of each joint that bends beyond its encoder, by which angles were put right [rad/(N·m)].
        diagnosis: what limits each number. assumptions: what may be wrong about the robot, as its file says, and what
            was found of it. comparisons: the same logs under other choices.
        campaign: what `plantar demo` adds, as plain data; None elsewhere.
        stances, walks: stiffness by each stance and by each recording alone [N·m/rad], where feet step. swing_zeros:
            what their force sensors read in the air [N, N·m].
        residuals: one row for each sample, foot and motion, or None; columns as in `read_residuals`.
        created: UTC time. version: of plantar.

    Example:
        >>> import plantar
        >>> result = plantar.FeetResult.load("out/feet")
        >>> result
        <FeetResult of biped: 10 parameters, 10 usable, from 2 logs>
        >>> row = result.parameter("left", "pitch", "stiffness")
        >>> row.unit, row.verdict, row.interval95[0] < 420.0 < row.interval95[1]
        ('N.m/rad', 'usable', True)
    """

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
    models: tuple[AxisModel, ...] = ()
    sensor_delay: DelayEstimate | None = None
    compliance: Mapping[str, float] = field(default_factory=dict)
    joint_compliance: Mapping[str, float] = field(default_factory=dict)
    diagnosis: tuple[Diagnosis, ...] = ()
    assumptions: tuple[Assumption, ...] = ()
    comparisons: tuple[Comparison, ...] = ()
    campaign: Mapping[str, Any] | None = None
    stances: tuple[StanceStiffness, ...] = ()
    walks: tuple[WalkStiffness, ...] = ()
    swing_zeros: tuple[SwingZero, ...] = ()
    residuals: pa.Table | None = field(default=None, compare=False)
    created: str = field(default_factory=lambda: datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"))
    version: str = plantar.__version__

    def __repr__(self) -> str:
        usable = sum(row.verdict == "usable" for row in self.parameters)
        count = sum(row.role == "fit" for row in self.inputs)
        numbers = f"{len(self.parameters)} parameters, {usable} usable"
        return f"<{type(self).__name__} of {self.robot}: {numbers}, from {count} logs>"

    def __str__(self) -> str:
        """Table 1 as text (± is half of the 95 % interval), what is not usable and why, prediction, warnings."""
        scores = feet_text.prediction_cells(self.validation)
        lines = [self._title(), *text.columns([feet_text.HEADS, *feet_text.parameter_cells(self.parameters)])]
        lines += feet_text.weak_lines(self.parameters)
        if scores:
            lines += ["Prediction of the torque [N·m]", *text.columns([feet_text.PREDICTION_HEADS, *scores])]
        lines += [*feet_text.delay_line(self.sensor_delay), *text.warnings(self.notes)]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """The same for a notebook."""
        table = text.html_table(self._title(), feet_text.HEADS, feet_text.parameter_cells(self.parameters))
        delay = feet_text.delay_line(self.sensor_delay)
        lines = [*feet_text.weak_lines(self.parameters), *delay, *text.warnings(self.notes)]
        return table + text.html_lines(lines)

    def _title(self) -> str:
        counts = [sum(row.role == role for row in self.inputs) for role in ("fit", "validate")]
        logs = f"logs: {counts[0]} fitted, {counts[1]} unseen"
        rule = self.settings.get("offset", "")
        return (
            f"Feet of {self.robot}: {self.model}, offset {rule}; {logs}; plantar {self.version}; ± for 95 %"
        )

    def parameter(self, foot: str, axis: str, name: str) -> Parameter:
        """One parameter by foot, axis ("pitch", "roll", "z") and name; KeyError where there is none."""
        for row in self.parameters:
            if (row.foot, row.axis, row.name) == (foot, axis, name):
                return row
        known = listing([f"{row.foot} {row.axis} {row.name}" for row in self.parameters], 18)
        raise KeyError(f"no parameter {foot} {axis} {name} (valid: {known})")

    @property
    def soles(self) -> dict[str, tuple[tuple[float, float], ...]]:
        """Each foot's sole outline, x forward and y left in the sole's frame [m], where the result knows it."""
        feet = value_of(dict[str, dict[str, Any]], self.robot_model, "feet", None, {})
        soles = {name: value_of(dict[str, Any], foot, "sole", None, {}) for name, foot in feet.items()}
        kind = tuple[tuple[float, float], ...]
        return {name: value_of(kind, own, "polygon", None) for name, own in soles.items() if "polygon" in own}

    def to_table(self) -> pa.Table:
        """The parameters as an Arrow table, one row each; `.to_pandas()` where pandas is installed.

        Columns: foot, axis, name, unit, value, std, low, high (of the 95 % interval), relative_std_percent, verdict,
        reason, advice.

        Example:
            >>> import plantar
            >>> plantar.FeetResult.load("out/feet").to_table().column("unit")[0].as_py()
            'N.m/rad'
        """
        numbers = ("value", "std", "low", "high", "relative_std_percent")
        return table_of(
            self.parameters, ("foot", "axis", "name", "unit"), numbers, ("verdict", "reason", "advice")
        )

    def plot(self, foot: str, axis: str, *, motions: str | Sequence[str] = (), axes: Any = None) -> Any:
        """Torque over angle of one foot and axis, measured and model, as matplotlib axes; see `plantar.plot_torque`."""
        # Drawing stands in a later room; the package's front door leads there.
        return plantar.plot_torque(self, foot, axis, motions=motions, axes=axes)

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON, the contract's keys; numbers that are not finite become None."""
        content: dict[str, Any] = {
            "schema": FEET_SCHEMA,
            "robot": self.robot,
            "plantar": self.version,
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
            "laws": [row.to_dict() for row in self.models],
        }
        if self.sensor_delay is not None:
            content["latency"] = asdict(self.sensor_delay)
        content["compliance"] = dict(self.compliance)
        if self.joint_compliance:
            content["joint_compliance"] = dict(self.joint_compliance)
        content["diagnosis"] = [asdict(row) for row in self.diagnosis]
        for key in _IF_ANY:
            if rows := getattr(self, key):
                content[key] = [asdict(row) for row in rows]
        if self.campaign is not None:
            content["campaign"] = dict(self.campaign)
        plain: dict[str, Any] = finite(content)
        return plain

    def save(self, directory: str | os.PathLike[str]) -> Path:
        """Write `residuals.parquet`, then `result.json` into a folder, each whole or not at all.

        Returns the path of `result.json`. Raises PlantarError where the folder cannot be written.
        """
        folder = Path(directory)
        write_table(self.residuals, folder)
        path = folder / "result.json"
        write_text(path, dump_json(self.to_dict()))
        return path

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, residuals: bool = True) -> FeetResult:
        """A result read back from `result.json` or its folder.

        Args:
            path: the file, or the folder that holds it.
            residuals: also read the residuals beside it, where there are any.

        Returns:
            The result; its `to_dict` is the file's content. Keys that this version does not know are left out.

        Raises:
            PlantarError: no such file, not a result of `identify_feet`, or a row that does not fit.

        Example:
            >>> import plantar
            >>> plantar.FeetResult.load("out/feet/result.json", residuals=False).model
            'kelvin_voigt'
        """
        file = result_path(path)
        found = cls._from_dict(read_result(file, FEET_SCHEMA), file)
        beside = residuals_path(file.parent) if residuals else None
        return found if beside is None else replace(found, residuals=read_table(beside))

    @classmethod
    def _from_dict(cls, content: Mapping[str, Any], path: Path) -> FeetResult:
        laws = value_of(list[Any], content, "laws", path, [])
        delay = content.get("latency")
        return cls(
            robot=value_of(str, content, "robot", path),
            inputs=rows_of(Input, content, "inputs", path),
            settings=value_of(dict[str, Any], content, "settings", path),
            model=value_of(str, content, "model", path),
            parameters=rows_of(Parameter, content, "parameters", path, required=True),
            offsets=rows_of(Offset, content, "offsets", path),
            phases=rows_of(Phase, content, "phases", path),
            validation=rows_of(ValidationRow, content, "validation", path),
            notes=rows_of(Note, content, "notes", path),
            robot_model=value_of(dict[str, Any], content, "robot_model", path, {}),
            models=tuple(AxisModel.from_dict(row, f"laws.{k}", path) for k, row in enumerate(laws)),
            sensor_delay=None if delay is None else row_of(DelayEstimate, delay, "latency", path),
            compliance=value_of(dict[str, float], content, "compliance", path, {}),
            joint_compliance=value_of(dict[str, float], content, "joint_compliance", path, {}),
            diagnosis=rows_of(Diagnosis, content, "diagnosis", path),
            assumptions=rows_of(Assumption, content, "assumptions", path),
            comparisons=rows_of(Comparison, content, "comparisons", path),
            campaign=value_of(dict[str, Any], content, "campaign", path) if "campaign" in content else None,
            stances=rows_of(StanceStiffness, content, "stances", path),
            walks=rows_of(WalkStiffness, content, "walks", path),
            swing_zeros=rows_of(SwingZero, content, "swing_zeros", path),
            created=value_of(str, content, "created", path),
            version=value_of(str, content, "plantar", path),
        )

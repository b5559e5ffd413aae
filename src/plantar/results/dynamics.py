"""What an identification of eq. 2 or 3 found, as data: the contract of `result.json` for inertia and joints."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from plantar import __version__
from plantar.errors import PlantarError
from plantar.files import read_bounded, write_text
from plantar.notes import Note
from plantar.results import dynamics_text, text
from plantar.results.dynamics_rows import BaseParameter, DynamicsScore, InertialParameter, JointParameter
from plantar.results.feet_rows import Input
from plantar.results.io import RESULT_LIMIT, dump_json, finite, read_result, result_path
from plantar.results.residuals import read_table, residuals_path, write_table
from plantar.results.stored import rows_of, table_of, value_of

if TYPE_CHECKING:
    import pyarrow as pa

__all__ = [
    "INERTIA_SCHEMA", "JOINTS_SCHEMA", "ONE_OF_MANY", "URDF", "BaseParameter", "DynamicsResult", "DynamicsScore",
    "InertialParameter", "JointParameter",
]  # fmt: skip

INERTIA_SCHEMA: Final = "plantar.inertia/1"
JOINTS_SCHEMA: Final = "plantar.joints/1"
ONE_OF_MANY: Final = (
    "Motions show base parameters, which combine those of several links. Use all links together: the numbers of one "
    "link alone may be far off."
)
URDF: Final = "identified.urdf"  # beside result.json: the robot with the inertias found


@dataclass(frozen=True, repr=False)
class DynamicsResult:
    """Everything `identify_inertia` or `identify_joints` found. `print` it for a table; in a notebook it shows itself.

    Attributes:
        schema: "plantar.inertia/1" or "plantar.joints/1". robot: its name. inputs: every log with its SHA-256.
        settings: what was chosen. rank, condition_number: of the weighted regressor.
        base_parameters: minimal parameters with 95 % intervals. inertial_parameters: ten of each link, beside the
            URDF's [kg, kg·m, kg·m²]. parameters: of the joints [N·m, N·m/rad, N·m·s/rad, kg·m²]; none in eq. 2.
        validation: errors on fitted (direct) and unseen (cross) motions [N, N·m]. notes: what was assumed.
        urdf: the robot's URDF with the identified inertias. residuals: measured and predicted, sample by sample.
        created: UTC time. version: of plantar.

    Example:
        >>> import plantar
        >>> plantar.DynamicsResult.load("out/inertia")
        <DynamicsResult of walker: plantar.inertia/1, 22.99 kg, rank 59>
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
    urdf: str
    residuals: pa.Table | None = field(compare=False)
    created: str = field(default_factory=lambda: datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"))
    version: str = __version__

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.robot}: {self.schema}, {self.mass:.4g} kg, rank {self.rank}>"

    def __str__(self) -> str:
        """Links or joint terms as text, prediction on all motions, warnings."""
        heads, cells = self._cells()
        scores = dynamics_text.score_cells(self.validation)
        lines = [self._title(), *text.columns([heads, *cells])]
        lines += ["Prediction", *text.columns([dynamics_text.SCORE_HEADS, *scores])] if scores else []
        return "\n".join([*lines, *text.warnings(self.notes)])

    def _repr_html_(self) -> str:
        """The same for a notebook."""
        return text.html_table(self._title(), *self._cells()) + text.html_lines(text.warnings(self.notes))

    def _title(self) -> str:
        what = "Joints" if self.schema == JOINTS_SCHEMA else "Inertias"
        return f"{what} of {self.robot}: {self.mass:.4g} kg, rank {self.rank}; plantar {self.version}, ± for 95 %"

    def _cells(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        if self.schema == JOINTS_SCHEMA:
            return dynamics_text.JOINT_HEADS, dynamics_text.joint_cells(self.parameters)
        return dynamics_text.LINK_HEADS, dynamics_text.link_cells(self.inertial_parameters)

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

    def to_table(self) -> pa.Table:
        """Joint terms (eq. 3) or inertial parameters (eq. 2) as an Arrow table; `.to_pandas()` where pandas is there.

        Columns: joint, name, unit, value, std, low, high (of the 95 % interval), verdict, reason; or link, name, unit,
        value, cad (the URDF's).
        """
        if self.schema != JOINTS_SCHEMA:
            return table_of(self.inertial_parameters, ("link", "name", "unit"), ("value", "cad"))
        numbers = ("value", "std", "low", "high")
        return table_of(self.parameters, ("joint", "name", "unit"), numbers, ("verdict", "reason"))

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON; numbers that are not finite become None."""
        content: dict[str, Any] = {
            "schema": self.schema,
            "robot": self.robot,
            "plantar": self.version,
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

    def save(self, directory: str | os.PathLike[str]) -> Path:
        """Write `residuals.parquet`, `identified.urdf` and `result.json` into a folder; returns the latter's path.

        Raises PlantarError where the folder cannot be written.
        """
        folder = Path(directory)
        write_table(self.residuals, folder)
        write_text(folder / URDF, self.urdf)
        path = folder / "result.json"
        write_text(path, dump_json(self.to_dict()))
        return path

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, beside: bool = True) -> DynamicsResult:
        """A result read back from `result.json` or its folder, with the URDF and the residuals beside it.

        Args:
            path: the file, or the folder that holds it.
            beside: also read the URDF and the residuals; without them `urdf` is empty and `residuals` None.

        Returns:
            The result; its `to_dict` is the file's content. Keys that this version does not know are left out.

        Raises:
            PlantarError: a file is missing, not a result of eq. 2 or 3, or a row does not fit.

        Example:
            >>> import plantar
            >>> plantar.DynamicsResult.load("out/inertia/result.json").rank
            59
        """
        file = result_path(path)
        content = read_result(file)
        schema = content["schema"]
        if schema not in (INERTIA_SCHEMA, JOINTS_SCHEMA):
            valid = f"{INERTIA_SCHEMA}, {JOINTS_SCHEMA}"
            raise PlantarError("is another kind of result", path=file, value=schema, valid=valid)
        residuals = residuals_path(file.parent) if beside else None
        return cls(
            schema=schema,
            robot=value_of(str, content, "robot", file),
            inputs=rows_of(Input, content, "inputs", file),
            settings=value_of(dict[str, Any], content, "settings", file),
            rank=value_of(int, content, "rank", file),
            condition_number=value_of(float, content, "condition_number", file),
            base_parameters=rows_of(BaseParameter, content, "base_parameters", file),
            inertial_parameters=rows_of(
                InertialParameter, content, "inertial_parameters", file, required=True
            ),
            parameters=rows_of(JointParameter, content, "parameters", file),
            validation=rows_of(DynamicsScore, content, "validation", file),
            notes=rows_of(Note, content, "notes", file),
            urdf=read_bounded(file.parent / URDF, RESULT_LIMIT).decode(errors="replace") if beside else "",
            residuals=None if residuals is None else read_table(residuals),
            created=value_of(str, content, "created", file),
            version=value_of(str, content, "plantar", file),
        )

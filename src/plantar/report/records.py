"""What a report needs of `result.json`, checked row by row: a result file may come from anywhere."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from plantar.errors import PlantarError, located


class Row(BaseModel):
    """A row of the contract; keys that this version does not know are kept for the reader."""

    model_config = ConfigDict(extra="allow", frozen=True)


class Parameter(Row):
    """One identified number. `reason` says why it has its verdict, `advice` what to record next."""

    foot: str = ""
    joint: str = ""
    axis: str = ""
    name: str
    unit: str
    value: float | None
    std: float | None = None
    interval95: tuple[float, float] | None = None
    relative_std_percent: float | None = None
    verdict: str = ""
    reason: str | None = None
    advice: str | None = None

    @property
    def half_width(self) -> float | None:
        """Half of the 95 % interval, or 1.96 standard deviations where no interval is given."""
        if self.interval95 is not None:
            return (self.interval95[1] - self.interval95[0]) / 2
        return None if self.std is None else 1.96 * self.std


class Offset(Row):
    foot: str
    axis: str
    motion: str
    unit: str
    value: float | None
    std: float | None = None


class Phase(Row):
    motion: str
    foot: str
    start: float
    end: float
    support: str
    used: bool
    reason: str | None = None


class Validation(Row):
    """One line of table 2 (`direct`) or 3 (`cross`)."""

    kind: str = ""
    motion: str = ""
    foot: str = ""
    joint: str = ""
    axis: str = ""
    mean_abs_error: float | None = None
    rms_error: float | None = None
    max_abs: float | None = None
    percent_of_max: float | None = None
    zero_mean_abs: float | None = None

    @property
    def has_skill(self) -> bool | None:
        """Whether the model beats predicting the offset alone; None where that cannot be said."""
        if self.mean_abs_error is None or self.zero_mean_abs is None:
            return None
        return self.mean_abs_error < self.zero_mean_abs


class Remark(Row):
    code: str = ""
    severity: str = "info"
    text: str


class Input(Row):
    path: str
    sha256: str | None = None
    role: str = ""


class Comparison(Row):
    """The same data under another choice, such as one shared offset."""

    name: str
    parameters: tuple[Parameter, ...] = ()
    validation: tuple[Validation, ...] = ()


class Result(Row):
    """What feet, inertia and joints have in common."""

    schema_name: str
    robot: str
    plantar: str = ""
    created: str = ""
    inputs: tuple[Input, ...] = ()
    settings: dict[str, Any] = {}
    validation: tuple[Validation, ...] = ()
    notes: tuple[Remark, ...] = ()


class SoleShape(Row):
    polygon: tuple[tuple[float, float], ...] = ()


class FootShape(Row):
    sole: SoleShape | None = None


class RobotShape(Row):
    feet: dict[str, FootShape] = {}


class FeetResult(Result):
    model: str = ""
    robot_model: RobotShape | None = None
    parameters: tuple[Parameter, ...]
    offsets: tuple[Offset, ...] = ()
    phases: tuple[Phase, ...] = ()
    comparisons: tuple[Comparison, ...] = ()
    diagnosis: tuple[str | Remark, ...] = ()

    @property
    def diagnosis_lines(self) -> tuple[str, ...]:
        return tuple(line if isinstance(line, str) else line.text for line in self.diagnosis)


class BaseParameter(Row):
    expression: str
    value: float | None
    std: float | None = None
    relative_std_percent: float | None = None


class InertialParameter(Row):
    link: str
    name: str
    unit: str
    value: float | None
    cad: float | None = None


class InertiaResult(Result):
    rank: int | None = None
    condition_number: float | None = None
    base_parameters: tuple[BaseParameter, ...] = ()
    inertial_parameters: tuple[InertialParameter, ...] = ()


class JointsResult(Result):
    parameters: tuple[Parameter, ...]


AnyResult = TypeVar("AnyResult", bound=Result)


def checked(content: dict[str, Any], kind: type[AnyResult], schema: str, path: Path) -> AnyResult:
    """`content` as a `kind`; `PlantarError` naming the first key that does not fit."""
    if content["schema"] != schema:
        raise PlantarError(
            located("is another kind of result", path=path, value=content["schema"], valid=schema)
        )
    try:
        return kind.model_validate({**content, "schema_name": schema})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise PlantarError(located(first["msg"], path=path, column=place)) from error

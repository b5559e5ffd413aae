"""The robot file's grammar: what may stand in the YAML, and one line for what may not."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from plantar.errors import RobotError, located
from plantar.files import read_bounded
from plantar.robot.guesses import Guess, read_guesses
from plantar.robot.uncertainty import Uncertainty

FILE_LIMIT = 2**20  # bytes
DEPTH_LIMIT = 20  # levels of nesting: a robot file needs five
LONGEST_SOLE = 1.0  # m from its frame to a corner: no robot walks on longer ones

Number = Annotated[float, Field(allow_inf_nan=False)]
Vector = tuple[Number, Number, Number]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Term = Literal["viscous", "coulomb", "offset", "stiffness", "inertia"]


class Entry(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class FrameEntry(Entry):
    link: Name | None = None
    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)


class ImuEntry(FrameEntry):
    name: Name
    link: Name


class WrenchEntry(FrameEntry):
    name: Name
    sign: Literal[1, -1] = 1


class SoleEntry(FrameEntry):
    polygon: Annotated[list[tuple[Number, Number]], Field(min_length=3, max_length=100)]

    @field_validator("polygon")
    @classmethod
    def _has_area(cls, polygon: list[tuple[float, float]]) -> list[tuple[float, float]]:
        farthest = max(abs(value) for corner in polygon for value in corner)
        if farthest > LONGEST_SOLE:
            raise ValueError(f"a corner lies {farthest:.3g} m away; are these millimetres?")
        following = polygon[1:] + polygon[:1]
        area = sum(x * v - u * y for (x, y), (u, v) in zip(polygon, following, strict=True)) / 2
        if abs(area) < 1e-6:
            raise ValueError(f"the polygon's area is {abs(area):.3g} m²; corners go round the sole in order")
        return polygon


class FootEntry(Entry):
    ankle: Name
    bush: FrameEntry
    wrench: WrenchEntry
    sole: SoleEntry
    contact: Literal["auto", "always"] = "auto"


class JointEntry(Entry):
    terms: list[Term] | None = None
    passive: bool = False


class JointNamesEntry(Entry):
    """What a log calls the joints of the URDF: `prefix` + name + `suffix`, but for those that `renamed` lists."""

    prefix: Annotated[str, Field(max_length=200)] = ""
    suffix: Annotated[str, Field(max_length=200)] = ""
    renamed: dict[Name, Name] = {}

    @model_validator(mode="after")
    def _log_names_differ(self) -> JointNamesEntry:
        names = list(self.renamed.values())
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise ValueError(f"renamed gives two joints the log's name '{twice}'")
        return self


class RobotEntry(Entry):
    """The whole file."""

    name: Name
    urdf: Name
    base: Literal["floating", "fixed"] = "floating"
    mass: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None  # kg, as weighed
    imu: ImuEntry | None = None
    feet: Annotated[dict[Name, FootEntry], Field(max_length=8)] = {}
    joints: dict[Name, JointEntry] = {}
    joint_names: JointNamesEntry = JointNamesEntry()
    uncertainty: Uncertainty = Uncertainty()
    topics: dict[Name, str] = {}
    columns: dict[Name, Any] = {}

    @model_validator(mode="after")
    def _sensor_names_differ(self) -> RobotEntry:
        names = [foot.wrench.name for foot in self.feet.values()]
        if len(set(names)) < len(names):
            raise ValueError(f"feet share one wrench sensor: {', '.join(names)}")
        return self


def read_robot_file(path: Path) -> tuple[RobotEntry, tuple[Guess, ...]]:
    """Parse and check a robot file; with it, which of its keys are marked as guesses.

    Raises RobotError: one line that says which key is wrong and what would be valid.
    """
    data, content = read_yaml(path)
    if not isinstance(data, dict):
        raise RobotError(located("holds no keys", path=path, valid="name, urdf, imu, feet"))
    try:
        entry = RobotEntry.model_validate(data)
    except ValidationError as error:
        raise RobotError(_explain(error, path)) from error
    return entry, read_guesses(content)


def read_yaml(path: Path) -> tuple[object, bytes]:
    """What an untrusted YAML file holds, and its bytes.

    Raises RobotError: one line of why it cannot be read; it is too large, no YAML, or could grow without bound.
    """
    content = read_bounded(path, FILE_LIMIT, RobotError)
    try:
        _refuse_bombs(content, path)
        return yaml.safe_load(content), content
    except (yaml.YAMLError, UnicodeDecodeError, ValueError) as error:
        reason = " ".join(str(getattr(error, "problem", None) or error).split())
        mark = getattr(error, "problem_mark", None)
        line = f" at line {mark.line + 1}" if mark is not None else ""
        raise RobotError(located(f"is not readable YAML{line}: {reason}", path=path)) from error


def _refuse_bombs(content: bytes, path: Path) -> None:
    """No aliases (they can multiply without bound) and no deep nesting, found before anything is built."""
    depth = 0
    for event in yaml.parse(content, Loader=yaml.SafeLoader):
        if isinstance(event, yaml.AliasEvent):
            raise RobotError(located("uses a YAML alias", path=path, valid="values written out"))
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > DEPTH_LIMIT:
            raise RobotError(located("is nested too deeply", path=path, valid=f"{DEPTH_LIMIT} levels"))


def _explain(error: ValidationError, path: Path) -> str:
    """The first problem as one line, an unknown key with the nearest known one."""
    problems = error.errors()
    first = next((p for p in problems if p["type"] == "extra_forbidden"), problems[0])
    key = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        known = _known_keys(first["loc"])
        near = difflib.get_close_matches(str(first["loc"][-1]), known, n=1) or known
        return located(f"unknown key '{key}'", path=path, valid=", ".join(near))
    if first["type"] == "missing":
        return located(f"key '{key}' is missing", path=path)
    message = first["msg"].removeprefix("Value error, ")
    value = first["input"] if isinstance(first["input"], str | int | float) else None
    return located(f"{key or 'the file'}: {message}", path=path, value=value)


def _known_keys(location: tuple[int | str, ...]) -> list[str]:
    """The keys valid beside the one at `location`."""
    entries: dict[str, type[BaseModel]] = {
        "imu": ImuEntry, "bush": FrameEntry, "wrench": WrenchEntry, "sole": SoleEntry,
        "joint_names": JointNamesEntry, "uncertainty": Uncertainty,
    }  # fmt: skip
    if len(location) == 1:
        return list(RobotEntry.model_fields)
    parent = str(location[-2])
    if parent in entries:
        return list(entries[parent].model_fields)
    return list((FootEntry if location[0] == "feet" else JointEntry).model_fields)

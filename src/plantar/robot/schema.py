"""The robot file's grammar: what may stand in the YAML, and one line for what may not.

It is written in the terms of pydantic's core: pydantic's own classes take a tenth of a second to import and build.
"""

from __future__ import annotations

import difflib
import errno
import os
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import yaml
from pydantic_core import CoreSchema, SchemaValidator, ValidationError, core_schema

from plantar.errors import RobotError
from plantar.files import read_bounded
from plantar.robot.guesses import Guess, read_guesses
from plantar.robot.uncertainty import Uncertainty

FILE_LIMIT = 2**20  # bytes: a robot file has some thousand
DEPTH_LIMIT = 20  # levels of nesting: a robot file needs five
LONGEST_SOLE = 1.0  # m from its frame to a corner: no robot walks on longer ones
LONGEST_LINK = 3.0  # m from a link's frame to a sensor on it: no walking robot has longer ones
FULL_TURN = 6.3  # rad, a little more than 2π
URDF_ENDINGS = (".urdf", ".xacro", ".xml")
LARGEST_DEVIATION = 1.0  # of a share, m, rad or s: whoever writes more means another unit

Entry = Mapping[str, Any]  # a checked part of the file, its defaults filled in
Grammar = dict[str, CoreSchema]  # what may stand under each key of an entry


def _polygon_with_area(polygon: list[tuple[float, float]]) -> list[tuple[float, float]]:
    farthest = max(abs(value) for corner in polygon for value in corner)
    if farthest > LONGEST_SOLE:
        raise ValueError(f"a corner lies {farthest:.3g} m away; are these millimetres?")
    following = polygon[1:] + polygon[:1]
    area = sum(x * v - u * y for (x, y), (u, v) in zip(polygon, following, strict=True)) / 2
    if abs(area) < 1e-6:
        raise ValueError(f"the polygon's area is {abs(area):.3g} m²; corners go round the sole in order")
    return polygon


def _near(xyz: tuple[float, ...]) -> tuple[float, ...]:
    if max(map(abs, xyz)) > LONGEST_LINK:
        raise ValueError(f"{max(xyz, key=abs):.4g} m away from the link's frame; are these millimetres?")
    return xyz


def _within_a_turn(rpy: tuple[float, ...]) -> tuple[float, ...]:
    if max(map(abs, rpy)) > FULL_TURN:
        raise ValueError(f"{max(rpy, key=abs):.4g} rad is more than a turn; are these degrees?")
    return rpy


def _log_names_differ(entry: dict[str, Any]) -> dict[str, Any]:
    names = list(entry["renamed"].values())
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"renamed gives two joints the log's name '{twice}'")
    return entry


def _feet_differ(entry: dict[str, Any]) -> dict[str, Any]:
    for what, names in (
        ("wrench sensor", [foot["wrench"]["name"] for foot in entry["feet"].values()]),
        ("ankle", [foot["ankle"] for foot in entry["feet"].values()]),
    ):
        if twice := [name for name in names if names.count(name) > 1]:
            raise ValueError(f"feet share one {what}, '{twice[0]}'; each needs its own")
    return entry


def _entry(grammar: Grammar) -> CoreSchema:
    """Keys that must stand there, but for those with a default; no others."""
    return core_schema.typed_dict_schema(
        {
            key: core_schema.typed_dict_field(schema, required=schema["type"] != "default")
            for key, schema in grammar.items()
        },
        extra_behavior="forbid",
    )


def _each(values: CoreSchema, most: int | None = None) -> CoreSchema:
    """Any names, none if left out."""
    return _or({}, core_schema.dict_schema(NAME, values, max_length=most))


def _one_of(*values: str | int) -> CoreSchema:
    return core_schema.literal_schema([*values])


def _or(default: object, schema: CoreSchema) -> CoreSchema:
    return core_schema.with_default_schema(schema, default=default)


def _or_none(schema: CoreSchema) -> CoreSchema:
    return _or(None, core_schema.nullable_schema(schema))


NUMBER = core_schema.float_schema(allow_inf_nan=False)
PAIR, VECTOR = (core_schema.tuple_schema([NUMBER] * size) for size in (2, 3))
NAME = core_schema.str_schema(min_length=1, max_length=200)
AFFIX = core_schema.str_schema(max_length=200)
POLYGON = core_schema.no_info_after_validator_function(
    _polygon_with_area, core_schema.list_schema(PAIR, min_length=3, max_length=100)
)
TERM = _one_of("viscous", "coulomb", "offset", "stiffness", "inertia")
DEVIATION = core_schema.float_schema(ge=0, le=LARGEST_DEVIATION, allow_inf_nan=False)

FRAME: Grammar = {
    "link": _or_none(NAME),
    "xyz": _or((0.0, 0.0, 0.0), core_schema.no_info_after_validator_function(_near, VECTOR)),
    "rpy": _or((0.0, 0.0, 0.0), core_schema.no_info_after_validator_function(_within_a_turn, VECTOR)),
}
IMU: Grammar = FRAME | {"name": NAME, "link": NAME}
WRENCH: Grammar = FRAME | {"name": NAME, "sign": _or(1, _one_of(1, -1))}
SOLE: Grammar = FRAME | {"polygon": POLYGON}
FOOT: Grammar = {
    "ankle": NAME,
    "bush": _entry(FRAME),
    "wrench": _entry(WRENCH),
    "sole": _entry(SOLE),
    "contact": _or("auto", _one_of("auto", "always")),
}
JOINT: Grammar = {
    "terms": _or_none(core_schema.list_schema(TERM)),
    "passive": _or(False, core_schema.bool_schema()),
}
# What a log calls the joints of the URDF: `prefix` + name + `suffix`, but for those that `renamed` lists.
JOINT_NAMES: Grammar = {"prefix": _or("", AFFIX), "suffix": _or("", AFFIX), "renamed": _each(NAME)}
UNCERTAINTY: Grammar = {one.name: _or(one.default, DEVIATION) for one in fields(Uncertainty)}
ROBOT: Grammar = {
    "name": NAME,
    "urdf": NAME,
    "base": _or("floating", _one_of("floating", "fixed")),
    "mass": _or_none(core_schema.float_schema(gt=0, allow_inf_nan=False)),  # kg, as weighed
    "imu": _or_none(_entry(IMU)),
    "feet": _each(_entry(FOOT), most=8),
    "joints": _each(_entry(JOINT)),
    "joint_names": _or(
        {"prefix": "", "suffix": "", "renamed": {}},
        core_schema.no_info_after_validator_function(_log_names_differ, _entry(JOINT_NAMES)),
    ),
    "uncertainty": _or({}, _entry(UNCERTAINTY)),
    "topics": _each(core_schema.str_schema()),
    "columns": _each(core_schema.any_schema()),
}
WHOLE_FILE = SchemaValidator(core_schema.no_info_after_validator_function(_feet_differ, _entry(ROBOT)))


def read_robot_file(path: Path) -> tuple[Entry, tuple[Guess, ...]]:
    """Parse and check a robot file; with it, which of its keys are marked as guesses.

    Raises RobotError: one line that says which key is wrong and what would be valid.
    """
    if path.suffix.lower() in URDF_ENDINGS:
        raise RobotError(
            "is no robot file", path=path, valid=f"a YAML file, as `plantar init {path.name}` writes"
        )
    if not path.exists():
        problem = os.strerror(errno.ENOENT)
        raise RobotError(
            f"cannot be read: {problem}", path=path, valid="`plantar init ROBOT.urdf` writes a first one"
        )
    data, content = read_yaml(path)
    if not isinstance(data, dict):
        raise RobotError("holds no keys", path=path, valid="name, urdf, imu, feet, as `plantar init` writes")
    try:
        entry: Entry = WHOLE_FILE.validate_python(data)
    except ValidationError as error:
        raise _explain(error, path) from error
    return entry, read_guesses(content)


def read_yaml(path: Path) -> tuple[Any, bytes]:
    """What an untrusted YAML file holds, and its bytes.

    Raises RobotError: one line of why it cannot be read; it is too large, no YAML, or could grow without bound.
    """
    content = read_bounded(path, FILE_LIMIT, RobotError, "a YAML file of some lines")
    try:
        loader = _Loader(content, path)
        if (node := loader.get_single_node()) is None:
            return None, content
        _refuse_twice(node, path)
        return loader.construct_document(node), content
    except (yaml.YAMLError, UnicodeDecodeError, ValueError) as error:
        reason = " ".join(str(getattr(error, "problem", None) or error).split())
        mark = getattr(error, "problem_mark", None)
        line = f" at line {mark.line + 1}" if mark is not None else ""
        valid = "spaces, not tabs, at the beginning of a line" if "'\\t'" in reason else None
        raise RobotError(f"is not readable YAML{line}: {reason}", path=path, valid=valid) from error


class _Loader(yaml.SafeLoader):
    """Refuses aliases (they can multiply without bound) and deep nesting as it comes upon them, while nothing is built
    of the nodes."""

    def __init__(self, content: bytes, path: Path) -> None:
        super().__init__(content)
        self._path, self._depth = path, 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        if self.check_event(yaml.AliasEvent):
            raise RobotError("uses a YAML alias", path=self._path, valid="values written out")
        self._depth += (inside := self.check_event(yaml.CollectionStartEvent))
        if self._depth > DEPTH_LIMIT:
            raise RobotError("is nested too deeply", path=self._path, valid=f"{DEPTH_LIMIT} levels")
        node = super().compose_node(parent, index)
        self._depth -= inside
        return node


def _refuse_twice(node: yaml.Node, path: Path) -> None:
    """No key twice in one entry: YAML would take the last and drop the others without a word."""
    if isinstance(node, yaml.SequenceNode):
        for each in node.value:
            _refuse_twice(each, path)
    elif isinstance(node, yaml.MappingNode):
        lines: dict[str, int] = {}
        for key, value in node.value:
            name, line = str(key.value), key.start_mark.line + 1
            if name in lines:
                twice = f"key '{name}' stands at line {lines[name]} and again at line {line}"
                raise RobotError(twice, path=path, valid="each key once")
            lines[name] = line
            _refuse_twice(value, path)


def _explain(error: ValidationError, path: Path) -> RobotError:
    """The first problem as one line, an unknown key with the nearest known one."""
    problems = error.errors()
    first = next((p for p in problems if p["type"] == "extra_forbidden"), problems[0])
    key = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        known = _known_keys(first["loc"])
        near = difflib.get_close_matches(str(first["loc"][-1]), known, n=1) or known
        return RobotError(f"unknown key '{key}'", path=path, valid=", ".join(near))
    too_few = first["type"] == "missing" and isinstance(first["loc"][-1], int)
    if too_few or first["type"] in ("tuple_type", "too_long"):
        key = key.rpartition(".")[0] if too_few else key
        valid = "numbers in brackets: [x, y, z], or [x, y] for a corner of a polygon"
        return RobotError(f"{key}: not the right number of numbers", path=path, valid=valid)
    if first["type"] == "missing":
        return RobotError(f"key '{key}' is missing", path=path)
    message = first["msg"].removeprefix("Value error, ")
    value = first["input"] if isinstance(first["input"], str | int | float) else None
    return RobotError(f"{key}: {message}" if key else message, path=path, value=value)


def _known_keys(location: tuple[int | str, ...]) -> list[str]:
    """The keys valid beside the one at `location`."""
    parts = {
        "imu": IMU, "bush": FRAME, "wrench": WRENCH, "sole": SOLE,
        "joint_names": JOINT_NAMES, "uncertainty": UNCERTAINTY,
    }  # fmt: skip
    if len(location) == 1:
        return list(ROBOT)
    return list(parts.get(str(location[-2]), FOOT if location[0] == "feet" else JOINT))

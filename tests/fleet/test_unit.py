"""A finished unit: read back as it was, and a key that follows content and nothing else."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from plantar.errors import PlantarError
from plantar.feet.settings import FeetSettings
from plantar.fleet.places import Stamp, stamp_of
from plantar.fleet.run import _known_key
from plantar.fleet.unit import (
    Failure,
    Unit,
    UnitInput,
    UnitRow,
    contents_of,
    read_unit,
    rows_of_result,
    unit_file,
    unit_key,
)
from plantar.fleet.work import task_key

LOG = UnitInput("s3://b/x.csv", "x.csv", "fit", "ab" * 32, Stamp(12, "today"))
ROW = UnitRow("left", "pitch", "stiffness", "N.m/rad", 0.1 + 0.2, 1.0, None, 5.0, "usable", "kelvin_voigt")
UNIT = Unit("c" * 64, (LOG,), (ROW,), (Failure("", "why"),), 1.5)
INPUTS = [("fit", "x.csv", "ab")]


def test_a_unit_is_read_back_to_the_bit() -> None:
    assert read_unit(UNIT.dump(), "u") == UNIT
    assert contents_of(UNIT) == {("s3://b/x.csv", Stamp(12, "today")): "ab" * 32}
    assert unit_file(UNIT.key).startswith("units/cc/")
    assert math.isclose(read_unit(UNIT.dump(), "u").rows[0].value or 0, 0.30000000000000004, rel_tol=0)


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[]", b'{"schema": "other"}', UNIT.dump().replace(b"rows", b"row")]
)
def test_anything_else_is_refused(content: bytes) -> None:
    with pytest.raises(PlantarError, match=r"^u"):
        read_unit(content, "u")


def test_the_key_is_of_content_names_order_and_settings() -> None:
    usual = unit_key("robot", INPUTS, FeetSettings())
    others = [
        unit_key("other", INPUTS, FeetSettings()),
        unit_key("robot", [("validate", "x.csv", "ab")], FeetSettings()),
        unit_key("robot", [("fit", "y.csv", "ab")], FeetSettings()),
        unit_key("robot", [("fit", "x.csv", "cd")], FeetSettings()),
        unit_key("robot", [*INPUTS, ("fit", "z.csv", "ef")], FeetSettings()),
        unit_key("robot", INPUTS, FeetSettings(cutoff=4.0)),
    ]
    assert usual == unit_key("robot", list(INPUTS), FeetSettings())
    assert len({usual, *others}) == 7


def test_a_groups_key_is_known_where_no_log_has_changed_since_it_was_read(tmp_path: Path) -> None:
    log = tmp_path / "x.csv"
    log.write_text("time\n0\n")
    robot: Any = SimpleNamespace(sha256="robot")
    group: Any = SimpleNamespace(logs=(SimpleNamespace(place=str(log), role="fit"),))
    read = {(str(log), stamp_of(str(log))): "ab" * 32}
    assert _known_key(group, robot, FeetSettings(), read) == unit_key(
        "robot", [("fit", "x.csv", "ab" * 32)], FeetSettings()
    )
    assert _known_key(group, robot, FeetSettings(), {}) is None, "nobody has read it"
    log.write_text("time\n0\n0.1\n")
    assert _known_key(group, robot, FeetSettings(), read) is None, "it is another now"
    log.unlink()
    assert _known_key(group, robot, FeetSettings(), read) is None, "it is gone"


def test_a_workers_key_is_the_one_that_the_driver_knows() -> None:
    task: Any = SimpleNamespace(robot=SimpleNamespace(sha256="robot"), settings=FeetSettings(cutoff=4.0))
    unseen = UnitInput("s3://b/y.csv", "y.csv", "validate", "cd" * 32, Stamp(1, "now"))
    content = [("fit", "x.csv", "ab" * 32), ("validate", "y.csv", "cd" * 32)]
    assert task_key(task, [LOG, unseen]) == unit_key("robot", content, FeetSettings(cutoff=4.0))


def test_each_row_has_the_model_of_its_own_axis() -> None:
    """An axis without one, such as z, has the result's."""
    rows = [
        SimpleNamespace(foot="left", axis=axis, name="stiffness", unit="u", value=1.0, std=0.1, interval95=interval,
                        verdict="usable")
        for axis, interval in (("pitch", (0.8, 1.2)), ("roll", None), ("z", (0.5, 2.0)))
    ]  # fmt: skip
    models = [
        SimpleNamespace(foot=foot, axis=axis, model=f"{foot} {axis}")
        for foot in ("left", "right")
        for axis in ("pitch", "roll")
    ]
    found = rows_of_result(SimpleNamespace(parameters=rows, models=models, model="kelvin_voigt"))  # type: ignore[arg-type]
    assert [(row.axis, row.low, row.high, row.model) for row in found] == [
        ("pitch", 0.8, 1.2, "left pitch"), ("roll", None, None, "left roll"), ("z", 0.5, 2.0, "kelvin_voigt"),
    ]  # fmt: skip

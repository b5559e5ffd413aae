"""Results as JSON: never NaN, and read as untrusted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from plantar.errors import PlantarError
from plantar.results.io import dump_json, finite, read_result


def test_numbers_that_are_not_finite_become_null() -> None:
    content = {"a": float("nan"), "b": (1.0, float("inf")), 3: [{"c": -0.5}], "d": True, "e": None}
    assert finite(content) == {"a": None, "b": [1.0, None], "3": [{"c": -0.5}], "d": True, "e": None}
    assert json.loads(dump_json(content))["b"] == [1.0, None]
    assert dump_json({}).endswith("}\n")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "not readable JSON"),
        ("{", "not readable JSON"),
        ("[" * 100_000, "not readable JSON"),
        ("[]", "another kind of result"),
        ('{"schema": "other/1"}', "another kind of result"),
        ('{"schema": 3}', "another kind of result"),
    ],
)
def test_files_that_are_no_results(tmp_path: Path, text: str, expected: str) -> None:
    path = tmp_path / "result.json"
    path.write_text(text)
    with pytest.raises(PlantarError, match=expected) as caught:
        read_result(path)
    assert "\n" not in str(caught.value)
    assert "result.json" in str(caught.value)


def test_a_missing_result(tmp_path: Path) -> None:
    with pytest.raises(PlantarError, match=r"result\.json: cannot be read: No such file or directory$"):
        read_result(tmp_path / "result.json")

"""A few hundred damaged files for every reader; benchmarks/fuzz_readers.py does the same by the ten thousand."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from log_formats import WRITERS

spec = importlib.util.spec_from_file_location(
    "fuzz_readers", Path(__file__).resolve().parents[3] / "benchmarks" / "fuzz_readers.py"
)
assert spec is not None
assert spec.loader is not None
fuzz = importlib.util.module_from_spec(spec)
spec.loader.exec_module(fuzz)


@pytest.mark.parametrize("name", WRITERS)
def test_damaged_files_give_a_log_or_one_line(name: str, tmp_path: Path) -> None:
    outcome = fuzz.attack(name, tmp_path, iter(range(90_000, 90_040)))
    assert outcome["failures"] == []
    assert outcome["read"] + outcome["refused"] == 40

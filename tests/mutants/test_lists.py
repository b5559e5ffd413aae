"""The lists of mutants follow the source: one whose text has left it would never again be tried."""

from __future__ import annotations

from pathlib import Path

import pytest
from lists import LISTS
from mutant import Mutant

TESTS = Path(__file__).resolve().parents[1]
SOURCE = TESTS.parent / "src" / "plantar"


@pytest.mark.parametrize(
    "mutant",
    [each for some in LISTS.values() for each in some],
    ids=lambda each: each.name,
)
def test_no_mutant_is_stale(mutant: Mutant) -> None:
    assert mutant.changed((SOURCE / mutant.file).read_text())
    assert all((TESTS / place).exists() for place in mutant.tests)

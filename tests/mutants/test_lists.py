"""The lists of mutants follow the source: one whose text has left it would never again be tried."""

from __future__ import annotations

from pathlib import Path

import pytest
from data_faults import DATA_FAULTS
from designed_motions import DESIGNED_MOTIONS
from drawn import DRAWN
from drawn_again import DRAWN_AGAIN
from fleet_statistics import FLEET
from handed_on import HANDED_ON
from made_cheaper import MADE_CHEAPER
from mutant import Mutant
from once_unnoticed import ONCE_UNNOTICED

TESTS = Path(__file__).resolve().parents[1]
SOURCE = TESTS.parent / "src" / "plantar"


@pytest.mark.parametrize(
    "mutant",
    [
        *DRAWN,
        *DRAWN_AGAIN,
        *MADE_CHEAPER,
        *ONCE_UNNOTICED,
        *DATA_FAULTS,
        *DESIGNED_MOTIONS,
        *FLEET,
        *HANDED_ON,
    ],
    ids=lambda each: each.name,
)
def test_no_mutant_is_stale(mutant: Mutant) -> None:
    assert mutant.changed((SOURCE / mutant.file).read_text())
    assert all((TESTS / place).exists() for place in mutant.tests)

"""What `plantar fleet run` says of its work."""

from __future__ import annotations

import pytest

from plantar.cli.fleet.run import _duration, counts
from plantar.fleet.run import Outcome
from plantar.fleet.tables import Written


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(89.4, "89 s"), (90.0, "2 min"), (5399.0, "90 min"), (5400.0, "1.5 h"), (9000, "2.5 h")],
)
def test_a_time_is_told_in_the_unit_that_suits_it(seconds: float, said: str) -> None:
    assert _duration(seconds) == said


def test_the_last_line_counts_what_came_of_the_groups() -> None:
    outcome = Outcome(9, 2, 6, Written(finished=7, failed=2, failures=5), 60.0, 100.0)
    assert counts(outcome) == (
        "9 groups: 7 with results, 2 were there already, 2 failed, 5 failures in failures.parquet"
    )

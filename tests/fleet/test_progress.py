"""What a run says of how far it is."""

from __future__ import annotations

import pytest

from plantar.fleet.run import Progress, _State
from plantar.fleet.unit import Failure


def test_groups_are_counted_and_the_time_left_is_that_of_the_usual_one() -> None:
    """Three groups ended ten seconds apart: four are left, ten seconds each; what was lost has failed, too."""
    state = _State(10, reused=2, done=3, failed=1, lost={"a": (Failure("", "gone"),)})
    assert state.progress() == Progress(10, 2, 3, 2, None), "one alone tells no pace"
    state.ends.extend([100.0, 110.0, 120.0])
    found = state.progress()
    assert (found.total, found.reused, found.done, found.failed) == (10, 2, 3, 2)
    assert found.seconds_left == pytest.approx(40.0)

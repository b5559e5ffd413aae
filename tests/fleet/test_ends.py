"""What a run notes of each group's end, and says of what no log is at fault for."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from plantar.errors import PlantarError
from plantar.fleet.places import PlaceError
from plantar.fleet.run import _State, _take
from plantar.fleet.unit import Failure
from plantar.fleet.work import Done


def ended(
    error: BaseException | None = None, done: Done | None = None, status: str = "finished"
) -> SimpleNamespace:
    return SimpleNamespace(status=status, exception=lambda: error, result=lambda: done)


def test_ends_are_counted_once_and_as_what_they_are() -> None:
    failure = Failure("a.csv", "is empty")
    state = _State(4)
    _take("new", ended(done=Done("k1", False, (), False, 2.0)), state)
    _take("old", ended(done=Done("k2", True, (), False, 0.5)), state)
    _take("bad", ended(done=Done("k3", False, (failure,), True, 1.0)), state)
    _take("lost", ended(done=Done(None, False, (failure,), True, 1.0)), state)
    assert state.keys == {"new": "k1", "old": "k2", "bad": "k3"}
    assert state.lost == {"lost": (failure,)}
    assert (state.done, state.reused, state.failed, state.worked) == (2, 1, 1, 3.5)
    assert len(state.ends) == 4


class KilledWorker(Exception):
    """Dask's, by its name."""


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (PlantarError("is empty"), "is empty"),
        (
            KilledWorker("gone"),
            "its workers died, one after the other (valid: more memory for each with --memory",
        ),
        (MemoryError(), "not enough memory for these logs (valid: more for each worker with --memory"),
        (ZeroDivisionError("by\n zero"), "internal error, please report it: ZeroDivisionError: by zero"),
    ],
)
def test_what_stops_a_group_is_one_line_and_stops_no_other(error: Exception, said: str) -> None:
    state = _State(1)
    _take("group", ended(error), state)
    ((failure,),) = state.lost.values()
    assert failure.log == ""
    assert failure.error.startswith(said)
    assert not state.ends, "its time tells no pace"


def test_a_scheduler_that_is_gone_and_a_store_that_cannot_be_used_end_the_run() -> None:
    with pytest.raises(
        PlantarError,
        match=r"^the scheduler is gone; what is finished stays \(valid: the same command again\)$",
    ):
        _take("group", ended(status="cancelled"), _State(1))
    with pytest.raises(PlaceError, match="is full"):
        _take("group", ended(PlaceError("is full")), _State(1))

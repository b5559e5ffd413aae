"""BLAS and its threads in work that is shared between cores: five times the time where each copy starts its own."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import plantar
from plantar.feet import identify, validate
from plantar.motions import select_motions
from plantar.results.feet import FeetResult


def threads() -> set[int]:
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


@pytest.mark.parametrize(
    ("module", "call"),
    [
        (identify, lambda: plantar.identify_feet("robot.yaml", "log.csv")),
        (select_motions, lambda: plantar.select_motions("robot.yaml", "log.csv")),
        (validate, lambda: plantar.validate_feet("result.json", "robot.yaml", "log.csv")),
    ],
)
def test_from_python_blas_has_one_thread_and_its_own_again_afterwards(
    module: object, call: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = set[int]()

    def robot_of(_: object) -> None:
        seen.update(threads())
        raise KeyError

    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    monkeypatch.setattr(FeetResult, "load", lambda *_, **__: None)
    monkeypatch.setattr(module, "robot_of", robot_of)
    with threadpool_limits(2, user_api="blas"):
        with pytest.raises(KeyError):
            call()
        assert seen == {1}
        assert threads() == {2}

"""Progress of several jobs as one share of the whole."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock
from typing import Final

STEPS: Final = 20  # a line for every five percent


def shares(what: str, count: int, progress: Callable[[str], None]) -> Callable[[str, float], None]:
    """A function that takes a job's name and the share of it that is done, from any thread, and says now and then how
    far `count` jobs are together."""
    done: dict[str, float] = {}
    said = -1
    lock = Lock()

    def report(job: str, share: float) -> None:
        nonlocal said
        with lock:
            done[job] = share
            step = int(STEPS * sum(done.values()) / count + 1e-9)
            if step > said:
                said = step
                progress(f"{what}: {100 // STEPS * step} %")

    return report

"""Memory that logs took and gave back: the C library keeps it for what comes next, and of large logs that is much."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from functools import cache

LARGE = 2**20  # bytes of a log's numbers: work on it takes some ten times that
KEPT = 2**30  # bytes that may lie free before they are handed back
LARGEST_OF_HEAP = 2**25  # bytes of a block that may come of those: the most that glibc takes


def keep_freed() -> None:
    """Let what one step frees be what the next one takes, on all threads, until `return_freed` hands it back.

    By itself glibc returns large blocks at once, and the system then clears every page anew: with logs of minutes that
    is a fifth of all time. For commands, whose process is their own; a library leaves its caller's memory alone.
    """
    arenas, largest, kept = -8, -3, -1  # as mallopt(3) numbers them
    for option, value in ((arenas, 1), (largest, LARGEST_OF_HEAP), (kept, KEPT)):
        _own("mallopt")(option, value)


def return_freed(size: int = LARGE) -> None:
    """Hand memory that is free back to the system, where the C library is one that can be asked to (glibc).

    Worth a call where a stage that took much has ended: it costs a millisecond, and what the next stage touches again.
    size: of the largest log that was worked on [bytes]; below LARGE nothing is done.
    """
    if size >= LARGE:
        _own("malloc_trim")(0)


@cache
def _own(name: str) -> Callable[..., object]:
    """A function of the C library, or one that does nothing where the library has none of that name."""

    def nothing(*_: int) -> None:
        pass

    return getattr(ctypes.CDLL(None), name, nothing) if sys.platform == "linux" else nothing

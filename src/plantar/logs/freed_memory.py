"""Memory that logs took and gave back: the C library keeps it for what comes next, and of large logs that is much."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from functools import cache

LARGE = 2**26  # bytes of a log's numbers


def return_freed(size: int = LARGE) -> None:
    """Hand memory that is free back to the system, where the C library is one that can be asked to (glibc).

    Worth a call where a stage that took much has ended: it costs a millisecond, and what the next stage touches again.
    size: of what was worked on [bytes]; below LARGE nothing is done.
    """
    if size >= LARGE:
        _trim()(0)


@cache
def _trim() -> Callable[[int], object]:
    """The C library's own function, or one that does nothing."""
    nothing: Callable[[int], object] = bool
    return getattr(ctypes.CDLL(None), "malloc_trim", nothing) if sys.platform == "linux" else nothing

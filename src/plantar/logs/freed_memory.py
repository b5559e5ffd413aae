"""Memory that logs took and gave back: the C library keeps it for what comes next, and of large logs that is much."""

from __future__ import annotations

import ctypes
import sys


def return_freed() -> None:
    """Hand memory that is free back to the system, where the C library is one that can be asked to (glibc).

    Worth a call where a stage that took much has ended: it costs a millisecond for what the next stage would touch
    again.
    """
    if sys.platform == "linux" and (trim := getattr(ctypes.CDLL(None), "malloc_trim", None)) is not None:
        trim(0)

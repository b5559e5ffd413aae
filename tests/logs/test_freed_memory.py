"""Memory that is freed and taken again."""

from __future__ import annotations

import subprocess
import sys

import pytest

TAKEN_AGAIN = """
import resource
import numpy as np
from plantar.logs.freed_memory import keep_freed

{call}

def work():
    one = np.ones(720_000)
    for _ in range(40):
        (2 * one + 1).sum()

work()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
work()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


def pages_taken(call: str) -> int:
    """How often the system has to give a page, in a process of its own, to what was done once before."""
    command = [sys.executable, "-c", TAKEN_AGAIN.format(call=call)]
    return int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


@pytest.mark.skipif(sys.platform != "linux", reason="glibc's memory")
def test_what_is_freed_is_taken_again() -> None:
    assert pages_taken("keep_freed()") < 40 < pages_taken("")

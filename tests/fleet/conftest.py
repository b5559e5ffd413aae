"""One worker for all tests of a file: to start it takes longer than most of what they give it, and it is never idle
for free, so that it does not live on through the rest of the session."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from plantar.fleet.cluster import connected


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with connected(1, None, None) as found:
        yield found

"""One worker for all tests of a fleet: to start it takes longer than most of what they give it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from plantar.fleet.cluster import connected


@pytest.fixture(scope="session")
def client() -> Iterator[Any]:
    with connected(1, None, None) as found:
        yield found

"""A biped's URDF, and the result of its feet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from export_robots import result, write_urdf


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    return write_urdf(tmp_path / "biped.urdf")


@pytest.fixture
def feet(urdf: Path) -> dict[str, Any]:
    return result(urdf)

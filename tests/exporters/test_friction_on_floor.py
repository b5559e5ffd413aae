"""Which of two geoms' frictions counts where they touch: MuJoCo's rule, on a model that is made up."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from plantar.exporters.mjcf.file import Compiled

PLANE, BOX = 0, 6
SOLE, FLOOR = [0.6, 0.02, 1e-4], [0.9, 0.005, 2e-4]


@pytest.mark.parametrize(
    ("kinds", "priorities", "friction"),
    [
        ([BOX, BOX], [0, 0], SOLE),  # without a floor its own
        ([BOX, PLANE], [0, 0], [0.9, 0.02, 2e-4]),  # of each the larger
        ([BOX, PLANE], [2, 1], SOLE),
        ([BOX, PLANE], [1, 2], FLOOR),
    ],
)
def test_the_geom_of_higher_priority_counts_else_the_larger_friction(
    kinds: list[int], priorities: list[int], friction: list[float]
) -> None:
    compiled: Any = object.__new__(Compiled)
    compiled._plane_type = PLANE
    compiled.model = SimpleNamespace(
        ngeom=2, geom_type=kinds, geom_friction=[SOLE, FLOOR], geom_priority=priorities
    )
    assert compiled.friction_on_floor(0).tolist() == friction

"""Small parts of dynamics, each by a case that is solved by hand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

import small_biped
from plantar.dynamics import base_parameters
from plantar.dynamics.equation import Equation
from plantar.dynamics.stream import EquationStream


@pytest.mark.parametrize(
    ("rows", "together", "groups"),
    [
        ((0, 2, 3, 4), (), [[0], [2], [3], [4]]),
        (range(6), ((0, 1, 2), (3, 4, 5)), [[0, 1, 2], [3, 4, 5]]),
        ((1, 2, 4), ((0, 1, 2), (3, 4, 5)), [[1, 2], [4]]),  # of those that are asked for
        ((4,), ((0, 1, 2),), [[4]]),
    ],
)
def test_rows_are_grouped_as_far_as_they_are_asked_for(
    tmp_path: Path, rows: Sequence[int], together: tuple[tuple[int, ...], ...], groups: list[list[int]]
) -> None:
    robot = small_biped.robot(tmp_path)
    equation = Equation(robot.floating_model)
    stream = EquationStream(equation, base_parameters(equation), rows, together=together)
    assert sorted(stream._groups.values()) == groups

"""Force cells under a sole read as the wrench that they make together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped_robot import make_robot
from plantar.errors import LogError
from plantar.logs.readers import open_log

AT = [[0.1, 0.06], [0.1, -0.06], [-0.08, -0.06], [-0.08, 0.06]]
NAMES = ["a", "b", "c", "d"]


def written(folder: Path, cells: np.ndarray) -> Path:
    rows = np.column_stack([0.01 * np.arange(len(cells)), cells])
    np.savetxt(folder / "log.csv", rows, delimiter=",", header="time,a,b,c,d", comments="", fmt="%.17g")
    return folder / "log.csv"


@pytest.mark.parametrize("sign", [1, -1])
def test_the_wrench_is_the_sum_of_the_cells_moments(tmp_path: Path, sign: int) -> None:
    cells = np.random.default_rng(0).uniform(0.0, 0.2, (50, 4))
    columns = {"wrench.left.cells": {"from": NAMES, "at": AT, "unit": "kN", "sign": sign}}
    log = open_log(written(tmp_path, cells), make_robot(tmp_path / "robot", columns=columns))
    forces = np.zeros((50, 4, 3))
    forces[:, :, 2] = sign * 1e3 * cells
    places = np.column_stack([AT, np.zeros(4)])
    expected = np.column_stack([forces.sum(axis=1), np.cross(places, forces).sum(axis=1)])
    np.testing.assert_allclose(log.wrench("left"), expected, rtol=1e-7, atol=1e-9)
    assert log.vertical_only("left")


def test_a_sensor_with_one_horizontal_reading_is_no_set_of_cells(tmp_path: Path) -> None:
    columns = {"wrench.left.cells": {"from": NAMES, "at": AT}}
    log = open_log(written(tmp_path, np.ones((50, 4))), make_robot(tmp_path / "robot", columns=columns))
    once = np.zeros(50)
    once[7] = 1.0
    assert not log.with_columns({"wrench.left.force.x": once}).vertical_only("left")
    assert not log.with_columns({"wrench.left.force.z": np.zeros(50)}).vertical_only("left")


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ({"from": NAMES}, "needs the cells' places"),
        (
            {"from": NAMES, "at": AT[:3]},
            r"robot\.yaml: columns\.wrench\.left\.cells has 3 places for 4 cells \(valid: at: \[\[x, "
            r"y\], \.\.\.\] \[m\], a pair for each column of from\)$",
        ),
        (
            {"from": NAMES, "at": [[100, 60], [100, -60], [-80, -60], [-80, 60]]},
            r"robot\.yaml: columns\.wrench\.left\.cells: a cell lies 100 m away; are these "
            r"millimetres\? \(valid: at: \[\[x, y\], \.\.\.\] \[m\], a pair for each column of from\)$",
        ),
        ({"from": NAMES, "at": [[0.1, 0], [0.05, 0], [0, 0], [-0.1, 0]]}, "in one line"),
        ({"from": NAMES[:2], "at": AT[:2]}, "in one line"),
        ({"from": NAMES, "at": "front"}, "needs the cells' places"),
        (
            {"from": NAMES, "at": AT, "unit": "N.m"},
            r"robot\.yaml, value 'N\.m': columns\.wrench\.left\.cells: no such unit of force \(valid: "
            r"N, kN, kgf\)$",
        ),
    ],
)
def test_places_that_cannot_be_are_one_clear_line(
    cells: dict[str, object], expected: str, tmp_path: Path
) -> None:
    robot = make_robot(tmp_path / "robot", columns={"wrench.left.cells": cells})
    with pytest.raises(LogError, match=expected) as caught:
        open_log(written(tmp_path, np.ones((50, 4))), robot)
    assert "\n" not in str(caught.value)

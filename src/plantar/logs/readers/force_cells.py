"""Single-axis force cells under a sole, as the wrench of a force sensor: vertical force and the two moments it makes.

    columns:
      wrench.left.cells: {from: [lf1, lf2, lf3, lf4], at: [[0.09, 0.05], [0.09, -0.05], [-0.07, -0.05], [-0.07, 0.05]]}

`at` holds x and y of each cell [m] in the frame of the robot file's `wrench`, in the order of `from`; a cell reads the
force along that frame's z.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.robot.schema import LONGEST_SOLE

FEWEST = 3  # cells: two show the moment about one axis only
# m, of the cells across their longest line: nearer to a line they show no moment about it.
LEAST_SPREAD = 0.005


def wrench_of_cells(sensor: str, values: Array, places: object, path: Path) -> dict[str, Array]:
    """Columns of the wrench: force.z = Σ f, torque.x = Σ y f, torque.y = -Σ x f; the others are 0.

    Args:
        sensor: `wrench.<name>`. values: (n, k) [N]. places: x and y of each cell [m], as the robot file has them.

    Raises:
        LogError: places that are not as many pairs of numbers as there are cells, fewer than three, or in one line.
    """
    where = f"columns.{sensor}.cells"
    valid = "at: [[x, y], ...] [m], a pair for each column of from"
    try:
        at = np.array(places, dtype=float).reshape(-1, 2)
    except (TypeError, ValueError):
        raise LogError(f"{where} needs the cells' places", path=path, valid=valid) from None
    if at.shape != (values.shape[1], 2) or not np.isfinite(at).all():
        raise LogError(f"{where} has {len(at)} places for {values.shape[1]} cells", path=path, valid=valid)
    if np.abs(at).max() > LONGEST_SOLE:
        text = f"{where}: a cell lies {np.abs(at).max():.3g} m away; are these millimetres?"
        raise LogError(text, path=path, valid=valid)
    if len(at) < FEWEST or np.linalg.svd(at - at.mean(axis=0), compute_uv=False)[1] < LEAST_SPREAD:
        text = f"{where}: the cells stand in one line and show no moment about it"
        raise LogError(text, path=path, valid=f"{FEWEST} or more cells that span an area")
    none = np.zeros(len(values))
    force = np.column_stack([none, none, values.sum(axis=1)])
    torque = np.column_stack([values @ at[:, 1], -values @ at[:, 0], none])
    return {
        f"{sensor}.{kind}.{axis}": column
        for kind, parts in (("force", force), ("torque", torque))
        for axis, column in zip("xyz", parts.T, strict=True)
    }

"""Where a chart's scale begins and ends, by value."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.report.charts.chart import MARGIN, ends


@pytest.mark.parametrize(
    ("values", "low", "high"),
    [
        ([2.0, np.nan, 4.0, np.inf], 2.0 - 2 * MARGIN, 4.0 + 2 * MARGIN),
        ([-5.0, 5.0], -5.0 - 10 * MARGIN, 5.0 + 10 * MARGIN),
        ([3.0, 3.0], 2.7, 3.3),  # a tenth about one value, of either sign
        ([-3.0], -3.3, -2.7),
        ([0.0, 0.0], -1.0, 1.0),
        ([np.nan], -1.0, 1.0),
        ([], -1.0, 1.0),
    ],
)
def test_a_scale_ends_a_margin_beyond_its_values(values: list[float], low: float, high: float) -> None:
    assert ends(np.array(values)) == pytest.approx((low, high))

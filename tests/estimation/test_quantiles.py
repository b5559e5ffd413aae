"""Quantiles against a library's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import special

from plantar.estimation.quantiles import fisher_quantile, student_quantile


@pytest.mark.parametrize("share", [0.975, 0.995])
@pytest.mark.parametrize("freedom", [1.0, 1.3, 2.0, 3.7, 20.0, 1e3, 1e6])
def test_student_s_is_a_library_s(share: float, freedom: float) -> None:
    assert student_quantile(share, freedom) == pytest.approx(special.stdtrit(freedom, share), rel=2e-8)


def test_a_deviation_that_is_known_gives_the_normal_one() -> None:
    assert student_quantile(0.975, np.inf) == pytest.approx(special.ndtri(0.975), rel=1e-5)


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("freedom", [2.0, 3.3, 17.0, 1e5])
def test_fisher_s_is_a_library_s(count: int, freedom: float) -> None:
    assert fisher_quantile(0.99, count, freedom) == pytest.approx(
        special.fdtri(count, freedom, 0.99), rel=2e-8
    )

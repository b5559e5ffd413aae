"""A mean by inverse squares of deviations, wider where its numbers disagree."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.estimation.weighted_mean import weighted_mean


def test_numbers_that_agree_are_known_as_well_as_they_say_together() -> None:
    """Weights 1 and 4, and 0.1 from each other."""
    mean = weighted_mean([3.0, 3.1], [1.0, 0.5])
    assert mean.value == pytest.approx((3.0 + 4 * 3.1) / 5)
    assert mean.std == pytest.approx(1 / np.sqrt(5))
    assert mean.apart == pytest.approx(0.1 / np.sqrt(1.25))


def test_numbers_that_disagree_are_known_less_well() -> None:
    """Of two, the mean square about their mean is the square of their difference over the sum of variances."""
    mean = weighted_mean([3.0, 8.0], [1.0, 0.5])
    assert mean.apart == pytest.approx(5 / np.sqrt(1.25))
    assert mean.std == pytest.approx(mean.apart / np.sqrt(5))


def test_one_number_is_what_it_is() -> None:
    assert weighted_mean([2.0], [0.3]) == (pytest.approx(2.0), pytest.approx(0.3), 0.0)

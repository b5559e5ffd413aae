"""What a fit of a law says of its own numbers: intervals, and doubts of a shape at an end."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from plantar.model_selection.model_fit import ModelFit
from plantar.models import MODELS, BoucWen


def test_each_parameter_has_the_freedom_of_its_own_interval() -> None:
    fit = ModelFit(
        model=MODELS["elastoplastic"],
        values=np.array([450.0, 20.0, 5.0]),
        shape=np.array([0.01]),
        covariance=np.diag([4.0, 1.0, 0.25, 1e-6]),
        freedom=np.array([3.0, 8.0, 30.0, 5.0]),
        white_std=np.zeros(4),
        offsets={},
        offset_std={},
        initial_states={},
        residuals={},
        limits=np.zeros((2, 1)),
        cutoff=5.0,
        shared_offset=False,
    )
    told = {"stiffness": (450.0, 2.0, 3), "damping": (20.0, 1.0, 8), fit.names[3]: (0.01, 1e-3, 5)}
    for name, (value, std, freedom) in told.items():
        assert fit.interval95(name) == pytest.approx(stats.t.interval(0.95, freedom, value, std), rel=1e-6)


@pytest.mark.parametrize("name", ["standard_linear_solid", "elastoplastic"])
@pytest.mark.parametrize(("value", "end"), [(0.0101, "low"), (0.0103, None), (0.97, None), (0.985, "high")])
def test_a_shape_at_an_end_that_its_law_cannot_see_beyond(name: str, value: float, end: str | None) -> None:
    """Within 2 per cent of 0.01 or of 1; a slip angle may be as small as it likes."""
    model, size = MODELS[name], np.array([150.0, 6.0, 5.0, value])
    fit = ModelFit(
        model, size[:3], size[3:], np.diag(0.01 * size) ** 2, np.full(4, 12.0), 0.01 * size,
        {}, {}, {}, {"sway": np.zeros(9)}, np.array([[0.01], [1.0]]), 5.0, False,
    )  # fmt: skip
    term = model.shape_terms[0]
    said = {
        "low": (f"{term} lies at or below 0.01, the smallest that these motions can show",),
        "high": (f"{term} lies at or beyond 1, the largest that these motions can show",),
        None: (),
    }
    assert fit.doubts == said[end if (term, end) in model.blind_ends else None]


def test_an_exponent_at_an_end_is_no_doubt() -> None:
    size = np.array([150.0, 6.0, 5.0, 0.1, 3.0])
    fit = ModelFit(
        BoucWen(), size[:3], size[3:], np.diag(0.01 * size) ** 2, np.full(5, 12.0), 0.01 * size,
        {}, {}, {}, {"sway": np.zeros(9)}, np.array([[0.01, 1.0], [1.0, 3.0]]), 5.0, False,
    )  # fmt: skip
    assert fit.doubts == ()

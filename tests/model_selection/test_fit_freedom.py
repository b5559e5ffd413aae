"""What a fit to several recordings says of each number's deviation: by the recordings that show it."""

from __future__ import annotations

import numpy as np
import pytest

from bush_data_sets import Rubber, recorded, sway
from plantar.estimation.residual_covariance import cosine_covariance
from plantar.model_selection.data_sets import prepare_data_sets
from plantar.model_selection.model_fit import fit_model
from plantar.models import KelvinVoigt

RUBBER, MODEL = Rubber(), KelvinVoigt()


def test_one_recording_has_the_freedom_of_its_cosines() -> None:
    data_set = recorded(np.random.default_rng(1), "one", sway(np.random.default_rng(1), 0.05, 0.5), RUBBER)
    fit = fit_model(MODEL, [data_set], shared_offset=False)
    (prepared,) = prepare_data_sets([data_set], fit.cutoff, drift=True)
    _, freedom = cosine_covariance(fit.residuals["one"][:, None], prepared.duration)
    assert fit.freedom == pytest.approx([freedom, freedom])


def test_a_number_has_the_freedom_of_the_recordings_that_show_it() -> None:
    """What the damping may be off by comes of one quick recording with much noise, the stiffness's of all."""
    rng = np.random.default_rng(2)
    slow = [recorded(rng, f"slow {k}", sway(rng, 0.08, 0.05), RUBBER) for k in range(4)]
    quick = recorded(rng, "quick", sway(rng, 0.02, 1.5), RUBBER, noise=8.0)
    alone = fit_model(MODEL, [quick], shared_offset=False).freedom[0]
    freedom = fit_model(MODEL, [*slow, quick], shared_offset=False).freedom
    assert alone <= freedom[1] < 1.6 * alone < 2.0 * alone < freedom[0] < 5.5 * alone


@pytest.mark.parametrize("shared", [False, True])
def test_each_offset_has_the_deviation_of_its_own_recording(shared: bool) -> None:
    """One recording of three has five times the noise."""
    rng = np.random.default_rng(3)
    data_sets = [
        recorded(rng, label, sway(rng, 0.05, 0.5), RUBBER, noise=noise)
        for label, noise in (("a", 1.0), ("b", 1.0), ("loud", 5.0))
    ]
    fit = fit_model(MODEL, data_sets, shared_offset=shared)
    assert fit.shared_offset == shared
    assert list(fit.offset_std) == ["a", "b", "loud"]
    if shared:
        assert len(set(fit.offset_std.values())) == len(set(fit.offsets.values())) == 1
    else:
        assert fit.offset_std["loud"] > 2.5 * max(fit.offset_std["a"], fit.offset_std["b"])


def test_white_residuals_leave_what_least_squares_says() -> None:
    """The residuals' variance, by the samples less three numbers, times the inverse of the normal equations."""
    data_set = recorded(
        np.random.default_rng(4), "short", sway(np.random.default_rng(4), 0.05, 0.5)[1000:1400], RUBBER
    )
    fit = fit_model(MODEL, [data_set], shared_offset=True)
    (prepared,) = prepare_data_sets([data_set], fit.cutoff, drift=False)
    motion = prepared.motion
    rows = np.column_stack([motion.deflection, motion.rate, np.ones(len(motion.rate))])[:: prepared.every][
        prepared.used
    ]
    values, squares, *_ = np.linalg.lstsq(rows, prepared.response, rcond=None)
    np.testing.assert_allclose(fit.values, values[:2], rtol=1e-9)
    variance = squares[0] / (prepared.every * len(rows) - 3)
    wanted = np.sqrt(variance * np.diag(np.linalg.inv(rows.T @ rows)))[:2]
    np.testing.assert_allclose(fit.white_std, wanted, rtol=1e-6)

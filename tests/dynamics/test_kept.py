"""Base parameters of robots and their fits, as they are kept: expressions, values, deviations, what is not excited."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import example_robots
import small_biped
from example_robots import random_motion
from kept_texts import assert_as_kept, described
from plantar.dynamics import (
    Equation,
    base_parameters,
    fit_base_parameters,
    fit_base_parameters_chunked,
    regressor,
)
from plantar.dynamics.base_parameters import BaseParameters

KEPT = Path(__file__).parent / "kept"
MODELS = {
    "biped": lambda: pin.buildModelFromXML(small_biped.urdf(), pin.JointModelFreeFlyer()),
    "arm": lambda: example_robots.model(example_robots.UR5),
}


def told(base: BaseParameters) -> dict[str, object]:
    size = len(base)
    return {
        "kept": base.kept, "masks": base.masks, "names": base.names, "expressions": base.expressions,
        "embedded": base.embed(np.arange(1.0, size + 1)),
    }  # fmt: skip


@pytest.mark.parametrize("name", MODELS)
def test_a_fit_is_as_it_is_kept(name: str) -> None:
    """Of noise and motion, whole, in two chunks, and of one in which one joint hardly turns."""
    model = MODELS[name]()
    q, v, a = random_motion(model, 90, 5)
    noise = np.random.default_rng(6).standard_normal(v.shape)
    data = model.createData()
    tau = np.array([pin.rnea(model, data, *sample) for sample in zip(q, v, a, strict=True)]) + 0.1 * noise
    still_v, still_a = v.copy(), a.copy()
    still_v[:, :-1], still_a[:, :-1] = 0.0, 0.0
    fits = {
        "all": fit_base_parameters(model, q, v, a, tau, rows="all"),
        "chunks": fit_base_parameters_chunked(
            model, ((q[rows], v[rows], a[rows], tau[rows]) for rows in (slice(40), slice(40, 90))), "all", 1
        ),
        "still": fit_base_parameters(model, np.tile(q[:1], (90, 1)), still_v, still_a, tau, rows="all"),
    }  # fmt: skip
    if name == "biped":
        fits["base"] = fit_base_parameters(model, q, v, a, tau)
    found = {
        kind: {
            "values": fit.values, "std": fit.std, "rank": fit.rank, "samples": fit.samples, "rms": fit.residual_rms,
            "condition": fit.condition_number, "notes": fit.notes, "predicted": fit.predict(q[:7], v[:7], a[:7]),
        }
        for kind, fit in fits.items()
    }  # fmt: skip
    text = described(
        {"base": told(base_parameters(Equation(model))), "regressor": regressor(model, q, v, a), **found}
    )
    assert_as_kept(text, KEPT / f"{name}.txt", share=1e-5, least=1e-7)

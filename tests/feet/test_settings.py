"""Settings are checked where they are made: one line that names what is valid."""

from __future__ import annotations

from typing import Any

import pytest

from plantar.errors import PlantarError, SettingsError
from plantar.feet.settings import FeetSettings
from plantar.models import MODELS


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (
            {"model": "x"},
            r"^value 'x': model is not a choice \(valid: auto, kelvin_voigt, hardening, coulomb, "
            r"elastoplastic, hardening_elastoplastic, iwan, bouc_wen, standard_linear_solid, "
            r"coupled\)$",
        ),
        (
            {"model": None},
            r"^model is not a choice \(valid: auto, kelvin_voigt, hardening, coulomb, elastoplastic, "
            r"hardening_elastoplastic, iwan, bouc_wen, standard_linear_solid, coupled\)$",
        ),
        ({"offset": "shard"}, r"value 'shard': offset is not a choice \(valid: per-motion, shared\)"),
        (
            {"offset": ["shared"]},
            r"^value \['shared'\]: offset is not a choice \(valid: per-motion, shared\)$",
        ),
        (
            {"cutoff": -1.0},
            r"value -1\.0: cutoff is not valid \(valid: at least 0\.1 Hz, or None: found from the data\)",
        ),
        ({"cutoff": 0}, "cutoff"),
        ({"cutoff": float("nan")}, "cutoff"),
        ({"cutoff": float("inf")}, "cutoff"),
        ({"cutoff": "5"}, "cutoff"),
        ({"cutoff": True}, "cutoff"),
        ({"edge_margin": -0.001}, r"^value -0\.001: edge_margin is not valid \(valid: at least 0 m\)$"),
        ({"window": 0.0}, "window is not valid .*None: found from the data"),
        ({"window": 4.0}, "window"),
        (
            {"wrench_delay": 5.0},
            r"^value 5\.0: wrench_delay is not valid \(valid: -1 to 1 s, or None: estimated from the "
            r"data\)$",
        ),
        ({"wrench_delay": "late"}, "wrench_delay"),
    ],
)
def test_a_wrong_setting_is_one_line(given: dict[str, Any], expected: str) -> None:
    with pytest.raises(SettingsError, match=expected) as caught:
        FeetSettings(**given)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, PlantarError)


def test_every_model_and_every_limit_is_valid() -> None:
    for model in ("auto", *MODELS):
        assert FeetSettings(model=model).model == model
    limits = FeetSettings("shared", "auto", 0.1, 0.0, 0.2, -0.005)
    assert limits.to_dict() == {
        "offset": "shared", "model": "auto", "cutoff": 0.1, "edge_margin": 0.0, "window": 0.2, "wrench_delay": -0.005,
    }  # fmt: skip

"""A result that is scored on other logs: what is said of it, and the models that it holds, by made-up results."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.contact.phases import Phase
from plantar.errors import DataError
from plantar.feet.validate import _of_another, _seen, _stored_model, _unscored
from plantar.models import MODELS
from plantar.notes import Note
from plantar.results.feet import AxisModel
from plantar.results.feet_rows import LinearEquivalent


def result_of(
    model: str = "elastoplastic", *numbers: tuple[str, str, str, float | None], **changes: Any
) -> Any:
    entry = AxisModel(
        "left", "roll", model, "why", LinearEquivalent(1.0, 2.0), (0.01, 0.02), turned=0.03, leans=0.04, crosstalk=0.05,
        imu_turned=(0.06, 0.07, 0.08),
    )  # fmt: skip
    names = ("foot", "axis", "name", "value")
    rows = [SimpleNamespace(**dict(zip(names, each, strict=True))) for each in numbers]
    return SimpleNamespace(**({"robot": "talos", "models": (entry,), "parameters": rows} | changes))


NUMBERS = (
    ("left", "pitch", "stiffness", 9.0), ("right", "roll", "stiffness", 8.0), ("left", "roll", "slip_angle", 0.012),
    ("left", "roll", "damping", 20.0), ("left", "roll", "slip_torque", 3.0), ("left", "roll", "stiffness", 400.0),
)  # fmt: skip


def test_a_stored_model_has_its_numbers_in_their_order_and_its_place() -> None:
    found = _stored_model(result_of("elastoplastic", *NUMBERS), "left", "roll")
    assert found is not None
    assert (found.foot, found.axis, found.model) == ("left", "roll", MODELS["elastoplastic"])
    assert (found.values.tolist(), found.shape.tolist()) == ([400.0, 20.0, 3.0], [0.012])
    assert (found.moment_arms, found.turned, found.leans, found.crosstalk) == ((0.01, 0.02), 0.03, 0.04, 0.05)
    assert found.imu_turned == (0.06, 0.07, 0.08)


def test_an_axis_without_an_entry_is_a_spring_and_damper_at_its_place() -> None:
    result = result_of("elastoplastic", *NUMBERS, ("left", "pitch", "damping", 0.5))
    found = _stored_model(result, "left", "pitch")
    assert found is not None
    assert (found.model.name, found.values.tolist(), found.moment_arms) == (
        "kelvin_voigt",
        [9.0, 0.5],
        (0.0, 0.0),
    )
    assert np.size(found.shape) == 0


def test_a_model_that_lacks_a_number_is_none() -> None:
    assert _stored_model(result_of("elastoplastic", *NUMBERS[:4]), "left", "roll") is None
    unknown = [(*each[:3], None if each[2] == "slip_angle" else each[3]) for each in NUMBERS]
    assert _stored_model(result_of("elastoplastic", *unknown), "left", "roll") is None
    message = (
        r"^the result's model 'magic' is unknown \(valid: kelvin_voigt, hardening, coulomb, elastoplastic, "
        r"hardening_elastoplastic, iwan, bouc_wen, standard_linear_solid, coupled\)$"
    )
    with pytest.raises(DataError, match=message):
        _stored_model(result_of("magic", *NUMBERS), "left", "roll")


def test_a_result_of_another_robot_in_words() -> None:
    text = (
        "the result is of 'talos', the robot file of 'hrp2': the errors are those of other feet, unless the robot was "
        "renamed"
    )
    other, same = (SimpleNamespace(name=name) for name in ("hrp2", "talos"))
    assert _of_another(result_of(), other) == [Note("other_robot", "warning", text)]  # type: ignore[arg-type]
    assert _of_another(result_of(), same) == []  # type: ignore[arg-type]


def test_only_logs_that_were_fitted_are_no_unseen_ones() -> None:
    """By their content; one that was only scored says as much as ever, and one without content is no other's."""
    inputs = [
        SimpleNamespace(sha256="a", role="fit"), SimpleNamespace(sha256="b", role="validate"),
        SimpleNamespace(sha256=None, role="fit"),
    ]  # fmt: skip
    logs: Any = [
        SimpleNamespace(name=f"log {key}", log=SimpleNamespace(sha256=key)) for key in ("b", None, "c", "a")
    ]
    text = (
        "log a: the result was fitted to this log: its errors say nothing of logs that the fit has not seen"
    )
    assert _seen(result_of(inputs=inputs), logs) == [Note("seen", "warning", text)]


def test_feet_without_a_score_are_told_with_what_their_seconds_are() -> None:
    def contact(foot: str, *spans: tuple[float, float, str | None]) -> Any:
        phases = [Phase("walk", foot, start, end, "double", why is None, why) for start, end, why in spans]
        return SimpleNamespace(phases=lambda *asked: phases if asked == ("walk", foot, "time") else None)

    recording: Any = SimpleNamespace(
        name="walk", time="time",
        contacts={
            "a": contact("a", (0.0, 9.0, None)), "b": contact("b", (0.0, 2.5, None)),
            "c": contact("c", (0.0, 1.5, "tipping: aside"), (1.5, 3.0, None), (3.0, 3.04, "slip: x"), (4.0, 5.0, None)),
        },
    )  # fmt: skip
    rows: Any = [SimpleNamespace(motion="walk", foot="a"), SimpleNamespace(motion="other", foot="b")]
    assert _unscored(rows, [recording], {"c", "b", "a"}) == [
        Note("not_scored", "warning", "walk: the b foot is not scored: of 2.5 s 2.5 can be used. Left out: nothing, "
             "but the result has no model of this foot"),
        Note("not_scored", "warning", "walk: the c foot is not scored: of 4.0 s 2.5 can be used. Left out: tipping "
             "(1.5 s)"),
    ]  # fmt: skip

"""What a result says of its models, and what its table of errors holds: by made-up fits, whole lines."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.feet.assumptions import Found, _delays, _places, _together, _turns, _width
from plantar.feet.result import _axis_model, _feet_notes, _model, _model_notes
from plantar.models import MODELS
from plantar.notes import Note
from plantar.results.feet_rows import Candidate, LinearEquivalent


def fit_of(foot: str = "left", axis: str = "pitch", model: str = "kelvin_voigt", **changes: Any) -> Any:
    fields = {
        "foot": foot, "axis": axis, "model": MODELS[model], "reason": "why", "equivalent": (412.346, 18.7654),
        "choice": None, "notes": (), "moment_arms": (0.0, 0.0), "place_std": (None,) * 6, "imu_turned": (0.0, 0.0, 0.0),
        "turned": 0.0, "leans": 0.0, "crosstalk": 0.0,
    }  # fmt: skip
    return SimpleNamespace(**(fields | changes))


@pytest.mark.parametrize(
    ("models", "most"),
    [
        ([], "kelvin_voigt"),
        (["kelvin_voigt", "kelvin_voigt", "hardening"], "kelvin_voigt"),
        (["kelvin_voigt", "hardening", "hardening"], "hardening"),
        (["kelvin_voigt", "hardening"], "hardening"),  # of equally many, the richer one
        (["hardening", "kelvin_voigt"], "hardening"),
    ],
)
def test_the_model_of_most_axes(models: list[str], most: str) -> None:
    assert _model([fit_of(model=name) for name in models]) == most


def test_richer_models_and_what_they_leave_open_are_told() -> None:
    """A caution of several axes stands once; a fit's own notes follow its model; long arms where it has none."""
    own = Note("bush_place", "warning", "left roll: elsewhere")
    doubt = SimpleNamespace(caution="it may be more")
    fits = [
        fit_of(choice=doubt), fit_of(axis="roll", model="hardening", notes=(own,), moment_arms=(0.05, 0.0)),
        fit_of("right", choice=doubt, moment_arms=(0.05, 0.0)),
        fit_of("right", "roll", choice=SimpleNamespace(caution=None)),
    ]  # fmt: skip
    notes = _model_notes(fits)
    assert notes[:3] == [
        Note("model", "info", "left roll: the model is hardening: why; the nearest spring and damper has K = 412.3, C "
             "= 18.77"),
        own,
        Note("model_caution", "warning", "left pitch, right pitch: it may be more"),
    ]  # fmt: skip
    assert [note.code for note in notes[3:]] == ["bush_arm_far"]
    assert "left roll" not in notes[3].text


def test_a_models_place_is_told_beside_the_logs_as_they_were() -> None:
    """What was put right of the IMU before, and what this axis found besides."""
    turn: Any = SimpleNamespace(angles=(0.01, 0.02, 0.03))
    fit = fit_of(
        axis="roll", moment_arms=(0.004, -0.005), turned=0.06, leans=0.07, crosstalk=0.08, imu_turned=(0.1, 0.2, 0.3)
    )  # fmt: skip
    found = _axis_model(fit, turn)
    assert (found.foot, found.axis, found.model, found.reason) == ("left", "roll", "kelvin_voigt", "why")
    assert found.linear_equivalent == LinearEquivalent(412.346, 18.7654)
    assert (found.moment_arms, found.turned, found.leans, found.crosstalk) == (
        (0.004, -0.005),
        0.06,
        0.07,
        0.08,
    )
    assert found.imu_turned == pytest.approx((0.11, 0.22, 0.33))
    assert (found.held_out, found.ranking) == (None, None)
    score = SimpleNamespace(model=MODELS["iwan"], held_out_rms=0.3, parameters=4, refused="no", chosen=False)
    fit.choice = SimpleNamespace(held_out="pieces", ranking=[score])
    told = _axis_model(fit, turn)
    assert (told.held_out, told.ranking) == ("pieces", (Candidate("iwan", 0.3, 4, "no", False),))


def test_feet_that_never_stand_in_words() -> None:
    robot: Any = SimpleNamespace(feet=("left", "right"))
    stands, hangs = (
        SimpleNamespace(standing=np.array([one]), support=np.array([1])) for one in (True, False)
    )
    log: Any = SimpleNamespace(contacts={"left": stands, "right": hangs})
    assert _feet_notes(robot, [log]) == [
        Note("foot_never_stands", "warning", "the right foot carries no load in any log"),
        Note("no_double_support", "info", "no log has both feet on the ground: slip cannot be checked"),
    ]


def test_delays_are_those_of_the_feet_where_they_differ() -> None:
    apart = SimpleNamespace(delay=0.004, std=0.001, feet={"left": 0.003, "right": 0.005})
    ready: Any = SimpleNamespace(sensor_delay=apart)
    assert _delays(ready) == [Found("left", 0.003, 0.001), Found("right", 0.005, 0.001)]
    apart.feet = {}
    assert _delays(ready) == [Found("", 0.004, 0.001)]


def test_pitch_shows_how_far_a_bush_is_forward_and_roll_how_far_aside() -> None:
    """A moment arm in pitch is backward of the place; heights are both axes'."""
    std = (0.001, 0.002, None, None, None, None)
    fits = [
        fit_of(moment_arms=(0.01, 0.03), place_std=std),
        fit_of(axis="roll", moment_arms=(0.02, 0.03), place_std=(0.004, 0.008, None, None, None, None)),
        fit_of("right", moment_arms=(0.5, 0.6), place_std=std),
    ]
    x, y, z = _places("left", fits)
    assert x == ("left x", -0.01, 0.001)
    assert y == ("left y", 0.02, 0.004)
    assert z == ("left z", pytest.approx(0.03), pytest.approx(0.002))
    assert [one.what for one in _places("right", fits)] == ["right x", "right z"]
    assert _places("other", fits) == []


def test_the_imu_is_turned_the_other_way_than_what_puts_it_right() -> None:
    """By steps where these told it, with their deviations, else by all axes together."""
    turn = SimpleNamespace(angles=(0.01, 0.0, -0.02), covariance=np.diag([1e-6, 4e-6, 9e-6]))
    ready: Any = SimpleNamespace(imu_turn=turn)
    assert [(one.what, one.value, pytest.approx(one.std)) for one in _turns(ready, [])] == [
        ("x", -0.01, 0.001), ("y", 0.0, 0.002), ("z", 0.02, 0.003)
    ]  # fmt: skip
    turn.angles = (0.0, 0.0, 0.0)
    fits = [
        fit_of(imu_turned=(0.1, 0.2, 0.3), place_std=(None, None, None, None, 0.02, 0.03)),
        fit_of(imu_turned=(0.1, 0.2, 0.3), place_std=(None, None, None, None, 0.05, None)),
    ]
    found = _turns(ready, fits)
    assert [(one.what, pytest.approx(one.value), one.std) for one in found] == [
        ("y", -0.2, 0.02),
        ("z", -0.3, 0.03),
    ]


def test_axes_that_agree_are_as_sure_as_the_surest_and_others_as_they_differ() -> None:
    assert _together("z", []) == []
    assert _together("z", [(1.0, None), (3.0, None)]) == [Found("z", 2.0, None)]
    (alike,) = _together("z", [(1.0, 0.2), (1.0, 0.1), (9.0, None)])
    assert alike == ("z", pytest.approx(1.0), 0.1)
    (apart,) = _together("z", [(1.0, 0.1), (2.0, 0.2)])
    mean = (1.0 * 4 + 2.0) / 5
    scatter = np.sqrt(((1.0 - mean) / 0.1) ** 2 + ((2.0 - mean) / 0.2) ** 2)
    assert apart == ("z", pytest.approx(mean), pytest.approx(0.1 * scatter))


def test_a_width_is_that_of_its_causes_where_it_is_widest() -> None:
    def row(name: str, percent: float, **shares: float) -> Any:
        return SimpleNamespace(name=name, half_width_percent=percent, variance_shares=shares)

    rows = [
        row("stiffness", 10.0, a=0.09, b=0.16, c=0.5), row("stiffness", 8.0, a=0.36), row("damping", 99.0, a=1.0)
    ]  # fmt: skip
    assert _width(rows, "stiffness", ("a", "b")) == pytest.approx(max(10 * 0.5, 8 * 0.6))
    assert _width(rows, "stiffness", ("b",)) == pytest.approx(4.0)
    assert _width(rows, "stiffness", ()) is None
    assert _width([], "stiffness", ("a",)) is None

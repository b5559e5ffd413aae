"""What makes a bush passive, and which shapes are tried for a motion: by value."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.models import MODELS, BushMotion

TIME = 0.01 * np.arange(2000)
SWAY = BushMotion(0.03 * np.sin(2 * np.pi * 0.5 * TIME), 0.03 * np.pi * np.cos(2 * np.pi * 0.5 * TIME), 0.01)


@pytest.mark.parametrize("name", MODELS)
def test_a_bush_is_a_spring_that_makes_no_energy(name: str) -> None:
    """A stiffness above zero, and no term that dissipates below it; damper and hardening may be negative."""
    model = MODELS[name]
    dissipates = {"slip_torque", "coulomb", "relaxing"} & set(model.terms)
    for place, term in enumerate(model.terms):
        for value in (1e-9, 0.0, -1e-9):
            values = np.ones(len(model.terms))
            values[place] = value
            least = 1e-9 if term == "stiffness" else 0.0 if term in model.dissipative_terms else -1.0
            assert model.possible(values) == (value >= least), (term, value)
    assert dissipates <= set(model.dissipative_terms)


def test_slip_angles_are_tried_from_dry_friction_to_what_hardly_slips() -> None:
    """Of half of the widest swing less a hundredth: 14 in equal ratios up to half of it, 14 in equal steps beyond."""
    found = MODELS["elastoplastic"].candidates([SWAY])[:, 0]
    reach = 0.5 * np.ptp(np.percentile(SWAY.deflection, [0.5, 99.5]))
    assert found[:14] == pytest.approx(reach * 0.02 * 25 ** (np.arange(14) / 13))
    assert found[14:] == pytest.approx(reach * (0.5 + 0.8 * np.arange(1, 15) / 14))
    still = BushMotion(np.zeros(100), np.zeros(100), 0.01)
    assert MODELS["elastoplastic"].candidates([still])[[0, -1], 0] == pytest.approx([0.02, 1.3])


def test_an_element_was_loaded_from_rest_to_where_a_run_begins() -> None:
    holed = BushMotion(np.array([0.004, 0.0, np.nan, -0.03, 0.0]), np.zeros(5), 0.01)
    found = MODELS["elastoplastic"].initial_states(holed, np.array([0.01]))
    assert found == pytest.approx([0.4, -1.0])
    assert MODELS["kelvin_voigt"].initial_states(holed, np.zeros(0)) == pytest.approx([0.0, 0.0])


def test_friction_turns_over_a_share_of_the_fast_rate() -> None:
    found = MODELS["coulomb"].candidates([SWAY])[:, 0]
    fast = np.percentile(np.abs(SWAY.rate), 98)
    assert found == pytest.approx(fast * 0.003 * 100 ** (np.arange(9) / 8))


@pytest.mark.parametrize("name", ["elastoplastic", "iwan"])
def test_a_slip_angle_beyond_four_fifths_of_the_swing_is_hardly_shown(name: str) -> None:
    model = MODELS[name]
    shapes = model.candidates([SWAY])
    limits = np.array([shapes.min(axis=0), shapes.max(axis=0)])
    for share, shown in ((0.79, True), (0.81, False)):
        shape = limits[1].copy()
        shape[0] = share * SWAY.swing
        assert (model.hardly_shown(shape, limits) is None) == shown


def test_relaxation_is_tried_from_a_damper_to_a_tenth_of_the_longest_run() -> None:
    """Of all runs of all motions; of short ones up to a fifth of a second."""
    short = BushMotion(np.zeros(100), np.zeros(100), 0.01)
    holed = BushMotion(np.where(np.arange(2000) == 1500, np.nan, SWAY.deflection), SWAY.rate, 0.01)
    found = MODELS["standard_linear_solid"].candidates([short, holed, short])[:, 0]
    assert found == pytest.approx(0.05 * (1.5 / 0.05) ** (np.arange(12) / 11))
    assert MODELS["standard_linear_solid"].candidates([short])[-1, 0] == pytest.approx(0.2)

"""Every law of the bush under one set of demands, against integrations made step by step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from scipy import signal

from bush_data_sets import bouc_wen_step
from plantar.conventions import AXES
from plantar.errors import DataError
from plantar.models import BESIDE, MODELS, BoucWen, BushModel, BushMotion, Coulomb, StandardLinearSolid, reach

PERIOD = 0.005
# Shapes and linear parameters of a bush that can exist, law by law.
EXAMPLES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "kelvin_voigt": ((), (430.0, 16.0)),
    "hardening": ((), (430.0, 16.0, 5000.0)),
    "coulomb": ((0.02,), (430.0, 16.0, 3.0)),
    "elastoplastic": ((0.012,), (430.0, 16.0, 5.0)),
    "hardening_elastoplastic": ((0.012,), (430.0, 16.0, 5.0, 5000.0)),
    "iwan": ((0.008,), (430.0, 16.0, 5.0)),
    "bouc_wen": ((0.01, 1.7), (430.0, 16.0, 5.0)),
    "standard_linear_solid": ((0.4,), (430.0, 16.0, 120.0)),
    "coupled": ((), (430.0, 16.0, 25.0, 2.0)),
}
HYSTERETIC = ("elastoplastic", "hardening_elastoplastic", "iwan", "bouc_wen")


def path(seed: int = 0, seconds: float = 12.0, size: float = 0.05) -> np.ndarray:
    """A periodic deflection (its second half repeats the first), with reversals of every size."""
    rng = np.random.default_rng(seed)
    half = round(seconds / 2 / PERIOD)
    time = np.arange(2 * half) * PERIOD
    cycles = np.array([1, 2, 3, 5, 8, 13])
    angles = 2 * np.pi * np.outer(time / (half * PERIOD), cycles) + rng.uniform(0, 2 * np.pi, len(cycles))
    return size * np.sin(angles) @ (rng.uniform(0.3, 1, len(cycles)) / cycles)


def rate_of(deflection: np.ndarray, period: float = PERIOD) -> np.ndarray:
    """Exact derivative of a periodic deflection that is smooth."""
    spectrum = np.fft.rfft(deflection)
    return np.fft.irfft(2j * np.pi * np.fft.rfftfreq(len(deflection), period) * spectrum, len(deflection))


def motion(deflection: np.ndarray, period: float = PERIOD, other: np.ndarray | None = None) -> BushMotion:
    other = path(seed=7) if other is None else other
    return BushMotion(
        deflection, rate_of(deflection, period), period, other[:, None], rate_of(other, period)[:, None]
    )


@pytest.fixture(params=sorted(MODELS))
def model(request: pytest.FixtureRequest) -> BushModel:
    return MODELS[request.param]


def torque(model: BushModel, moved: BushMotion, initial_states: Sequence[float] | None = None) -> np.ndarray:
    shape, values = EXAMPLES[model.name]
    return model.columns(
        moved, shape, None if initial_states is None else np.array(initial_states)
    ) @ np.array(values)


def test_terms_start_with_spring_and_damper_and_have_units(model: BushModel) -> None:
    assert model.terms[:2] == BESIDE
    assert model.name == next(name for name, each in MODELS.items() if each is model)
    for axis in AXES:
        assert all(model.unit(term, axis) for term in (*model.terms, *model.shape_terms))
    assert set(model.dissipative_terms) <= set(model.terms)
    assert {term for term, _ in model.blind_ends} <= set(model.shape_terms)
    assert model.size == len(model.terms) + len(model.shape_terms)


def test_columns_have_their_shape_and_the_linear_ones_come_first(model: BushModel) -> None:
    moved = motion(path())
    columns = model.columns(moved, EXAMPLES[model.name][0])
    assert columns.shape == (len(moved), len(model.terms))
    np.testing.assert_array_equal(columns[:, 0], moved.deflection)
    np.testing.assert_array_equal(columns[:, 1], moved.rate)


def test_candidates_span_the_motions(model: BushModel) -> None:
    small, large = model.candidates([motion(path())]), model.candidates([motion(2 * path())])
    assert small.shape[1] == len(model.shape_terms)
    assert np.all(small > 0)
    if model.name in HYSTERETIC:
        np.testing.assert_allclose(large[:, 0], 2 * small[:, 0])
        # Twice the reach: from one end of its state an element just slips at the other end of the path.
        assert reach([motion(path())]) < small[:, 0].max() < 2 * reach([motion(path())])


def test_rest_gives_no_torque(model: BushModel) -> None:
    still = np.zeros(400)
    np.testing.assert_array_equal(torque(model, motion(still, other=still)), 0.0)


def test_mirrored_motion_gives_mirrored_torque(model: BushModel) -> None:
    moved, other = path(), path(seed=7)
    initial_states = [0.3]
    plus = torque(model, motion(moved, other=other), initial_states)
    minus = torque(model, motion(-moved, other=-other), [-0.3])
    np.testing.assert_allclose(minus, -plus, atol=1e-9)


def test_no_energy_comes_out_of_a_closed_cycle(model: BushModel) -> None:
    """Work put in over the second of two equal cycles; for the coupled law over both axes together."""
    moved, other = path(seed=3), path(seed=4)
    cycle = slice(len(moved) // 2, None)
    work = np.sum((torque(model, motion(moved, other=other)) * rate_of(moved))[cycle]) * PERIOD
    if model.name == "coupled":
        work += np.sum((torque(model, motion(other, other=moved)) * rate_of(other))[cycle]) * PERIOD
    damped = EXAMPLES[model.name][1][1] * np.sum(rate_of(moved)[cycle] ** 2) * PERIOD
    assert work > 0.9 * damped
    if model.dissipative_terms:
        assert work > 1.05 * damped


def test_negative_friction_is_not_possible(model: BushModel) -> None:
    values = np.array(EXAMPLES[model.name][1])
    assert model.possible(values)
    for term in model.dissipative_terms:
        worse = values.copy()
        worse[model.terms.index(term)] *= -1
        assert not model.possible(worse)


def test_gaps_part_the_runs_and_memory_starts_anew(model: BushModel) -> None:
    whole = motion(path())
    assert whole.across is not None
    assert whole.across_rate is not None
    hole = whole.deflection.copy()
    hole[1000:1010] = np.nan
    parted = BushMotion(hole, whole.rate, PERIOD, whole.across, whole.across_rate)
    initial_states = np.array([0.4, -0.7])
    columns = model.columns(parted, EXAMPLES[model.name][0], initial_states)
    assert np.isnan(columns[1000:1010]).all()
    tail = slice(1010, None)
    alone = BushMotion(hole[tail], whole.rate[tail], PERIOD, whole.across[tail], whole.across_rate[tail])
    if model.name == "standard_linear_solid":  # its start is a share of the motion's reach
        initial_states = initial_states * reach([parted]) / reach([alone])
    np.testing.assert_allclose(
        columns[tail], model.columns(alone, EXAMPLES[model.name][0], initial_states[1:]), atol=1e-12
    )


def test_variants_side_by_side_are_those_one_by_one(model: BushModel) -> None:
    moved = motion(path())
    shapes = np.array([np.array(EXAMPLES[model.name][0]) * scale for scale in (1.0, 1.3, 2.0)])
    initial_states = np.array([[0.1], [-0.5], [0.9]])
    together = model.basis_columns(moved, shapes, initial_states)
    for variant, (shape, start) in enumerate(zip(shapes, initial_states, strict=True)):
        alone = model.columns(moved, shape, start)[:, 2:]
        np.testing.assert_allclose(together[:, :, variant], alone, atol=1e-12)


@pytest.mark.parametrize("name", [*HYSTERETIC, "hardening"])
def test_speed_does_not_matter_without_rates(name: str) -> None:
    slow, fast = motion(path()), motion(path(), period=PERIOD / 7)
    shape = EXAMPLES[name][0]
    np.testing.assert_allclose(
        MODELS[name].columns(slow, shape)[:, 2], MODELS[name].columns(fast, shape)[:, 2]
    )


@pytest.mark.parametrize("name", HYSTERETIC)
def test_a_hysteretic_state_depends_on_deflection_over_slip_angle_only(name: str) -> None:
    shape = np.array(EXAMPLES[name][0])
    wide = shape.copy()
    wide[0] *= 3
    small = MODELS[name].columns(motion(path()), shape)[:, 2]
    np.testing.assert_allclose(MODELS[name].columns(motion(3 * path()), wide)[:, 2], small, atol=1e-9)


@pytest.mark.parametrize("name", HYSTERETIC)
def test_a_hysteretic_state_starts_as_a_spring_and_ends_at_one(name: str) -> None:
    shape = np.array(EXAMPLES[name][0])
    ramp = np.linspace(0, 30 * shape[0], 60_001)
    state = MODELS[name].columns(BushMotion(ramp, np.ones_like(ramp), PERIOD), shape)[:, 2]
    assert state[1] / ramp[1] == pytest.approx(1 / shape[0], rel=0.01)
    assert state[-1] == pytest.approx(1.0, abs=1e-6)
    assert np.all(np.diff(state) >= -1e-12)


@pytest.mark.parametrize("start", [-1.0, -0.4, 0.0, 0.8])
def test_jenkins_element_against_a_stepped_one(start: float) -> None:
    moved, state, states = np.repeat(path(), 2), start, []  # a pause after every sample
    for step in np.diff(moved, prepend=moved[0]) / 0.012:
        state = min(max(state + step, -1.0), 1.0)
        states.append(state)
    found = MODELS["elastoplastic"].columns(motion(moved), [0.012], np.array([start]))[:, 2]
    np.testing.assert_allclose(found, states, atol=1e-11)


def test_iwan_elements_against_stepped_ones() -> None:
    moved = path()
    ratios = (np.arange(8) + 0.5) / 4
    states, torques = np.zeros(8), []
    for step in np.diff(moved, prepend=moved[0]):
        states = np.clip(states + step / (ratios * 0.008), -1, 1)
        torques.append(np.mean(ratios * states))
    np.testing.assert_allclose(MODELS["iwan"].columns(motion(moved), [0.008])[:, 2], torques, atol=1e-11)


@pytest.mark.parametrize("sharpness", [1.0, 1.7, 4.0])
def test_bouc_wen_against_a_stepped_one(sharpness: float) -> None:
    moved, state, states, substeps = path(), -0.3, [], 12
    for step in np.diff(moved, prepend=moved[0]) / 0.01:
        for _ in range(substeps):
            state = bouc_wen_step(state, step / substeps, sharpness)
        states.append(state)
    found = BoucWen().columns(motion(moved), [0.01, sharpness], np.array([-0.3]))[:, 2]
    np.testing.assert_allclose(found, states, atol=2e-6)


def test_relaxing_spring_against_a_state_space_simulation() -> None:
    moved, time = path(), 0.4
    start = 0.2 * reach([motion(moved)])
    # The state w with ẇ = -w/τ + q gives x = q - w/τ; its start follows from x(0).
    system = signal.StateSpace([[-1 / time]], [[1.0]], [[-1 / time]], [[1.0]])
    _, expected, _ = signal.lsim(
        system, moved, np.arange(len(moved)) * PERIOD, X0=[(moved[0] - start) * time], interp=True
    )
    found = StandardLinearSolid().columns(motion(moved), [time], np.array([0.2]))[:, 2]
    np.testing.assert_allclose(found, expected, atol=1e-8)


def test_coulomb_friction_follows_the_sign_of_a_fast_rate() -> None:
    moved = motion(path())
    column = Coulomb().columns(moved, [1e-4])[:, 2]
    fast = np.abs(moved.rate) > 1e-3
    np.testing.assert_allclose(column[fast], np.sign(moved.rate[fast]))


def test_a_loaded_element_starts_where_its_load_put_it() -> None:
    model = MODELS["elastoplastic"]
    lean = motion(path() - path()[0] + 0.004)
    assert model.initial_states(lean, np.array([0.01])) == pytest.approx([0.4])
    assert model.initial_states(lean, np.array([0.001])) == pytest.approx([1.0])


def test_the_coupled_law_asks_for_the_other_axis() -> None:
    alone = BushMotion(path(), rate_of(path()), PERIOD)
    assert not MODELS["coupled"].applies([alone])
    with pytest.raises(DataError, match=r"^the coupled model needs the deflection of the foot's other axis$"):
        MODELS["coupled"].columns(alone)


def test_the_reach_is_half_of_the_widest_swing_less_a_hundredth() -> None:
    """Half of a per cent of the samples at either end may be noise."""
    ramp, still = np.linspace(-1.0, 3.0, 1001), np.zeros(1001)
    motion = BushMotion(np.concatenate([ramp, [np.nan], 0.1 * ramp]), np.zeros(2003), 0.01)
    assert reach([BushMotion(still, still, 0.01), motion]) == pytest.approx(0.99 * 2.0)


def test_relaxation_is_looked_for_between_a_damper_and_drift() -> None:
    """From 50 ms to a tenth of the longest run, in equal ratios; of short runs to four times the least."""
    model = MODELS["standard_linear_solid"]
    for seconds, slowest in ((40.0, 4.0), (1.0, 0.2)):
        count = round(seconds / 0.01)
        motion = BushMotion(0.01 * np.sin(np.linspace(0, 9, count)), np.zeros(count), 0.01)
        times = model.candidates([motion])[:, 0]
        assert times[[0, -1]] == pytest.approx([0.05, slowest])
        assert np.ptp(np.diff(np.log(times))) < 1e-9

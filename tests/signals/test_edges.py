"""Each limit of the signals' clean-up, tried just inside and just outside on small signals made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog
from plantar.signals.dropouts import dropouts_of, dropped_samples
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.footfalls import footfalls
from plantar.signals.gyroscope_delay import gyroscope_delay, of_a_filter
from plantar.signals.held import held_samples
from plantar.signals.resampling import evenly_sampled, sampling, without_holes
from plantar.signals.segments import longest_run, run_ends, run_numbers, steps_in
from plantar.signals.thinning import step_of, thinned

STEPS = np.tile([0.0, 1.0], 1000)  # every step is 1
FORCES = [f"wrench.{foot}.force.{axis}" for foot in ("left", "right") for axis in "xyz"]


def log_of(values: Array, period: float = 0.01, name: str = "imu.chest.angular_velocity.x") -> MotionLog:
    return MotionLog("log", period * np.arange(len(values)), {name: values})


def noise(count: int) -> Array:
    return np.random.default_rng(0).normal(0.0, 1.0, count)


@pytest.mark.parametrize(
    ("period", "repeats", "count", "held"),
    [(0.01, 19, 2000, False), (0.01, 20, 2000, True), (0.05, 9, 1000, False), (0.05, 10, 1000, True),
     (0.01, 20, 4150, True), (0.01, 20, 4250, False)],
)  # fmt: skip
def test_a_value_is_held_a_fifth_of_a_second_ten_samples_and_half_a_per_cent_of_the_log(
    period: float, repeats: int, count: int, held: bool
) -> None:
    values = noise(count)
    values[300 : 301 + repeats] = 0.3
    assert held_samples(values, period).sum() == (repeats + 1) * held


@pytest.mark.parametrize(("repeats", "held"), [(9, False), (10, True)])
def test_a_full_scale_is_repeated_ten_times(repeats: int, held: bool) -> None:
    """Then a pair of samples there is held as well; of a quaternion's component nothing is a full scale."""
    for limit in (5.0, -5.0):
        values = noise(2000)
        values[300 : 301 + repeats] = values[700:702] = limit
        assert held_samples(values, 0.01).sum() == (repeats + 3) * held
        assert not held_samples(values, 0.01, full_scale=False).any()


@pytest.mark.parametrize(("share", "held"), [(0.89, False), (0.91, True)])
def test_a_channel_changes_nine_times_of_ten(share: float, held: bool) -> None:
    values = noise(2000)
    values[1:][np.arange(1999) % 100 >= 100 * share] = np.nan
    values = values[np.maximum.accumulate(np.where(np.isfinite(values), np.arange(2000), 0))]
    values[300:330] = 0.3
    assert held_samples(values, 0.01).any() == held


@pytest.mark.parametrize(
    ("low", "samples", "changes"),
    [(0.11, 50, []), (0.09, 50, [299, 349]), (0.0, 2, []), (0.0, 3, [299, 302])],
)
def test_a_foot_lands_at_a_tenth_of_its_largest_force_for_three_samples(
    low: float, samples: int, changes: list[int]
) -> None:
    force = np.full(1000, 300.0)
    force[300 : 300 + samples] = 300.0 * low
    log = MotionLog("log", 0.01 * np.arange(1000), dict.fromkeys(FORCES, np.zeros(1000)) | {FORCES[2]: force})
    assert list(footfalls(log, "left")) == changes


@pytest.mark.parametrize(
    ("late", "std", "told"),
    [(0.00049, 0.0, False), (0.00051, 0.0, True), (-0.0049, 0.0, True), (-0.0051, 0.0, False),
     (0.003, 0.00099, True), (0.003, 0.00101, False)],
)  # fmt: skip
def test_a_filter_s_delay(late: float, std: float, told: bool) -> None:
    assert of_a_filter(late, std) == told


@pytest.mark.parametrize(("samples", "told"), [(499, False), (501, True)])
def test_a_gyroscope_s_delay_takes_five_seconds_without_a_hole(samples: int, told: bool) -> None:
    time = 0.01 * np.arange(samples)
    turning = np.sin(2 * np.pi * 1.3 * time[:, None] + [0, 1, 2])
    late = np.sin(2 * np.pi * 1.3 * (time[:, None] - 0.002) + [0, 1, 2])
    found = gyroscope_delay(late, turning, 0.01)
    assert (found is not None) == told
    if found is not None:
        assert found.late == pytest.approx(0.002, rel=0.01)
        assert found.explained > 0.99
    assert gyroscope_delay(np.ones_like(late), np.ones_like(late), 0.01) is None


def switched(values: Array, stretches: int) -> Array:
    """The values with so many stretches of five zeros."""
    out = values.copy()
    for place in range(stretches):
        out[100 + 50 * place : 105 + 50 * place] = 0.0
    return out


TWITCH = np.where(np.arange(2000) % 5 < 2, STEPS, 0.0)  # four of ten steps are 1


@pytest.mark.parametrize(
    ("values", "stretches"),
    [
        (switched(np.full(2000, 0.0095), 2), 0),
        (switched(np.full(2000, -0.0105), 2), 2),
        (switched(np.full(2000, 0.0105), 1), 0),
        (switched(0.095 + 0.01 * STEPS, 2), 0),  # nearer than ten steps
        (switched(0.105 + 0.01 * STEPS, 2), 2),
        (switched(0.05 + 0.02 * TWITCH + 5e-8 * STEPS, 3), 0),  # the smaller steps are rounding
        (switched(0.05 + 0.02 * TWITCH + 2e-7 * STEPS, 3), 3),
    ],
)
def test_zeros_between_jumps_of_ten_steps_and_a_hundredth(values: Array, stretches: int) -> None:
    assert dropped_samples(values).sum() == 7 * stretches  # and a sample on either side


@pytest.mark.parametrize(("slow", "dropped"), [(2, True), (3, False)])
def test_as_many_stretches_jump_as_are_passed_slowly(slow: int, dropped: bool) -> None:
    values = switched(np.full(2000, 0.3), 2)
    for place in range(slow):
        values[1000 + 100 * place : 1061 + 100 * place] = np.abs(np.arange(-30, 31)) / 100
    assert dropped_samples(values).any() == dropped


@pytest.mark.parametrize(("rest", "dropped"), [(0.73, True), (0.77, False)])
def test_a_silent_force_sensor_lost_a_quarter_of_the_load(rest: float, dropped: bool) -> None:
    silent = switched(np.ones(2000), 3) == 0
    columns = dict.fromkeys(FORCES, np.zeros(2000))
    columns |= {FORCES[2]: np.where(silent, 0.0, 300.0), FORCES[5]: np.where(silent, 600.0 * rest, 300.0)}
    assert bool(dropouts_of(MotionLog("log", 0.01 * np.arange(2000), columns))) == dropped


def stepped(*steps: float, period: float = 0.01) -> MotionLog:
    """After the first fifty periods these steps, in periods."""
    time = period * np.cumsum([0.0, *[1.0] * 50, *steps, *[1.0] * 50])
    return MotionLog("log", time, {"joint.a.position": time})


def test_a_log_s_sampling_by_hand() -> None:
    found = sampling(stepped(1.3, 0.7, 3.4, 3.6))
    assert found.rate == pytest.approx(100)
    assert found.jitter == pytest.approx(0.01 * np.sqrt((0.09 + 0.09 + 2.4**2) / 103))
    assert found.gaps == ((pytest.approx(0.554), pytest.approx(0.59)),)


@pytest.mark.parametrize(("step", "even"), [(1.24, True), (1.26, False)])
def test_samples_stand_evenly_up_to_a_quarter_of_a_period(step: float, even: bool) -> None:
    log = stepped(step, 2 - step)
    assert (evenly_sampled(log) is log) == even
    assert even or "put on an even grid of 100 Hz" in evenly_sampled(log).notes[-1].text


@pytest.mark.parametrize(("gap", "rows"), [(1270, 1371), (1290, 106)])
def test_a_gap_of_ten_seconds_is_not_spelled_out(gap: float, rows: int) -> None:
    grid = evenly_sampled(stepped(gap, period=1 / 128))
    assert len(grid) == rows
    assert np.isfinite(grid.column("joint.a.position")).sum() == 102


@pytest.mark.parametrize(
    ("period", "missing", "filled", "limit"), [(1 / 128, 4, True, 40), (1 / 128, 5, False, 40), (0.02, 1, True, 50),
                                              (0.02, 2, False, 50)],
)  # fmt: skip
def test_holes_of_forty_milliseconds_or_two_periods_are_filled(
    period: float, missing: int, filled: bool, limit: int
) -> None:
    values = np.arange(200.0)
    values[50 : 50 + missing] = np.nan
    log = without_holes(log_of(values, period))
    assert np.array_equal(log.column("imu.chest.angular_velocity.x"), np.arange(200.0)) == filled
    assert not filled or f"holes of at most {limit} ms filled" in log.notes[-1].text


@pytest.mark.parametrize(
    ("rate", "step"), [(199.0, 1), (399.0, 1), (400.0, 2), (599.0, 2), (600.0, 3), (1000.0, 5)]
)
def test_two_hundred_samples_a_second_are_kept(rate: float, step: int) -> None:
    assert step_of(log_of(np.zeros(10), 1 / rate)) == step


def test_thinning_halves_a_tone_at_eight_tenths_of_what_is_kept() -> None:
    log = thinned(log_of(np.sin(2 * np.pi * 80.0 * 1e-3 * np.arange(4000)), 1e-3))
    middle = log.column("imu.chest.angular_velocity.x")[200:600]
    assert np.sqrt(2) * np.std(middle) == pytest.approx(0.5, rel=0.02)
    text = "log: 1000 Hz; one in 5 samples of the filtered signals is used (200 Hz)"
    assert log.notes[-1].text == text


@pytest.mark.parametrize(("cutoff", "changed"), [(47.3, True), (47.7, False)])
def test_a_cutoff_near_half_the_rate_changes_nothing(cutoff: float, changed: bool) -> None:
    assert np.array_equal(low_pass(noise(500), 0.01, cutoff), noise(500)) != changed


def test_differences_are_of_fourth_order_inside_second_beside_the_ends_and_first_there() -> None:
    time = 0.1 * np.arange(9)
    for power, right in ((4, slice(2, -2)), (2, slice(1, -1)), (1, slice(None))):
        slope = differentiate(time**power, 0.1)
        assert slope[right] == pytest.approx(power * time[right] ** (power - 1), abs=1e-12)
    holed = np.where(time == time[4], np.nan, time)
    assert differentiate(holed, 0.1)[[2, 6]] == pytest.approx([1.0, 1.0])
    assert differentiate(time[:4] ** 2, 0.1) == pytest.approx([0.1, 0.2, 0.4, 0.5])
    assert differentiate(time[:1], 0.1) == pytest.approx([0.0])


def test_segments_by_hand() -> None:
    valid = np.array([1, 1, 0, 1, 1, 0, 0, 1], dtype=bool)
    assert longest_run(valid) == slice(0, 2), "the first of two"
    assert longest_run(~valid) == slice(5, 7)
    assert longest_run(np.zeros(3, dtype=bool)) == slice(0, 0)
    assert list(run_numbers(valid)) == [0, 0, -1, 1, 1, -1, -1, 2]
    long = np.array([1] * 5 + [0] + [1] * 2, dtype=bool)
    assert list(run_ends(long, 2)) == [True, True, False, True, True, False, True, True]
    assert [steps_in(*pair) for pair in ((0.1, 0.01), (0.014, 0.01), (0.016, 0.01), (0.001, 0.01))] == [
        10,
        1,
        2,
        1,
    ]

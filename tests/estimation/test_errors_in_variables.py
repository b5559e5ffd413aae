"""Noise put on angles and rates: it draws stiffness and damping towards zero, and that is given back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot
from plantar.conventions import Array
from plantar.estimation import Block, fit_linear
from plantar.estimation.blocks import StanceRows
from plantar.estimation.errors_in_variables import (
    attenuation,
    noise_after_filter,
    offsets_moved,
    slow_attenuation,
    slow_share,
)
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.signals.filters import differentiate, low_pass

PERIOD, CUTOFF = 0.005, 5.0
VALUES = np.array([400.0, 20.0])


def signals(seed: int, samples: int = 12000) -> Array:
    """Deflection and rate of a slow sway, (N, 2)."""
    time = PERIOD * np.arange(samples)
    phase = np.random.default_rng(seed).uniform(0, 2 * np.pi)
    angle, omega = 0.02, 2 * np.pi * 0.3
    return angle * np.column_stack([np.sin(omega * time + phase), omega * np.cos(omega * time + phase)])


@pytest.mark.parametrize(
    ("drawn", "beside", "share"),
    [
        (0.5, 0.0, 0.5),  # two sines of one size: the error is half of the square of what is read
        (0.1, 0.0, 0.1),
        (0.0, 200.0, 0.0),  # stiffer by half
        (0.0, -800.0, 0.0),  # reversed
        (0.0, -40.0, 0.01),  # a tenth softer: an error of a hundredth of the square would do it
    ],
)
def test_what_slow_errors_may_have_drawn_a_value_by(drawn: float, beside: float, share: float) -> None:
    """Of a torque of K·angle, read beside an error of another frequency that holds `drawn` of the square of what is
    read; or of another stiffness."""
    time = PERIOD * np.arange(12000)
    true, error = np.sin(2 * np.pi * 0.25 * time), np.sin(2 * np.pi * 0.15 * time)
    angle = 0.01 * (np.sqrt(1 - drawn) * true + np.sqrt(drawn) * error)
    rate = differentiate(angle[:, None], PERIOD)[:, 0]
    torque = 400.0 * 0.01 * np.sqrt(1 - drawn) * true + beside * angle
    one = Block("sway", np.column_stack([angle, rate]), torque, PERIOD)
    left = torque - 400.0 * angle
    assert slow_share(one, left, 400.0) == pytest.approx(share, rel=0.05, abs=1e-4)


def test_of_one_offset_all_that_goes_along_parabolas_of_stances_may_be_taken() -> None:
    """By hand: least squares with one offset, what they leave, and a parabola through it in each of four stances."""
    random, count = np.random.default_rng(7), 400
    x = np.column_stack([random.standard_normal(count).cumsum() / 10, random.standard_normal(count)])
    y = x @ VALUES + 3.0 + random.standard_normal(count).cumsum() / 5
    number = np.repeat(np.arange(4), count // 4)
    one = Block("walk", x, y, PERIOD, stances=StanceRows(number, np.ones(count)))
    whole = np.column_stack([x, np.ones(count)])
    left = y - whole @ np.linalg.lstsq(whole, y, rcond=None)[0]
    beside = 0.0
    for stance in range(4):
        own, time = left[number == stance], np.arange(count // 4)
        beside += float(np.sum((own - np.polyval(np.polyfit(time, own, 2), time)) ** 2))
    wanted = np.linalg.inv(whole.T @ whole)[:2, 0] * (left @ left - beside) / 400.0
    assert slow_attenuation([one], 400.0, shared_offset=True) == pytest.approx(wanted)
    assert slow_attenuation([one], 400.0) != pytest.approx(wanted, rel=0.1), "each stance has its own"


def behind_filter(values: Array) -> float:
    """Variance behind the filter, which answers to the ends of a recording."""
    return float(low_pass(values, PERIOD, CUTOFF)[500:-500].var())


def block(seed: int, sizes: tuple[float, float]) -> Block:
    """Torque of a known spring and damper, and a regressor with white noise, both through the filter."""
    random = np.random.default_rng(100 + seed)
    true = signals(seed)
    noisy = true + random.standard_normal(true.shape) * sizes
    torque = (true @ VALUES + 0.05 * random.standard_normal(len(true)))[:, None]
    noise = noise_after_filter(noisy[:, :1], noisy[:, 1:], torque, PERIOD, CUTOFF).ravel()
    response = low_pass(torque, PERIOD, CUTOFF)[:, 0]
    return Block(str(seed), low_pass(noisy, PERIOD, CUTOFF), response, PERIOD, noise=noise)


def test_noise_is_measured_above_the_motion_and_followed_through_the_filter() -> None:
    sizes, random = np.array([0.01, 0.1]), np.random.default_rng(5)
    white, torque = sizes * random.standard_normal((200_000, 2)), random.standard_normal((200_000, 1))

    def measured(raw: Array, every: int = 1) -> Array:
        (angle, rate), other = raw[::every].T[:, :, None], torque[: len(raw) : every]
        return noise_after_filter(angle, rate, other, every * PERIOD, CUTOFF).ravel()

    expected = low_pass(white, PERIOD, CUTOFF).var(axis=0)
    np.testing.assert_allclose(measured(white), expected, rtol=0.05)
    np.testing.assert_allclose(measured(white[:12000] + signals(1)), expected, rtol=0.15)
    assert not measured(signals(1)).max() > 1e-12, "a smooth motion is no noise"
    assert not measured(white, every=10).any(), "too slow to tell"


def test_what_rings_at_one_frequency_is_no_white_noise() -> None:
    """Of two bands, just below and above 20 Hz, the quieter one tells."""
    random = np.random.default_rng(6)
    white, torque = 0.01 * random.standard_normal((100_000, 1)), random.standard_normal((100_000, 1))
    quiet = 1e-6 * random.standard_normal((100_000, 1))

    def of_both(noise: Array) -> Array:
        return np.array([noise_after_filter(*each, torque, PERIOD, CUTOFF)[place, 0]
                         for place, each in enumerate([(noise, quiet), (quiet, noise)])])  # fmt: skip

    plain = of_both(white)
    for frequency in (15.0, 45.0):
        ringing = 0.05 * np.sin(2 * np.pi * frequency * PERIOD * np.arange(len(white)))[:, None]
        rung = of_both(white + ringing)
        np.testing.assert_allclose(rung, plain, rtol=0.2, err_msg=f"{frequency} Hz")


def test_a_foot_that_shakes_with_its_torque_is_no_noise() -> None:
    random = np.random.default_rng(7)
    shaking = low_pass(random.standard_normal((40_000, 1)), PERIOD, 30.0)
    angles = shaking, np.gradient(shaking, PERIOD, axis=0)
    noise = noise_after_filter(
        *angles, shaking * 5 + 0.1 * random.standard_normal(shaking.shape), PERIOD, CUTOFF
    )
    alone = noise_after_filter(*angles, random.standard_normal(shaking.shape), PERIOD, CUTOFF)
    assert (noise < 0.05 * alone).all()


@pytest.mark.parametrize("band", [30.0, 60.0])
@pytest.mark.parametrize("seed", [8, 9, 10])
def test_noise_of_encoders_that_were_differentiated_is_not_white(band: float, seed: int) -> None:
    """It grows with frequency: carried down from above as white noise it would be several times what it is."""
    random = np.random.default_rng(seed)
    angle, torque = 0.002 * random.standard_normal((40_000, 1)), random.standard_normal((40_000, 1))
    gyroscope = 0.02 * random.standard_normal(angle.shape)
    for own in (0.0, 1.0):
        rate = differentiate(low_pass(angle, PERIOD, band), PERIOD) + own * gyroscope
        noise = noise_after_filter(angle, rate, torque, PERIOD, CUTOFF)[1, 0]
        assert noise == pytest.approx(behind_filter(rate), rel=0.4)


@pytest.mark.parametrize("encoders", [0.0, 1e-4, 1e-3])
@pytest.mark.parametrize("gyroscope", [0.003, 0.02])
def test_an_attitudes_noise_is_not_in_the_gyroscopes_rates(encoders: float, gyroscope: float) -> None:
    """What an angle has alone takes nothing off the noise that its rate has alone; encoders' noise is in both."""
    random = np.random.default_rng(11)
    attitude, joints, torque, turn = random.standard_normal((4, 40_000, 1))
    angle = 2e-4 * attitude + encoders * joints
    rate = gyroscope * turn + encoders * differentiate(joints, PERIOD)
    noise = noise_after_filter(angle, rate, torque, PERIOD, CUTOFF)[1, 0]
    assert noise == pytest.approx(behind_filter(rate), rel=0.4)


def test_what_noise_takes_is_given_back() -> None:
    errors = []
    for seed in range(6):
        blocks = [block(2 * seed, (0.01, 0.08)), block(2 * seed + 1, (0.0, 0.08))]
        fit = fit_linear(blocks)
        taken = attenuation(blocks, fit.values, shared_offset=False)
        assert taken is not None
        errors.append([fit.values / VALUES - 1, (fit.values + taken) / VALUES - 1])
    before, after = np.array(errors).swapaxes(0, 1)
    assert (before < 0).all(), "both are drawn towards zero"
    assert before[:, 1].max() < -0.2, "damping by far"
    assert (np.abs(after.mean(axis=0)) < 0.2 * np.abs(before.mean(axis=0))).all()


def test_nothing_is_given_back_where_nothing_was_taken() -> None:
    clean = block(1, (0.0, 0.0))
    taken = attenuation([clean], fit_linear([clean]).values, shared_offset=False)
    assert taken is not None
    np.testing.assert_allclose(taken, 0.0, atol=1e-6)


def test_offsets_follow_what_is_given_back() -> None:
    blocks = [block(seed, (0.01, 0.08)) for seed in (1, 2)]
    leaning = [replace(one, regressor=one.regressor + [0.1 * k, 0.0]) for k, one in enumerate(blocks, 1)]
    for shared in (False, True):
        fit = fit_linear(leaning, shared_offset=shared)
        taken = attenuation(leaning, fit.values, shared_offset=shared)
        assert taken is not None
        moved = offsets_moved(leaning, taken, shared_offset=shared)
        missed = [
            one.response - one.regressor @ (fit.values + taken) - fit.offsets[one.label] - moved[one.label]
            for one in leaning
        ]
        means = [float(np.mean(part)) for part in ([np.concatenate(missed)] if shared else missed)]
        np.testing.assert_allclose(means, 0.0, atol=1e-9)
        assert max(map(abs, moved.values())) > 1e-3, "left where they were, they would miss by as much"


def test_a_bush_that_does_not_turn_at_all_gets_nothing_back() -> None:
    still = replace(block(1, (0.0, 0.0)), regressor=np.zeros((12000, 2)), noise=np.zeros(2))
    taken = attenuation([still], fit_linear([still]).values, shared_offset=False)
    assert taken is not None
    assert not taken.any()


def test_mostly_noise_is_said() -> None:
    noise = block(1, (0.3, 1.0))
    assert attenuation([noise], fit_linear([noise]).values, shared_offset=False) is None


def gyroscope(log: MotionLog, size: float) -> MotionLog:
    random = np.random.default_rng(len(log.name))
    names = [name for name in log.columns if ".angular_velocity." in name]
    return log.with_columns(
        {name: log.column(name) + size * random.standard_normal(len(log)) for name in names}
    )


def residuals(result: FeetResult, motion: str, foot: str, axis: str) -> Array:
    """What the fit leaves of the torque, where it served."""
    assert result.residuals is not None
    table = result.residuals
    rows = np.array(table["motion"]) == motion
    rows &= (np.array(table["foot"]) == foot) & np.array(table["used"])
    return np.asarray((np.array(table[f"{axis}.torque"]) - np.array(table[f"{axis}.predicted"]))[rows])


def test_a_noisy_gyroscope_costs_no_damping(tmp_path: Path) -> None:
    robot, settings = make_robot(tmp_path), FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
    logs = [record(sway(name, seed=seed, duration=40.0)) for name, seed in (("one", 1), ("second", 2))]
    quiet = identify_feet(robot, logs, settings=settings)
    assert "noisy_regressors" not in {note.code for note in quiet.notes}
    noisy = identify_feet(robot, [gyroscope(log, 0.05) for log in logs], settings=settings)
    told = [note.text for note in noisy.notes if note.code == "noisy_regressors"]
    assert any("damping +" in text for text in told)
    for foot, axis in TRUTH:
        for name in ("one", "second"):
            missed = residuals(noisy, name, foot, axis)
            assert abs(missed.mean()) < 1e-3 * missed.std(), "offsets follow what is given back"
    inside = []
    for (foot, axis), truth in TRUTH.items():
        row = noisy.parameter(foot, axis, "damping")
        assert row.interval95 is not None
        inside.append(row.interval95[0] <= truth.damping <= row.interval95[1])
    assert sum(inside) >= len(inside) - 1


def test_an_ordinary_gyroscope_needs_no_correction(tmp_path: Path) -> None:
    robot, settings = make_robot(tmp_path), FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
    logs = [gyroscope(record(sway(name, seed=seed)), 0.0013) for name, seed in (("one", 1), ("second", 2))]
    found = identify_feet(robot, logs, settings=settings)
    assert "noisy_regressors" not in {note.code for note in found.notes}

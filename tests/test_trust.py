"""What residuals cannot show: delay, slip, height, and what limits a number."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, make_robot, record, sway
from plantar.estimation.delay import Pair, estimate_delay
from plantar.identify.feet import identify_feet
from plantar.identify.settings import FeetSettings
from plantar.identify.usage import served_shares
from plantar.robot import RobotModel
from plantar.signals import interpolate, low_pass
from plantar.slip import sliding

PERIOD = 0.005
SAMPLES = 8000


def late_pair(delay: float, seed: int, push: float = 0.0) -> Pair:
    """A random wrench below 1.5 Hz, measured `delay` late, noise on both sides; `push`: an operator's share."""
    random = np.random.default_rng(seed)
    time = PERIOD * np.arange(SAMPLES)
    true = 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5)
    hand = push * 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5)
    late = np.nan_to_num(
        np.column_stack([interpolate(time - delay, time, column, 1.0) for column in (true + hand).T])
    )
    measured = low_pass(late + random.standard_normal(late.shape), PERIOD, 8.0)
    predicted = low_pass(true + random.standard_normal(true.shape), PERIOD, 8.0)
    return Pair("sweep", measured[100:-100], predicted[100:-100], PERIOD)


@pytest.mark.parametrize("delay", [-0.01, 0.0, 0.004, 0.01])
def test_a_delay_is_found_whatever_its_sign(delay: float) -> None:
    found = [estimate_delay([late_pair(delay, seed)]) for seed in range(8)]
    assert all(each is not None for each in found)
    values = np.array([each.value for each in found if each is not None])
    claimed = np.array([each.std for each in found if each is not None])
    assert abs(values - delay).max() < 0.0015
    assert np.mean(abs(values - delay) < 2.2 * claimed) >= 0.75
    assert claimed.max() < 0.001


def test_nothing_is_claimed_where_somebody_pushes() -> None:
    assert estimate_delay([late_pair(0.005, 1, push=0.6)]) is None


def test_a_known_delay_is_taken_off_and_an_unknown_one_widens_damping(tmp_path: object) -> None:
    robot: RobotModel = make_robot(tmp_path)  # type: ignore[arg-type]
    logs = [record(sway("one", seed=1)), record(sway("two", seed=2))]
    unknown = identify_feet(robot, logs)
    known = identify_feet(robot, logs, settings=FeetSettings(wrench_delay=0.0))
    assert any(note.code == "delay_unknown" for note in unknown.notes)
    wide, narrow = (one.parameter("left", "pitch", "damping") for one in (unknown, known))
    assert wide.std is not None
    assert narrow.std is not None
    assert wide.std == pytest.approx(0.0075 * TRUTH["left", "pitch"].stiffness, rel=0.1), (
        "K times the delay's deviation"
    )
    assert wide.std > 5 * narrow.std
    assert wide.advice is not None
    assert "arm sweeps" in wide.advice
    shifted = identify_feet(robot, logs, settings=FeetSettings(wrench_delay=0.005)).parameter(
        "left", "pitch", "damping"
    )
    assert shifted.value is not None
    assert narrow.value is not None
    gained = 0.005 * TRUTH["left", "pitch"].stiffness
    assert shifted.value - narrow.value == pytest.approx(gained, rel=0.1), (
        "C grows by K times the delay taken off"
    )


def test_sliding_soles_are_found_in_their_seconds() -> None:
    random = np.random.default_rng(0)
    time = PERIOD * np.arange(SAMPLES)
    slides = (time > 10) & (time < 12)
    path = np.cumsum(np.where(slides, 0.02, 0.0)) * PERIOD
    position = np.column_stack([path, np.zeros(SAMPLES)]) + 2e-5 * random.standard_normal((SAMPLES, 2))
    found = sliding(position, np.zeros(SAMPLES), np.ones(SAMPLES, dtype=bool), PERIOD)
    assert np.mean(slides[found]) > 0.9, "precision"
    assert np.mean(found[slides]) > 0.9, "recall"
    still = sliding(position[:1900], np.zeros(1900), np.ones(1900, dtype=bool), PERIOD)
    assert not still.any(), "no false alarm on noise"


def test_every_second_is_accounted_for(tmp_path: object) -> None:
    robot: RobotModel = make_robot(tmp_path)  # type: ignore[arg-type]
    log = record(sway("hop", duration=20.0, lifts=(("left", 8.0, 11.0),)))
    result = identify_feet(robot, [log], settings=FeetSettings(model="kelvin_voigt"))
    left = next(
        row for row in served_shares([phase.to_dict() for phase in result.phases]) if row["foot"] == "left"
    )
    assert left["seconds"] == pytest.approx(20.0, abs=0.1)
    assert 12 < left["served"] < 17.5
    assert "in the air" in left["reasons"]
    assert replace(result).extras["diagnosis"], "what limits each number is told"

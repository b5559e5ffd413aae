"""What residuals cannot show: delay, slip, height, and what limits a number."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot
from plantar.contact.slip import sliding
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.results.usage import used_shares
from plantar.robot.model import RobotModel

PERIOD = 0.005
SAMPLES = 8000


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
        row for row in used_shares([phase.to_dict() for phase in result.phases]) if row["foot"] == "left"
    )
    assert left["seconds"] == pytest.approx(20.0, abs=0.1)
    assert 12 < left["served"] < 17.5
    assert "in the air" in left["reasons"]
    assert replace(result).extras["diagnosis"], "what limits each number is told"

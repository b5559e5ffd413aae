"""What is uncertain about the robot, and what recordings differ by, is in the intervals."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from feet_trials import LINEAR, noisy
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.interval_width.between_recordings import Apart
from plantar.feet.interval_width.systematic import robot_causes
from plantar.feet.prepare import prepare_all
from plantar.feet.regression.tangent import Tangent
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT, Uncertainty

NOTHING = Uncertainty(**dict.fromkeys(asdict(EXACT), 0.0))


def identified(
    robot: RobotModel, uncertainty: Uncertainty, spread: float = 0.0, count: int = 6
) -> FeetResult:
    """Of recordings whose stiffness differs by `spread` (a share, rms)."""
    shares = 1 + spread * np.linspace(-1.5, 1.5, count)
    logs = []
    for seed, share in enumerate(shares, 3):
        truth = {key: replace(model, stiffness=share * model.stiffness) for key, model in TRUTH.items()}
        logs.append(noisy(record(sway(f"sway_{seed}", seed, truth=truth)), seed))
    return identify_feet(replace(robot, uncertainty=uncertainty), logs, settings=LINEAR)


@pytest.fixture(scope="module")
def sure(robot: RobotModel) -> FeetResult:
    return identified(robot, NOTHING, count=2)


@pytest.mark.parametrize("gain", [0.01, 0.04])
def test_a_gain_widens_stiffness_and_damping_by_itself(
    robot: RobotModel, sure: FeetResult, gain: float
) -> None:
    unsure = identified(robot, replace(NOTHING, wrench_gain=gain), count=2)
    for name in ("stiffness", "damping"):
        known, row = (one.parameter("left", "pitch", name) for one in (sure, unsure))
        assert row.std == pytest.approx(np.hypot(known.std, gain * row.value), rel=0.05)


def test_recordings_that_differ_widen_the_stiffness(robot: RobotModel) -> None:
    alike, apart = identified(robot, NOTHING), identified(robot, NOTHING, 0.02)
    for foot, axis in TRUTH:
        usual, row = (one.parameter(foot, axis, "stiffness") for one in (alike, apart))
        low, high = row.interval95
        assert low < TRUTH[foot, axis].stiffness < high
        assert row.std > 1.5 * usual.std
    shares = [
        each.variance_shares["between recordings"] for each in apart.diagnosis if each.name == "stiffness"
    ]
    assert min(shares) > 0.5


def test_few_recordings_take_what_the_robot_file_says(robot: RobotModel) -> None:
    told = identified(robot, replace(NOTHING, between_recordings=0.03), count=2)
    row = told.parameter("left", "roll", "stiffness")
    assert row.std == pytest.approx(0.03 / np.sqrt(2) * row.value, rel=0.1)


def test_a_turned_sensor_reads_less_by_its_cosine(robot: RobotModel) -> None:
    logs = [noisy(record(sway(f"sway_{seed}", seed)), seed) for seed in (3, 4)]
    ready = prepare_all(robot, logs, [], LINEAR, lambda _: None)
    fit = fit_axis(ready.fitted, "left", "pitch", LINEAR)
    assert fit is not None
    tangent = Tangent.of(fit, ready.fitted, False)
    assert [cause.name for cause in robot_causes(tangent, 0.0, Apart(0.0, 1))] == ["between recordings"]
    turned = replace(tangent, fit=replace(fit, turned=0.2))
    cause, _ = robot_causes(turned, 0.0, Apart(0.0, 1))
    assert cause.std == pytest.approx(1 - np.cos(0.2))
    np.testing.assert_array_equal(cause.effect, fit.values)

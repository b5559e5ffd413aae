"""Encoders read at another moment than the IMU widen the damping where motions show it, and nothing else does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot
from feet_trials import PUNCTUAL
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.stances import Stances
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.interval_width.sensor_causes import LATE_ENCODERS, encoder_delay_causes
from plantar.feet.regression.tangent import Tangent
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult

KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
EARLY = 0.0035  # s


def early(log: MotionLog) -> MotionLog:
    """The log with its encoders read before the IMU, as of an IMU and wrenches behind a filter of 60 Hz."""
    moved = {
        name: np.interp(log.time + EARLY, log.time, values)
        for name, values in log.columns.items()
        if name.startswith("joint.")
    }
    return log.with_columns(moved).select(slice(0, -20))


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[FeetResult, FeetResult]:
    """From logs whose encoders are on time, and early."""
    robot = make_robot(tmp_path_factory.mktemp("robot"))
    logs = [record(sway(f"sway_{seed}", seed=seed, duration=30.0)) for seed in (1, 2)]
    one, other = (identify_feet(robot, each, settings=KNOWN) for each in (logs, [early(log) for log in logs]))
    return one, other


def shares(result: FeetResult) -> list[float]:
    return [row.variance_shares.get(LATE_ENCODERS, 0.0) for row in result.diagnosis if row.name == "damping"]


def test_encoders_on_time_widen_nothing(results: tuple[FeetResult, FeetResult]) -> None:
    assert max(shares(results[0])) == 0.0


def test_early_ones_widen_the_damping_until_it_holds_the_truth(
    results: tuple[FeetResult, FeetResult],
) -> None:
    assert np.median(shares(results[1])) > 0.3
    missed = []
    for (foot, axis), law in TRUTH.items():
        row = results[1].parameter(foot, axis, "damping")
        assert row.interval95 is not None
        low, high = row.interval95
        assert low < law.damping < high
        share = next(
            one.variance_shares.get(LATE_ENCODERS, 0.0)
            for one in results[1].diagnosis
            if (one.foot, one.axis, one.name) == (foot, axis, "damping")
        )
        without = (high - low) / 2 * np.sqrt(1 - share)
        missed.append(abs(row.value - law.damping) > without)
    assert any(missed), "without it some interval misses"


def test_of_a_walk_encoders_late_by_what_nobody_knows_are_damping() -> None:
    """Joints alone bend the bush of a foot that steps: K times the delay goes into C."""
    angle = swayed(2000, seed=1)
    rate = np.gradient(angle, PERIOD)
    stances = Stances(np.arange(2000) // 100, np.ones(2000))
    torque = 400.0 * angle + 20.0 * rate + 0.05 * np.random.default_rng(2).standard_normal(2000)
    walk = replace(
        made_recording("walk", angle, torque, stances=stances),
        encoder_rates={FOOT: np.column_stack([rate, rate])},
    )
    walk.raw[FOOT].torque[:, 1] = 0.0  # else a turned sensor would explain all
    fit = fit_axis([walk], FOOT, "pitch", replace(PUNCTUAL, model="kelvin_voigt"))
    assert fit is not None
    tangent = Tangent.of(fit, [walk], False)
    (cause,) = encoder_delay_causes(tangent, 0.0005)
    assert cause.share[1] == pytest.approx(400.0 * 0.0005, rel=0.05)
    assert encoder_delay_causes(tangent, 0.0) == [], "a delay that is known"

"""A recording's signals pass one filter, wherever runs are short: what is used is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording, filtered_recording, moment_arm_effect, moved_centre
from plantar.feet.regression.load_torque import ALL, moment_columns
from plantar.feet.regression.regression_data import blocks_of
from plantar.robot.model import RobotModel

CUTOFF = 2.0  # Hz, below a slow log's Nyquist frequency
LIFTS = tuple(("left", 1.5 + 4.0 * place, 3.5 + 4.0 * place) for place in range(10))


@pytest.fixture(scope="module")
def walk(robot: RobotModel) -> Recording:
    """A foot that steps at 10 Hz, in stances of about twenty samples, the force sensors silent for a second a swing."""
    log = record(sway(duration=42.0, lifts=LIFTS)).select(slice(None, None, 10))
    silent = np.mod(log.time - 1.5, 4.0) < 1.0
    log = log.with_columns(
        {
            name: np.where(silent, np.nan, values)
            for name, values in log.columns.items()
            if "wrench.left" in name
        }
    )
    return filtered_recording(prepare(robot, checked(robot, log), "fit"), CUTOFF)


def test_the_moment_arms_torque_is_known_wherever_a_sample_is_used(walk: Recording) -> None:
    assert walk.stances["left"] is not None
    used = walk.used("left")
    assert used.sum() > 50
    rigid, soft = (
        moved_centre(walk, {"left": value, "right": value}).bushes["left"] for value in (0.0, 1e-5)
    )
    np.testing.assert_array_equal(rigid.torque[used], walk.bushes["left"].torque[used])
    assert np.isfinite(soft.torque[used]).all()
    assert not np.allclose(soft.torque[used], rigid.torque[used])


def test_the_load_of_a_used_sample_is_not_taken_for_none(walk: Recording) -> None:
    for block in blocks_of([walk], "left", "pitch"):
        assert block.common_nuisance is not None
        assert block.common_nuisance[:, 0].min() > 50.0


def test_a_fit_reads_the_same_rows_of_a_decimated_recording(robot: RobotModel) -> None:
    """Columns and torque as they are, the load's torque within what the wide filter leaves of it."""
    standing = filtered_recording(prepare(robot, checked(robot, record(sway(duration=20.0))), "fit"), CUTOFF)
    thin = standing.decimated("left")
    assert (thin.every, len(thin.time)) == (standing.stride("left"), thin.rows("left").size)
    (whole,), (few,) = (blocks_of([one], "left", "pitch") for one in (standing, thin))
    np.testing.assert_array_equal(whole.regressor, few.regressor)
    np.testing.assert_array_equal(whole.response, few.response)
    assert few.thinned == whole.thinned
    assert few.period == pytest.approx(whole.period)
    rows = standing.rows("left")
    for of_whole, of_few in zip(
        moment_columns(standing, "left", "pitch", rows=ALL)[rows].T,
        moment_columns(thin, "left", "pitch", rows=ALL)[thin.rows("left")].T,
        strict=True,
    ):
        assert np.abs(of_few - of_whole).max() < 0.01 * np.ptp(of_whole)


def test_between_gaps_the_moment_arms_torque_of_a_decimated_recording_is_known_too(robot: RobotModel) -> None:
    """Runs of 1.3 s are 20 of its samples, fewer than a raw log's runs must have to be filtered."""
    log = record(sway(duration=20.0))
    silent = np.mod(log.time, 1.5) < 0.2
    torn = {
        name: np.where(silent, np.nan, values) for name, values in log.columns.items() if "wrench" in name
    }
    standing = filtered_recording(
        prepare(robot, checked(robot, log.with_columns(torn)), "fit"), CUTOFF
    ).decimated("left")
    rows = standing.rows("left")
    assert rows.sum() > 50
    assert np.isfinite(moved_centre(standing, {"left": 1e-5, "right": 0.0}).bushes["left"].torque[rows]).all()


def test_a_foot_that_steps_is_not_decimated(walk: Recording) -> None:
    assert walk.decimated("left") is walk


def test_what_joints_and_imu_do_passes_the_bushes_filter(robot: RobotModel) -> None:
    """Slow motion stays, shaking goes: effects that stand beside a filtered torque are as it is."""
    raw = prepare(robot, checked(robot, record(sway(duration=20.0))), "fit")
    slow, quick = (np.sin(2 * np.pi * hertz * raw.time) for hertz in (0.3, 25.0))

    def both(shape: tuple[int, ...], share: float) -> np.ndarray:
        return np.multiply.outer(slow + share * quick, 1.0 + np.arange(np.prod(shape)).reshape(shape))

    given = replace(raw, encoder_rates={"left": both((2,), 1.0)}, imu_turns={"left": both((2, 3), 1.0)})
    found, inside = filtered_recording(given, CUTOFF), slice(200, -200)
    np.testing.assert_allclose(found.encoder_rates["left"][inside], both((2,), 0.0)[inside], atol=0.02)
    np.testing.assert_allclose(found.imu_turns["left"][inside], both((2, 3), 0.0)[inside], atol=0.06)


def test_the_slide_lifts_the_centre_along_the_ankle_and_roll_turns_with_pitch(walk: Recording) -> None:
    """z e_z × force is (-F_y, F_x, 0) z; of it the roll axis, pitched by 0.5 rad, sees cos(0.5) = 0.878."""
    bush = walk.bushes["left"]
    wrench = np.tile([20.0, -30.0, 400.0, 0.0, 0.0, 0.0], (len(walk.time), 1))
    bent = replace(bush, wrench=wrench, deflection=np.tile([0.5, 0.1], (len(walk.time), 1)))
    standing = replace(walk, bushes={"left": bent}, stances={**walk.stances, "left": None})
    expected = [-400.0 * 20.0, np.cos(0.5) * 400.0 * -30.0]
    np.testing.assert_allclose(moment_arm_effect(standing, "left"), np.tile(expected, (len(walk.time), 1)))

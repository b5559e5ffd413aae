"""A motion contradicts a model that holds in others where more is missed than an attitude's drift can make."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.feet.assess.contradiction import (
    _mount_that_fits,
    beside_drift,
    contradiction,
    missed_motions,
)
from plantar.feet.assess.scores import score_axis
from plantar.feet.fit.axis_fit import fit_axis
from plantar.results.feet import ValidationRow

DRIFT_PERIOD = 20.0

STIFFNESS, COUNT = 400.0, 6000
MOUNT = 0.01  # rad
TIME = PERIOD * np.arange(COUNT)


def scored(motion: str, error: float, constant: float) -> ValidationRow:
    return ValidationRow("direct", motion, "left", "pitch", error, error, 4 * constant, 1.0, constant, 1000)


def test_motions_that_are_missed_although_the_liveliest_is_not() -> None:
    lively, quiet = scored("sway", 0.3, 17.0), scored("squat", 1.0, 1.1)
    assert missed_motions([lively, quiet, scored("tilt", 0.2, 2.4)]) == []  # the squat hardly loads the axis
    bad, worst = scored("lean", 1.5, 2.3), scored("tilt", 4.1, 2.3)
    assert missed_motions([lively, quiet, bad, worst]) == [bad, worst]
    assert (
        missed_motions([scored("sway", 9.0, 17.0), worst]) == []
    )  # where nothing holds, nothing contradicts
    assert missed_motions([]) == []


def test_the_liveliest_motion_is_the_one_that_loads_most_and_not_the_one_with_a_spike() -> None:
    lively, lean = scored("sway", 1.0, 10.0), scored("lean", 3.0, 5.0)
    spiked = replace(
        scored("squat", 0.4, 0.9), max_abs=100.0
    )  # a tenth of the liveliest's, and missed by half
    assert missed_motions([lively, lean, spiked]) == [lean]
    assert missed_motions([lively, replace(spiked, mean_abs_error=0.7)]) == []


@pytest.mark.parametrize(
    ("liveliest", "share", "load", "missed"),
    [
        (0.29, 0.51, 0.11, True),
        (0.31, 0.51, 0.11, False),
        (0.29, 0.49, 0.11, False),
        (0.29, 0.51, 0.09, False),
    ],
)
def test_the_edges_of_a_missed_motion(liveliest: float, share: float, load: float, missed: bool) -> None:
    """Shares of a constant's error; the load of the liveliest motion's."""
    rows = [scored("sway", 20.0 * liveliest, 20.0), scored("lean", share * load * 20.0, load * 20.0)]
    assert missed_motions(rows) == rows[1:] * missed


def found(error: Array, waist: Array | None = None, turned: float = 0.0) -> ValidationRow | None:
    """What contradicts a fit of a lively motion: a quieter, unseen one whose torque is off by `error` (n,) [N·m], and
    whose deflection is read by an IMU that is `turned` [rad] while a `waist` (n,) [rad] turns it against the foot."""
    lively, quiet = swayed(COUNT), swayed(COUNT, 0.006, seed=1)
    seen = made_recording("sway", lively, STIFFNESS * lively)
    waist = np.zeros(COUNT) if waist is None else waist
    unseen = made_recording("Myrand5", quiet + turned * waist, STIFFNESS * quiet + error, role="validate")
    turns = np.zeros((COUNT, 2, 3))
    turns[:, 0, 0] = -waist  # a turn about x shows in pitch; it is taken off what is read
    seen, unseen = replace(seen, imu_turns={FOOT: 0 * turns}), replace(unseen, imu_turns={FOOT: turns})
    fit = fit_axis([seen], FOOT, "pitch", LINEAR)
    assert fit is not None
    scores, predictions = score_axis([seen, unseen], fit)
    # As it is, each of these errors is missed.
    assert (error.any() or turned > 0) == bool(missed_motions(scores))
    return contradiction(scores, fit, [seen, unseen], predictions, MOUNT)


def test_of_two_motions_the_one_that_is_missed_more_is_named() -> None:
    lively, quiet = swayed(COUNT), swayed(COUNT, 0.006, seed=1)
    swing = np.sin(2 * np.pi * 0.8 * TIME)
    recordings = [
        made_recording("sway", lively, STIFFNESS * lively),
        made_recording("lean", quiet, STIFFNESS * quiet + 5.0 * swing, role="validate"),
        made_recording("squat", quiet, STIFFNESS * quiet + 7.0 * swing, role="validate"),
        made_recording("tilt", quiet, STIFFNESS * quiet + 6.0 * swing, role="validate"),
    ]
    recordings = [replace(one, imu_turns={FOOT: np.zeros((COUNT, 2, 3))}) for one in recordings]
    fit = fit_axis(recordings[:1], FOOT, "pitch", LINEAR)
    assert fit is not None
    scores, predictions = score_axis(recordings, fit)
    row = contradiction(scores, fit, recordings, predictions, 0.0)
    assert row is not None
    assert row.motion == "squat"


def test_a_motion_that_fits_contradicts_nothing() -> None:
    assert found(np.zeros(COUNT)) is None


@pytest.mark.parametrize("times", [2.0, 3.0])
def test_drift_is_no_contradiction(times: float) -> None:
    """The attitude wanders: by a line, and by a swing that is slower than any motion asked for."""
    drift = 3.0 * TIME / TIME[-1] + np.cos(2 * np.pi * TIME / (1.5 * DRIFT_PERIOD))
    assert found(times * drift) is None


@pytest.mark.parametrize("frequency", [0.1, 0.3])
def test_what_is_quicker_than_drift_is_named_with_what_is_missed_beside_it(frequency: float) -> None:
    swing = 5.0 * np.sin(2 * np.pi * frequency * TIME)
    row = found(swing + 8.0 * TIME / TIME[-1])
    assert row is not None
    assert row.motion == "Myrand5"
    assert row.mean_abs_error == pytest.approx(np.mean(np.abs(swing)), rel=0.1)
    assert row.zero_mean_abs > 0.5 * row.mean_abs_error


def test_a_mount_that_the_robot_file_allows_is_no_contradiction() -> None:
    """No fitted motion moves the waist; one that does reads two deviations of the mount as deflection."""
    assert found(np.zeros(COUNT), 0.5 * np.sin(2 * np.pi * 0.2 * TIME), 2 * MOUNT) is None
    row = found(np.zeros(COUNT), 0.5 * np.sin(2 * np.pi * 0.2 * TIME), 5 * MOUNT)
    assert row is not None
    assert row.mean_abs_error == pytest.approx(STIFFNESS * 0.5 * 5 * MOUNT * 2 / np.pi, rel=0.1)


def test_a_mount_explains_nothing_while_no_joint_turns_it() -> None:
    swing = 5.0 * np.sin(2 * np.pi * 0.2 * TIME)
    assert found(swing, 0.5 * np.sin(2 * np.pi * 0.5 * TIME)) is not None


def test_what_is_missed_is_counted_about_its_mean() -> None:
    """Pushes for a quarter of the time: 2·¼·¾ of their height about their mean, far as most samples are from it."""
    height, lively = 8.0, swayed(COUNT)
    pushes = height * (np.sin(2 * np.pi * 0.7 * TIME) > np.cos(np.pi / 4))
    seen = made_recording("sway", lively, STIFFNESS * lively)
    unseen = made_recording("push", swayed(COUNT, 0.006, seed=1), pushes, role="validate")
    turns = {FOOT: np.zeros((COUNT, 2, 3))}
    seen, unseen = replace(seen, imu_turns=turns), replace(unseen, imu_turns=turns)
    fit = fit_axis([seen], FOOT, "pitch", LINEAR)
    assert fit is not None
    scores, predictions = score_axis([seen, unseen], fit)
    row = beside_drift(scores[1], fit, unseen, predictions, 0.0)
    assert row.zero_mean_abs == pytest.approx(0.375 * height, rel=0.03)


@pytest.mark.parametrize("seconds", [2.0, 8.0])
def test_a_mount_is_drawn_to_none_by_its_deviation(seconds: float) -> None:
    """Blows for a tenth of the time, as a turn by two deviations makes them: one step takes A / (1 + A) of it,
    A = seconds · (1 / 2)²; what is left is smaller, so that a second step takes more."""
    blows = (np.arange(1000) % 10 == 0).astype(float)
    wanted = 2 * MOUNT
    found = _mount_that_fits(lambda turned: 300.0 * (wanted - turned[1]) * blows, np.zeros(3), MOUNT, seconds)
    first = seconds / 4
    second = first / (1 / (1 + first)) ** 2
    assert found == pytest.approx([0.0, wanted * second / (1 + second), 0.0], abs=1e-9)

"""Motions replayed in a simulator: errors of chest and torques, and how feet score by them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.campaign import replay
from plantar.campaign.replay import IDENTIFIED, RIGID, ReplayRow, best_guess, replay_rows, scores
from plantar.campaign.tables import simulator_table
from plantar.logs.motion_log import MotionLog
from plantar.twin.bush import GUESSES
from plantar.twin.replay import Replayed, moved_onto, pitch_and_roll


def test_scores_pool_motions_and_tell_who_falls() -> None:
    def rows(feet: str, *errors: float | None) -> list[ReplayRow]:
        return [
            ReplayRow(feet, motion, axis, "rad", error)
            for motion, error in zip("ab", errors, strict=True)
            for axis in ("chest pitch", "chest roll")
        ]

    every = [
        *rows(IDENTIFIED, 0.0, 0.001),
        *rows(RIGID, 0.02, 0.02),
        *rows("soft", 0.001, None),
        *rows("hard", 0.1, 0.1),
    ]
    found = {score.feet: score for score in scores(every)}
    assert found[IDENTIFIED].pitch == pytest.approx(0.001 / np.sqrt(2))
    assert found[RIGID].both == pytest.approx(0.02 * np.sqrt(2))
    assert found["soft"].both is None
    assert best_guess(every) == "hard"  # the soft one falls in a motion
    text = {row[0].text: [cell.text for cell in row[1:]] for row in simulator_table(every).rows}
    assert text["soft"][0] == "falls"
    assert text["hard"][1] == "5.000"


def test_bias_and_slow_drift_of_an_attitude_are_not_the_feets() -> None:
    time = np.arange(2001) / 200.0
    turn = Rotation.from_euler(
        "zyx", np.column_stack([0.6 * np.sin(time), 0.05 * np.cos(time), 0.1 * time / 10])
    )
    off = Rotation.from_rotvec(np.array([0.003, -0.002, 0.1]) + np.outer(time, [1e-4, -2e-4, 1e-3]))
    recorded = (off * turn).as_matrix()
    assert pitch_and_roll(moved_onto(recorded, turn.as_matrix())) == pytest.approx(
        pitch_and_roll(recorded[:, 2, :]), abs=2e-5
    )
    # what else lies between the two stays
    wave = 0.004 * np.cos(2 * np.pi * (time - time.mean()))  # even about the middle: no line is in it
    swayed = turn * Rotation.from_rotvec(np.outer(wave, [0.0, 1.0, 0.0]))
    left = pitch_and_roll(moved_onto(recorded, swayed.as_matrix())) - pitch_and_roll(recorded[:, 2, :])
    assert left == pytest.approx(np.outer(wave, [1.0, 0.0]), abs=3e-4)


def test_errors_of_a_replay() -> None:
    time = np.arange(400) / 200.0
    chest, place = np.tile([0.003, -0.004], (400, 1)), ("left", "roll")
    late = np.where(time > 1.0, -2.0, 50.0)  # the first second is not scored
    one = Replayed(
        "Tilt1", IDENTIFIED, time, {place: late}, {place: np.zeros(400)}, chest, np.zeros((400, 2))
    )
    assert one.chest_error() == pytest.approx((0.003, 0.004))
    assert one.torque_error(*place) == pytest.approx(2.0)


def test_a_robot_that_fell_keeps_its_rows() -> None:
    assert {row.error for row in replay_rows([], ["Squat"], ["soft"])} == {None}


def test_feet_to_compare_and_the_hands_that_lead(monkeypatch: pytest.MonkeyPatch) -> None:
    hand = object()
    monkeypatch.setattr(
        replay, "planned", lambda name, _: SimpleNamespace(hand=hand if name == "Manual" else None)
    )
    assert replay.hands_of(None, ("Tilt1", "Manual")) == {"Manual": hand}  # type: ignore[arg-type]
    ours = {"left": object(), "right": object()}
    monkeypatch.setattr(replay, "feet_of", lambda result: ours)
    found = replay.candidates(None, ("LAAS", "JRL"))  # type: ignore[arg-type]
    assert list(found) == [IDENTIFIED, RIGID, "LAAS", "JRL"]
    assert found[IDENTIFIED] is ours
    assert found[RIGID] is None
    assert found["JRL"] == dict.fromkeys(ours, GUESSES["JRL"])


def test_the_record_is_as_far_from_the_truth_as_its_attitude_errs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two waves, pitch of 3 and roll of 4 mrad: their root mean squares, in the motion's own line."""
    time = np.arange(2001) / 200.0
    still = np.tile(np.eye(3), (time.size, 1, 1))
    wave = np.cos(2 * np.pi * (time - time.mean()))[:, None]
    recorded = Rotation.from_rotvec(wave * [0.004, 0.003, 0.0]).as_matrix()
    monkeypatch.setattr(
        replay, "preset_named", lambda name: SimpleNamespace(physics=lambda bushes, robot: bushes)
    )
    for name in ("cut_feet", "describe", "planned", "rolled", "exact_columns"):
        monkeypatch.setattr(replay, name, lambda *_: {})
    log = MotionLog("sway", time, {"measured": time})
    monkeypatch.setattr(
        replay, "chest_attitude", lambda _, one: recorded if "measured" in one.columns else still
    )
    pitch, roll = replay.record_rows(None, [log], "clean", {})  # type: ignore[arg-type]
    assert [(row.feet, row.motion, row.quantity, row.unit) for row in (pitch, roll)] == [
        (replay.RECORD, "sway", "chest pitch", "rad"), (replay.RECORD, "sway", "chest roll", "rad"),
    ]  # fmt: skip
    assert (pitch.error, roll.error) == pytest.approx((0.003 / np.sqrt(2), 0.004 / np.sqrt(2)), rel=0.02)

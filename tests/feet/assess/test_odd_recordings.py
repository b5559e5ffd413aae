"""A recording whose stiffness is not that of the others, and stiffness that differs for another reason."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped import TRUTH, record, sway
from bush_data_sets import Rubber
from feet_trials import LINEAR, noisy, stepping
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.estimation.random_effects import Differences, Odd, furthest
from plantar.feet.assess.odd_recordings import CODE, _notes, odd_recordings, odd_walks
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.recording import Recording
from plantar.feet.regression.tangent import Tangent
from plantar.feet.settings import FeetSettings
from plantar.notes import Note
from plantar.results.walk_rows import WalkStiffness
from plantar.robot.model import RobotModel

COUNT = 6000
PLAIN = Rubber(stiffness=420.0, damping=18.0)
SOFTER = Rubber(stiffness=378.0, damping=16.2)  # by a tenth
SLIPPING = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)


def swaying(*feet: tuple[Rubber, float]) -> list[Recording]:
    """A sway on each of these feet, of this size."""
    made = []
    for seed, (rubber, size) in enumerate(feet):
        angle = size * swayed(COUNT, seed=seed)
        torque = rubber.torque(angle, np.gradient(angle, PERIOD))
        torque += 0.1 * np.random.default_rng(seed).standard_normal(COUNT)
        made.append(made_recording(f"sway_{seed}", angle, torque))
    return made


def said(recordings: list[Recording], model: str = "kelvin_voigt") -> list[str]:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model=model))
    assert fit is not None
    assert odd_recordings(Tangent.of(fit, recordings, True), fit) == [], "of one offset for all"
    return [note.text for note in odd_recordings(Tangent.of(fit, recordings, False), fit)]


FLOOR = "Was it recorded on another floor, on another sole, or with a joint read otherwise?"
SIGN = "Has a joint, the IMU or a force sensor another sign, unit or axis in it?"


@pytest.mark.parametrize(
    ("odd", "names", "said"),
    [
        (Odd(1, -0.123, 0.0134, 0.0213), "abc", "b: left pitch: stiffness is -12 ± 1.3 % beside that of 2 other "
         f"recordings, which agree within 2.1 % (standard deviation). {FLOOR}"),
        (Odd(0, 0.123, 0.0134, 0.0), "ab",
         f"a: left pitch: stiffness is +12 ± 1.3 % beside that of b, and nobody knows which is right. {FLOOR}"),
        (Odd(1, 0.123, 0.0134, 0.0), "ab",
         f"b: left pitch: stiffness is +12 ± 1.3 % beside that of a, and nobody knows which is right. {FLOOR}"),
        (Odd(2, -0.76, 0.1, 0.02), "abcd",
         f"c: left pitch: stiffness is nowhere near that of 3 other recordings. {SIGN}"),
        (Odd(0, 0.76, 0.1, 0.0), "ab",
         f"a: left pitch: stiffness is nowhere near that of b, and nobody knows which is right. {SIGN}"),
    ],
)  # fmt: skip
def test_an_odd_recording_in_words(odd: Odd, names: str, said: str) -> None:
    fit: Any = SimpleNamespace(foot="left", axis="pitch")
    assert _notes(odd, fit, list(names)) == [Note(CODE, "warning", f"{said} Leave it out, or fit it alone")]
    assert _notes(None, fit, list(names)) == []


def test_the_odd_one_of_three_is_named_with_how_far_it_is() -> None:
    (text,) = said(swaying((PLAIN, 1.0), (SOFTER, 1.0), (PLAIN, 1.0)))
    assert text.startswith(f"sway_1: {FOOT} pitch: stiffness is -10 ± 0.")
    assert "2 other recordings, which agree within 0." in text


def test_of_two_that_differ_nobody_knows_which_is_right() -> None:
    (text,) = said(swaying((PLAIN, 1.0), (SOFTER, 1.0)))
    assert all(name in text for name in ("sway_0", "sway_1", "nobody knows which is right"))


def test_a_recording_with_another_sign_is_no_other_floor() -> None:
    reversed_ = Rubber(stiffness=-420.0, damping=-18.0)
    (text,) = said(swaying((PLAIN, 1.0), (reversed_, 1.0), (PLAIN, 1.0)))
    assert text.startswith(f"sway_1: {FOOT} pitch: stiffness is nowhere near that of 2 other recordings. Has")
    assert "another sign" in text
    assert "floor" not in text


def test_recordings_that_agree_are_none() -> None:
    assert said(swaying((PLAIN, 1.0), (PLAIN, 1.0), (PLAIN, 1.0))) == []
    assert said(swaying((SOFTER, 1.0))) == []


def test_a_recording_that_hardly_moves_is_not_compared() -> None:
    """The softer one moves by a third, by a twentieth of the others."""
    assert len(said(swaying((PLAIN, 1.0), (SOFTER, 0.33), (PLAIN, 1.0)))) == 1
    assert said(swaying((PLAIN, 1.0), (SOFTER, 0.05), (PLAIN, 1.0))) == []


def test_an_angle_that_wanders_beside_a_small_motion_is_no_other_sign() -> None:
    """One moves by a sixth of the others, its attitude wanders by more: a fifth of the stiffness. Another sign is told
    of as small a motion."""
    recordings = swaying((PLAIN, 1.0), (PLAIN, 1.0), (PLAIN, 0.16))
    wandering = swayed(COUNT, amplitude=0.006, seed=9)
    state = recordings[2].bushes[FOOT]
    read = state.deflection[:, 0] + wandering
    wanders = made_recording("sway_2", read, state.torque[:, 0])
    assert said([*recordings[:2], wanders]) == []
    reversed_ = Rubber(stiffness=-420.0, damping=-18.0)
    assert len(said(swaying((PLAIN, 1.0), (PLAIN, 1.0), (reversed_, 0.16)))) == 1


def test_of_a_foot_that_hardly_turns_none_is_odd() -> None:
    """A third of the angle is the attitude's in two recordings, nearly all in one, which still tells a seventh."""
    recordings = swaying((PLAIN, 0.1), (PLAIN, 0.1), (PLAIN, 0.05))
    read = []
    for seed, (recording, wander) in enumerate(zip(recordings, (0.0005, 0.0005, 0.002), strict=True)):
        state = recording.bushes[FOOT]
        angle = state.deflection[:, 0] + swayed(COUNT, amplitude=wander, seed=9 + seed)
        read.append(made_recording(f"sway_{seed}", angle, state.torque[:, 0]))
    assert said(read) == []


def test_a_memory_makes_small_motions_stiffer() -> None:
    recordings = swaying((SLIPPING, 1.0), (SLIPPING, 0.3), (SLIPPING, 1.0))
    assert len(said(recordings, "kelvin_voigt")) == 1
    assert said(recordings, "elastoplastic") == []


@pytest.mark.parametrize(
    ("shares", "found"),
    [
        ([0.0, -0.1, 0.0], 2),  # places count from the first recording, beside which the shares are
        ([0.1, 0.1, 0.1], 0),
        ([0.0, -0.04, 0.0], None),  # less than is told
        ([0.05, -0.1, 0.0], None),  # the others differ as much
        ([0.0, 0.0, 0.0], None),
    ],
)
def test_the_furthest_is_told_as_far_as_the_others_agree(shares: list[float], found: int | None) -> None:
    odd = furthest(Differences(np.array(shares), 0.002**2 * (np.eye(3) + 1.0)), 0.05, 5.0)
    assert (odd and odd.place) == found
    if odd is not None:
        assert abs(odd.share) == pytest.approx(0.1, abs=0.003)
        assert odd.std < 0.01


def test_what_is_hardly_known_is_not_told() -> None:
    """A tenth, known to 3 %."""
    assert furthest(Differences(np.array([0.0, -0.1, 0.0]), 0.03**2 * (np.eye(3) + 1.0)), 0.05, 5.0) is None


def test_a_walk_is_told_from_others_by_the_scatter_of_its_stances() -> None:
    recordings = swaying((PLAIN, 1.0))
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None

    def walks(*rows: tuple[float, float]) -> list[str]:
        found = [
            WalkStiffness(
                f"walk_{k}", "fit", FOOT, "pitch", 9, stiffness, (stiffness - half, stiffness + half)
            )
            for k, (stiffness, half) in enumerate(rows)
        ]
        unseen = WalkStiffness("unseen", "validate", FOOT, "pitch", 9, 200.0, (190.0, 210.0))
        return [note.text for note in odd_walks(Tangent.of(fit, recordings, False), fit, [*found, unseen])]

    (text,) = walks((420.0, 4.0), (378.0, 4.0), (420.0, 4.0))
    assert text.startswith(f"walk_1: {FOOT} pitch: stiffness is -10 ± ")
    (text,) = walks((378.0, 4.0), (420.0, 4.0))
    assert "walk_0" in text
    assert "walk_1" in text
    # Beside a first walk that is itself hardly known, to a seventh, no other one is odd.
    assert walks((378.0, 60.0), (420.0, 4.0)) == []
    assert walks((420.0, 40.0), (378.0, 40.0), (420.0, 40.0)) == []
    assert walks((420.0, 4.0)) == []


@pytest.mark.parametrize(("share", "told"), [(0.8, True), (1.0, False)])
def test_a_recording_in_which_the_foot_stands_is_told_from_walks(
    robot: RobotModel, share: float, told: bool
) -> None:
    law = TRUTH["left", "pitch"]
    softer = {**TRUTH, ("left", "pitch"): replace(law, stiffness=share * law.stiffness)}
    walks = [stepping(record(sway(f"walk_{seed}", seed, duration=15.0))) for seed in (1, 2, 3)]
    logs = [noisy(log, seed) for seed, log in enumerate([*walks, record(sway("stand", 4, truth=softer))])]
    found = [note.text for note in identify_feet(robot, logs, settings=LINEAR).notes if note.code == CODE]
    assert [text.split(": stiffness")[0] for text in found] == ["stand: left pitch"] * told
    assert all("beside that of 3 other recordings" in text for text in found)


def test_no_number_of_an_odd_axis_is_usable(robot: RobotModel) -> None:
    """The left foot stands on something softer in one of three recordings."""
    softer = {
        key: replace(law, stiffness=(0.9 if key[0] == "left" else 1.0) * law.stiffness)
        for key, law in TRUTH.items()
    }
    truths = [TRUTH, softer, TRUTH]
    logs = [noisy(record(sway(f"sway_{seed}", seed, truth=truth)), seed) for seed, truth in enumerate(truths)]
    result = identify_feet(robot, logs, settings=LINEAR)
    told = {note.text.split(": stiffness")[0] for note in result.notes if note.code == CODE}
    assert told == {"sway_1: left pitch", "sway_1: left roll"}
    assert {row.foot for row in result.parameters if row.axis != "z" and row.verdict == "usable"} == {"right"}


@pytest.mark.parametrize(("shares", "odd"), [([0.1], 0), ([0.0], None), ([0.1, 0.1], 0), ([0.1, 0.0], 1)])
def test_of_logs_without_noise_nothing_is_unsure_and_the_odd_one_is_found(
    shares: list[float], odd: int | None
) -> None:
    found = furthest(Differences(np.array(shares), np.zeros((len(shares), len(shares)))), 0.05, 5.0)
    assert (found and found.place) == odd

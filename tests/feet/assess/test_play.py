"""Play between an encoder and the foot, and what resembles it: hardening, memory, friction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.feet.assess.play import CODE, encoder_play_notes, play_notes
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.recording import Recording
from plantar.feet.regression.regression_data import tangent_blocks
from plantar.feet.settings import FeetSettings
from plantar.notes import Note

COUNT = 6000
PLAIN = Rubber(stiffness=420.0, damping=18.0)


def swaying(rubber: Rubber, play: float = 0.0) -> list[Recording]:
    """Sways whose encoder reads `play` [rad] more on the one side of the torque's zero than on the other."""
    made = []
    for seed in (0, 1):
        angle, random = swayed(COUNT, seed=seed), np.random.default_rng(seed)
        torque = rubber.torque(angle, np.gradient(angle, PERIOD))
        read = angle + play / 2 * np.tanh(torque / 0.05)
        noise = 0.05 * random.standard_normal(COUNT)
        made.append(made_recording(f"sway_{seed}", read, torque + noise, rate=np.gradient(angle, PERIOD)))
    return made


def said(recordings: list[Recording]) -> list[Note]:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings())
    assert fit is not None
    return play_notes(recordings, fit, tangent_blocks(recordings, fit), False)


@pytest.mark.parametrize("play", [0.004, 0.01])
def test_play_is_told_with_its_size(play: float) -> None:
    (note,) = said(swaying(PLAIN, play))
    assert (note.code, note.severity) == (CODE, "warning")
    assert float(note.text.split("jumps by ")[1].split()[0]) == pytest.approx(1e3 * play, rel=0.25)


@pytest.mark.parametrize(
    "rubber",
    [
        PLAIN,
        Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006),
        Rubber(stiffness=420.0, damping=18.0, hardening=3e5),
        Rubber(stiffness=420.0, damping=18.0, coulomb=1.5),
    ],
)
def test_no_foot_without_play_is_told_of_it(rubber: Rubber) -> None:
    assert said(swaying(rubber)) == []


@pytest.mark.parametrize(("play", "told"), [(0.0023, False), (0.0033, True)])
def test_play_is_told_where_half_as_much_again_is_left_without_it(play: float, told: bool) -> None:
    """Of a step of the torque, half a play times the stiffness, spring and damper leave a fifth of the squares."""
    made = []
    for seed in (0, 1):
        angle, random = swayed(COUNT, seed=seed), np.random.default_rng(seed)
        rate = np.gradient(angle, PERIOD)
        noise = 0.35 * random.standard_normal(COUNT)
        torque = PLAIN.torque(angle, rate) + noise
        read = angle + play / 2 * np.tanh(10 * torque / np.std(torque))
        made.append(made_recording(f"sway_{seed}", read, torque, rate=rate))
    fit = fit_axis(made, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    assert bool(play_notes(made, fit, tangent_blocks(made, fit), False)) == told


def behind(angle: Array, play: float) -> Array:
    """What an encoder reads whose drive has play [rad]: it follows only when the joint has turned by as much."""
    read, state = np.empty_like(angle), angle[0]
    for place, value in enumerate(angle):
        state = min(max(state, value - play / 2), value + play / 2)
        read[place] = state
    return read


def said_of_encoders(
    rubber: Rubber, play: float = 0.0, late: int = 0, share: float = 0.0, noise: float = 0.05
) -> list[Note]:
    """Of sways over an ankle that turns as the bush does by a `share`, and for the rest by itself, and over a hip; read
    with `play` [rad], or `late` by so many samples."""
    made = []
    for seed in (0, 1):
        angle, own, hip = (swayed(COUNT, seed=seed + apart) for apart in (0, 10, 20))
        ankle, rate = share * angle + (1 - share) * own, np.gradient(angle, PERIOD)
        read = np.roll(behind(ankle, play), late)
        torque = rubber.torque(angle, rate) + noise * np.random.default_rng(seed).standard_normal(COUNT)
        one = made_recording(f"sway_{seed}", angle + ankle - read, torque, rate=rate)
        log = one.log.with_columns({"joint.ankle.position": read, "joint.hip.position": hip})
        made.append(replace(one, log=log))
    fit = fit_axis([one.decimated(FOOT) for one in made], FOOT, "pitch", FeetSettings())
    assert fit is not None
    tangents = tangent_blocks([one.decimated(FOOT) for one in made], fit)
    return encoder_play_notes(made, fit, tangents, {"hip", "ankle", "not recorded"}, False)


@pytest.mark.parametrize(("play", "share"), [(0.001, 0.0), (0.002, 0.0), (0.002, 0.5)])
def test_play_in_an_encoders_drive_is_told_with_its_joint_and_size(play: float, share: float) -> None:
    (note,) = said_of_encoders(PLAIN, play, share=share)
    assert (note.code, note.severity) == (CODE, "warning")
    assert "'ankle'" in note.text
    assert float(note.text.split("behind by ")[1].split()[0]) == pytest.approx(1e3 * play, rel=0.3)


@pytest.mark.parametrize("share", [0.0, 0.5])
@pytest.mark.parametrize(
    "rubber", [PLAIN, Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)]
)
def test_no_encoder_without_play_is_told_of_it(rubber: Rubber, share: float) -> None:
    assert said_of_encoders(rubber, share=share) == []


@pytest.mark.parametrize(("play", "told"), [(1e-6, False), (2e-3, True)])
def test_play_that_moves_no_number_is_not_said_even_of_exact_logs(play: float, told: bool) -> None:
    assert bool(said_of_encoders(PLAIN, play, noise=0.0)) == told


def test_encoders_that_are_late_have_no_play() -> None:
    assert said_of_encoders(PLAIN, late=1) == []
    assert said_of_encoders(PLAIN, late=2) == []

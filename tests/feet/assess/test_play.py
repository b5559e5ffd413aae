"""Play between an encoder and the foot, and what resembles it: hardening, memory, friction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.assess.play import CODE, Play, find_play, play_notes
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.recording import Recording
from plantar.feet.regression.tangent import Tangent
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
    return play_notes(Tangent.of(fit, recordings, False), fit)


@pytest.mark.parametrize("play", [0.004, 0.01])
def test_play_is_told_with_its_size(play: float) -> None:
    (note,) = said(swaying(PLAIN, play))
    assert (note.code, note.severity) == (CODE, "warning")
    size, _, rest = note.text.removeprefix(f"{FOOT} pitch: the angle jumps by ").partition(" mrad ")
    assert float(size) == pytest.approx(1e3 * play, rel=0.25)
    assert rest == (
        "where the torque changes its sign: play in the bush, or between an encoder and the foot, which makes the "
        "spring look softer (valid: a bush and gears without play, or encoders on the foot's side; or keep the torque "
        "on one side of zero)"
    )


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
    assert bool(play_notes(Tangent.of(fit, made, False), fit)) == told


def test_play_that_moves_no_number_out_of_its_interval_is_not_said() -> None:
    """`wide`: with all that is unsure of robot and sensors."""
    recordings = swaying(PLAIN, 0.004)
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    tangent = Tangent.of(fit, recordings, False)
    unsure = replace(fit, covariance=np.diag([400.0, 20.0]) ** 2)
    assert len(play_notes(tangent, fit)) == 1
    assert play_notes(tangent, unsure) == []


@pytest.mark.parametrize("zero", [0.0, 2.5, -4.0])
def test_play_is_found_wherever_the_torque_has_its_zero(zero: float) -> None:
    """A force sensor's zero and the torque of the load move it, by more than small motions bend the bush."""
    made = [
        replace(one, bushes={FOOT: replace(one.bushes[FOOT], torque=one.bushes[FOOT].torque + zero)})
        for one in swaying(PLAIN, 0.004)
    ]
    fit = fit_axis(made, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    found = find_play(Tangent.of(fit, made, False))
    assert found is not None
    assert found.jump == pytest.approx(0.004, rel=0.15)
    assert found.zero == pytest.approx(zero, abs=1.0)
    assert found.values[0] == pytest.approx(420.0, rel=0.02)


OTHER = Play(jump=0.002, deviations=40.0, zero=0.0, values=np.zeros(2), squares=0.0)


@pytest.mark.parametrize(("play", "told"), [(0.0, False), (0.0003, False), (0.0008, True)])
def test_an_axis_that_does_not_exclude_the_other_s_play_is_told_of_it(play: float, told: bool) -> None:
    """Alone it shows too little to be told of. It excludes what is four times as much as it shows."""
    made = [
        replace(one, bushes={FOOT: replace(one.bushes[FOOT], torque=one.bushes[FOOT].torque + extra)})
        for seed, one in enumerate(swaying(PLAIN, play))
        for extra in [0.2 * np.random.default_rng(seed + 5).standard_normal((COUNT, 1))]
    ]
    fit = fit_axis(made, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    tangent = Tangent.of(fit, made, False)
    assert play_notes(tangent, fit) == []
    notes = play_notes(tangent, fit, OTHER)
    assert bool(notes) == told
    if told:
        start = f"{FOOT} pitch: about the foot's other axis the angle jumps by 2 mrad where the torque changes its sign"
        assert notes[0].text.startswith(start)
        larger = float(notes[0].text.partition("the stiffness is ")[2].partition(" %")[0])
        assert 1.0 <= larger <= 8.0
        unsure = replace(fit, covariance=np.diag([400.0, 20.0]) ** 2)
        assert play_notes(tangent, unsure, OTHER) == []


def test_play_about_both_axes_is_the_bush_s_and_told_within_intervals_too() -> None:
    recordings = swaying(PLAIN, 0.004)
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    unsure = replace(fit, covariance=np.diag([400.0, 20.0]) ** 2)
    tangent = Tangent.of(fit, recordings, False)
    (note,) = play_notes(tangent, unsure, OTHER)
    assert note.text.startswith(f"{FOOT} pitch: the angle jumps by 4.2 mrad")


def test_noise_of_the_torque_is_no_play() -> None:
    """It makes the torque's own sign, most at the ends of its range, where a jump of the other sense fits it best."""
    made = [
        replace(one, bushes={FOOT: replace(one.bushes[FOOT], torque=one.bushes[FOOT].torque + extra)})
        for seed, one in enumerate(swaying(PLAIN, 0.0008))
        for extra in [0.5 * np.random.default_rng(seed + 5).standard_normal((COUNT, 1))]
    ]
    fit = fit_axis(made, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    found = find_play(Tangent.of(fit, made, False))
    assert found is None or found.jump > 0

"""A zero that jumps within a log, and what looks like one: memory, drift, one sway in a quiet log, another stance."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from biped import TRUTH, record, sway
from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.phases import AIR, SUPPORTS
from plantar.contact.reasons import Reason
from plantar.estimation import Block
from plantar.feet.assess.zero_jumps import CODE, EXPLAINS, _left_beside, zero_jumps
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.models import KelvinVoigt
from plantar.robot.model import RobotModel

COUNT = 6000
PLAIN = Rubber(stiffness=420.0, damping=18.0)
SLIPPING = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)
LATER = PERIOD * np.arange(COUNT) >= 33.0


def swaying(
    rubber: Rubber, added: np.ndarray | float = 0.0, angle: np.ndarray | None = None, noise: float = 0.1
) -> list[Recording]:
    made = []
    for seed in (0, 1):
        moved = swayed(COUNT, seed=seed) if angle is None else angle
        torque = rubber.torque(moved, np.gradient(moved, PERIOD))
        torque += noise * np.random.default_rng(seed).standard_normal(COUNT)
        made.append(made_recording(f"sway_{seed}", moved, torque + (added if seed else 0.0)))
    return made


def said(recordings: list[Recording], model: str = "kelvin_voigt") -> list[str]:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model=model))
    assert fit is not None
    return [note.text for note in zero_jumps(recordings, fit, False)]


@pytest.mark.parametrize(("rubber", "model"), [(PLAIN, "kelvin_voigt"), (SLIPPING, "elastoplastic")])
def test_a_jump_is_told_with_its_log_and_time(rubber: Rubber, model: str) -> None:
    (text,) = said(swaying(rubber, 6.0 * LATER), model)
    assert text.startswith("sway_1: t = 3")
    assert abs(float(text.split()[3]) - 33.0) < 0.3
    assert text.partition(" s: ")[2] == (
        f"the zero of {FOOT} pitch jumps: an encoder between IMU and foot slipped, or IMU or force sensor were zeroed "
        "anew or are loose (valid: one zero throughout a log; cut it there)"
    )


@pytest.mark.parametrize("size", [1.0, 3.0])
def test_a_jump_has_its_size_beside_the_drift_that_follows_it(size: float) -> None:
    """Slow columns take most of a step; what is left of it between the means is a tenth."""
    (text,) = said(swaying(PLAIN, size * LATER))
    assert abs(float(text.split()[3]) - 33.0) < 0.3


@pytest.mark.parametrize("count", [3, 12])
def test_a_sensor_that_is_loose_jumps_to_and_fro(count: int) -> None:
    """Over longer means none of its jumps stands out, and none alone explains much."""
    loose = np.sign(np.sin(np.pi * (0.5 + count * np.arange(COUNT) / COUNT)))
    (text,) = said(swaying(PLAIN, 2.0 * loose))
    assert f" s, the first of {count} times: the zero of {FOOT} pitch jumps: " in text


@pytest.mark.parametrize(
    "recordings",
    [
        swaying(PLAIN),
        swaying(SLIPPING),
        swaying(PLAIN, 6.0 * PERIOD * np.arange(COUNT) / 60),  # a line
        swaying(PLAIN, 3.0 * np.sin(0.15 * PERIOD * np.arange(COUNT))),  # drift
        swaying(SLIPPING, angle=np.where(np.abs(np.arange(COUNT) - 3000) < 300, swayed(COUNT, seed=0), 0.0)),
        swaying(PLAIN, 0.02 * LATER),  # too small to matter
    ],
)
@pytest.mark.parametrize("model", ["kelvin_voigt", "elastoplastic"])
def test_what_is_no_jump_is_not_taken_for_one(recordings: list[Recording], model: str) -> None:
    assert said(recordings, model) == []


def test_a_clear_jump_of_less_than_three_per_cent_of_the_torques_spread_does_no_harm() -> None:
    recordings = swaying(PLAIN, 0.2 * LATER, noise=0.02)
    assert 0.03 * np.std(recordings[1].bushes[FOOT].torque[:, 0]) > 0.2
    assert said(recordings) == []


def test_memory_of_a_push_is_no_jump_of_a_zero() -> None:
    """After a push to the other side the element pulls the other way, as long as small motions do not make it slip."""
    time = PERIOD * np.arange(COUNT)
    pushed = [0.01 * side * np.exp(-(((time - at) / 0.7) ** 2)) for side, at in ((-1, 4.0), (1, 33.0))]
    recordings = swaying(SLIPPING, angle=0.05 * swayed(COUNT, seed=0) + sum(pushed))
    assert len(said(recordings, "kelvin_voigt")) == 2
    assert said(recordings, "elastoplastic") == []


def test_a_memory_that_was_not_chosen_still_explains_what_looks_like_a_jump() -> None:
    """Spring and damper are kept where a memory that predicts better is hardly known: its first turn is no jump."""
    time = PERIOD * np.arange(COUNT)
    angle = 0.05 * swayed(COUNT, seed=0) + 0.01 * np.exp(-(((time - 33.0) / 0.7) ** 2))
    recordings = swaying(SLIPPING, angle=angle)
    spring, chosen = (
        fit_axis(recordings, FOOT, "pitch", FeetSettings(model=name)) for name in ("kelvin_voigt", "auto")
    )
    assert spring is not None
    assert chosen is not None
    assert len(zero_jumps(recordings, spring, False)) == 2
    assert zero_jumps(recordings, replace(spring, choice=chosen.choice), False) == []
    assert chosen.choice is not None
    worse = [
        replace(score, held_out_rms=score.held_out_rms + 9.0)
        for score in chosen.choice.ranking
        if score.model.remembers
    ]
    others = [score for score in chosen.choice.ranking if not score.model.remembers]
    seldom = replace(spring, choice=replace(chosen.choice, ranking=(*others, *worse)))
    assert zero_jumps(recordings, seldom, False) == [], "one turn in all logs predicts nothing held out"
    jumped = swaying(PLAIN, 6.0 * LATER)
    told = fit_axis(jumped, FOOT, "pitch", FeetSettings())
    assert told is not None
    assert told.choice is not None
    assert len(zero_jumps(jumped, replace(told, model=KelvinVoigt()), False)) == 1


def test_beside_a_memory_that_was_chosen_no_other_explains_a_jump() -> None:
    """A push turns the element just behind the jump, so that it follows nearly all of it and its misfit shows none."""
    time = PERIOD * np.arange(COUNT)
    pushed = 0.01 * sum(side * np.exp(-(((time - at) / 0.7) ** 2)) for side, at in ((-1, 4.0), (1, 33.5)))
    recordings = swaying(PLAIN, 1.5 * LATER, angle=0.05 * swayed(COUNT, seed=0) + pushed)
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model="elastoplastic"))
    assert fit is not None
    exact = Mock(model=fit.model, fit=Mock(residuals={each.name: np.zeros(1) for each in recordings}))
    assert len(zero_jumps(recordings, replace(fit, choice=Mock(ranking=(exact,))), False)) == 1


def test_an_element_that_just_slips_once_is_no_jump_of_a_zero() -> None:
    """It leans once by its slip angle, in a log without noise: from which state it began decides whether it slips."""
    lean = 0.004 * np.clip((PERIOD * np.arange(COUNT) - 30.0) / 3.0, 0.0, 1.0)
    angles = [swayed(COUNT, seed=0), 0.05 * swayed(COUNT, seed=1) + lean]
    recordings = [swaying(SLIPPING, angle=angle, noise=0.0)[place] for place, angle in enumerate(angles)]
    assert said(recordings, "elastoplastic") == []


def test_a_foot_that_was_lifted_meanwhile_stands_elsewhere() -> None:
    recordings = swaying(PLAIN, 6.0 * LATER)
    contact = recordings[1].contacts[FOOT]
    support = contact.support.copy()
    support[3250:3300] = SUPPORTS.index(AIR)
    lifted = replace(recordings[1], contacts={FOOT: replace(contact, support=support)})
    assert said([recordings[0], lifted.without(FOOT, support > 0, Reason.FILTER_EDGE)]) == []


@pytest.mark.parametrize(("reason", "told"), [(Reason.OUTLIER, 1), (Reason.ON_THE_EDGE, 0)])
def test_a_sole_that_tipped_meanwhile_lies_otherwise(reason: Reason, told: int) -> None:
    """A jump's own samples are left out as well, but never as those of a sole that tips."""
    recordings = swaying(PLAIN, 6.0 * LATER)
    gone = np.abs(np.arange(COUNT) - 3300) < 30
    assert len(said([recordings[0], recordings[1].without(FOOT, gone, reason)])) == told


def test_an_encoder_that_slips_keeps_numbers_from_being_usable(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    column = "joint.left_ankle_pitch.position"
    slipped = log.with_columns({column: log.column(column) + 0.01 * (log.time > 35)})
    found = identify_feet(robot, [slipped], settings=FeetSettings(model="kelvin_voigt"))
    (note,) = [note for note in found.notes if note.code == CODE]
    assert "zero of left pitch jumps" in note.text
    for name in ("stiffness", "damping"):
        for axis in (
            "pitch",
            "roll",
        ):  # a leg that is elsewhere than its encoders say tilts the other way as well
            assert found.parameter("left", axis, name).verdict != "usable"
    healthy = found.parameter("right", "pitch", "stiffness")
    assert healthy.value == pytest.approx(TRUTH["right", "pitch"].stiffness, rel=0.01)
    assert not [note for note in identify_feet(robot, [log]).notes if note.code == CODE]


@pytest.mark.parametrize(("share", "told"), [(0.4, False), (0.6, True)])
def test_a_step_explains_most_of_what_is_missed(share: float, told: bool) -> None:
    """Half of the squares; a step of `size` has a quarter of its square, the rest is noise."""
    random = np.random.default_rng(0)
    missed = random.standard_normal(2000)
    missed /= missed.std()
    step = 2 * np.sqrt(share / (1 - share)) * (np.arange(2000) >= 1000)
    block = Block("sway", random.standard_normal((2000, 1)), 10 * random.standard_normal(2000), PERIOD, 1)
    whole = missed - missed.mean() + step - step.mean()
    left = _left_beside(whole, [1000], block, share=EXPLAINS)
    assert (left is not None) == told
    if left is not None:
        assert left == pytest.approx((1 - share) * float(whole @ whole), rel=0.05)


def test_a_stiffness_of_the_recordings_own_is_no_jump_of_its_zero() -> None:
    """What the common stiffness misses goes with the angle; a step that hardly shows beside noise explains little."""
    random = np.random.default_rng(0)
    angle, noise = random.standard_normal((2, 2000))
    block = Block("sway", angle[:, None], 10 * angle, PERIOD, 1)
    step = np.where(np.arange(2000) >= 1000, 0.5, 0.0)
    assert _left_beside(3 * angle + step + 0.5 * noise, [1000], block, share=EXPLAINS) is None
    assert _left_beside(3 * angle + step + 0.1 * noise, [1000], block, share=EXPLAINS) is not None

"""Rows, columns and torques of a regression by hand: which recordings take part, and what is taken off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import FOOT, LOAD, PERIOD, made_recording, swayed
from plantar.contact.phases import AIR, SUPPORTS
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AngleDrift, AxisFit
from plantar.feet.regression.load_torque import late_encoder_torque, load_torque
from plantar.feet.regression.model_columns import UNTURNED, model_columns
from plantar.feet.regression.prediction import predict
from plantar.feet.regression.regression_data import blocks_of, data_set_of, motion_of, path_of
from plantar.models import MODELS, KelvinVoigt

COUNT = 2000
TIME = PERIOD * np.arange(COUNT)
ANGLE = swayed(COUNT)
TORQUE = 400.0 * ANGLE + 10.0 * np.gradient(ANGLE, PERIOD) + 3.0
FIT = AxisFit(
    foot=FOOT, axis="pitch", model=KelvinVoigt(), values=np.array([400.0, 10.0]), shape=np.zeros(0),
    covariance=np.diag([16.0, 0.25]), freedom=np.full(2, 30.0), white_std=np.ones(2), offset_std={},
    equivalent=(400.0, 10.0), choice=None, reason="", offsets={"sway": 3.0},
)  # fmt: skip
WALK = Stances(np.repeat(np.arange(4), 500), np.linspace(0.2, 0.8, COUNT))


def loaded(recording: Recording, x: float = 20.0, y: float = 30.0, yaw: float = 7.0) -> Recording:
    """Under horizontal forces and a yaw torque that do not change."""
    bush = recording.bushes[FOOT]
    wrench = bush.wrench.copy()
    wrench[:, 0], wrench[:, 1], wrench[:, 5] = x, y, yaw
    moved = replace(bush, wrench=wrench)
    return replace(recording, bushes={FOOT: moved}, raw={FOOT: moved})


@pytest.mark.parametrize(("used", "takes_part"), [(49, False), (51, True)])
def test_fifty_samples_take_part(used: int, takes_part: bool) -> None:
    """Of all, however many a fit takes: at 100 Hz behind 5 Hz every second one."""
    recording = made_recording("sway", ANGLE, TORQUE).without(
        FOOT, np.arange(COUNT) >= used, Reason.SET_ASIDE
    )
    blocks = blocks_of([recording], FOOT, "pitch")
    assert len(blocks) == takes_part
    assert not blocks or (len(blocks[0].response), blocks[0].thinned) == (26, 2)
    assert not blocks or blocks[0].period == pytest.approx(0.02)
    assert blocks_of([made_recording("other", ANGLE, TORQUE)], FOOT, "pitch", fit=FIT) == []


def test_rows_of_a_foot_that_steps_have_stances_weights_and_what_is_not_the_bush_s() -> None:
    recording = loaded(made_recording("walk", ANGLE, TORQUE, stances=WALK))
    (block,) = blocks_of([recording], FOOT, "roll")
    assert block.stances is not None
    assert block.common_nuisance is not None
    assert (len(block.response), block.thinned, block.nuisance) == (COUNT // 2, 2, None)
    assert np.array_equal(block.stances.weight, WALK.weight[::2])
    middle = block.common_nuisance[125]
    assert middle == pytest.approx([LOAD, -30.0, TORQUE[250], 7.0, 20.0], rel=1e-6)
    assert list(block.common_spread) == [np.inf, 0.006, 0.02, 0.02, 0.004]  # type: ignore[arg-type]
    assert blocks_of([made_recording("sway", ANGLE, TORQUE)], FOOT, "roll")[0].common_spread is None


@pytest.mark.parametrize(("axis", "across", "along"), [("pitch", 20.0, 30.0), ("roll", -30.0, 20.0)])
def test_a_load_s_torque_is_the_sum_of_its_parts(axis: str, across: float, along: float) -> None:
    recording = loaded(made_recording("sway", ANGLE, TORQUE))
    fit = replace(FIT, axis=axis, moment_arms=(0.01, 0.002), turned=0.1)  # type: ignore[arg-type]
    expected = 0.01 * LOAD + 0.002 * across + 0.1 * TORQUE
    assert load_torque(recording, fit)[500:1500] == pytest.approx(expected[500:1500], abs=1e-6)
    leaning = load_torque(recording, replace(fit, leans=0.05))
    assert leaning[500:1500] == pytest.approx(expected[500:1500] + 0.05 * 7.0, abs=1e-6)
    crossed = load_torque(recording, replace(fit, crosstalk=0.004))
    assert crossed[500:1500] == pytest.approx(expected[500:1500] + 0.004 * along, abs=1e-6)
    (block,) = blocks_of([recording], FOOT, axis, fit=replace(fit, offsets={"sway": 0.0}))  # type: ignore[arg-type]
    assert block.response[250:750] == pytest.approx((TORQUE - expected)[500:1500:2], abs=1e-6)


def test_late_encoders_make_a_torque_of_the_joints_rates() -> None:
    rate = 0.2 * np.sin(2 * np.pi * 0.5 * TIME)
    rates = {FOOT: np.column_stack([np.zeros(COUNT), rate])}
    recording = replace(made_recording("sway", ANGLE, TORQUE), encoder_rates=rates)
    slope = 0.2 * np.pi * np.cos(2 * np.pi * 0.5 * TIME)
    found = late_encoder_torque(recording, replace(FIT, axis="roll"))
    assert found[5:-5] == pytest.approx((400.0 * rate + 10.0 * slope)[5:-5], abs=1e-3)
    assert not late_encoder_torque(recording, FIT).any()
    assert not late_encoder_torque(made_recording("sway", ANGLE, TORQUE), FIT).any()


def test_an_imu_s_turn_moves_the_angle_and_its_rate() -> None:
    recording = made_recording("sway", ANGLE, TORQUE)
    turns = np.zeros((COUNT, 2, 3))
    turns[:, 0, 2] = TIME
    found = motion_of(replace(recording, imu_turns={FOOT: turns}), FOOT, "pitch", (0.0, 0.0, 0.01))
    plain = motion_of(recording, FOOT, "pitch", imu_turned=UNTURNED)
    assert found.deflection - plain.deflection == pytest.approx(0.01 * TIME)
    assert found.rate - plain.rate == pytest.approx(np.full(COUNT, 0.01))


def test_a_memory_s_path_is_quicker_in_stances_and_without_its_drift() -> None:
    """Six times the fit's cutoff: a tone of 30 Hz is halved; a foot that stands follows what the fit sees."""
    quick = np.sin(2 * np.pi * 30.0 * TIME)
    walk = replace(
        made_recording("walk", quick, TORQUE, rate=quick, stances=replace(WALK, number=np.zeros(COUNT, int)))
    )
    path = path_of(walk, FOOT, "pitch").deflection
    assert np.std(path[200:-200]) == pytest.approx(0.5 * np.std(quick), rel=0.02)
    own = replace(walk.raw[FOOT], deflection=np.outer(quick, [1.0, 2.0]), rate=np.outer(quick, [3.0, 4.0]))
    found = [path_of(replace(walk, raw={FOOT: own}), FOOT, axis) for axis in ("pitch", "roll")]
    for one, sizes in zip(found, ((1.0, 3.0), (2.0, 4.0)), strict=True):
        assert one.deflection == pytest.approx(sizes[0] * path)
        assert one.rate == pytest.approx(sizes[1] * path)
    standing = made_recording("sway", quick, TORQUE, rate=quick)
    assert np.array_equal(path_of(standing, FOOT, "pitch").deflection, quick)
    drift = AngleDrift(TIME[[0, -1]], np.array([0.0, 0.01]))
    assert data_set_of(standing, FOOT, "pitch", drift=drift).drift == pytest.approx(
        np.linspace(0.0, 0.01, COUNT)
    )


def test_a_walk_s_data_set_is_without_what_is_not_the_bush_s() -> None:
    recording = loaded(made_recording("walk", ANGLE, TORQUE, stances=WALK))
    place = {"above": 0.01, "turned": 0.2, "leans": 0.05, "crosstalk": 0.004}
    for axis, across, along in (("pitch", 20.0, 30.0), ("roll", -30.0, 20.0)):
        found = data_set_of(recording, FOOT, axis, 0.3, **place)  # type: ignore[arg-type]
        assert found.torque == pytest.approx(0.8 * TORQUE - 0.01 * across - 0.05 * 7.0 - 0.004 * along)
        assert found.steps is not None
        assert found.steps.share == 0.3


def test_an_unseen_motion_has_its_first_second_s_offset_and_a_seen_one_its_own() -> None:
    step = np.where(TIME > 1.5, 2.0, 0.0)
    seen = predict(made_recording("sway", ANGLE, TORQUE + step), FIT)
    assert seen is not None
    assert seen.torque == pytest.approx(TORQUE, abs=0.05)
    assert seen.trivial == pytest.approx(np.full(COUNT, np.mean(TORQUE + step)))
    unseen = predict(made_recording("other", ANGLE, TORQUE + step + 5.0, role="validate"), FIT)
    assert unseen is not None
    assert unseen.torque == pytest.approx(TORQUE + 5.0, abs=0.05)
    assert unseen.trivial[0] == pytest.approx(np.mean((TORQUE + 5.0)[~unseen.scored]))
    assert np.sum(~unseen.scored) in (100, 101)
    assert predict(made_recording("third", ANGLE, TORQUE), FIT) is None


def test_a_fit_s_numbers_by_name() -> None:
    assert list(FIT.std) == [4.0, 0.5]
    assert (FIT.slip_angle, FIT.names) == (None, ("stiffness", "damping"))
    slips = replace(
        FIT, model=MODELS["elastoplastic"], values=np.array([400.0, 10.0, 3.0]), shape=np.array([0.02])
    )
    assert slips.slip_angle == 0.02
    assert list(slips.numbers) == [400.0, 10.0, 3.0, 0.02]
    assert slips.names == ("stiffness", "damping", "slip_torque", "slip_angle")
    assert list(slips.at_place(np.arange(5.0)).place) == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_columns_of_a_memory_are_gaps_in_the_air() -> None:
    """Neither a zero, which would be fitted, nor what the memory had before: a bush in the air forgets."""
    slipping = replace(
        FIT, model=MODELS["elastoplastic"], values=np.array([400.0, 10.0, 4.0]), shape=np.array([0.006])
    )
    recording = made_recording("sway", ANGLE, TORQUE)
    contact = recording.contacts[FOOT]
    support = contact.support.copy()
    support[900:1100] = SUPPORTS.index(AIR)
    lifted = replace(recording, contacts={FOOT: replace(contact, support=support)})
    for fit, count in ((FIT, 2), (slipping, 3)):
        columns = model_columns(lifted, FOOT, "pitch", fit)
        assert columns.shape == (COUNT, count)
        assert np.isnan(columns[900:1100]).all()
        assert np.isfinite(columns[100:800]).all()


def test_each_turn_of_the_imu_has_its_own_motion() -> None:
    """However often one or another was asked for before; angle and rate follow the turn, each axis its own."""
    recording = made_recording("sway", ANGLE, TORQUE)
    seen = np.random.default_rng(0).normal(0, 0.1, (2, 3)) * np.sin(TIME)[:, None, None]
    recording = replace(recording, imu_turns={FOOT: seen})
    plain = motion_of(recording, FOOT, "pitch", imu_turned=UNTURNED)
    for turn in ((0.01, 0.0, 0.0), (0.0, 0.02, -0.01), (0.01, 0.0, 0.0)):
        for column, axis in enumerate(("pitch", "roll")):
            turned = motion_of(recording, FOOT, axis, turn)
            moved = seen[:, column] @ np.array(turn)
            assert turned.deflection - plain.deflection == pytest.approx(moved, abs=1e-12)
            rate = turned.rate - plain.rate
            assert rate[2:-2] == pytest.approx(np.gradient(moved, PERIOD)[2:-2], abs=1e-6)

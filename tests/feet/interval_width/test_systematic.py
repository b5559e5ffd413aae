"""What no residual shows widens an interval by as much as it moves the number, and no further."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped import TRUTH, Motion, record, sway
from biped_robot import FEET
from feet_trials import AXES, LINEAR, noisy
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import NORMAL95
from plantar.estimation import Block, fit_blocks
from plantar.estimation.blocks import StanceRows
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.vertical_stiffness import VerticalStiffness
from plantar.feet.identify import identify_feet
from plantar.feet.interval_width import systematic
from plantar.feet.interval_width.cause import Cause, inflated
from plantar.feet.interval_width.systematic import (
    _angle_errors,
    _ends_of_stances,
    _late_torques,
    _softening,
    _suspected_hardening,
    systematic_causes,
)
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.logs.motion_log import MotionLog
from plantar.models import MODELS
from plantar.notes import Note
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import SensorDelay


def stiffening(hardening: float) -> list[Motion]:
    """Two sways on bushes that stiffen (or soften) with deflection."""
    truth = {key: replace(model, hardening=hardening) for key, model in TRUTH.items()}
    return [sway(f"sway_{seed}", seed, duration=40.0, truth=truth) for seed in (3, 4)]


def identified(robot: RobotModel, hardening: float) -> FeetResult:
    logs = [noisy(record(motion), seed) for seed, motion in enumerate(stiffening(hardening))]
    return identify_feet(robot, logs, settings=LINEAR)


@pytest.fixture(scope="module")
def plain(robot: RobotModel) -> FeetResult:
    return identified(robot, 0.0)


@pytest.mark.parametrize("hardening", [20000.0, -20000.0])
def test_a_spring_that_stiffens_widens_the_stiffness_of_a_model_that_does_not(
    robot: RobotModel, plain: FeetResult, hardening: float
) -> None:
    found = identified(robot, hardening)
    for foot in FEET:
        for axis in AXES:
            row, clean = (one.parameter(foot, axis, "stiffness") for one in (found, plain))
            truth = TRUTH[foot, axis].stiffness
            assert (row.value - truth) * hardening > 0  # mean slope, not the slope at zero
            assert abs(row.value - truth) > 2 * clean.std
            low, high = row.interval95
            assert low < truth < high
            assert row.std < 1.5 * abs(row.value - truth)


def test_a_cube_is_looked_for_about_the_middle_of_the_motions() -> None:
    """A turned IMU puts the angle's zero anywhere: far from it a cube is a slope, and says nothing of these motions."""
    angle = swayed(4000, seed=2)
    found = []
    for middle in (0.0, 0.05):
        torque = 400.0 * angle + 2e5 * angle**3
        fit = fit_axis([made_recording("sway", angle + middle, torque)], FOOT, "pitch", LINEAR)
        assert fit is not None
        tangent = Tangent.of(fit, [made_recording("sway", angle + middle, torque)], False)
        found += [cause.effect[0] * cause.std for cause in _suspected_hardening(tangent)]
    assert len(found) == 2
    assert abs(found[0]) > 5.0
    assert found[1] == pytest.approx(found[0], rel=1e-6)


def test_a_spring_that_does_not_stiffen_is_not_widened(plain: FeetResult) -> None:
    shares = [
        each.variance_shares.get("hardening", 0.0) for each in plain.diagnosis if each.name == "stiffness"
    ]
    assert len(shares) == 4
    assert np.median(shares) == 0.0


def lifted(log: MotionLog) -> MotionLog:
    """The left foot leaves the floor for a second in the middle, and lands with another torque zero."""
    middle = 0.5 * (log.time[0] + log.time[-1])
    away, later = np.abs(log.time - middle) < 0.5, log.time > middle
    changed = {}
    for part in ("force", "torque"):
        for axis in "xyz":
            name = f"wrench.left.{part}.{axis}"
            moved = 6.0 * later if (part, axis) == ("torque", "y") else 0.0
            changed[name] = np.where(away, 0.0, log.columns[name] + moved)
    return log.with_columns(changed)


def test_a_foot_put_down_anew_is_widened_by_what_its_zeros_do(robot: RobotModel) -> None:
    log = noisy(record(sway("sway_3", 3, duration=40.0)), 3)
    usual, found = (identify_feet(robot, [one], settings=LINEAR) for one in (log, lifted(log)))
    shares = {(each.foot, each.axis, each.name): each.variance_shares for each in found.diagnosis}
    assert shares["left", "pitch", "stiffness"]["zeros of stances"] > 0
    assert "zeros of stances" not in shares["right", "pitch", "stiffness"]
    assert not any("zeros of stances" in each.variance_shares for each in usual.diagnosis)
    low, high = found.parameter("left", "pitch", "stiffness").interval95
    assert low < TRUTH["left", "pitch"].stiffness < high


def test_a_delay_in_doubt_is_allowed_for_as_far_as_it_may_be_off() -> None:
    """Of a spring's torque that swings at 1 Hz, read 0.1 s late or early, a fifth of the slope is lost."""
    period, reach = 0.01, 0.1
    time = period * np.arange(1000)
    torque, used = np.sin(2 * np.pi * time), np.arange(1000) % 1000 > 100
    sure = SensorDelay(0.0, reach / NORMAL95, np.inf, False, Note("delay", "info", ""))
    read: Any = SimpleNamespace(period=period)
    (slope,) = (late(read)[used] for late in _late_torques(sure, lambda _: torque))
    np.testing.assert_allclose(slope, 2 * np.pi * np.cos(2 * np.pi * time)[used], atol=0.1)
    doubtful = _late_torques(replace(sure, doubtful=True), lambda _: torque)
    later, earlier = (late(read)[used] for late in doubtful)
    inner = slice(100, -100)
    wave = torque[used][inner]
    for change, moved in ((later, reach), (earlier, -reach)):
        expected = (np.sin(2 * np.pi * (time + moved)) - torque)[used][inner] / reach
        np.testing.assert_allclose(change[inner], expected, atol=1e-6)
        assert reach * (change[inner] @ wave) / (wave @ wave) == pytest.approx(
            np.cos(2 * np.pi * reach) - 1, abs=0.01
        )


def test_a_cause_adds_its_variance_and_brings_its_few_degrees_of_freedom() -> None:
    """Welch and Satterthwaite, by hand: (1 + 9)² / (1²/10 + 9²/2) of the stiffness; the damping is not moved."""
    angle = swayed(2000)
    fit = fit_axis([made_recording("sway", angle, 400.0 * angle)], FOOT, "pitch", LINEAR)
    assert fit is not None
    fit = replace(fit, covariance=np.eye(2), freedom=np.full(2, 10.0))
    wide = inflated(fit, [Cause("delay", np.array([-6.0, 0.0]), 0.5, 2.0)])
    np.testing.assert_allclose(wide.covariance, np.diag([10.0, 1.0]))
    np.testing.assert_allclose(wide.freedom, [100 / 40.6, 10.0])


def causes_of(
    fit: AxisFit, recordings: list[Recording], delay: SensorDelay, vertical: VerticalStiffness
) -> dict[str, Cause]:
    tangent = Tangent.of(fit, recordings, False)
    return {cause.name: cause for cause in systematic_causes(tangent, delay, vertical)}


def test_a_cause_is_as_sure_as_what_it_comes_from() -> None:
    """The delay's deviation rests on few logs, the compliance's on others."""
    angle = swayed(2000)
    recording = made_recording("sway", angle, 400.0 * angle)
    fit = fit_axis([recording], FOOT, "pitch", LINEAR)
    assert fit is not None
    late = SensorDelay(0.0, 0.001, 7.0, True, Note("delay", "info", ""))
    vertical = VerticalStiffness((), (), {FOOT: 0.0}, {FOOT: 2e-6}, 5.0)
    found = causes_of(fit, [recording], late, vertical)
    assert (found["delay"].std, found["delay"].freedom) == (0.001, 7.0)
    assert (found["moment arm"].std, found["moment arm"].freedom) == (2e-6, 5.0)
    assert found["delay"].share[1] == pytest.approx(0.001 * 400.0, rel=0.02), "K·delay off the damping"


def test_a_delay_in_doubt_counts_the_way_that_moves_the_stiffness_more() -> None:
    """Of K·q + C·q̇ a later torque has lost C·ω·sin and K·(1 - cos); an earlier one loses and gains, and loses less."""
    angle = swayed(2000)
    recording = made_recording("sway", angle, 400.0 * angle + 20.0 * np.gradient(angle, PERIOD))
    fit = fit_axis([recording], FOOT, "pitch", LINEAR)
    assert fit is not None
    late = SensorDelay(0.0, 0.01, 7.0, False, Note("delay", "info", ""), doubtful=True)
    found = causes_of(fit, [recording], late, VerticalStiffness((), (), {FOOT: 0.0}, {FOOT: 0.0}, 5.0))
    assert found["delay"].effect[0] < 0.0 < found["delay"].effect[1]


@pytest.mark.parametrize(("seed", "zeros"), [(0, 3.5355), (5, 0.4), (5, 20.0)])
def test_the_yaw_torques_zero_is_as_large_as_the_others_or_as_motions_show_it(
    seed: int, zeros: float
) -> None:
    """The others' root mean square, whatever their signs, at most; where pitch is roll, no motion shows it smaller.
    Each recording has its own, and moves roll by the sine of its own pitch."""
    roll, pitch = ([swayed(2000, seed=first + k) for k in (0, 1)] for first in (0, seed))
    recordings, random = [], np.random.default_rng(7)
    for k, (own, other) in enumerate(zip(roll, pitch, strict=True)):
        torque = 400.0 * own - zeros * (seed > 0) * np.sin(other)
        one = made_recording(f"sway_{k}", own, torque + random.normal(0, 0.002, 2000))
        state = replace(one.bushes[FOOT], deflection=np.column_stack([other, own]))
        recordings.append(replace(one, raw={FOOT: state}, bushes={FOOT: state}))
    fit = fit_axis(recordings, FOOT, "roll", LINEAR)
    assert fit is not None
    fit = replace(fit, offsets={"sway_0": 3.0, "sway_1": -4.0})
    exact = SensorDelay(0.0, 0.0, np.inf, False, Note("delay", "info", ""))
    flat = VerticalStiffness((), (), {FOOT: 0.0}, {FOOT: 0.0}, np.inf)
    yaw = causes_of(fit, recordings, exact, flat)["yaw torque zero"]
    influences = Tangent.of(fit, recordings, False).influences
    sines = [np.sin(other)[one.rows(FOOT)] for other, one in zip(pitch, recordings, strict=True)]
    moved = [(own @ sine)[0] for own, sine in zip(influences, sines, strict=True)]
    assert yaw.share[0] == pytest.approx(min(zeros, np.sqrt(12.5)) * np.hypot(*moved), rel=0.01)
    if seed == 0:  # of two alike recordings one adds half of the pitch angle's sine to K·roll
        assert np.hypot(*moved) == pytest.approx(np.hypot(0.5, 0.5), rel=0.05)
    assert "yaw torque zero" not in causes_of(replace(fit, axis="pitch"), recordings, exact, flat)


def test_ends_of_stances_move_a_fit_beyond_what_fewer_samples_do_by_chance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without a tenth at either end; the deviations of both fits differ by 3, so 3 of 5 may be chance (Hausman)."""
    kept: list[np.ndarray] = []

    class Rows(SimpleNamespace):
        def part(self, rows: np.ndarray) -> str:
            kept.append(rows)
            return "inner"

    fits = {
        "inner": SimpleNamespace(values=np.array([405.0, 18.0]), std=np.array([5.0, 5.0])),
        "whole": SimpleNamespace(values=np.array([400.0, 20.0]), std=np.array([4.0, 4.0])),
    }
    monkeypatch.setattr(
        systematic, "fit_blocks", lambda some: fits["inner" if some[0] == "inner" else "whole"]
    )
    stances = SimpleNamespace(split=lambda: [np.arange(20), np.arange(20, 50)])
    cause = _ends_of_stances([Rows(stances=stances)])  # type: ignore[list-item]
    assert cause.effect == pytest.approx([4.0, 0.0])
    assert kept[0].tolist() == [*range(2, 18), *range(23, 47)]


def test_a_standing_foot_whose_angle_wanders_is_widened_by_what_that_takes_off() -> None:
    """Between what is seen and what may be there: the spring is no weaker than seen, and no stiffer than the bound."""
    truth = swayed(4000)
    time = 0.01 * np.arange(4000)
    wander = 0.01 * np.sin(2 * np.pi * 0.43 * time)
    recording = made_recording("sway", truth + wander, 400.0 * truth)
    fit = fit_axis([recording], FOOT, "pitch", LINEAR)
    assert fit is not None
    punctual = SensorDelay(0.0, 0.0, 7.0, True, Note("delay", "info", ""))
    vertical = VerticalStiffness((), (), {FOOT: 0.0}, {FOOT: 0.0}, 5.0)
    cause = causes_of(fit, [recording], punctual, vertical)["angle errors"]
    taken = 400.0 - fit.values[0]
    assert taken > 10.0, "it matters"
    assert cause.effect[0] == pytest.approx(taken, rel=0.25)


@pytest.mark.parametrize("steps", [True, False])
@pytest.mark.parametrize(("wander", "noise", "share"), [(0.004, 0.0, 0.1), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
def test_an_attitude_that_wanders_draws_the_spring_to_zero(
    wander: float, noise: float, share: float, steps: bool
) -> None:
    """Of feet that step or stand: as much as the slow torque that is left says, where all of it is the angle's; healthy
    logs, and those with quick noise of the torque, are hardly widened."""
    time, number = 0.01 * np.arange(12000), np.arange(12000) // 100
    angle = swayed(12000, 0.01)
    slow = sum(np.sin(2 * np.pi * hertz * time + hertz) for hertz in (0.131, 0.217, 0.43)) / np.sqrt(3)
    torque = 400.0 * angle + noise * np.random.default_rng(4).standard_normal(12000)
    seen = np.column_stack([angle + wander * slow, np.gradient(angle)])
    stances = StanceRows(number, np.ones(12000)) if steps else None
    blocks = [Block("log", seen, torque, 0.01, stances=stances)]
    stiffness = fit_blocks(blocks).values[0]
    fit: Any = SimpleNamespace(equivalent=(stiffness, 0.0))
    cause = _angle_errors(Tangent(fit, blocks, [], False))
    assert 400.0 - stiffness == pytest.approx(share * 400.0, rel=0.3, abs=0.02 * 400.0)
    assert cause.effect[0] == pytest.approx(share * 400.0, rel=0.3, abs=0.01 * 400.0)
    assert cause.std == pytest.approx(1 / np.sqrt(3)), "anything from none to all of it"


@pytest.mark.parametrize(("model", "bends", "widened"), [
    ("hardening", -5e4, 30.0), ("hardening", 5e4, 0.0), ("hardening_elastoplastic", -5e4, 0.0), ("kelvin_voigt", 0, 0),
])  # fmt: skip
def test_a_spring_that_seems_to_soften_may_be_a_sensor_that_bends(
    model: str, bends: float, widened: float
) -> None:
    """All of the bend may be the sensor's, and the slope the mean one; damping by the same share. What rubber does, to
    harden, and loops are not doubted."""
    terms = MODELS[model].terms
    values = np.array(
        [{"stiffness": 430.0, "damping": 43.0, "hardening": bends}.get(term, 1.0) for term in terms]
    )
    fit = SimpleNamespace(model=MODELS[model], values=values, equivalent=(400.0, 1.0))
    causes = _softening(fit)  # type: ignore[arg-type]
    all_of_it = {"stiffness": widened, "damping": widened / 10, "hardening": bends}
    expected = [[all_of_it.get(term, 0.0) for term in terms]] if widened else []
    assert [cause.effect.tolist() for cause in causes] == [pytest.approx(effect) for effect in expected]


@pytest.mark.parametrize(("deviations", "suspected", "damping"), [
    (1.9, False, 1.0), (2.1, True, 1.0), (-2.1, True, 2.0),
])  # fmt: skip
def test_a_cube_is_suspected_from_two_deviations_on(
    monkeypatch: pytest.MonkeyPatch, deviations: float, suspected: bool, damping: float
) -> None:
    """A sensor that bends takes of the damping what it takes of the stiffness."""
    angle = swayed(2000)
    recordings = [made_recording("sway", angle, 400.0 * angle + 100.0 * np.gradient(angle, PERIOD))]
    fit = fit_axis(recordings, FOOT, "pitch", LINEAR)
    assert fit is not None
    found = SimpleNamespace(
        values=np.append(fit.values + [8.0, 1.0], 500.0 * deviations),
        std=np.array([1.0, 1.0, 500.0]),
        singular=False,
    )
    monkeypatch.setattr(systematic, "fit_blocks", lambda *_, **__: found)
    causes = _suspected_hardening(Tangent.of(fit, recordings, False))
    assert len(causes) == suspected
    for cause in causes:
        assert np.abs(cause.share) == pytest.approx([8.0, damping], rel=1e-2), "as far as it moves the fit"

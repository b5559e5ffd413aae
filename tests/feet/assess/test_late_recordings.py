"""A recording that is late where the others are not, and damping that differs for another reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from bush_data_sets import Rubber
from feet_trials import LINEAR, noisy
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet import foot_assessment
from plantar.feet.assess.late_recordings import RECORDING_LATE, late_recordings
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.recording import Recording, Stances
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel

COUNT = 6000
PLAIN = Rubber(stiffness=420.0, damping=18.0)
SLIPPING = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)


def swaying(rubber: Rubber, late: float = 0.0, sizes: tuple[float, ...] = (1.0, 1.0, 1.0)) -> list[Recording]:
    """Three sways of these sizes; the force sensors are `late` [s] in the second."""
    made, time = [], PERIOD * np.arange(COUNT)
    for seed, size in enumerate(sizes):
        angle = size * swayed(COUNT, seed=seed)
        torque = rubber.torque(angle, np.gradient(angle, PERIOD))
        torque += 0.1 * np.random.default_rng(seed).standard_normal(COUNT)
        torque = np.interp(time - late * (seed == 1), time, torque)
        made.append(made_recording(f"sway_{seed}", angle, torque))
    return made


def said(
    recordings: list[Recording], model: str = "kelvin_voigt", std: float = 0.2, turned: float = 0.0
) -> list[str]:
    """std: of the damping [N·m·s/rad], with all that is unsure about it; turned: the force sensor, as it was found."""
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model=model))
    assert fit is not None
    fit = replace(fit, turned=turned)
    covariance = fit.covariance.copy()
    covariance[1, 1] = std**2
    wide = replace(fit, covariance=covariance)
    return [note.text for note in late_recordings(Tangent.of(fit, recordings, False), wide)]


def test_recordings_with_one_offset_are_not_compared() -> None:
    recordings = swaying(PLAIN, 0.012)
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model="kelvin_voigt"))
    assert fit is not None
    found = [len(late_recordings(Tangent.of(fit, recordings, shared), fit)) for shared in (False, True)]
    assert found == [1, 0]


@pytest.mark.parametrize(("late", "told"), [(0.012, "12 ms later"), (-0.012, "12 ms earlier")])
def test_a_late_recording_is_told_with_its_delay(late: float, told: str) -> None:
    (text,) = said(swaying(PLAIN, late))
    assert text.startswith(f"sway_1: {FOOT} pitch: damping is {'-' if late > 0 else '+'}5.")
    assert text.partition(" N.m.s/rad ")[2] == (
        f"beside the other recordings', as if its force sensors were {told} against the IMU than theirs. Record it "
        "again with clocks and filters as in the others, or leave it out"
    )


def test_a_delay_within_the_interval_of_damping_is_none() -> None:
    """12 ms in one of three recordings move the damping by 420 · 0.012 / 3 = 1.7."""
    assert len(said(swaying(PLAIN, 0.012), std=0.6)) == 1
    assert said(swaying(PLAIN, 0.012), std=1.2) == []


def test_recordings_that_agree_are_none() -> None:
    assert said(swaying(PLAIN), std=0.001) == []


def test_a_memory_makes_damping_differ_with_the_size_of_motions() -> None:
    """As spring and damper, the small sway shows more damping; the memory explains that, and leaves less."""
    recordings = swaying(SLIPPING, sizes=(1.0, 0.15, 1.0))
    assert len(said(recordings, "kelvin_voigt", std=0.01)) == 1
    assert said(recordings, "elastoplastic", std=0.01) == []


def test_the_other_axis_torque_in_a_turned_sensor_is_no_delay() -> None:
    """In one recording the roll torque goes with pitch's rate: 0.05 of it shows in pitch as 0.05 · 120 of damping."""
    recordings = swaying(PLAIN)
    state = recordings[1].bushes[FOOT]
    state.torque[:, 1] = 120.0 * state.rate[:, 0]
    state.torque[:, 0] += 0.05 * state.torque[:, 1]
    assert len(said(recordings)) == 1
    assert said(recordings, turned=0.05) == []


def test_one_recording_has_none_to_differ_from() -> None:
    assert said(swaying(PLAIN, 0.012)[1:2]) == []


def walking(late: float, from_row: int, stances: int = 12) -> list[Recording]:
    """Two walks; the force sensors are `late` [s] from one row on. Every stance has an offset of its own."""
    number, made = np.arange(COUNT) * stances // COUNT, []
    for seed in (0, 1):
        angle, random = swayed(COUNT, seed=seed), np.random.default_rng(seed)
        torque = PLAIN.torque(angle, np.gradient(angle, PERIOD)) + random.standard_normal(stances)[number]
        behind = PERIOD * (np.arange(COUNT) - late / PERIOD * (np.arange(COUNT) >= from_row))
        torque = np.interp(behind, PERIOD * np.arange(COUNT), torque) + 0.1 * random.standard_normal(COUNT)
        made.append(made_recording(f"walk_{seed}", angle, torque, stances=Stances(number, np.ones(COUNT))))
        made[-1].raw[FOOT].torque[:, 1] = 0.0  # else a turned sensor would explain all
    return made


@pytest.mark.parametrize(("late", "told"), [(0.02, "20 ms later"), (-0.02, "20 ms earlier")])
def test_walks_whose_second_halves_are_late_are_told_of(late: float, told: str) -> None:
    (text,) = said(walking(late, COUNT // 2))
    assert text.startswith(f"{FOOT} pitch: damping is {'-' if late > 0 else '+'}8.")
    assert text.partition(" N.m.s/rad ")[2] == (
        f"in the second halves of the recordings beside the first, as if its force sensors were {told} there against "
        "the IMU. Find the moment at which a clock or driver changed, and cut the recordings there"
    )


@pytest.mark.parametrize(
    ("recordings", "std"),
    [
        (walking(0.0, 0), 0.001),
        (walking(0.02, 0), 0.001),  # late throughout: all of it is damping's
        (walking(0.02, COUNT // 2), 2.5),  # half of 8.4 is within the interval
        (walking(0.02, COUNT // 2, stances=7), 0.2),  # three stances scatter by chance
    ],
)
def test_walks_whose_halves_agree_as_far_as_they_tell_are_none(
    recordings: list[Recording], std: float
) -> None:
    assert said(recordings, std=std) == []


def late_by(log: MotionLog, delay: float) -> MotionLog:
    columns = {
        name: np.interp(log.time - delay, log.time, values) if name.startswith("wrench.left") else values
        for name, values in log.columns.items()
    }
    return replace(log, columns=columns)


def test_no_number_of_the_late_axis_is_usable(robot: RobotModel) -> None:
    logs = [noisy(record(sway(f"sway_{seed}", seed=seed)), seed) for seed in range(3)]
    good = identify_feet(robot, logs, settings=LINEAR)
    assert RECORDING_LATE not in {note.code for note in good.notes}
    logs[1] = late_by(logs[1], 0.04)
    result = identify_feet(robot, logs, settings=LINEAR)
    assert {note.text.split(":")[0] for note in result.notes if note.code == RECORDING_LATE} == {"sway_1"}
    usable = {row.foot for row in result.parameters if row.axis != "z" and row.verdict == "usable"}
    assert usable == {"right"}


def test_a_recording_that_is_late_about_one_axis_is_trusted_about_neither(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Roll's damping may hardly show a clock that pitch's shows."""

    def late_in_pitch(_: Tangent, wide: AxisFit) -> list[Note]:
        told = wide.foot == "left" and wide.axis == "pitch"
        return [Note(RECORDING_LATE, "warning", "sway_1: late")] if told else []

    monkeypatch.setattr(foot_assessment, "late_recordings", late_in_pitch)
    logs = [noisy(record(sway(f"sway_{seed}", seed=seed)), seed) for seed in range(2)]
    rows = [row for row in identify_feet(robot, logs, settings=LINEAR).parameters if row.axis != "z"]
    assert {(row.foot, row.verdict) for row in rows} == {("left", "weak"), ("right", "usable")}

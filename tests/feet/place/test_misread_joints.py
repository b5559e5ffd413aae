"""A joint that reads a share too much, or late, is told where a foot steps: stiffness and damping follow it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sines, sway
from feet_trials import LINEAR, codes, noisy, stepping, without
from plantar.feet.identify import identify_feet
from plantar.feet.place.misread_joints import IMU_SOFT, MISREAD, OUT_OF_TIME, _columns, _misread
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.signals.filters import low_pass

TRUNK = (
    sines((0.01, 0.35, 0.3)),
    sines((0.02, 0.45, 0.7)),
    sines((0.0, 0.0, 0.0)),
)  # leans as far as ankles turn


@cache
def stepped() -> list[MotionLog]:
    return [stepping(record(sway(f"walk_{seed}", seed, duration=15.0, torso=TRUNK))) for seed in (1, 2, 3)]


@pytest.fixture(scope="module")
def walks() -> list[MotionLog]:
    return [noisy(log, seed) for seed, log in enumerate(stepped())]


def misread(log: MotionLog, joint: str, gain: float = 1.0, late: float = 0.0) -> MotionLog:
    """The log with one encoder that reads `gain` times its angle, `late` by so much [s]."""
    names = [f"joint.{joint}.{quantity}" for quantity in ("position", "velocity")]
    return log.with_columns(
        {name: gain * np.interp(log.time - late, log.time, log.column(name)) for name in names}
    )


def with_play(log: MotionLog, joint: str, play: float) -> MotionLog:
    """The log with one encoder whose drive has play [rad]: it follows only when the joint has turned by as much."""
    name = f"joint.{joint}.position"
    read = log.column(name).copy()
    state = read[0]
    for place, value in enumerate(read):
        read[place] = state = min(max(state, value - play / 2), value + play / 2)
    return log.with_columns({name: read})


def imu_late(log: MotionLog, late: float) -> MotionLog:
    """The log with all of its IMU's columns `late` by so much [s]."""
    names = [name for name in log.columns if name.startswith("imu.")]
    return log.with_columns({name: np.interp(log.time - late, log.time, log.column(name)) for name in names})


def said(found: FeetResult) -> list[str]:
    codes = (MISREAD, OUT_OF_TIME, IMU_SOFT)
    return [note.text for note in found.notes if note.code in codes and note.severity == "warning"]


@pytest.mark.parametrize(
    ("joint", "axis", "gain", "late", "words"),
    [
        ("left_ankle_pitch", "pitch", 1.05, 0.0, "'left_ankle_pitch' 1.05 times"),
        ("left_ankle_roll", "roll", 0.95, 0.0, "'left_ankle_roll' 0.95 times"),
        ("left_ankle_roll", "roll", 1.0, 0.008, " ms late"),
        ("left_ankle_roll", "roll", 1.0, -0.008, " ms early"),
    ],
)
def test_the_joint_is_named_and_neither_number_is_usable(
    robot: RobotModel, walks: list[MotionLog], joint: str, axis: str, gain: float, late: float, words: str
) -> None:
    found = identify_feet(robot, [misread(log, joint, gain, late) for log in walks], settings=LINEAR)
    (text,) = said(found)
    assert text.startswith(f"left {axis}: ")
    assert f"'{joint}'" in text
    assert words in text
    if late:
        assert 1e-3 * float(text.split(words)[0].split()[-1]) == pytest.approx(abs(late), rel=0.1)
    rows = [row for row in found.parameters if row.foot == "left" and row.name in ("stiffness", "damping")]
    doubted = [row.axis for row in rows if "error of measurement" in row.reason]
    assert doubted == [axis, axis]
    assert all(row.verdict == "usable" for row in rows if row.axis not in (axis, "z"))


@pytest.mark.parametrize(("joint", "axis"), [("left_ankle_roll", "roll"), ("right_ankle_pitch", "pitch")])
def test_a_joint_of_the_other_sign_is_named(
    robot: RobotModel, walks: list[MotionLog], joint: str, axis: str
) -> None:
    """Where it swings about its middle the wrenches balance gravity with either sign."""
    found = identify_feet(robot, [misread(log, joint, -1.0) for log in walks], settings=LINEAR)
    texts = [text for text in said(found) if "reversed" in text]
    assert [text.partition(":")[0] for text in texts] == [f"{joint.partition('_')[0]} {axis}"]
    assert f": the sign of '{joint}' reversed. " in texts[0]


@pytest.mark.parametrize(
    ("stiffness", "share", "std", "told"),
    [
        (400.0, -2.0, 0.1, True),
        (400.0, -1.4, 0.1, True),
        (400.0, -2.6, 0.1, True),
        (400.0, -1.2, 0.1, False),  # as of an encoder that is dead
        (400.0, -2.8, 0.1, False),
        (400.0, 2.0, 0.1, False),
        (400.0, -2.0, 1.1, False),  # hardly known
        (-400.0, -2.0, 0.1, False),  # no sign of this joint makes a bush of it
    ],
)
def test_the_other_sign_makes_a_bush_of_it(stiffness: float, share: float, std: float, told: bool) -> None:
    values = np.array([stiffness, 20.0, share * stiffness])
    fit = SimpleNamespace(values=values, std=abs(stiffness) * np.array([0.1, 0.1, std]), squares=7.0)
    wider: Any = SimpleNamespace(least_squares=fit)
    unasked: Any = None
    found = _misread("hip", "reversed", wider, unasked, np.array([-60.0, 20.0]))
    assert found == (("hip", "reversed", pytest.approx(share), 7.0, True) if told else None)


@pytest.mark.parametrize(("turn", "asked"), [(0.009, False), (0.011, True)])
def test_a_joint_that_is_held_has_no_other_sign(
    monkeypatch: pytest.MonkeyPatch, turn: float, asked: bool
) -> None:
    """It turns as its servo gives way, which goes with the torque."""
    swings = turn * np.sin(np.linspace(0, 2 * np.pi, 101))
    motion = np.column_stack([swings, swings, swings])
    module = "plantar.feet.place.misread_joints"
    monkeypatch.setattr(f"{module}._turns", lambda *_: {"knee": (np.ones((101, 2)), motion)})
    monkeypatch.setattr(f"{module}._tilts", lambda *_: np.zeros((101, 2, 2)))
    fit: Any = SimpleNamespace(foot="left", axis="pitch", values=np.array([400.0, 20.0]))
    unasked: Any = None
    names, columns = _columns(unasked, unasked, fit)
    assert columns[:, names.index(("knee", "reversed"))].any() == asked


def test_play_in_an_encoders_drive_is_told_with_its_size(robot: RobotModel, walks: list[MotionLog]) -> None:
    found = identify_feet(robot, [with_play(log, "left_ankle_roll", 0.002) for log in walks], settings=LINEAR)
    (text,) = said(found)
    named = text.partition("'left_ankle_roll' ")[2]
    assert "mrad behind wherever it turns round" in named
    assert float(named.split()[0]) == pytest.approx(2.0, rel=0.25)


@cache
def standing(noise: bool = True) -> list[MotionLog]:
    logs = [record(sway(f"sway_{seed}", seed, duration=30.0, torso=TRUNK)) for seed in (1, 2)]
    return [noisy(log, seed) for seed, log in enumerate(logs)] if noise else logs


@pytest.mark.parametrize("play", [0.001, 0.002])
def test_play_of_a_standing_foots_joint_is_told_with_its_size(robot: RobotModel, play: float) -> None:
    (text,) = said(
        identify_feet(robot, [with_play(log, "left_ankle_roll", play) for log in standing()], settings=LINEAR)
    )
    assert text.startswith("left roll: ")
    assert float(text.partition("'left_ankle_roll' ")[2].split()[0]) == pytest.approx(1e3 * play, rel=0.3)


@pytest.mark.parametrize("late", [0.0, 0.02])
def test_a_standing_foots_joint_that_is_late_has_no_play(robot: RobotModel, late: float) -> None:
    """The torque goes with the joint's rate itself, not with its sign."""
    found = identify_feet(
        robot, [misread(log, "left_ankle_roll", late=late) for log in standing()], settings=LINEAR
    )
    texts = said(found)
    assert ["play" in text.partition("(valid")[0] or "behind" in text for text in texts] == [False] * bool(
        late
    )
    assert all("'left_ankle_roll' 19 ms late" in text for text in texts)


def on_soft_mount(log: MotionLog, tilt: float) -> MotionLog:
    """The log of an IMU whose mount lets it tilt by so much [rad] for each m/s², its mass above."""
    acceleration = log.linear_acceleration("chest")
    turn = tilt * low_pass(np.cross([0.0, 0.0, 1.0], acceleration), log.period, 4.0)
    orientation = Rotation.from_quat(log.orientation("chest"), scalar_first=True) * Rotation.from_rotvec(turn)
    rates = log.angular_velocity("chest") + np.gradient(turn, log.period, axis=0)
    columns = (*orientation.as_quat(scalar_first=True).T, *rates.T)
    return log.with_columns(
        dict(zip(imu_columns("chest", "orientation", "angular_velocity"), columns, strict=True))
    )


@pytest.mark.parametrize("tilt", [0.002, -0.004])
def test_an_imu_on_a_soft_mount_is_told_with_its_tilt(robot: RobotModel, tilt: float) -> None:
    logs = [on_soft_mount(log, tilt) for log in standing()]
    texts = said(identify_feet(robot, logs, settings=LINEAR))
    assert texts
    for text in texts:
        size = text.partition("the IMU tilts by ")[2].split()[0]
        assert float(size) == pytest.approx(1e3 * abs(tilt), rel=0.2)


def test_one_foot_that_shows_a_soft_mount_tells_of_both(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = identify_feet(robot, [on_soft_mount(log, 0.006) for log in standing()], settings=LINEAR)
    assert [note.text[:10] for note in shown.notes if note.code == IMU_SOFT] == ["right roll"]

    def told(_: RobotModel, __: Any, wide: Any) -> list[Note]:
        note = Note(IMU_SOFT, "warning", "right roll: the IMU tilts")
        return [note] * (wide.foot == "right" and wide.axis == "roll")

    monkeypatch.setattr("plantar.feet.foot_assessment.misread_joint_notes", told)
    rows = [one for one in identify_feet(robot, standing(), settings=LINEAR).parameters if one.axis != "z"]
    assert {one.verdict for one in rows if one.foot == "left"} == {"weak"}
    assert all("the IMU tilts" in one.reason for one in rows if one.foot == "left")


def test_what_a_soft_mount_moves_by_two_per_cent_matters() -> None:
    """It moves hysteresis and the bush's place as well. An axis of which nothing is known tells nothing of the IMU."""
    for moved, unsure, matters in ((7.0, 50.0, False), (9.0, 50.0, True), (9.0, 110.0, False)):
        values, std = np.array([400.0 + moved, 20.0, 0.003]), np.array([1.0, 1.0, 1e-4])
        fit = SimpleNamespace(values=values, std=std, squares=7.0, singular=False)
        wide: Any = SimpleNamespace(
            holds=lambda _: True, values=np.array([400.0, 20.0]), std=np.array([unsure, 5.0])
        )
        wider: Any = SimpleNamespace(least_squares=fit)
        for kind in ("soft", "gain"):
            found = _misread("the IMU", kind, wider, wide, np.array([400.0, 20.0]))
            assert found is not None
            assert found.matters == (matters and kind == "soft")


def test_logs_without_an_accelerometer_tell_no_soft_mount(robot: RobotModel) -> None:
    """Beside one that has it, too."""
    first, second = (on_soft_mount(log, 0.002) for log in standing())
    logs = [first, without(second, "linear_acceleration")]
    assert "internal_error" not in codes(identify_feet(robot, logs, settings=LINEAR))
    found = identify_feet(robot, [without(log, "linear_acceleration") for log in logs], settings=LINEAR)
    assert not any("tilts" in text for text in said(found))


def test_no_joint_between_imu_and_bush_is_misread(robot: RobotModel) -> None:
    """As on a bench that holds a foot alone."""
    on_foot = replace(robot, imu=replace(robot.required_imu, placement=robot.feet["left"].bush))
    assert "internal_error" not in codes(identify_feet(on_foot, standing(), settings=LINEAR))


@pytest.mark.parametrize(("play", "told"), [(1e-6, False), (2e-3, True)])
def test_play_that_moves_no_number_is_not_said_even_of_exact_logs(
    robot: RobotModel, play: float, told: bool
) -> None:
    exact = [with_play(log, "left_ankle_roll", play) for log in standing(noise=False)]
    assert bool(said(identify_feet(robot, exact, settings=LINEAR))) == told


def test_a_leg_all_of_whose_joints_are_late_is_told_as_one(robot: RobotModel, walks: list[MotionLog]) -> None:
    leg = [name for name in robot.joint_names if name.startswith("left_")]
    late = walks
    for joint in leg:
        late = [misread(log, joint, late=0.012) for log in late]
    found = identify_feet(robot, late, settings=LINEAR)
    assert any("all joints to the left foot 1" in text for text in said(found))


@pytest.mark.parametrize("late", [0.03, 0.2])
def test_an_imu_that_is_late_is_told_of_every_number_where_no_log_shows_a_delay(
    robot: RobotModel, late: float
) -> None:
    """K came out 2 to 12 % too small, usable."""
    found = identify_feet(robot, [imu_late(log, late) for log in standing()], settings=LINEAR)
    assert any("(or the IMU late)" in text for text in said(found))
    assert not any(row.verdict == "usable" for row in found.parameters if row.axis != "z")


@pytest.mark.parametrize(("joint", "gain"), [("left_ankle_pitch", 1.0), ("right_ankle_pitch", 1.05)])
def test_nothing_is_said_of_joints_read_right_nor_of_a_foot_that_stands(
    robot: RobotModel, walks: list[MotionLog], joint: str, gain: float
) -> None:
    assert said(identify_feet(robot, [misread(log, joint, gain) for log in walks], settings=LINEAR)) == []


@pytest.mark.parametrize(("gain", "told"), [(1.004, False), (1.01, True)])
def test_what_moves_no_number_by_a_per_cent_is_not_said(robot: RobotModel, gain: float, told: bool) -> None:
    """Of exact logs, whose intervals hold nothing else."""
    exact = [misread(log, "left_ankle_pitch", gain) for log in stepped()]
    assert bool(said(identify_feet(robot, exact, settings=LINEAR))) == told


@pytest.mark.parametrize(("noise", "told"), [(0.3, True), (3.2, False)])
def test_it_has_to_explain_a_third_of_what_is_left(
    robot: RobotModel, walks: list[MotionLog], noise: float, told: bool
) -> None:
    random = np.random.default_rng(0)
    rough = []
    for log in walks:
        torque = log.column("wrench.left.torque.y")
        more = noise * random.standard_normal(len(log)) * (torque != 0)
        rough.append(
            misread(log.with_columns({"wrench.left.torque.y": torque + more}), "left_ankle_pitch", 1.1)
        )
    assert bool(said(identify_feet(robot, rough, settings=LINEAR))) == told


@pytest.mark.parametrize(
    ("kind", "size", "std", "singular", "moved", "said"),
    [
        ("gain", 0.05, 0.002, False, 30.0, True),
        ("gain", -0.05, 0.002, False, 30.0, True),
        ("gain", 0.05, 0.002, True, 30.0, False),  # what columns that hang together tell is no error
        ("gain", 0.05, 0.02, False, 30.0, False),  # hardly known
        ("gain", 0.9, 0.002, False, 30.0, False),  # no encoder reads that
        ("play", -0.002, 5e-5, False, 30.0, False),  # no drive is ahead of its joint
        ("play", 0.002, 5e-5, False, 30.0, True),
    ],
)
def test_an_error_of_a_joint_is_surely_known_and_of_a_size_that_there_is(
    kind: str, size: float, std: float, singular: bool, moved: float, said: bool
) -> None:
    """It matters where it moves stiffness and damping out of their interval."""
    usual, asked = np.array([400.0, 20.0]), list[np.ndarray]()
    fit = SimpleNamespace(
        values=np.array([400.0 + moved, 20.0, size]),
        std=np.array([1.0, 1.0, std]),
        squares=7.0,
        singular=singular,
    )
    wide: Any = SimpleNamespace(holds=lambda by: asked.append(by) or False)
    wider: Any = SimpleNamespace(least_squares=fit)
    found = _misread("knee", kind, wider, wide, usual)
    assert (found is not None) == said
    if found is not None:
        assert (found.joint, found.kind, found.size, found.squares, found.matters) == (
            "knee",
            kind,
            size,
            7.0,
            True,
        )
        assert asked[0][0] >= moved

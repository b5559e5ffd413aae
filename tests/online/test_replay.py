"""What a replay says of where a foot stands, of the vertical stiffness, and of motions that were too small."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.online.estimates import FIELDS, Contact, Flag
from plantar.online.replay import IDENTIFY, Replay
from plantar.results.feet_rows import Parameter


def ended(**values: float) -> Replay:
    row = np.array([values.get(name.replace(".", "_"), 0.0) for name in FIELDS])
    return Replay(np.zeros(1), ("left",), row[None, None], np.zeros(1))


def test_a_foot_whose_readings_are_missing_is_not_counted_as_one_that_stands() -> None:
    def counted(contact: Contact, flags: int) -> bool:
        return bool(ended(contact=contact, flags=flags).stands("left")[0])

    assert counted(Contact.STANCE, Flag.EDGE)
    assert not counted(Contact.STANCE, Flag.INPUT_MISSING | Flag.NOT_STANDING)
    assert not counted(Contact.LANDING, 0)


def test_a_replay_prints_no_arrays() -> None:
    assert repr(ended()) == "Replay(feet=('left',))"


def z_row(value: float, half: float) -> Parameter:
    replay = ended(compliance=value, compliance_std=half / 2, compliance_half_width=half)
    return next(row for row in replay.parameters if row.axis == "z")


def test_the_vertical_stiffness_is_one_over_the_compliance() -> None:
    row = z_row(4e-6, 1e-6)
    assert row.value == pytest.approx(250e3)
    assert row.interval95 == pytest.approx((200e3, 1 / 3e-6))
    assert row.std == pytest.approx(250e3 * 0.5e-6 / 4e-6), "the same share of the value"
    assert (row.unit, row.verdict) == ("N/m", "weak")
    assert z_row(4e-6, 2e-7).verdict == "usable"


def test_a_compliance_that_nothing_has_shown_is_no_stiffness() -> None:
    for value in (3e-6, 0.0, -1e-6):
        row = z_row(value, 5e-6)
        assert (row.value, row.verdict) == (None, "unidentifiable")
        assert "walk" in row.advice


def test_a_compliance_that_was_told_is_not_called_learnt() -> None:
    row = z_row(4e-6, 4e-12)
    assert row.value == pytest.approx(250e3)
    assert row.interval95 is None
    assert "batch result" in row.reason


@pytest.mark.parametrize(
    "name", ["pitch_stiffness", "pitch_damping", "roll_stiffness", "roll_slip_torque", "z"]
)
def test_a_number_may_be_used_once_it_is_known_within_a_tenth(name: str) -> None:
    """A damping once it is known within 6 %.

    Whatever its size and sign of doubt; beyond its own value it is not known, and beyond ten times not said.
    """

    def judged(share: float) -> Parameter:
        key = "compliance" if name == "z" else name
        value = 4e-6 if name == "z" else 200.0
        replay = ended(**{key: value, f"{key}_std": share * value / 4, f"{key}_half_width": share * value})
        axis, _, number = name.partition("_")
        return next(row for row in replay.parameters if (row.axis, row.name) == (axis, number or "stiffness"))

    most = 0.06 if name == "pitch_damping" else 0.1
    assert [judged(share * most).verdict for share in (0.99, 1.01)] == ["usable", "weak"]
    assert [judged(share).verdict for share in (0.99, 1.01, 9.9)] == [
        "weak",
        "unidentifiable",
        "unidentifiable",
    ]
    assert judged(10.1).value is None
    near, far = judged(0.05), judged(0.4)
    assert near.reason == ""
    assert f"± 40 % so far; enough from ± {100 * most:.0f} % on" in far.reason
    assert far.value is not None
    assert far.interval95 is not None
    if name == "z":
        assert far.interval95 == pytest.approx((1 / 5.6e-6, 1 / 2.4e-6))
    else:
        assert far.interval95 == pytest.approx((120.0, 280.0))
        assert far.std == pytest.approx(20.0)
        assert (
            far.unit == {"stiffness": "N.m/rad", "damping": "N.m.s/rad", "torque": "N.m"}[name.split("_")[-1]]
        )


def test_how_long_a_step_takes_is_told_in_microseconds() -> None:
    latency = np.concatenate([np.arange(9991) * 1e-9, np.full(9, 1e-3), [2e-3]])
    replay = Replay(np.zeros(len(latency)), ("left",), np.zeros((len(latency), 1, len(FIELDS))), latency)
    assert replay.latency_us["median"] == pytest.approx(5.0, rel=1e-3)
    assert 9.9 < replay.latency_us["p999"] < 1000.0 < replay.latency_us["max"] == pytest.approx(2000.0)


@pytest.mark.parametrize(
    ("flag", "word"),
    [
        (Flag.PITCH_UNTESTED, "too small"),
        (Flag.PITCH_MEMORY, "hysteresis"),
        (Flag.LATE_WRENCH, "delay"),
        (Flag.LATE_IMU, "IMU"),
    ],
)
def test_numbers_that_other_motions_change_are_weak(flag: Flag, word: str) -> None:
    replay = ended(flags=float(flag), pitch_stiffness=400.0, pitch_stiffness_half_width=1.0)
    row = next(row for row in replay.parameters if (row.axis, row.name) == ("pitch", "stiffness"))
    assert row.verdict == "weak"
    assert word in row.reason


def test_a_stiffness_that_rests_on_what_was_told_is_weak_and_its_damping_is_not() -> None:
    known = {"pitch_stiffness": 400.0, "pitch_stiffness_half_width": 9.0, "pitch_slip_torque_std": 0.05}
    known |= {"pitch_slip_torque": 5.0, "pitch_damping": 20.0, "pitch_damping_half_width": 0.5}
    rows = {
        row.name: row
        for row in ended(flags=float(Flag.PITCH_UNTESTED), **known).parameters
        if row.axis == "pitch"
    }
    assert rows["stiffness"].verdict == "weak"
    assert (rows["stiffness"].reason, rows["stiffness"].advice) == (
        "motions too small to test the slip torque that was given, on which this stiffness depends",
        "bend the foot beyond its slip angle to either side, as walking does",
    )
    assert rows["damping"].verdict == "usable"


def test_a_damping_below_zero_is_none() -> None:
    def judged(half: float) -> Parameter:
        replay = ended(pitch_damping=-20.0, pitch_damping_half_width=half)
        return next(row for row in replay.parameters if (row.axis, row.name) == ("pitch", "damping"))

    for half in (0.5, 10.0, 19.9):
        assert judged(half).verdict == "unidentifiable"
        assert (judged(half).reason, judged(half).advice) == (
            "negative, which no bush is: force sensors that are late look like this",
            "say how late they are (--wrench-delay), or let `identify feet` find it and give its result (--result)",
        )
    assert "negative" not in judged(20.1).reason, "it may be above"


def test_what_is_wrong_with_a_foot_is_said_of_both_numbers_and_the_delay_first() -> None:
    """The left foot stands well; of the right one the roll alone is doubted, by a memory and then by a delay."""
    late = "torques follow deflections as if the force sensors' delay were not the one that was given"
    memory = "the rubber has hysteresis: motions of another size have another stiffness"
    small = "motions too small to show hysteresis: in larger ones the stiffness may be lower"
    known = {
        "roll_stiffness": 300.0,
        "roll_stiffness_half_width": 3.0,
        "roll_damping": 20.0,
        "roll_damping_half_width": 0.5,
    }
    for flags, reason in (
        (Flag.ROLL_MEMORY | Flag.LATE_WRENCH, late), (Flag.ROLL_MEMORY | Flag.ROLL_UNTESTED, memory),
        (Flag.ROLL_UNTESTED, small), (Flag.PITCH_MEMORY | Flag.PITCH_UNTESTED, ""),
    ):  # fmt: skip
        rows = [row for row in ended(flags=float(flags), **known).parameters if row.axis == "roll"]
        assert [(row.name, row.reason) for row in rows] == [("stiffness", reason), ("damping", reason)]
        assert {row.advice for row in rows} == {IDENTIFY if reason else None}

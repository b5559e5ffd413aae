"""Streams on clocks of their own, merged on one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.errors import LogError
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.streams import Stream, merge, origin, resample
from plantar.notes import Note

LIMIT = ReadLimit(Path("x"), files=[])


def stream(name: str, time: np.ndarray, **columns: np.ndarray) -> Stream:
    return Stream(name, time, {key.replace("__", "."): value for key, value in columns.items()})


def test_the_fastest_clock_is_the_base_and_the_rest_is_linear_in_between() -> None:
    fast, slow = np.arange(0, 2, 0.002), np.arange(0, 2, 0.01)
    notes: list[Note] = []
    joints = stream("j", fast, joint__a__position=np.sin(fast))
    force = stream("w", slow, wrench__l__force__z=3 * slow + 1)
    time, columns = merge([force, joints], LIMIT, notes)
    assert np.isin(time, fast).all()
    np.testing.assert_allclose(columns["wrench.l.force.z"], 3 * time + 1, atol=1e-12)
    (note,) = [one for one in notes if one.code == "streams_resampled"]
    assert note.text.endswith("resampled to the clock of j (500 Hz): w")


def test_gaps_stay_gaps_and_samples_beside_them_stay_recorded() -> None:
    base, other = np.arange(0, 10, 0.01), np.r_[np.arange(0, 4, 0.02), np.arange(6, 10, 0.02)]
    columns, exact = resample(stream("w", other, wrench__l__force__z=np.ones(other.size)), base)
    hole = (base > 3.98 + 1e-9) & (base < 6 - 1e-9)
    values = columns["wrench.l.force.z"]
    assert np.isnan(values[hole]).all()
    assert (values[~hole & (base <= other[-1])] == 1).all()
    assert np.isnan(values[base > other[-1] + 1e-9]).all(), "nothing is extrapolated"
    assert not exact


def test_stamps_that_agree_are_not_interpolated() -> None:
    time = np.arange(0, 1, 0.01)
    values = np.random.default_rng(0).normal(size=time.size)
    columns, exact = resample(stream("w", time + 5e-9, wrench__l__force__z=values), time)
    assert exact
    assert np.array_equal(columns["wrench.l.force.z"], values)


def test_a_quaternion_that_changes_sign_is_interpolated_the_short_way() -> None:
    half = np.linspace(0, 1.5, 16)
    attitude = np.column_stack([np.cos(half), np.sin(half), 0 * half, 0 * half])
    attitude[1::2] *= -1
    time = np.arange(16) * 0.1
    names = [f"imu.c.orientation.{axis}" for axis in "wxyz"]
    columns, _ = resample(Stream("i", time, dict(zip(names, attitude.T, strict=True))), time[:-1] + 0.05)
    seen = np.column_stack([columns[name] for name in names])
    between = (half[:-1] + half[1:]) / 2
    wanted = np.column_stack([np.cos(between), np.sin(between), 0 * between, 0 * between])
    np.testing.assert_allclose(np.abs(np.sum(seen * wanted, axis=1)), 1, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(seen, axis=1), 1, atol=1e-12)


def test_four_columns_that_are_no_orientation_are_no_quaternion() -> None:
    """A motor's voltages, for one, keep their size."""
    time = np.arange(16) * 0.1
    values = {f"motor.{axis}": (place + 2) * np.cos(time) for place, axis in enumerate("wxyz")}
    columns, _ = resample(Stream("m", time, values), time[:-1] + 0.05)
    for name, column in values.items():
        np.testing.assert_allclose(columns[name], (column[:-1] + column[1:]) / 2, atol=1e-12)


def test_the_log_is_cut_to_what_all_streams_cover_unless_little_is_left() -> None:
    base = np.arange(0, 10, 0.01)
    joints = stream("j", base, joint__a__position=base)
    notes: list[Note] = []
    late = base[base > 2]
    time, columns = merge([joints, stream("w", late, wrench__l__force__z=late)], LIMIT, notes)
    assert time[0] == late[0]
    assert not np.isnan(columns["wrench.l.force.z"]).any()
    assert "log_cut_to_overlap" in {note.code for note in notes}
    notes = []
    late = base[base > 9]
    time, columns = merge([joints, stream("w", late, wrench__l__force__z=late)], LIMIT, notes)
    assert time.size == base.size
    assert np.isnan(columns["wrench.l.force.z"][0])
    assert "streams_apart" in {note.code for note in notes}


def test_stray_stamps_go_with_a_note_and_a_clock_that_jumps_is_refused() -> None:
    time = np.arange(0, 10, 0.01)
    time[500] = np.nan
    time[700] = 3.0
    time[800] = time[799]
    notes: list[Note] = []
    cleaned, _ = merge([stream("j", time, joint__a__position=time)], LIMIT, notes)
    assert cleaned.size == time.size - 3
    assert (np.diff(cleaned) > 0).all()
    assert "time_order" in {note.code for note in notes}
    jumped = np.r_[np.arange(0, 10, 0.01), np.arange(5, 15, 0.01)]
    with pytest.raises(
        LogError,
        match=r"^x, t = 9\.99 s, value 5\.0: /joint_states: time does not increase in 500 of 2000 "
        r"samples, first here \(valid: stamps that increase, but for 1% of them\)$",
    ) as caught:
        merge([stream("/joint_states", jumped, joint__a__position=jumped)], LIMIT, [])
    assert "/joint_states" in str(caught.value)


def test_stamps_of_an_epoch_start_within_their_second() -> None:
    """As 1.7e9 s they keep a quarter of a microsecond; times of the log's own stay as they are."""
    assert origin(1_700_000_000.25) == 1_700_000_000.0
    assert [origin(first) for first in (0.0, 12.3, -4.0, 86400.5)] == [0.0] * 4


@pytest.mark.parametrize(("periods", "gap"), [(2, False), (3, True)])
def test_a_hole_of_more_than_two_and_a_half_periods_is_a_gap(periods: int, gap: bool) -> None:
    base, other = np.arange(0, 4, 0.01), np.arange(0, 4, 0.1)
    kept = np.r_[other[:20], other[19 + periods :]]
    values = resample(stream("w", kept, wrench__l__force__z=kept), base)[0]["wrench.l.force.z"]
    inside = (base > kept[19] + 1e-9) & (base < kept[20] - 1e-9)
    assert inside.sum() >= 10
    assert np.isnan(values[inside]).all() == gap
    if not gap:
        np.testing.assert_allclose(values[inside], base[inside], atol=1e-9)

"""Lone samples far from their neighbours are bridged; impacts, coarse steps and long stretches are left."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.signals.spikes import lone_spikes, without_spikes

PERIOD, COUNT = 0.005, 4000
TIME = PERIOD * np.arange(COUNT)


def signal(seed: int = 0) -> np.ndarray:
    """A slow wave of 10 with noise of 0.05."""
    return 10 * np.sin(2 * np.pi * 0.5 * TIME) + 0.05 * np.random.default_rng(seed).standard_normal(COUNT)


def spikes_in(values: np.ndarray) -> list[int]:
    return [int(place) for place in lone_spikes(values, PERIOD, landings=None)]


@pytest.mark.parametrize(("length", "found"), [(1, True), (2, True), (3, False), (40, False)])
def test_one_or_two_samples_are_a_spike_and_three_are_none(length: int, found: bool) -> None:
    values = signal()
    values[1000 : 1000 + length] += 20.0
    assert spikes_in(values) == (list(range(1000, 1000 + length)) if found else [])


def test_a_clean_signal_has_no_spike_and_a_coarse_one_none() -> None:
    assert spikes_in(signal()) == []
    assert spikes_in(np.round(signal() / 2.0) * 2.0) == []
    blip = np.zeros(COUNT)
    blip[2000] = 1.0  # the smallest step that this sensor shows
    assert spikes_in(blip) == []


def test_an_impact_and_what_rings_after_it_is_motion() -> None:
    values = signal()
    ringing = np.arange(40)
    values[1500:1540] += 60 * np.exp(-ringing / 15) * np.cos(2.0 * ringing)
    assert spikes_in(values) == []


def test_a_column_that_is_full_of_them_is_what_the_sensor_reads() -> None:
    values = signal()
    values[50::100] += 20.0
    assert len(spikes_in(values)) == len(values[50::100])
    often = signal()
    often[20::40] += 20.0  # one in forty: more than may be spikes
    assert spikes_in(often) == []


def test_knocks_of_landing_feet_are_motion_and_a_spike_among_them_is_one() -> None:
    """Each second a foot lands or leaves, and its edge knocks for a sample or two, now harder, now softer."""
    random, changes = np.random.default_rng(0), np.arange(200, COUNT - 100, 200)
    loaded = np.cumsum(np.isin(np.arange(COUNT), changes)) % 2 == 1
    columns = {f"wrench.foot.force.{axis}": signal(k) for k, axis in enumerate("xyz", start=1)}
    for change in changes:
        # Below 8 quick samples in the time around, as a log at 200 Hz shows them.
        columns["wrench.foot.force.x"][change + np.array([-5, -2, 2, 5])] += random.uniform(10, 40, size=4)
    columns["wrench.foot.force.z"] += 500.0 * loaded
    walk = MotionLog("walk", TIME, columns)
    assert without_spikes(walk) is walk
    standing = walk.with_columns({"wrench.foot.force.z": signal(3) + 500.0})
    assert without_spikes(standing) is not standing
    spoilt = columns["wrench.foot.force.x"].copy()
    spoilt[changes[4] + 1] += 2000.0
    mended = without_spikes(walk.with_columns({"wrench.foot.force.x": spoilt}))
    assert [note.severity for note in mended.notes] == ["info"]
    assert np.flatnonzero(mended.column("wrench.foot.force.x") != spoilt).tolist() == [changes[4] + 1]


def test_spikes_are_bridged_and_told_with_their_time() -> None:
    clean, orientation = signal(), np.cos(TIME)
    spoilt, turned = clean.copy(), orientation.copy()
    spoilt[1000], turned[1000] = -300.0, -1.0
    names = ("imu.chest.angular_velocity.x", "imu.chest.orientation.w", "joint.knee.position")
    log = MotionLog("walk", TIME, dict(zip(names, (spoilt, turned, spoilt), strict=True)))
    mended = without_spikes(log)
    assert mended.column(names[0])[1000] == pytest.approx((clean[999] + clean[1001]) / 2)
    for name in names[1:]:
        np.testing.assert_array_equal(mended.column(name), log.column(name))
    (note,) = [note for note in mended.notes if note.code == "spikes"]
    assert note.severity == "info"
    assert f"{names[0]} (1, first at t = 5 s: -300)" in note.text
    spoilt[1100:1600:20] = 300.0
    again = without_spikes(MotionLog("walk", TIME, {names[0]: spoilt}))
    assert next(note.severity for note in again.notes if note.code == "spikes") == "warning"
    fine = MotionLog("walk", TIME, {names[0]: clean})
    assert without_spikes(fine) is fine


@pytest.mark.parametrize("at", [1000, 4090])
def test_a_spike_is_bridged_also_in_what_is_left_of_the_last_second(at: int) -> None:
    values = np.append(signal(), 0.05 * np.random.default_rng(1).standard_normal(100))
    values[at] += 5.0
    log = MotionLog("spiked", PERIOD * np.arange(len(values)), {"imu.chest.angular_velocity.x": values})
    bridged = without_spikes(log).column("imu.chest.angular_velocity.x")
    assert np.flatnonzero(bridged != values).tolist() == [at]


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_landings_that_no_sample_shows_leave_the_spikes_elsewhere() -> None:
    values, landings = signal(), np.zeros(len(signal()), dtype=bool)
    values[300:310] = np.nan
    landings[302:308] = True
    values[600] += 10.0
    assert list(lone_spikes(values, PERIOD, landings)) == [600]

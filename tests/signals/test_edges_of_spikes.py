"""Lone samples far from their neighbours, at each limit of what counts as one."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog
from plantar.signals.spikes import lone_spikes, without_spikes

STEPS = np.tile([0.0, 1.0], 1000)  # every step is 1


def spiked(places: list[int], height: float = 100.0) -> Array:
    values = STEPS.copy()
    values[places] = height
    return values


def ringing(periods: int, size: float) -> Array:
    """A spike, and 50 ms behind it so many periods of a quick ringing."""
    values = spiked([800])
    values[805 : 805 + 2 * periods + 1] = 1.0
    values[806 : 806 + 2 * periods : 2] += size
    return values


@pytest.mark.parametrize(
    ("values", "found"),
    [
        (spiked([800], 10.5), []),  # 9.5 of the usual steps above those around it
        (spiked([800], 11.5), [800]),
        (spiked([800, 802, 806, 808]), [800, 802, 806, 808]),
        (spiked([800, 802, 806, 808, 812]), []),  # ten quick steps within 0.15 s
        (spiked([800, 804, 808, 812, 816]), [800, 816]),  # the outer ones see eight
        (spiked([*range(0 + 40, 2000, 49)][:40]), [*range(40, 2000, 49)][:40]),
        (spiked([*range(0 + 30, 2000, 48)][:41]), []),  # more than two per cent of the column
        (ringing(2, 6.0), [800]),  # and six steps of six
        (ringing(4, 6.0), []),  # and ten: what rings after a blow is no noise
        (ringing(4, 4.0), [800]),
        (STEPS[:5], []),
    ],
)
def test_spikes_stand_out_by_ten_steps_are_few_and_alone(values: Array, found: list[int]) -> None:
    assert list(lone_spikes(values, 0.01, landings=None)) == found


@pytest.mark.parametrize(("place", "found"), [(660, False), (740, True), (460, False), (380, True)])
def test_steps_are_compared_with_those_of_a_second_and_of_the_seconds_beside_it(
    place: int, found: bool
) -> None:
    values = 0.1 * STEPS
    values[500:600] = STEPS[500:600]
    values[place] = 5.0
    assert list(lone_spikes(values, 0.01, landings=None)) == [place] * found


@pytest.mark.parametrize(("count", "severity"), [(10, "info"), (11, "warning")])
def test_bridged_spikes_are_told_from_half_a_per_cent_on(count: int, severity: str) -> None:
    places = [100 + 100 * place for place in range(count)]
    rates = {f"imu.chest.angular_velocity.{axis}": spiked(places) for axis in "xyz"}
    more = {f"imu.chest.linear_acceleration.{axis}": spiked(places[:3]) for axis in "xy"}
    cleaned = without_spikes(MotionLog("log", 0.01 * np.arange(2000), rates | more))
    (note,) = cleaned.notes
    told = [f"{name} ({count}, first at t = 1 s: 100)" for name in rates]
    expected = f"log: lone samples far from their neighbours bridged: {', '.join(told)} and 2 more columns"
    assert (note.severity, note.text) == (severity, expected)
    assert np.abs(cleaned.stack(list(rates))).max() == 1.0

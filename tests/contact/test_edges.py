"""Each limit of contact, slip and stances, tried just inside and just outside on small signals made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.contact.balance import Balance, require_balance
from plantar.contact.phases import SUPPORTS, FootContact, Phase, detect_contact, shaken
from plantar.contact.slip_indicator import (
    SlipIndicator,
    slides,
    turning,
    twist_speed,
    unresisted,
    usual_deviation,
)
from plantar.contact.stances import Stances, stances_of, without_rolling
from plantar.conventions import Array
from plantar.errors import DataError, MotionError

PERIOD, WEIGHT = 0.01, 600.0


def contact(force: Array) -> FootContact:
    return detect_contact({"left": force}, {"left": False}, WEIGHT, PERIOD)["left"]


@pytest.mark.parametrize(
    ("before", "then", "stands"), [(0.0, 0.099, False), (0.0, 0.101, True), (0.5, 0.051, True), (0.5, 0.049, False)]
)  # fmt: skip
def test_a_foot_lands_at_a_tenth_of_the_weight_and_lifts_at_a_twentieth(
    before: float, then: float, stands: bool
) -> None:
    force = WEIGHT * np.repeat([before, then], 500)
    assert contact(force).loaded[999] == stands


@pytest.mark.parametrize(
    ("samples", "settling"), [(49, 0), (51, 10), (100, 20), (240, 48), (260, 50), (500, 50)]
)
def test_a_stance_lasts_half_a_second_and_settles_for_a_quarter_or_a_tenth(
    samples: int, settling: int
) -> None:
    force = np.zeros(1000)
    force[200 : 200 + samples] = WEIGHT
    found = contact(force)
    assert np.sum(found.support == SUPPORTS.index("transition")) == settling
    assert found.used.sum() == max(samples - settling, 0) * (samples > 50)


def test_a_phase_is_written_to_the_microsecond() -> None:
    phase = Phase("a", "left", 0.12345649, 1.9999996, "double", True, None)
    assert (phase.to_dict()["start"], phase.to_dict()["end"]) == (0.123456, 2.0)


def struck(amplitude: float, hertz: float, always: float = 0.0, period: float = 0.005) -> bool:
    """Whether a second of a tone [N] in a log of ten counts as an impact."""
    time = period * np.arange(round(10 / period))
    size = np.where((time > 5.0) & (time < 6.0), amplitude, always)
    force = np.zeros((time.size, 3))
    force[:, 1] = size * np.sin(2 * np.pi * hertz * time)
    return bool(shaken(force, WEIGHT, period)[(time > 5.45) & (time < 5.85)].any())


@pytest.mark.parametrize(
    ("low", "high", "hertz", "always", "period"),
    [(16.3, 17.7, 50.0, 0.0, 0.005),  # a fiftieth of the weight, rms
     (32.5, 35.5, 20.0, 0.0, 0.005),  # half of 20 Hz passes
     (32.5, 35.5, 10.0, 0.0, 0.02),  # of slow logs a fifth of the rate
     (26.5, 29.5, 50.0, 4.0, 0.005)],  # seven times what is always there
)  # fmt: skip
def test_a_foot_is_shaken_by_a_fiftieth_of_the_weight_and_seven_times_the_noise(
    low: float, high: float, hertz: float, always: float, period: float
) -> None:
    assert not struck(low, hertz, always, period)
    assert struck(high, hertz, always, period)


def test_an_impact_is_seen_for_a_tenth_of_a_second_and_settles_for_a_quarter() -> None:
    """One sample: within 0.05 s of it, as much before, and 0.25 s behind."""
    force = np.zeros((2000, 3))
    force[1000, 0] = 150.0
    assert np.array_equal(np.flatnonzero(shaken(force, WEIGHT, 0.005)), np.arange(980, 1061))


def over(samples: int, speed: float, start: int = 300) -> Array:
    values = np.zeros(1000)
    values[start : start + samples] = speed
    return values


def slid(speed: Array, deviation: float = 0.0, way: Array | None = None) -> int:
    indicator = SlipIndicator(speed, np.full(1000, deviation))
    return int(slides([indicator], speed if way is None else way, PERIOD).sum())


def test_a_slide_s_speed_deviations_and_path() -> None:
    assert [slid(over(100, speed)) for speed in (0.0019, 0.0021)] == [0, 100]
    assert [slid(over(10, 0.01) + over(100, speed, 310), 0.001) for speed in (0.0034, 0.0036)] == [10, 110]
    assert [slid(over(100, 0.004) + over(1, speed, 400), 0.001) for speed in (0.0049, 0.0051)] == [0, 101]
    assert [slid(over(samples, 0.003)) for samples in (29, 31)] == [0, 31]
    assert [slid(over(40, 0.01) + over(40, 0.01, 340 + gap)) for gap in (10, 11)] == [90, 80]
    fast = over(50, 0.1, 310)  # rings for a tenth of a second, by seven per cent
    assert [slid(fast + over(10, speed) + over(10, speed, 360)) for speed in (0.0069, 0.0071)] == [50, 70]
    assert slid(fast + over(11, 0.0069, 299)) == 61


def test_what_an_indicator_says_in_deviations() -> None:
    """A plane vector's length has its fourth fifth at √(-2 ln 0.2) deviations of its components."""
    rayleigh = 0.003 * np.sqrt(-2 * np.log1p(-np.linspace(0, 1, 2001)[:-1]))
    assert usual_deviation(np.append(rayleigh, np.nan)) == pytest.approx(0.003, rel=2e-3)
    assert usual_deviation(np.array([np.nan])) == 0.0
    indicator = SlipIndicator(np.array([0.002, np.nan, 0.006]), np.array([0.001, 1.0, 0.0]))
    assert indicator.clearness(slice(0, 2)) == pytest.approx(2.0)
    assert indicator.clearness(slice(2, 3)) == pytest.approx(6000.0), "less noise than 1e-6 m/s is none"
    assert indicator.clearness(slice(0, 0)) == 0.0


@pytest.mark.parametrize(("samples", "turns"), [(48, False), (52, True)])
def test_a_sole_turns_by_more_than_a_fiftieth_of_a_radian(samples: int, turns: bool) -> None:
    """At 0.04 rad/s, at an arm of 0.1 m."""
    assert turning(over(samples, 0.004), PERIOD).any() == turns
    to_and_fro = over(52, 0.004) - over(52, 0.004, 352)
    assert not turning(to_and_fro, PERIOD).any()


@pytest.mark.parametrize(("seconds", "left"), [(1.7, 1.0), (2.4, 0.0)])
def test_a_heading_s_drift_is_what_it_does_for_more_than_two_seconds(seconds: float, left: float) -> None:
    """The IMU's yaw turns by 0.01 rad/s all the time; the sole by 0.5 rad/s for a while."""
    time = PERIOD * np.arange(3000)
    heading = 0.01 * time + 0.5 * np.clip(time - 12.0, 0.0, seconds)
    twist = twist_speed(heading, np.ones(3000, dtype=bool), PERIOD)
    middle = round((12.0 + seconds / 2) / PERIOD)
    assert twist[middle] == pytest.approx(0.05 * left, abs=0.003)
    assert twist[[500, 2500]] == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize(
    ("friction", "cosine", "against"),
    [(0.051, -0.29, True), (0.051, -0.31, False), (0.049, -0.29, False), (0.2, 0.9, True)]
)  # fmt: skip
def test_friction_works_against_a_slide(friction: float, cosine: float, against: bool) -> None:
    velocity = np.column_stack([over(100, 0.01), np.zeros(1000)])
    force = friction * np.tile([cosine, np.sqrt(1 - cosine**2)], (1000, 1))
    indicator = SlipIndicator(over(100, 0.01), np.zeros(1000))
    assert unresisted(indicator, velocity, force, PERIOD).sum() == 100 * against
    for speed, deviation in ((0.0019, 0.0), (0.0034, 0.001)):
        slow = SlipIndicator(over(100, speed), np.full(1000, deviation))
        assert not unresisted(slow, velocity, force, PERIOD).any()


def walk(first: int, usual: int, count: int) -> Array:
    """The load of a foot that steps `count` times, as long as `usual` samples, the first time as long as `first`."""
    stands = np.zeros(100 + first + (count - 1) * (usual + 60))
    for place in range(count):
        start = 50 + (first + 60 + (place - 1) * (usual + 60) if place else 0)
        stands[start : start + (usual if place else first)] = WEIGHT
    return stands


@pytest.mark.parametrize(
    ("first", "usual", "count", "stances"),
    [
        (100, 100, 2, None),
        (100, 100, 3, 3),
        (490, 490, 3, 3),
        (510, 510, 3, None),
        (290, 100, 5, 5),
        (310, 100, 5, 6),
    ],
)
def test_three_stances_of_five_seconds_at_most_are_a_walk(
    first: int, usual: int, count: int, stances: int | None
) -> None:
    """One of more than three usual lengths counts as two."""
    force = walk(first, usual, count)
    found = stances_of(contact(force), force, WEIGHT, PERIOD)
    assert (found and found.count) == stances


@pytest.mark.parametrize(("depth", "left"), [(0.0048, 80), (0.0052, 100), (np.nan, 80)])
def test_a_sole_rolls_within_a_tenth_of_its_half_width(depth: float, left: int) -> None:
    """Of its outline, at most for a tenth of the stance at either end."""
    sole = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    stances = Stances(np.zeros(100, dtype=np.intp), np.ones(100))
    cop = np.tile([0.0, 0.05 - depth], (100, 1))
    assert (without_rolling(stances, cop, sole).number == 0).sum() == left


def test_a_balance_is_told_in_millimetres_or_not_at_all() -> None:
    square = {"left": np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])}

    def balance(x: float) -> Balance:
        return Balance("m", np.array([0.5, 1.5]), np.array([[0.0, 0.0], [x, 0.0]]), square)

    require_balance(balance(0.0949))
    with pytest.raises(
        MotionError,
        match=r"^t = 1\.5 s: m: the zero-moment point comes within 4\.9 mm of the support polygon's "
        r"border \(valid: at least 5 mm inside\)$",
    ):
        require_balance(balance(0.0951))
    with pytest.raises(
        MotionError,
        match=r"^t = 1\.5 s: m: the zero-moment point leaves the support polygon by 3\.0 mm \(valid: at "
        r"least 5 mm inside\)$",
    ):
        require_balance(balance(0.103))
    with pytest.raises(DataError, match="no foot carries the robot"):
        Balance("m", np.zeros(1), np.full((1, 2), np.nan), square).worst()

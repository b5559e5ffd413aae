"""Which delays differ and when steps are settled, on stubs of what Newton's law shows."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.estimation.delays.delay import Delay
from plantar.estimation.delays.lag_search import Lags
from plantar.estimation.delays.sensor_delays import Delays
from plantar.robot.model import RobotModel
from plantar.sensors.delays import refined_delays as refining
from plantar.sensors.delays.refined_delays import RefinedDelays
from plantar.sensors.delays.sensor_delay import _doubtful, _in_doubt, _surer

LOG: Any = SimpleNamespace(period=0.005)
LOG_OF_SOME_SIZE: Any = SimpleNamespace(period=0.005, size=1)
RESIDUAL: Any = SimpleNamespace(balance=SimpleNamespace(cells=[]), pair=None)
COMMON = 0.004  # s
STEADY = np.zeros(0), np.zeros((3, 3))  # weights and inverse of delays that are the same throughout


def stepped(
    monkeypatch: pytest.MonkeyPatch,
    values: Sequence[float],
    std: float,
    at: Sequence[float] = (0.0, 0.0, 0.0),
) -> RefinedDelays | None:
    """One step, where all delays together come out as `values` with `std` each, and the common one as 4 ± 1 ms by both
    ways of weighing."""
    covariance = std**2 * np.eye(3)

    def delays(_: object, held: np.ndarray | None = None) -> Delays:
        free = np.eye(3) if held is None or not len(held) else np.eye(3) - np.linalg.pinv(held) @ held
        common = 0.0 if held is None else COMMON
        return Delays(free @ np.array(values) + [common, common, 0.0], covariance, 60, *STEADY)

    monkeypatch.setattr(refining, "estimate_delays", delays)
    monkeypatch.setattr(refining, "estimate_delay", lambda _: Delay(COMMON, 0.001, 30.0, 20))
    return refining._step([LOG], [[RESIDUAL]], np.array(at))


@pytest.mark.parametrize(
    ("values", "std", "feet", "encoders"),
    [((0.0007, -0.0007, 0.0), 1e-6, False, False), ((0.0016, -0.0016, 0.0), 1e-6, True, False),
     ((0.0, 0.0, 0.0014), 1e-6, False, False), ((0.0, 0.0, 0.0016), 1e-6, False, True),
     ((0.0, 0.0, 0.0080), 0.002, False, False), ((0.0, 0.0, 0.0082), 0.002, False, True)],
)  # fmt: skip
def test_sensors_differ_by_a_millisecond_and_a_half_and_four_deviations(
    monkeypatch: pytest.MonkeyPatch, values: tuple[float, ...], std: float, feet: bool, encoders: bool
) -> None:
    """No delay is known better than to 0.3 ms: four times that and 2 ms are 8.1 ms."""
    found = stepped(monkeypatch, values, std)
    assert found is not None
    assert (found.feet_differ, found.encoders_differ, found.suspect) == (feet, encoders, False)
    if feet or encoders:
        assert found.std == pytest.approx(np.hypot(std, 0.0003))


def test_what_sensors_show_beside_the_common_delay_is_drawn_to_none_by_a_millisecond(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two normal distributions multiplied, the one of 1 ms about none; known to 0.4 and 0.3 ms, its share is 0.8."""
    share = 1 / (1 + 0.4**2 + 0.3**2)
    shown = (0.0007, -0.0007, 0.0012)
    moved = stepped(monkeypatch, shown, 0.0004)
    assert moved is not None
    beside = share * np.array(shown)
    assert moved.std == np.inf, "what is common is told anew beside sensors that are read in time"
    assert moved.values == pytest.approx(beside + [COMMON, COMMON, 0.0], rel=0.2)
    left = np.array(shown) - (moved.values - [COMMON, COMMON, 0.0])
    found = stepped(monkeypatch, left, 0.0004, at=moved.values)
    assert found is not None
    assert found.std == 0.001
    assert found.encoders_unsure == pytest.approx(0.0005 * np.sqrt(share))
    assert 0.0002 < found.feet_unsure < 0.0004
    assert found.values[-1] == pytest.approx(beside[-1])
    unknown = stepped(monkeypatch, (0.0, 0.0, 0.0012), 0.00096)
    assert unknown is not None
    assert unknown.values == pytest.approx([COMMON, COMMON, 0.0]), "known no better than by what is usual"
    assert unknown.encoders_unsure == pytest.approx(0.001)


@pytest.mark.parametrize(("apart", "beside"), [(0.0052, 0.0012**2 - 0.0005**2 + 0.0001**2), (0.00448, 0.0)])
def test_a_common_delay_is_anywhere_between_what_encoders_in_time_and_apart_make_of_it(
    monkeypatch: pytest.MonkeyPatch, apart: float, beside: float
) -> None:
    """Known to 0.1 ms with encoders in time and to 0.5 ms with them apart, it moves by 0.49 ms by chance. What is
    anywhere within one unit to either side has a variance of a third."""

    def delays(_: object, held: np.ndarray | None = None) -> Delays:
        known = {0: (0.0, 0.0005), 3: (0.004, 0.0001), 2: (apart, 0.0005)}
        value, std = known[0 if held is None else len(held)]
        return Delays(np.array([value, value, 0.0]), std**2 * np.eye(3), 60, *STEADY)

    monkeypatch.setattr(refining, "estimate_delays", delays)
    monkeypatch.setattr(refining, "estimate_delay", lambda _: Delay(0.004, 0.001, 30.0, 20))
    found = refining._step([LOG], [[RESIDUAL]], np.zeros(3))
    assert found is not None
    assert found.std == pytest.approx(np.sqrt(0.001**2 + beside / 3))


@pytest.mark.parametrize(("weighed", "beside"), [(0.0065, 0.0025**2 - 0.0008**2), (0.0047, 0.0)])
def test_a_common_delay_is_anywhere_between_what_two_ways_of_weighing_make_of_it(
    monkeypatch: pytest.MonkeyPatch, weighed: float, beside: float
) -> None:
    """Known to 1 ms with the one and to 0.6 ms with the other, they are 0.8 ms apart by chance."""

    def delays(_: object, held: np.ndarray | None = None) -> Delays:
        value = 0.0 if held is None else weighed
        return Delays(np.array([value, value, 0.0]), 0.0006**2 * np.eye(3), 60, *STEADY)

    monkeypatch.setattr(refining, "estimate_delays", delays)
    monkeypatch.setattr(refining, "estimate_delay", lambda _: Delay(COMMON, 0.001, 30.0, 20))
    found = refining._step([LOG], [[RESIDUAL]], np.zeros(3))
    assert found is not None
    assert found.std == pytest.approx(np.sqrt(0.001**2 + beside / 3))


@pytest.mark.parametrize(("std", "suspect"), [(0.0029, False), (0.0031, True)])
def test_what_clearly_differs_is_read_apart_however_well_it_is_known(
    monkeypatch: pytest.MonkeyPatch, std: float, suspect: bool
) -> None:
    """Sensors that are 20 ms apart are not read at one moment, known to a millisecond; beyond three it is as well asked
    whether they are late by something else."""
    found = stepped(monkeypatch, (0.0, 0.0, 0.02), std)
    assert found is not None
    assert (found.suspect, found.encoders_differ) == (suspect, True)
    assert found.values[-1] == pytest.approx(0.02)
    assert found.encoders_unsure == pytest.approx(np.hypot(std, 0.0003))


@pytest.mark.parametrize(("apart", "suspect"), [(0.0146, False), (0.0156, True)])
def test_three_deviations_of_what_is_not_known_well_are_ground_for_a_search(
    monkeypatch: pytest.MonkeyPatch, apart: float, suspect: bool
) -> None:
    """Encoders 100 ms late look 50 ± 14 ms late from none; three times 5 and 0.3 ms are 15.03 ms."""
    found = stepped(monkeypatch, (0.0, 0.0, apart), 0.005)
    assert found is not None
    assert (found.suspect, found.encoders_differ) == (suspect, False)


def test_delays_that_need_not_differ_go_together_first(monkeypatch: pytest.MonkeyPatch) -> None:
    found = stepped(monkeypatch, (-0.002, 0.002, 0.0), 1e-6, at=(0.006, 0.002, 0.0))
    assert found is not None
    assert found.std == np.inf
    assert found.values == pytest.approx([0.008, 0.008, 0.0]), "and what is left of all goes with it"
    assert refining._step([LOG], [[]], np.zeros(3)) is None
    far = stepped(monkeypatch, (0.0, 0.0, 0.051), 1e-6)
    assert far is None, "later than 50 ms is another fault"


def refined(
    std: float, closed: int = 1, suspect: bool = False, value: float = 0.0, differ: bool = False
) -> RefinedDelays:
    mask = np.arange(2) < closed
    return RefinedDelays(np.array([value, value, 0.0]), std, 20.0, differ, False, mask, 0.005, suspect)


def test_of_two_answers_the_unsuspected_then_the_wider_then_the_apart_then_the_sharper_is_surer() -> None:
    order = [
        refined(0.1, 1, suspect=True),
        refined(0.2, 1),
        refined(0.1, 1),
        refined(0.3, 1, differ=True),
        refined(0.5, 2),
    ]
    for place, one in enumerate(order):
        assert [_surer(one, other) for other in order] == [other < place for other in range(len(order))]


def lags(
    missed: float, power: float = 1.0, value: float = 0.0, std: float = 0.02, edge: bool = False
) -> Lags:
    each = np.array([missed, 0.01])
    return Lags(np.array([value, value, 0.0]), np.full(3, std), edge, each, np.array([power, 1.0]))


@pytest.mark.parametrize(
    ("found", "searched", "doubt"),
    [
        (None, lags(0.069), False), (None, lags(0.071), True), (None, lags(0.071, 3.1), False),
        (None, lags(0.071, 2.9), True), (None, lags(0.071, 1 / 3.1), False), (None, lags(0.071, 1 / 2.9), True),
        (refined(0.0029, 0), lags(0.071), False), (refined(0.0031, 0), lags(0.071), True),
        (refined(0.0031, 2), lags(0.071), False),
        (refined(0.0005, 2), lags(0.01, value=0.099), False), (refined(0.0005, 2), lags(0.01, value=0.101), True),
        (refined(0.0005, 2), lags(0.01, value=0.119, std=0.06), False),
        (refined(0.0005, 2), lags(0.01, value=0.121, std=0.06), True),
        (refined(0.0005, 2, value=0.1), lags(0.01, value=0.1), False),
    ],
)  # fmt: skip
def test_delays_are_in_doubt_where_the_law_closes_elsewhere_or_nowhere(
    found: RefinedDelays | None, searched: Lags, doubt: bool
) -> None:
    """7 % missed; torques threefold are a push; two steps of 50 ms or two deviations are elsewhere."""
    both = np.ones(2, dtype=bool)
    assert _in_doubt(searched, found, both, both) == doubt
    # Where soles say how the robot accelerates only a lag at which the law closes raises doubt.
    assert _in_doubt(searched, found, both, ~both) == (doubt and searched.missed.max() < 0.07)


@pytest.mark.parametrize(("edge", "left"), [(False, np.hypot(0.02, 0.1)), (True, 0.5 / np.sqrt(12))])
def test_what_may_be_late_by_anything_is_allowed_for(robot: RobotModel, edge: bool, left: float) -> None:
    found = _doubtful(robot, lags(0.5, value=0.1, edge=edge))
    std = np.hypot(robot.uncertainty.wrench_delay, left)
    assert (found.delay, found.doubtful, found.measured) == (0.0, True, False)
    assert found.std == pytest.approx(std)
    assert (
        f"sensors may be late by {1.96e3 * std:.0f} ms: no delays up to 250 ms were found" in found.note.text
    )


def test_steps_that_go_back_and_forth_between_two_answers_settle(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Encoders that are told beside feet read in time, and no longer where that has moved them."""
    told_at_last = list[bool]()

    def step(_logs: object, _tried: object, at: np.ndarray, told: np.ndarray | None = None) -> RefinedDelays:
        known = np.array([True, True, bool(at[-1] == 0.0)]) & (True if told is None else told)
        told_at_last.append(bool(known[-1]))
        values = np.array([0.0, 0.0, -0.0015 if known[-1] else 0.0])
        std = np.inf if np.abs(values - at).max() > 0.0003 else 0.001
        return RefinedDelays(values, std, 9.0, False, False, np.array([True]), 0.005, told=known)

    monkeypatch.setattr(refining, "_step", step)
    monkeypatch.setattr(refining, "residuals_at", lambda *_: [])
    found = refining.refined_delays(robot, [LOG_OF_SOME_SIZE], map, np.zeros(3))
    assert found is not None
    np.testing.assert_array_equal(found.values, np.zeros(3))
    assert told_at_last[:4] == [True, False, True, False], "both answers are tried before one stays"


@pytest.mark.parametrize(
    ("moved", "variances", "expected"),
    [
        ((0.0, 0.0), (1e-8, 1e-8), 0.0),
        ((3e-4, 0.0), (4e-8, 1e-8), np.sqrt(9e-8 - 3e-8)),  # less what chance moves it by
        ((3e-4, 4e-4), (1e-8, 1e-8), 5e-4),
        (
            (3e-4, 0.0),
            (1e-8, 4e-8),
            3e-4,
        ),  # the wider one first: chance explains nothing, and takes nothing off
    ],
)
def test_what_is_chosen_without_being_known_widens_the_delay_by_what_chance_does_not_move(
    moved: tuple[float, float],
    variances: tuple[float, float],
    expected: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of encoders as tried, and found beside; cells weigh as in the common delay, which is as sure as the second."""
    apart, together = (
        SimpleNamespace(values=np.array([0.005 + by]), covariance=np.array([[variance]]))
        for by, variance in zip((moved[0], 0.0), variances, strict=True)
    )
    monkeypatch.setattr(refining, "estimate_delays", lambda _, held: together if len(held) == 2 else apart)
    found = refining._by_choice([], np.eye(2), 0.005 + moved[1], float(np.sqrt(variances[1])))
    assert found == pytest.approx(expected / np.sqrt(3))

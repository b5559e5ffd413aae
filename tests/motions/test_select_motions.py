"""Which recordings are most informative: wide sways before small ones, sets before single logs."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from biped_robot import FEET
from feet_trials import AXES, PUNCTUAL, noisy
from plantar.errors import DataError
from plantar.estimation import fit_blocks
from plantar.feet.prepare import prepare_all
from plantar.feet.regression.regression_data import blocks_of
from plantar.logs.motion_log import MotionLog
from plantar.motions.select_motions import (
    SEVERAL,
    UNKNOWN,
    Choice,
    MotionInformation,
    Selection,
    _best_sets,
    _promise,
    select_motions,
)
from plantar.robot.model import RobotModel

STILL = lambda t: 0.0 * t + 0.002 * np.sin(1.1 * t)  # noqa: E731


@pytest.fixture(scope="module")
def logs() -> list[MotionLog]:
    """Two good sways, and one in which the right foot hardly moves."""
    good = [noisy(record(sway(name, seed)), seed) for seed, name in enumerate(("one", "two"))]
    motion = sway("poor", 3)
    poor = sway("poor", 3, ankles={**motion.ankles, "right": (STILL, STILL)})
    return [*good, noisy(record(poor), 3)]


@pytest.fixture(scope="module")
def found(robot: RobotModel, logs: list[MotionLog]) -> Selection:
    return select_motions(robot, logs, ["poor", "one"], largest=2, settings=PUNCTUAL)


def test_the_poorest_log_is_last_and_more_logs_promise_more(found: Selection) -> None:
    assert [choice.motions for choice in found.alone][-1] == ("poor",)
    assert [choice.motions for choice in found.best] == [found.alone[0].motions, ("one", "two")]
    assert found.best[1].usual < found.best[0].usual
    assert found.together.motions == ("one", "two", "poor")
    assert found.compared is not None
    assert found.compared.motions == ("poor", "one")
    assert found.compared.usual > found.best[1].usual


def test_half_widths_are_those_of_the_fit(robot: RobotModel, logs: list[MotionLog], found: Selection) -> None:
    recordings = prepare_all(robot, logs, (), PUNCTUAL, lambda _: None).fitted
    for foot in FEET:
        for axis in AXES:
            fit = fit_blocks(blocks_of(recordings, foot, axis))
            for place, term in enumerate(("stiffness", "damping")):
                expected = 196 * fit.std[place] / abs(fit.values[place])
                assert found.together.half_width_percent[foot, axis, term] == pytest.approx(
                    expected, rel=0.05
                )
    assert found.together.worst == max(found.together.half_width_percent.values())
    widths = np.array(list(found.together.half_width_percent.values()))
    assert found.together.usual == pytest.approx(np.exp(np.log(widths).mean()))
    assert found.together.condition_number >= 1.0


def test_an_unknown_name_and_logs_without_a_foot_are_one_line(
    robot: RobotModel, logs: list[MotionLog]
) -> None:
    with pytest.raises(DataError, match=r"no log is called 'three' \(valid: one, two, poor\)"):
        select_motions(robot, logs, ["three"])
    lifted = record(sway("up", lifts=(("left", 0.0, 30.0), ("right", 0.0, 30.0))))
    with pytest.raises(DataError):
        select_motions(robot, [lifted], settings=PUNCTUAL)


KEY, INFORMATION, SCORES = ("left", "pitch"), np.diag([4.0, 9.0]), np.array([[2.0, 0.5], [0.5, 3.0]])
VALUES = {(*KEY, "stiffness"): 400.0, (*KEY, "damping"): -20.0}


def promised(*shares: float) -> Choice:
    """Of recordings that hold these shares of the information and of the scores' covariance."""
    parts = {
        str(place): MotionInformation(share * INFORMATION, share * SCORES)
        for place, share in enumerate(shares)
    }
    return _promise(tuple(parts), {KEY: parts}, VALUES)


def test_a_promise_is_the_sandwich_in_percent_of_the_value_and_halves_in_four_times_as_many() -> None:
    inverse = np.linalg.inv(INFORMATION)
    std = np.sqrt(np.diag(inverse @ SCORES @ inverse))
    one, four = promised(1.0), promised(1.0, 1.0, 1.0, 1.0)
    for term, deviation, value in (("stiffness", std[0], 400.0), ("damping", std[1], 20.0)):
        assert one.half_width_percent[*KEY, term] == pytest.approx(195.996 * deviation / value, rel=1e-4)
        assert four.half_width_percent[*KEY, term] == pytest.approx(one.half_width_percent[*KEY, term] / 2)
    assert one.condition_number == pytest.approx(1.0), (
        "of columns that have nothing in common, whatever their size"
    )


def test_what_a_set_does_not_show_is_unknown_and_never_more() -> None:
    still = MotionInformation(np.diag([4.0, 0.0]), SCORES)
    for parts in ({}, {"still": still}):
        found = _promise(("still",), {KEY: parts}, VALUES)
        assert set(found.half_width_percent.values()) == {1000.0}
        assert found.condition_number == np.inf
    assert promised(1e-6).half_width_percent[*KEY, "damping"] == UNKNOWN


def test_of_many_recordings_the_best_set_grows_by_one() -> None:
    """All pairs of thirty are looked at; of more than SEVERAL sets the best pair gets its best third."""
    names = [f"log_{place:02d}" for place in range(30)]
    asked: list[tuple[str, ...]] = []

    def promise(motions: tuple[str, ...]) -> Choice:
        asked.append(motions)
        places = [int(name[4:]) for name in motions]
        # The best single is no part of the best pair.
        width = {(3,): 1.0, (7, 9): 0.5}.get(tuple(places), 2.0 - 0.01 * max(places))
        return Choice(motions, {(*KEY, "stiffness"): width}, 1.0)

    best = _best_sets(names, 3, promise)
    assert [choice.motions for choice in best] == [
        ("log_03",),
        ("log_07", "log_09"),
        ("log_07", "log_09", "log_29"),
    ]
    assert [sum(len(one) == size for one in asked) for size in (1, 2, 3)] == [30, 435, 28]
    asked.clear()
    assert len(_best_sets(names[:26], 4, promise)) == 4
    assert sum(len(one) == 3 for one in asked) == 2600 < SEVERAL, "few enough for all"

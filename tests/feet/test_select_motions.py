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
from plantar.feet.select_motions import Selection, select_motions
from plantar.logs.motion_log import MotionLog
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

"""A place that the robot file calls exact gives way to what motions show, and that is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import FEET
from feet_trials import AXES, LINEAR, codes, noisy, shifted
from plantar.feet.identify import identify_feet
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.place.told_exact import as_measured
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty


@pytest.fixture(scope="module")
def recorded() -> list[MotionLog]:
    return [noisy(record(sway(f"sway_{seed}", seed)), seed) for seed in (3, 4)]


def worst(result: FeetResult) -> float:
    """The largest error of a stiffness, as a share."""
    rows = {(foot, axis): result.parameter(foot, axis, "stiffness") for foot in FEET for axis in AXES}
    return max(abs(row.value / TRUTH[key].stiffness - 1) for key, row in rows.items())


def test_a_careful_lab_measures_as_the_defaults_say(robot: RobotModel) -> None:
    assert not PlaceSpread.of(robot, "left").deviations.any()
    assert as_measured(robot, "left").deviations.tolist() == [0.005, 0.005, 0.0, 0.0, 0.0, 0.0]
    always = replace(robot, feet={name: replace(foot, contact="always") for name, foot in robot.feet.items()})
    assert not as_measured(always, "left").deviations.any()


@pytest.mark.parametrize("away", [(0.0, 0.0, 0.04), (0.03, 0.0, 0.0), (0.0, 0.0, 0.02)])
def test_a_place_that_is_told_as_exact_gives_way_to_what_motions_show(
    robot: RobotModel, recorded: list[MotionLog], away: tuple[float, float, float]
) -> None:
    sure = replace(robot, uncertainty=Uncertainty(bush_position=0.0))
    surer = replace(robot, uncertainty=Uncertainty(bush_position=0.0002, wrench_crosstalk=0.0))
    logs = [shifted(log, np.array(away)) for log in recorded]
    for told in (robot, sure, surer):
        found = identify_feet(told, logs, settings=LINEAR)
        assert worst(found) < 0.01
        assert all(np.hypot(*model.moment_arms) > 0.005 for model in found.models if model.axis == "pitch")
    texts = [note.text for note in found.notes if note.code == "bush_place" and "`uncertainty`" in note.text]
    assert {text.split()[0] for text in texts} == {"left", "right"}
    assert all("known to 0.2 mm: taken as known to 5 mm" in text for text in texts)


def test_a_place_that_is_told_as_exact_and_is_right_is_not_told_of(
    robot: RobotModel, recorded: list[MotionLog]
) -> None:
    sure = replace(robot, uncertainty=Uncertainty(bush_position=0.0))
    assert "bush_place" not in codes(identify_feet(sure, recorded, settings=LINEAR))


def test_what_is_told_as_exact_and_shown_elsewhere_is_told_of_the_foot_alone_of_which_it_is_so(
    robot: RobotModel, recorded: list[MotionLog]
) -> None:
    logs = [log.with_columns({name: values for name, values in shifted(log, np.array([0.0, 0.0, 0.02])).columns.items()
                              if name.startswith("wrench.right")}) for log in recorded]  # fmt: skip
    found = identify_feet(robot, logs, settings=LINEAR)
    texts = [note.text for note in found.notes if note.code == "bush_place"]
    assert texts
    assert all(text.startswith("right") for text in texts)
    assert all(np.hypot(*model.moment_arms) < 0.003 for model in found.models if model.foot == "left")


def test_a_foot_that_always_stands_has_no_place_to_be_told_exactly(
    robot: RobotModel, recorded: list[MotionLog]
) -> None:
    feet = {name: replace(foot, contact="always") for name, foot in robot.feet.items()}
    logs = [shifted(log, np.array([0.03, 0.0, 0.02])) for log in recorded]
    assert "bush_place" not in codes(identify_feet(replace(robot, feet=feet), logs, settings=LINEAR))

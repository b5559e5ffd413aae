"""Feet that are pulled down: reversed signs are told from sensors zeroed under load, whichever sign is tried."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import WEIGHT, record, sway
from biped_robot import SOLE_DEPTH, Frame, Mounting, make_robot
from plantar.faults.load_signs import check_load_signs
from plantar.faults.log_faults import check_log
from plantar.robot.model import RobotModel

TIME = np.arange(0.0, 20.0, 0.01)
LEFT = WEIGHT * (0.7 + 0.25 * np.sin(TIME))  # most of the weight on the left foot


@pytest.fixture
def robot(tmp_path: Path) -> RobotModel:
    return make_robot(tmp_path)


def signed(robot: RobotModel, sign: float) -> RobotModel:
    feet = {name: replace(foot, wrench=replace(foot.wrench, sign=sign)) for name, foot in robot.feet.items()}
    return replace(robot, feet=feet)


def test_loads_that_push_up_are_right(robot: RobotModel) -> None:
    assert not list(check_load_signs(robot, {"left": LEFT, "right": WEIGHT - LEFT}))


def test_a_sensor_with_a_link_of_its_own_may_be_mounted_upside_down(robot: RobotModel) -> None:
    """As force sensors stand in many URDFs: it reads the load along its -z, which pulls nobody down."""
    turn, places = (np.pi, 0.0, 0.0), {}
    for name, foot in robot.feet.items():
        xyz = foot.wrench.placement.xyz + [0.0, 0.0, SOLE_DEPTH]
        placed = replace(foot.wrench.placement, link=f"{name}_sole", xyz=xyz, rpy=np.array(turn))
        places[name] = replace(foot, wrench=replace(foot.wrench, placement=placed))
    log = record(sway(duration=5.0), Mounting(wrench=Frame((0.01, 0.0, -0.04), turn)))
    assert not [one for one in check_log(replace(robot, feet=places), log) if one.fatal]


@pytest.mark.parametrize("sign", [1, -1])
def test_a_reversed_sensor_gets_the_other_sign(robot: RobotModel, sign: int) -> None:
    (found,) = check_load_signs(signed(robot, sign), {"left": -LEFT, "right": WEIGHT - LEFT})
    assert found.code == "sign"
    assert f"'sign: {-sign}' in feet.left.wrench" in found.text


def test_both_reversed_get_the_other_sign(robot: RobotModel) -> None:
    found = list(check_load_signs(robot, {"left": -LEFT, "right": LEFT - WEIGHT}))
    assert "sign" in {one.code for one in found}
    assert "zeroed_under_load" not in {one.code for one in found}


@pytest.mark.parametrize("sign", [1, -1])
def test_no_sign_is_advised_where_sensors_were_zeroed_under_load(robot: RobotModel, sign: int) -> None:
    """Zeroed while both feet carried half, then most of the weight on one: one foot reads negative with either sign."""
    loads = {"left": sign * (LEFT - WEIGHT / 2), "right": sign * (WEIGHT / 2 - LEFT)}
    (found,) = check_load_signs(signed(robot, sign), {name: 1.5 * load for name, load in loads.items()})
    assert (found.code, found.fatal) == ("zeroed_under_load", True)
    foot = "right" if sign == 1 else "left"
    assert found.text == (
        f"column 'wrench.{foot}.force.z', value {-1.5 * (np.median(LEFT) - WEIGHT / 2):.4g}: pulls the standing foot "
        "down; the feet exchange load as they should, so the sensors were zeroed under load (valid: zeroed in the air, "
        "or 'contact: always' for feet that stand throughout)"
    )


def test_samples_that_one_foot_lacks_say_nothing_of_the_exchange(robot: RobotModel) -> None:
    loads = {"left": 1.5 * (LEFT - WEIGHT / 2), "right": 1.5 * (WEIGHT / 2 - LEFT)}
    loads["left"][100:140] = np.nan
    loads["right"][500:520] = np.nan
    (found,) = check_load_signs(robot, loads)
    assert found.code == "zeroed_under_load"


@pytest.mark.parametrize("right", [0.7, 1.0])
def test_a_foot_in_the_air_that_pulls_has_a_zero_and_no_reversed_sign(
    robot: RobotModel, right: float
) -> None:
    """A third of the weight downward: a reversed sign where the other foot carries two thirds, else a zero."""
    left = np.full_like(TIME, -0.3 * WEIGHT)
    (found,) = check_load_signs(robot, {"left": left, "right": np.full_like(TIME, right * WEIGHT)})
    assert found.code == ("zeroed_under_load" if right == 1.0 else "sign")
    said = (
        "reads this while the other foot carries the whole weight, so its zero is off (valid: 0; zero the sensor in "
        "the air)"
    )
    if right < 1.0:
        said = "pulls the standing foot down (valid: > 0; set 'sign: -1' in feet.left.wrench, or turn its rpy if it "
        said += "sits upside down)"
    assert found.text == f"column 'wrench.left.force.z', value {-0.3 * WEIGHT:.4g}: {said}"


def test_feet_that_stand_throughout_are_not_asked(robot: RobotModel) -> None:
    feet = {name: replace(foot, contact="always") for name, foot in robot.feet.items()}
    assert not list(check_load_signs(replace(robot, feet=feet), {"left": -LEFT, "right": LEFT - WEIGHT}))

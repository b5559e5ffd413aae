"""What the robot file says may be wrong: what logs of a robot that is otherwise show of it, and where it is printed."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from biped import record, sway
from biped_robot import FEET, Frame, Mounting
from feet_trials import noisy, shifted
from plantar.conventions import NORMAL95
from plantar.feet.assess.diagnosis import REMEDY
from plantar.feet.assumptions import CAUSES, _bending, assumptions
from plantar.feet.identify import identify_feet
from plantar.feet.interval_width.between_recordings import Apart
from plantar.feet.prepare import PreparedLogs
from plantar.feet.settings import FeetSettings
from plantar.report.feet import feet_page
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Assumption
from plantar.results.feet_text import NOT_FOUND, PRINTED_IN, assumption_cells
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.moments.bent_joints import JointBending

ASIDE = np.array(
    [0.004, -0.005, 0.006]
)  # m: where the force sensors really are beside the robot file's place
TURN = 0.02  # rad, of the IMU about its z
SETTINGS = FeetSettings(model="kelvin_voigt")


@pytest.fixture(scope="module")
def usual(robot: RobotModel) -> RobotModel:
    """The robot as a careful lab knows it."""
    return replace(robot, uncertainty=Uncertainty())


@pytest.fixture(scope="module")
def found(usual: RobotModel) -> FeetResult:
    turn = Mounting(imu=Frame((0.0, 0.0, 0.0), (0.0, 0.0, TURN)))
    motions = [sway(f"sway_{seed}", seed, duration=40.0) for seed in (3, 4)]
    return identify_feet(
        usual, [shifted(noisy(record(one, turn), 5), ASIDE) for one in motions], settings=SETTINGS
    )


def row(result: FeetResult, name: str, what: str) -> Assumption:
    (one,) = (each for each in result.assumptions if (each.name, each.what) == (name, what))
    return one


def test_every_key_of_the_robot_file_has_its_row(found: FeetResult, usual: RobotModel) -> None:
    """The total mass where the robot was weighed."""
    named = {each.name: each.assumed for each in found.assumptions}
    keys = {field.name for field in fields(Uncertainty)}
    assert set(named) == keys - {"total_mass"}
    assert set(PRINTED_IN) == keys
    assert set(CAUSES) | set(NOT_FOUND) <= keys
    assert {cause for causes in CAUSES.values() for cause in causes} <= set(REMEDY)
    assert all(value == getattr(usual.uncertainty, name) for name, value in named.items())


@pytest.mark.parametrize("foot", FEET)
@pytest.mark.parametrize(("place", "axis"), [(0, "x"), (1, "y"), (2, "z")])
def test_a_bush_that_is_elsewhere_is_shown_where_it_is(
    found: FeetResult, foot: str, place: int, axis: str
) -> None:
    """Beside sensors that sit ASIDE of their place, the bush is on the other side."""
    one = row(found, "bush_position", f"{foot} {axis}")
    assert one.found is not None
    assert one.std is not None
    assert one.found == pytest.approx(-ASIDE[place], abs=max(3 * one.std, 5e-4))
    assert one.std < Uncertainty().bush_position


def test_a_turned_imu_is_shown_about_its_axis(found: FeetResult) -> None:
    about = [row(found, "imu_mount", axis) for axis in "xyz"]
    for each, true in zip(about, (0.0, 0.0, TURN), strict=True):
        assert each.found is not None
        assert each.std is not None
        assert each.found == pytest.approx(true, abs=3 * each.std)
    assert about[2].std < TURN / 10


def test_what_recordings_differ_by_is_as_sure_as_its_interval_is_narrow(usual: RobotModel) -> None:
    """Of 95 % from 1 to 5 per cent: a normal deviation is half of that over 1.96."""
    timing, still = SimpleNamespace(measured=False), SimpleNamespace(angles=(0.0, 0.0, 0.0))
    ready = cast(
        "PreparedLogs",
        SimpleNamespace(
            gain_errors={}, sensor_delay=timing, robot=usual, imu_turn=still, bending=JointBending.told(usual)
        ),
    )
    for apart, expected in (
        (Apart(0.02, 3, (0.01, 0.05)), (0.02, 0.04 / 3.92)),
        (Apart(0.02, 3), (None, None)),
    ):
        (one,) = (each for each in assumptions(ready, [], apart) if each.name == "between_recordings")
        assert (one.found, one.std) == (expected[0], expected[1] and pytest.approx(expected[1], rel=1e-3))


def test_a_delay_that_no_log_shows_is_not_found(found: FeetResult) -> None:
    """The biped's forces are drawn, not moved by Newton."""
    one = row(found, "wrench_delay", "")
    assert (one.found, one.std) == (None, None)
    assert any(
        line[0] == "wrench_delay" and line[3] == "not in these logs"
        for line in assumption_cells(found.assumptions)
    )


def test_what_it_does_is_half_the_interval_that_it_alone_would_make(found: FeetResult) -> None:
    one = row(found, "wrench_delay", "")
    widths = [
        each.half_width_percent * np.sqrt(each.variance_shares["delay"])
        for each in found.diagnosis
        if each.name == "damping"
    ]
    assert one.damping_percent == pytest.approx(max(widths))
    assert row(found, "link_mass", "").damping_percent is None


def test_sensors_that_are_better_known_leave_less(found: FeetResult, usual: RobotModel) -> None:
    gain = [each for each in found.assumptions if each.name == "wrench_gain"]
    assert [each.what for each in gain] == [f"{foot}, beside the weight" for foot in FEET]
    assert gain[0].stiffness_percent is not None
    assert gain[0].stiffness_percent >= 100 * NORMAL95 * usual.uncertainty.wrench_gain
    assert gain[1].stiffness_percent is None, "said once"


def test_it_is_printed_and_kept(found: FeetResult, tmp_path: Path) -> None:
    assert FeetResult.load(found.save(tmp_path)).assumptions == found.assumptions
    cells = assumption_cells(found.assumptions)
    (height,) = (line for line in cells if line[2] == "left z")
    assert height[3].startswith("−6.") or height[3].startswith("−5.")
    assert height[3].endswith(" mm")
    page = feet_page(found)
    assert "What the robot file may be wrong about" in page
    assert height[3] in page


def test_of_an_exact_robot_nothing_is_said_that_may_not_be_wrong(robot: RobotModel) -> None:
    log = noisy(record(sway("sway", 3, duration=20.0)), 3)
    cells = assumption_cells(identify_feet(robot, [log], settings=SETTINGS).assumptions)
    assert {line[0] for line in cells if line[0]} <= {"wrench_gain", "wrench_delay", "between_recordings"}


def test_the_bend_of_legs_is_told_with_its_deviation() -> None:
    def of(mean: float | None) -> list[tuple[str, float, float]]:
        ready = SimpleNamespace(bending=SimpleNamespace(mean=mean, std=2e-6))
        return [tuple(one) for one in _bending(cast(PreparedLogs, ready))]  # type: ignore[arg-type]

    assert of(1.5e-5) == [("joints of legs and trunk together", 1.5e-5, 2e-6)]
    assert of(0.0) == [("joints of legs and trunk together", 0.0, 2e-6)]
    assert of(None) == []

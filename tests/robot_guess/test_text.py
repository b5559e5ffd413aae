"""The lines of a first robot file: what is measured, what is a guess, how far off it may be; always YAML."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import yaml

from plantar.robot.joint_names import JointNames
from plantar.robot_guess.biped import Limb
from plantar.robot_guess.evidence import Remark
from plantar.robot_guess.feet import Sole, box
from plantar.robot_guess.imu import Mount
from plantar.robot_guess.seat import Seat
from plantar.robot_guess.text import BushHeight, Draft

QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # about z
LIMB = Limb("left_ankle", (), np.zeros(3), np.eye(3), "left")
SOLE = Sole(LIMB, np.eye(3), box(-0.1, 0.2, -0.06, 0.06), -0.11, 0.004, 0.012, "its shapes", True)
FRAME = Seat("left_ft", np.zeros(3), np.eye(3), "the frame of its messages", False, 0.03)
PLACE = Seat("left_ankle", np.array([0.0, 0.0, -0.02]), np.eye(3), "the balance", True, 0.03, 0.007)
DRAFT = Draft(
    "biped",
    "biped.urdf",
    None,
    [SOLE],
    {"left": "left_foot_ft"},
    {"left": FRAME},
    {"left": BushHeight(-0.08, 0.015, "half way")},
    JointNames(),
    {},
    remarks=(),
)


def lines(draft: Draft, key: str) -> list[str]:
    """What the file says at a key, line by line without the spaces before."""
    return [line.strip() for line in draft.text("b.urdf").splitlines() if line.strip().startswith(key)]


def parsed(draft: Draft) -> dict[str, Any]:
    found = yaml.safe_load(draft.text("b.urdf"))
    assert isinstance(found, dict)
    return found


def test_names_that_yaml_would_read_otherwise_are_quoted() -> None:
    odd = replace(DRAFT, name="on", sensors={"left": "12: #3"}, topics={"imu": "/imu: raw"})
    found = parsed(odd)
    assert found["name"] == "on"
    assert found["feet"]["left"]["wrench"]["name"] == "12: #3"
    assert found["topics"] == {"imu": "/imu: raw"}


def test_a_sensor_that_no_log_names_is_called_as_its_side() -> None:
    assert parsed(DRAFT)["feet"]["left"]["wrench"]["name"] == "left_foot_ft"
    assert parsed(replace(DRAFT, sensors={}))["feet"]["left"]["wrench"]["name"] == "left"


def test_without_an_imu_the_file_says_that_none_was_found() -> None:
    assert lines(DRAFT, "# imu:") == ["# imu: no IMU was found in the logs"]
    assert "imu" not in parsed(DRAFT)


@pytest.mark.parametrize(("turn", "rpy"), [(np.eye(3), None), (QUARTER, [0, 0, 1.5708])])
def test_an_imu_whose_frame_is_known_is_no_guess(turn: np.ndarray, rpy: list[float] | None) -> None:
    known = replace(DRAFT, imu=("chest", Mount("torso", turn, False, "its messages")))
    (line,) = lines(known, "imu:")
    assert line.endswith("# link: its messages")
    assert "GUESS" not in line
    written = parsed(known)["imu"]
    assert written.pop("rpy", None) == (rpy and pytest.approx(rpy, abs=1e-4))
    assert written == {"name": "chest", "link": "torso"}


def test_an_imu_that_is_guessed_says_how_far_off_and_what_else_it_may_be() -> None:
    mount = Mount("torso", QUARTER, True, "called so", ("head_imu", "waist_imu"), 0.1)
    guess = replace(DRAFT, imu=("chest", mount))
    (line,) = lines(guess, "imu:")
    assert line.endswith("# GUESS ± 100 mm: called so; or one of head_imu, waist_imu")
    assert parsed(guess)["imu"]["xyz"] == [0, 0, 0]
    (sure,) = lines(replace(DRAFT, imu=("chest", replace(mount, others=(), spread=0.0))), "imu:")
    assert sure.endswith("# GUESS: called so")


def test_a_sensors_frame_is_named_and_a_guessed_place_is_written_out() -> None:
    (frame,) = lines(DRAFT, "wrench:")
    assert frame == "wrench: {name: left_foot_ft, link: left_ft}  # link: the frame of its messages"
    upside = replace(DRAFT, seats={"left": replace(PLACE, sign=-1)})
    (place,) = lines(upside, "wrench:")
    assert place.startswith("wrench: {name: left_foot_ft, xyz: [0, 0, -0.02], sign: -1}")
    assert place.endswith("# GUESS ± 7 mm: the balance; sign: its force points down under load")
    elsewhere = parsed(replace(DRAFT, seats={"left": replace(PLACE, link="left_toe")}))
    assert elsewhere["feet"]["left"]["wrench"]["link"] == "left_toe"
    ankle = replace(DRAFT, seats={"left": replace(FRAME, link="left_ankle")})
    assert parsed(ankle)["feet"]["left"]["wrench"]["link"] == "left_ankle", "a frame that is known is named"


def test_bush_and_sole_say_how_far_off_they_may_be() -> None:
    (bush,) = lines(DRAFT, "bush:")
    assert bush == "bush: {xyz: [0, 0, -0.08]}  # GUESS ± 15 mm: half way"
    assert lines(DRAFT, "# GUESS ±") == ["# GUESS ± 12 mm in the outline, ± 4 mm in height: its shapes"]
    sole = parsed(DRAFT)["feet"]["left"]["sole"]
    assert sole["xyz"] == [0, 0, -0.11]
    assert sole["polygon"] == [[0.2, 0.06], [-0.1, 0.06], [-0.1, -0.06], [0.2, -0.06]]


def test_doubts_stand_before_the_keys_and_are_told_from_what_was_seen() -> None:
    told = replace(DRAFT, remarks=[Remark("the load fits"), Remark("the sole is small", doubt=True)])
    head = told.text("b.urdf").split("name: biped")[0].splitlines()
    assert head[-2:] == ["# Seen: the load fits", "# DOUBT: the sole is small"]


@pytest.mark.parametrize("numbered", [False, True])
def test_joints_that_are_only_numbered_are_a_guess(numbered: bool) -> None:
    named = replace(DRAFT, names=JointNames(renamed={"knee": "0"}), numbered=numbered)
    assert parsed(named)["joint_names"] == {"renamed": {"knee": "0"}}
    guess = "# GUESS: the logs only number the joints; taken in the URDF's order, look it up"
    assert (guess in named.text("b.urdf").splitlines()) == numbered
    assert "joint_names" not in parsed(DRAFT)

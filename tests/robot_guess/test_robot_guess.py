"""A first robot file: what the URDF tells, what logs of a standing robot put right, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import yaml

from biped import record, sway
from biped_robot import URDF, Frame, Mounting, make_robot
from example_robots import (
    BAXTER,
    BOLT,
    CENTAURO,
    G1,
    GO2,
    HAND,
    HUMAN,
    HUMANOID,
    ICUB,
    PANDA,
    ROMEO,
    TALOS,
    TIAGO,
    UR5,
    model,
)
from feet_trials import LINEAR
from plantar.errors import LogError, RobotError
from plantar.exporters.urdf.tree import UrdfTree
from plantar.faults.log_faults import check_log
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.save import save_log
from plantar.robot.model import RobotModel, load_robot
from plantar.robot_guess import guess_robot_file
from plantar.robot_guess.biped import find_biped
from plantar.robot_guess.feet import find_sole
from renamed_joints import renamed
from standing_robot import talos_sways

LARGE = sway(duration=12.0)


def guessed(
    folder: Path, *logs: MotionLog, urdf: str | Path = URDF, known: RobotModel | None = None
) -> tuple[RobotModel, str]:
    """The robot as `guess_robot_file` writes it from logs, and the text; from bags with the frames of `known`."""
    folder.mkdir(exist_ok=True, parents=True)
    path = urdf if isinstance(urdf, Path) else folder / "biped.urdf"
    if isinstance(urdf, str):
        path.write_text(urdf)
    files = [folder / f"{log.name}{'.csv' if known is None else '.mcap'}" for log in logs]
    for file, log in zip(files, logs, strict=True):
        save_log(log, file, known)
    text = guess_robot_file(path, files, folder / "robot.yaml")
    (folder / "robot.yaml").write_text(text)
    return load_robot(folder / "robot.yaml"), text


@pytest.mark.parametrize("urdf", [TALOS, G1, ICUB, ROMEO, HUMAN, HUMANOID], ids=lambda path: path.stem)
def test_bipeds_get_a_file_without_a_log(tmp_path: Path, urdf: Path) -> None:
    robot, text = guessed(tmp_path, urdf=urdf)
    assert list(robot.feet) == ["left", "right"]
    assert robot.imu is not None
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, pin.neutral(robot.model))
    heights = {}
    for name, foot in robot.feet.items():
        poses = {}
        for part in ("bush", "wrench", "sole"):
            placed = foot.bush if part == "bush" else getattr(foot, part).placement
            joint, pose = robot.frame(placed)
            poses[part] = data.oMi[joint] * pose
        up = poses["sole"].rotation[:, 2]
        heights[name] = float(up @ poses["sole"].translation)
        above = {
            part: float(up @ (pose.translation - poses["sole"].translation)) for part, pose in poses.items()
        }
        assert 0.015 < above["bush"] <= 0.02 + 1e-9
        assert above["bush"] <= above["wrench"] < 0.15
        length, width = np.ptp(foot.sole.polygon, axis=0)
        assert 0.05 < width < length < 0.35
    assert heights["left"] == pytest.approx(heights["right"], abs=2e-3), "both soles on one plane"
    assert {guess.key for guess in robot.guesses} >= {"imu", "feet.left.bush", "feet.right.sole"}
    assert all(f"#   {key}: " in text for key in ("wrench_gain", "between_recordings"))


@pytest.mark.parametrize(
    ("urdf", "reason"),
    [
        (UR5, "no two of its chains"),
        (PANDA, "no two of its chains"),
        (HAND, "no biped"),
        (BAXTER, "no two of its chains"),
        (TIAGO, "no two of its chains"),
        (GO2, "4 legs alike"),
        (
            CENTAURO,
            r"centauro\.urdf: is no biped: arm1_6 and arm2_6 are not the lowest, 'contact_joint_2' is "
            r"\(valid: two legs on which it stands\)$",
        ),
        (BOLT, "no flat feet"),
    ],
    ids=lambda value: value.stem if isinstance(value, Path) else "",
)
def test_what_is_no_biped_is_refused_in_one_line(tmp_path: Path, urdf: Path, reason: str) -> None:
    with pytest.raises(RobotError, match=reason) as caught:
        guess_robot_file(urdf, [], tmp_path / "robot.yaml")
    assert "\n" not in str(caught.value)
    assert str(urdf) in str(caught.value)


@pytest.mark.parametrize("height", [0.0, 0.8, 1.5])
def test_a_robot_that_is_fixed_to_the_world_stands_as_it_does_without(tmp_path: Path, height: float) -> None:
    """As many URDFs for simulators: the root link is where the floor is, not the trunk."""
    root = pin.buildModelFromXML(URDF).frames[1].name
    hung = f'<link name="world"/><joint name="to_world" type="fixed"><origin xyz="0 0 {height}"/>'
    hung += f'<parent link="world"/><child link="{root}"/></joint></robot>'
    free, fixed = (guessed(tmp_path / name, record(LARGE), urdf=urdf)[1].replace(name, "")
                   for name, urdf in (("free", URDF), ("fixed", URDF.replace("</robot>", hung))))  # fmt: skip
    assert fixed == free


def test_a_robot_without_weight_is_told_of_the_urdf_not_of_a_file_that_is_gone(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match=r"biped\.urdf: urdf: its links weigh nothing"):
        guessed(tmp_path, record(LARGE), urdf=re.sub('mass value="[^"]*"', 'mass value="0"', URDF))


def test_toes_that_nothing_drives_and_nobody_records_are_no_feet(tmp_path: Path) -> None:
    """Before there is a log they are what legs end in; one that holds all of the leg but them says otherwise."""
    plain, text = guessed(tmp_path / "plain", record(LARGE))
    toes = ""
    for foot in plain.feet.values():
        toe = foot.ankle + "_toe"
        toes += f'<link name="{toe}"/><joint name="{toe}s" type="revolute"><parent link="{foot.ankle}"/>'
        toes += f'<child link="{toe}"/><origin xyz="0.1 0 -0.05"/><axis xyz="0 1 0"/>'
        toes += '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    urdf = URDF.replace("</robot>", toes + "</robot>")
    assert {foot.ankle[-3:] for foot in guessed(tmp_path / "blind", urdf=urdf)[0].feet.values()} == {"toe"}
    found, told = guessed(tmp_path / "toes", record(LARGE), urdf=urdf)
    assert [foot.ankle for foot in found.feet.values()] == [foot.ankle for foot in plain.feet.values()]
    assert told.replace("toes", "plain") == text
    driven = record(LARGE)
    read = driven.with_columns(
        {f"joint.{foot.ankle}_toes.position": 0 * driven.time for foot in plain.feet.values()}
    )
    robot, _ = guessed(tmp_path / "driven", read, urdf=urdf)
    assert {foot.ankle[-3:] for foot in robot.feet.values()} == {"toe"}


def test_a_hand_is_not_taken_for_a_foot() -> None:
    """With all joints at 0 one hand of this model is lower than its feet along the root link's z axis."""
    biped = find_biped(UrdfTree.load(HUMAN), model(HUMAN))
    assert [leg.link for leg in biped.legs] == ["left_foot", "right_foot"]
    np.testing.assert_allclose(biped.axes[:, 2], [0, 1, 0], err_msg="this model stands along its y axis")


def test_a_sole_without_shapes_follows_from_mass_and_inertia(tmp_path: Path) -> None:
    """TALOS and G1 with their shapes taken away: within the spread that the guess names."""
    for urdf in (TALOS, G1):
        tree, robot = UrdfTree.load(urdf), model(urdf)
        biped = find_biped(tree, robot)
        drawn = find_sole(tree, robot, biped, biped.legs[0])
        for link in tree.links.values():
            for shape in [*link.findall("collision"), *link.findall("visual")]:
                link.remove(shape)
        tree.links = {"plain" if "sole" in name else name: link for name, link in tree.links.items()}
        bare = find_sole(tree, robot, biped, biped.legs[0])
        assert "mass and inertia" in bare.reason
        assert abs(bare.depth - drawn.depth) < bare.spread
        assert (
            np.abs(np.ptp(bare.corners, axis=0) - np.ptp(drawn.corners, axis=0)).max()
            < 2 * bare.outline_spread
        )


TURNS = [(np.pi, 0.0, 0.0), (0.0, np.pi / 2, 0.0), (0.0, 0.0, np.pi / 2), (0.0, np.pi, np.pi / 2)]


@pytest.mark.parametrize("turn", TURNS)
def test_a_turned_imu_shows_in_gravity_and_in_its_tilts(
    tmp_path: Path, turn: tuple[float, float, float]
) -> None:
    axes = Frame(rpy=turn).rotation
    robot, text = guessed(tmp_path, talos_sways(TALOS, imu_turn=axes), urdf=TALOS)
    assert robot.imu is not None
    assert robot.imu.placement.link == "imu_link"
    np.testing.assert_allclose(robot.imu.placement.rotation, axes, atol=1e-4)
    assert "turned by right angles, as its tilts show" in text


@pytest.mark.parametrize("turn", TURNS)
def test_a_force_sensors_axes_show_in_load_and_balance(
    tmp_path: Path, turn: tuple[float, float, float]
) -> None:
    axes = Frame(rpy=turn).rotation
    robot, _ = guessed(tmp_path, talos_sways(TALOS, wrench_turn=axes), urdf=TALOS)
    for foot in robot.feet.values():
        np.testing.assert_allclose(foot.wrench.sign * foot.wrench.placement.rotation, axes, atol=1e-4)


def test_sensors_that_agree_stay_as_they_are(tmp_path: Path) -> None:
    robot, text = guessed(tmp_path, talos_sways(TALOS), urdf=TALOS)
    assert robot.imu is not None
    np.testing.assert_allclose(robot.imu.placement.rotation, np.eye(3))
    for foot in robot.feet.values():
        assert foot.wrench.sign == 1
        np.testing.assert_allclose(foot.wrench.placement.rotation, np.eye(3))
    assert "balance gravity to 0.0 cm" in text
    assert re.search("lie on one plane within [0-3] mm", text)
    assert "DOUBT" not in text


def test_an_accelerometer_is_enough_to_see_which_way_is_up(tmp_path: Path) -> None:
    log = record(LARGE, Mounting(imu=Frame((0.0, 0.0, 0.0), (np.pi, 0.0, 0.0))))
    columns = {name: values for name, values in log.columns.items() if ".orientation." not in name}
    assert any("linear_acceleration" in name for name in columns)
    robot, _ = guessed(tmp_path, MotionLog("felt", log.time, columns))
    assert robot.imu is not None
    np.testing.assert_allclose(robot.imu.placement.rotation[2], [0, 0, -1], atol=1e-4)


def test_the_bushs_height_shows_in_torque_and_force(tmp_path: Path) -> None:
    mounting = Mounting(bush=Frame((0.0, 0.0, -0.045)), wrench=Frame())
    logs = record(LARGE, mounting), record(sway("more", seed=3), mounting)
    robot, _ = guessed(tmp_path, *logs, known=make_robot(tmp_path / "known", mounting))
    spread = {guess.key: guess.spread for guess in robot.guesses}
    for name, foot in robot.feet.items():
        assert abs(foot.bush.xyz[2] + 0.045) < (spread[f"feet.{name}.bush"] or 0) < 0.06


def test_a_log_that_contradicts_the_urdf_is_doubted(tmp_path: Path) -> None:
    for share, said in ((0.6, "# DOUBT: the feet carry 36"), (1.14, "# DOUBT: the feet carry 68"),
                        (0.95, "# Seen: the feet carry 57"), (1.0, "# Seen: the feet carry 60")):  # fmt: skip
        columns = {
            name: share * values if name.startswith("wrench.") else values
            for name, values in record(LARGE).columns.items()
        }
        _, text = guessed(tmp_path / f"{share}", MotionLog("light", record(LARGE).time, columns))
        assert said in text


def test_what_a_log_lacks_or_holds_twice_is_said(tmp_path: Path) -> None:
    """A robot that hangs, and a second IMU, which is not taken for the first."""
    log = record(LARGE)
    hung = {
        name: 0.05 * values if name.startswith("wrench.") else values for name, values in log.columns.items()
    }
    _, text = guessed(tmp_path / "hung", MotionLog("hung", log.time, hung))
    assert "# DOUBT: the feet never carry the robot's weight: nothing could be checked" in text
    twice = {name.replace("imu.chest", "imu.head"): values for name, values in log.columns.items()}
    robot, text = guessed(tmp_path / "twice", MotionLog("twice", log.time, {**log.columns, **twice}))
    assert robot.imu is not None
    assert robot.imu.name == "chest"
    assert "; the logs also hold head" in text
    assert "also hold" not in guessed(tmp_path / "once", log)[1]


def test_a_log_of_another_robot_is_an_error(tmp_path: Path) -> None:
    log = record(LARGE)
    columns = {
        name.replace("joint.", "joint.x"): values
        for name, values in log.columns.items()
        if "joint" not in name
    }
    for name in list(model(TALOS).names)[1:]:
        columns[f"joint.{name}.position"] = 0.1 * np.sin(log.time)
    with pytest.raises(LogError, match="do not hold any joint of the URDF") as caught:
        guessed(tmp_path, MotionLog("talos", log.time, columns), urdf=G1)
    assert "\n" not in str(caught.value)
    assert "talos.csv" in str(caught.value)


def test_a_prefix_of_the_joints_is_written_down(tmp_path: Path) -> None:
    log = record(LARGE)
    columns = {name.replace("joint.", "joint.b/"): values for name, values in log.columns.items()}
    robot, _ = guessed(tmp_path, MotionLog("sway", log.time, columns))
    assert robot.joint_names_in_logs.prefix == "b/"


def test_numbered_joints_are_written_down_as_a_guess_that_takes_usable_away(tmp_path: Path) -> None:
    logs = [record(sway(f"sway_{seed}", seed=seed)) for seed in (3, 4)]
    joints = list(pin.buildModelFromXML(URDF).names)[1:]
    numbers = {joint: f"motor_{place}" for place, joint in enumerate(joints)}
    robot, text = guessed(tmp_path, *(renamed(log, numbers) for log in logs))
    assert robot.joint_names_in_logs.in_log(joints[-1]) == f"motor_{len(joints) - 1}"
    assert "joint_names" in {guess.key for guess in robot.guesses}
    read = [open_log(tmp_path / f"{log.name}.csv", robot) for log in logs]
    result = identify_feet(robot, read, settings=LINEAR)
    assert "guessed_joint_names" in {note.code for note in result.notes}
    assert not [row for row in result.parameters if row.verdict == "usable" and row.axis != "z"]
    # The test's robot obeys no Newton: from its balance no axes of sensors follow.
    told = text.replace("# GUESS: the logs only number", "# they only number").replace(
        "rpy: [0, 0, 3.14159]", "rpy: [0, 0, 0]"
    )
    (tmp_path / "robot.yaml").write_text(told)
    sure = load_robot(tmp_path / "robot.yaml")
    read = [open_log(tmp_path / f"{log.name}.csv", sure) for log in logs]
    result = identify_feet(sure, read, settings=LINEAR)
    assert result.parameter("left", "pitch", "stiffness").verdict == "usable"


def test_what_the_twin_knows_is_no_log(tmp_path: Path) -> None:
    save_log(record(LARGE), tmp_path / "sway.csv")
    (tmp_path / "biped.urdf").write_text(URDF)
    (tmp_path / "sway.truth.parquet").write_bytes(b"never read")
    text = guess_robot_file(
        tmp_path / "biped.urdf",
        [tmp_path / "sway.csv", tmp_path / "sway.truth.parquet"],
        tmp_path / "robot.yaml",
    )
    assert "sway.truth.parquet is what the twin knows, no log: left out" in text
    assert yaml.safe_load(text)["imu"]["name"] == "chest"


def test_a_walking_humanoid_gets_a_file_near_the_one_made_by_hand(tmp_path: Path, shared_data: Path) -> None:
    folder = shared_data / "reemc"
    text = guess_robot_file(
        folder / "reemc.urdf", [folder / "step_12_no_fall_1.csv.gz"], tmp_path / "robot.yaml"
    )
    (tmp_path / "robot.yaml").write_text(text)
    robot, known = load_robot(tmp_path / "robot.yaml"), load_robot(folder / "robot.yaml")
    spread = {guess.key: guess.spread or 0.0 for guess in robot.guesses}
    for name, foot in robot.feet.items():
        by_hand = known.feet[name]
        assert (
            np.abs(foot.sole.placement.xyz - by_hand.sole.placement.xyz).max() < spread[f"feet.{name}.sole"]
        )
        assert np.abs(foot.bush.xyz - by_hand.bush.xyz).max() < spread[f"feet.{name}.bush"]
        for own, other in ((foot.wrench.placement, by_hand.wrench.placement), (foot.bush, by_hand.bush)):
            np.testing.assert_allclose(own.rotation, other.rotation, atol=1e-4)
    log = open_log(folder / "step_12_no_fall_1.csv.gz", robot)
    assert not [finding for finding in check_log(robot, log) if finding.fatal]

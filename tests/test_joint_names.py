"""What a log calls the URDF's joints: guessed from names, read from the robot file, refused where it fits nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot, write_robot
from example_robots import G1, TALOS, model
from plantar.cli import main
from plantar.errors import DataError, LogError
from plantar.identify.feet import identify_feet
from plantar.inspection import inspect_log
from plantar.joint_names import JointNames, propose_names
from plantar.log import MotionLog
from plantar.readers import open_log
from plantar.readers.save import save_log
from plantar.sanity import check_log

TALOS_JOINTS = list(model(TALOS).names)[1:]
G1_JOINTS = list(model(G1).names)[1:]


def renamed(log: MotionLog, new: dict[str, str] | None = None, prefix: str = "") -> MotionLog:
    """The log with its joints called otherwise."""
    columns = {}
    for column, values in log.columns.items():
        kind, _, rest = column.partition(".")
        joint, _, quantity = rest.rpartition(".")
        name = (new or {}).get(joint, prefix + joint)
        columns[f"joint.{name}.{quantity}" if kind == "joint" else column] = values
    return MotionLog(log.name, log.time, columns)


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway(duration=6.0))


def talos_words(name: str) -> str:
    """leg_left_1_joint as Leg1Left."""
    part, side, number, _ = name.split("_")
    return f"{part.title()}{number}{side.title()}"


@pytest.mark.parametrize(
    ("joints", "recorded"),
    [
        (TALOS_JOINTS, [f"talos/{name}" for name in TALOS_JOINTS]),
        (TALOS_JOINTS, [f"{name}_position" for name in TALOS_JOINTS]),
        ([f"talos::{name}" for name in TALOS_JOINTS], TALOS_JOINTS),
        (TALOS_JOINTS, [name.upper() for name in TALOS_JOINTS]),
        (TALOS_JOINTS, ["_".join(reversed(name.split("_"))) for name in TALOS_JOINTS]),
        (
            [name for name in TALOS_JOINTS if name.startswith("leg")],
            [talos_words(name) for name in TALOS_JOINTS if name.startswith("leg")],
        ),
        (["left_knee_joint", "right_knee_joint"], ["LKnee", "RKnee"]),
    ],
)
def test_a_naming_is_proposed_that_reaches_every_joint(joints: list[str], recorded: list[str]) -> None:
    names = propose_names(joints, recorded)
    assert names is not None
    assert sorted(names.in_log(joint) for joint in joints) == sorted(recorded)


def test_no_naming_is_proposed_for_another_robot() -> None:
    assert propose_names(TALOS_JOINTS, G1_JOINTS) is None
    assert propose_names(G1_JOINTS, TALOS_JOINTS) is None
    assert propose_names(TALOS_JOINTS, TALOS_JOINTS) is None, "nothing to rename"
    assert propose_names([], ["a"]) is None


def test_a_log_of_other_joints_is_an_error_that_proposes_the_prefix(tmp_path: Path, log: MotionLog) -> None:
    robot, other = make_robot(tmp_path), renamed(log, prefix="biped/")
    with pytest.raises(DataError, match=r"joint_names: \{prefix: biped/\}") as caught:
        identify_feet(robot, [other])
    assert "\n" not in str(caught.value)
    assert any(
        finding.code == "joint_names" and finding.fatal for finding in inspect_log(robot, other).findings
    )
    assert not [finding for finding in check_log(robot, log) if finding.code == "joint_names"]


def test_a_log_without_one_leg_is_an_error(tmp_path: Path, log: MotionLog) -> None:
    robot = make_robot(tmp_path)
    columns = {name: values for name, values in log.columns.items() if not name.startswith("joint.left_")}
    lame = MotionLog("lame", log.time, columns)
    texts = [found.text for found in check_log(robot, lame) if found.code == "joint_names" and found.fatal]
    assert len(texts) == 1
    assert "any joint between IMU and left foot" in texts[0]
    without_neck = {name: values for name, values in log.columns.items() if "neck" not in name}
    fine = MotionLog("fine", log.time, without_neck)
    assert not [found for found in check_log(robot, fine) if found.code == "joint_names"]


def test_the_robot_file_says_what_the_log_calls_its_joints(tmp_path: Path, log: MotionLog) -> None:
    save_log(renamed(log, {"neck": "Hals"}, prefix="biped/"), tmp_path / "sway.csv")
    names = {"prefix": "biped/", "renamed": {"neck": "Hals"}}
    robot = make_robot(tmp_path, joint_names=names)
    read = open_log(tmp_path / "sway.csv", robot)
    for joint in robot.joint_names:
        if log.has(f"joint.{joint}.position"):
            np.testing.assert_allclose(
                read.column(f"joint.{joint}.position"), log.column(f"joint.{joint}.position"), atol=1e-12
            )
    assert not [found for found in check_log(robot, read) if found.code == "joint_names"]
    save_log(log, tmp_path / "own.csv")
    assert set(open_log(tmp_path / "own.csv", robot).columns) == set(log.columns), "the URDF's names stay"


def test_a_log_that_holds_a_joint_twice_is_refused(tmp_path: Path, log: MotionLog) -> None:
    both = {**log.columns, "joint.Hals.position": log.column("joint.left_ankle_roll.position")}
    save_log(MotionLog("twice", log.time, both), tmp_path / "twice.csv")
    robot = make_robot(tmp_path, joint_names={"renamed": {"left_ankle_roll": "Hals"}})
    with pytest.raises(LogError, match="also holds"):
        open_log(tmp_path / "twice.csv", robot)


def test_inspect_prints_one_line_and_fails(
    tmp_path: Path, log: MotionLog, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_robot(tmp_path)
    save_log(renamed(log, prefix="b_"), tmp_path / "sway.csv")
    with pytest.raises(SystemExit) as left:
        main(["inspect", str(path), str(tmp_path / "sway.csv")])
    assert left.value.code == 1
    assert "joint_names: {prefix: b_}" in " ".join(capsys.readouterr().out.split())


def test_long_namings_are_cut_in_messages() -> None:
    names = JointNames(renamed={f"j{k}": f"k{k}" for k in range(5)})
    assert str(names) == "joint_names: {renamed: {j0: k0, j1: k1, j2: k2, ...}}"
    assert names.entry() == {"renamed": dict(names.renamed)}

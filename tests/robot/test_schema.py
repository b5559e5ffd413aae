"""Robot files: every way to get one wrong has one clear line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from biped_robot import URDF, Frame, Mounting, make_robot, robot_entry, write_robot
from plantar.errors import RobotError
from plantar.robot.model import load_robot

Change = Callable[[dict], None]


def refusal(folder: Path, change: Change) -> str:
    """The message with which a robot file is refused after `change`."""
    path = write_robot(folder)
    entry = yaml.safe_load(path.read_text())
    change(entry)
    path.write_text(yaml.safe_dump(entry))
    with pytest.raises(RobotError) as caught:
        load_robot(path)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_a_robot_file_becomes_a_robot(tmp_path: Path) -> None:
    robot = make_robot(tmp_path, Mounting(sign=-1, wrench=Frame((0.01, 0.0, -0.04), (0.0, 0.0, np.pi / 2))))
    assert robot.name == "biped"
    assert robot.mass == pytest.approx(60.0)
    assert list(robot.feet) == ["left", "right"]
    assert robot.imu is not None
    assert robot.imu.name == "chest"
    left = robot.feet["left"]
    assert left.wrench.sign == -1.0
    assert left.contact == "auto"
    assert left.bush.link == "left_foot", "a part without a link sits on the ankle"
    assert left.sole.placement.link == "left_sole"
    np.testing.assert_allclose(left.wrench.placement.rotation @ [1, 0, 0], [0, 1, 0], atol=1e-12)
    assert len(robot.joint_names) == 11
    assert robot.joint_names[3:6] == ("left_ankle_pitch", "left_ankle_roll", "neck")
    assert robot.floating_model.nv == robot.model.nv + 6


def test_frames_go_through_fixed_joints(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    joint, placement = robot.frame(robot.feet["left"].sole.placement)
    assert robot.model.names[joint] == "left_ankle_roll"
    np.testing.assert_allclose(placement.translation, [0, 0, -0.09])


def test_joints_between_imu_and_foot(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    assert robot.imu is not None
    between = robot.joints_between(robot.imu.placement, robot.feet["left"].bush)
    assert between == {f"left_{joint}" for joint in ("leg_x", "leg_y", "leg_z", "ankle_pitch", "ankle_roll")}
    assert robot.path_joints == between | {name.replace("left", "right") for name in between}
    assert replace(robot, imu=None).path_joints == frozenset()


def test_paths_are_relative_to_the_robot_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_robot(tmp_path / "robots")
    monkeypatch.chdir(tmp_path)
    assert load_robot(path.relative_to(tmp_path)).urdf_path == Path("robots/biped.urdf")


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda e: e.update(weight=3), ["unknown key 'weight'", "valid:"]),
        (lambda e: e.update(feets={}), ["unknown key 'feets'", "feet"]),
        (
            lambda e: e["feet"]["left"]["wrench"].update(sing=-1),
            ["unknown key 'feet.left.wrench.sing'", "sign"],
        ),
        (lambda e: e["feet"]["right"]["sole"].update(polygone=[]), ["'feet.right.sole.polygone'", "polygon"]),
        (lambda e: e["imu"].update(frame="x"), ["unknown key 'imu.frame'", "valid:"]),
        (lambda e: e.update(joints={"neck": {"term": []}}), ["unknown key 'joints.neck.term'", "terms"]),
        (lambda e: e.pop("urdf"), ["'urdf' is missing"]),
        (lambda e: e["feet"]["left"].pop("sole"), ["'feet.left.sole' is missing"]),
        (lambda e: e["imu"].pop("link"), ["'imu.link' is missing"]),
        (lambda e: e.update(base="flying"), ["base", "floating"]),
        (lambda e: e["feet"]["left"].update(contact="never"), ["feet.left.contact", "always"]),
        (lambda e: e["feet"]["left"]["wrench"].update(sign=2), ["feet.left.wrench.sign"]),
        (lambda e: e["feet"]["left"]["bush"].update(xyz=[0, 0]), ["feet.left.bush.xyz", "[x, y, z]"]),
        (lambda e: e["feet"]["left"]["bush"].update(xyz="0 0 0"), ["feet.left.bush.xyz", "[x, y, z]"]),
        (lambda e: e["feet"]["left"]["bush"].update(xyz=[0, 0, 0, 0]), ["feet.left.bush.xyz", "[x, y, z]"]),
        (lambda e: e["feet"]["left"]["bush"].update(xyz=[0, 0, -3.1]), ["feet.left.bush.xyz", "millimetres"]),
        (lambda e: e["imu"].update(rpy=[0, 0, -90]), ["imu.rpy", "-90 rad", "degrees"]),
        (lambda e: e["feet"]["left"].update(ankle="right_foot"), ["share one ankle"]),
        (lambda e: e["feet"]["left"]["bush"].update(xyz=[0, 0, "low"]), ["feet.left.bush.xyz", "low"]),
        (
            lambda e: e["feet"]["left"]["bush"].update(xyz=[0, 0, float("nan")]),
            ["feet.left.bush.xyz", "finite"],
        ),
        (lambda e: e["imu"].update(link="tors"), ["link 'tors' is not in the URDF", "torso"]),
        (lambda e: e["feet"]["left"].update(ankle="left_fot"), ["'left_fot'", "left_foot"]),
        (
            lambda e: e["feet"]["left"]["wrench"].update(name="right"),
            ["yaml: feet share one wrench sensor, 'right'"],
        ),
        (lambda e: e.update(joints={"nek": {}}), ["joints.nek", "neck"]),
        (lambda e: e.update(joints={"neck": {"terms": ["sticky"]}}), ["joints.neck.terms"]),
        (lambda e: e.update(uncertainty={"imu_mout": 0.1}), ["'uncertainty.imu_mout'", "imu_mount"]),
        (lambda e: e.update(uncertainty={"imu_mount": -0.1}), ["uncertainty.imu_mount", "-0.1"]),
        (lambda e: e.update(uncertainty={"wrench_delay": 7.5}), ["uncertainty.wrench_delay", "7.5"]),
        (lambda e: e.update(urdf="package://biped/biped.urdf"), ["'package://biped/biped.urdf'", "valid:"]),
        (lambda e: e.update(urdf="~/biped.urdf"), ["'~/biped.urdf'", "valid:"]),
        (lambda e: e.update(uncertainty={"link_mass": float("inf")}), ["uncertainty.link_mass", "finite"]),
        (lambda e: e.update(joint_names={"prefx": "a"}), ["'joint_names.prefx'", "prefix"]),
        (lambda e: e.update(joint_names={"renamed": {"nek": "a"}}), ["joint_names.renamed.nek", "neck"]),
        (
            lambda e: e.update(joint_names={"renamed": {"neck": "a", "left_leg_x": "a"}}),
            ["joint_names", "two joints", "'a'"],
        ),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, change: Change, expected: list[str]) -> None:
    message = refusal(tmp_path, change)
    assert "robot.yaml" in message
    for part in expected:
        assert part in message, message


def test_uncertainty_has_defaults_and_takes_what_is_given(tmp_path: Path) -> None:
    usual = make_robot(tmp_path, uncertainty={}).uncertainty
    assert (usual.wrench_gain, usual.bush_position, usual.between_recordings) == (0.01, 0.003, 0.0)
    given = make_robot(tmp_path, uncertainty={"bush_position": 0.02, "imu_mount": 0}).uncertainty
    assert (given.bush_position, given.imu_mount, given.wrench_gain) == (0.02, 0.0, 0.01)


def test_a_sole_in_millimetres_is_refused(tmp_path: Path) -> None:
    wide = [[110.0, 60.0], [-110.0, 60.0], [-110.0, -60.0], [110.0, -60.0]]
    told = refusal(tmp_path, lambda e: e["feet"]["left"]["sole"].update(polygon=wide))
    assert "110 m away; are these millimetres?" in told


def test_a_sole_without_area_is_refused(tmp_path: Path) -> None:
    line = [[0.1, 0.0], [0.0, 0.0], [-0.1, 0.0]]
    assert "area" in refusal(tmp_path, lambda e: e["feet"]["left"]["sole"].update(polygon=line))
    crossed = [[0.1, 0.05], [-0.1, -0.05], [-0.1, 0.05], [0.1, -0.05]]
    assert "area" in refusal(tmp_path, lambda e: e["feet"]["left"]["sole"].update(polygon=crossed))
    corners = [[0.1, 0.0], [0.0, 0.1]]
    assert "polygon" in refusal(tmp_path, lambda e: e["feet"]["left"]["sole"].update(polygon=corners))


def test_a_sensor_behind_a_joint_is_refused(tmp_path: Path) -> None:
    message = refusal(tmp_path, lambda e: e["feet"]["left"]["wrench"].update(link="torso"))
    assert "feet.left.wrench is not rigidly fixed" in message
    message = refusal(tmp_path, lambda e: e["feet"]["right"]["sole"].update(link="left_sole"))
    assert "feet.right.sole is not rigidly fixed" in message


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "holds no keys"),
        ("- a\n- b\n", "holds no keys"),
        (
            "name: [unclosed\n",
            r"robot\.yaml: is not readable YAML at line 2: expected ',' or '\]', but got '<stream "
            r"end>'$",
        ),
        ("name: \x00\n", "is not readable YAML"),
        ("!!python/object/apply:os.system ['true']\n", "is not readable YAML"),
        ("name: &n biped\nurdf: *n\n", "alias"),
        ("a: &a [x, x]\nb: &b [*a, *a]\nc: &c [*b, *b]\n", "alias"),
        ("a: " + "[" * 200 + "]" * 200 + "\n", "nested too deeply"),
        ("a: " + "[" * 100_000, "nested too deeply"),
    ],
)
def test_hostile_or_broken_yaml(tmp_path: Path, text: str, expected: str) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(text)
    with pytest.raises(RobotError, match=expected) as caught:
        load_robot(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("added", "told"),
    [
        (
            "imu: {name: other, link: torso}\n",
            r"robot\.yaml: key 'imu' stands at line 3 and again at line 95 \(valid: each key once\)$",
        ),
        (
            "joints: {neck: {passive: true, passive: false}}\n",
            r"robot\.yaml: key 'passive' stands at line 95 and again at line 95 \(valid: each key "
            r"once\)$",
        ),
        (
            "columns: [{a: 1, a: 1}]\n",
            r"robot\.yaml: key 'a' stands at line 95 and again at line 95 \(valid: each key once\)$",
        ),
    ],
)
def test_a_key_that_stands_twice_is_refused(tmp_path: Path, added: str, told: str) -> None:
    path = write_robot(tmp_path)
    path.write_text(path.read_text() + added)
    with pytest.raises(RobotError, match=told):
        load_robot(path)


def test_tabs_are_named(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("name: a\nimu:\n\tname: chest\n")
    with pytest.raises(
        RobotError,
        match=r"robot\.yaml: is not readable YAML at line 3: found character '\\t' that cannot start "
        r"any token \(valid: spaces, not tabs, at the beginning of a line\)$",
    ):
        load_robot(path)


def test_frames_up_to_their_limits_are_taken(tmp_path: Path) -> None:
    path = write_robot(tmp_path)
    entry = yaml.safe_load(path.read_text())
    entry["imu"].update(xyz=[0, 0, 2.9], rpy=[0, 0, -6.28])
    path.write_text(yaml.safe_dump({**entry, "uncertainty": {"wrench_gain": 1.0}}))
    assert load_robot(path).imu is not None


def test_a_robot_file_that_is_not_text(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_bytes(b"name: \xfa\xfb")
    with pytest.raises(
        RobotError,
        match=r"robot\.yaml: is not readable YAML: unacceptable character #x00fa: invalid start byte in "
        r'"<byte string>", position 6$',
    ):
        load_robot(path)


def test_a_huge_robot_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("# " + "x" * 2**20)
    with pytest.raises(
        RobotError, match=r"robot\.yaml: is larger than 1048576 bytes \(valid: a YAML file of some lines\)$"
    ):
        load_robot(path)


def test_missing_files(tmp_path: Path) -> None:
    with pytest.raises(
        RobotError, match=r"nowhere\.yaml.*No such file.*`plantar init ROBOT\.urdf` writes a first one"
    ):
        load_robot(tmp_path / "nowhere.yaml")
    with pytest.raises(RobotError, match=r"is no robot file.*as `plantar init biped\.urdf` writes"):
        load_robot(tmp_path / "biped.urdf")
    path = write_robot(tmp_path)
    (tmp_path / "biped.urdf").unlink()
    with pytest.raises(
        RobotError,
        match=r"robot\.yaml, value 'biped\.urdf': urdf: there is no such file \(valid: a path from this "
        r"file's folder, or a whole one\)$",
    ):
        load_robot(path)
    with pytest.raises(RobotError, match=r": cannot be read: Is a directory$"):
        load_robot(tmp_path)


@pytest.mark.parametrize(
    ("urdf", "expected"),
    [
        ('<!DOCTYPE robot [<!ENTITY a "x">]>' + URDF, "DOCTYPE"),
        ('<?xml version="1.0"?>\n<!doctype robot>' + URDF, "DOCTYPE"),
        (URDF[: len(URDF) // 2], "not a readable URDF"),
        ("not xml", "not a readable URDF"),
        ("<robot><link></robot>", "not a readable URDF"),
        ("<robot name='a' name='b'/>", "not a readable URDF"),
        ("<robot name='empty'/>", r"biped\.urdf: is not a readable URDF: it has no <link>$"),
    ],
)
def test_a_broken_or_hostile_urdf(
    tmp_path: Path, urdf: str, expected: str, capfd: pytest.CaptureFixture[str]
) -> None:
    path = write_robot(tmp_path)
    (tmp_path / "biped.urdf").write_text(urdf)
    with pytest.raises(RobotError, match=expected) as caught:
        load_robot(path)
    assert "\n" not in str(caught.value)
    assert "biped.urdf" in str(caught.value)
    assert capfd.readouterr().err == "", "the parser's own words"


def test_a_urdf_that_is_not_text(tmp_path: Path) -> None:
    path = write_robot(tmp_path)
    (tmp_path / "biped.urdf").write_bytes(b"\xff\xfe" + URDF.encode("utf-16-le"))
    with pytest.raises(RobotError, match=r"biped\.urdf: is not UTF-8 text \(valid: a URDF\)$"):
        load_robot(path)


def test_a_robot_bolted_down_needs_neither_imu_nor_feet(tmp_path: Path) -> None:
    path = write_robot(tmp_path)
    entry = robot_entry()
    del entry["imu"], entry["feet"]
    path.write_text(yaml.safe_dump({**entry, "base": "fixed", "joints": {"neck": {"passive": True}}}))
    robot = load_robot(path)
    assert robot.base == "fixed"
    assert robot.imu is None
    assert robot.feet == {}
    assert robot.joints["neck"].terms == ("stiffness", "viscous", "offset")


def test_real_robot_files_load(shared_data: Path) -> None:
    for name, mass in (("icub_mats", None), ("icub_walking", 33.08), ("kuka_lwr4", None)):
        robot = load_robot(shared_data / name / "robot.yaml")
        if mass:
            assert robot.mass == pytest.approx(mass, abs=0.01)

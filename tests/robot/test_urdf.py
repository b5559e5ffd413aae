"""URDFs of which Pinocchio would leave out a part without a word, and those that it reads as they are."""

from __future__ import annotations

from pathlib import Path

import pytest

from biped_robot import write_robot
from plantar.errors import RobotError
from plantar.robot.model import load_robot
from plantar.robot.urdf import following_joints, parse_urdf, read_urdf

PLAIN = """<robot name="r">
  <link name="trunk"><inertial><origin xyz="0 0 .1"/><mass value="1e1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <!-- made from <xacro:robot> with ${mass} -->
  <link name="foot"/>
  <joint name="ankle" type="revolute"><parent link="trunk"/><child link="foot"/>
    <origin xyz=" 0 0  -1" rpy="0 0 0"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="9"/></joint>
</robot>"""
FILE = Path("robot.urdf")


def refusal(old: str, new: str) -> str:
    assert old in PLAIN
    with pytest.raises(RobotError) as caught:
        parse_urdf(PLAIN.replace(old, new), FILE, floating=False)
    return str(caught.value)


def test_a_plain_one_is_read() -> None:
    model = parse_urdf(PLAIN, FILE, floating=False)
    assert model.names[1] == "ankle"
    assert parse_urdf(PLAIN, FILE, floating=True).inertias[1].mass == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"1e1"', '"7,26"', "robot.urdf, value '7,26': value of <mass> in link 'trunk' (valid: a number)"),
        ('"1e1"', '"nan"', "value 'nan': value of <mass>"),
        ('"1e1"', '"-2"', "value '-2': the mass of link 'trunk' is negative"),
        ('xyz="0 1 0"', 'xyz="0 0 0"', "value '0 0 0': axis of revolute joint 'ankle' has no direction"),
        ('iyy="1"', 'iyy="1 2"', "value '1 2': iyy of <inertia> in link 'trunk'"),
        ('"0 0 .1"', '"0 0"', "value '0 0': xyz of <origin> in link 'trunk' (valid: 3 numbers"),
        ('rpy="0 0 0"', 'rpy="0 0 0,5"', "rpy of <origin> in joint 'ankle'"),
        ('"0 1 0"', '"y"', "xyz of <axis> in joint 'ankle'"),
        ('"1e1"', '"${mass}"', "is xacro that was not expanded (valid: the URDF that `xacro robot.urdf"),
        ('<link name="foot"/>', '<xacro:foot xmlns:xacro="http://www.ros.org/wiki/xacro"/>', "is xacro"),
        ("robot", "sdf", "its root is <sdf>"),
        ('xyz=" 0 0  -1"', 'xyz="0 0 -450"', "joint 'ankle' is 20 m away or more; are these millimetres?"),
        ('xyz="0 0 .1"', 'xyz="0 0 100"', "value '0 0 100': link 'trunk' is 20 m away or more"),
        ('type="revolute"', 'type="ball"', "robot.urdf: is not a readable URDF: The XML stream does not contain"),
        ("</robot>", "", "is not a readable URDF: no element found: line 8, column 0"),
        ('<link name="foot"/>', '<link name="foot"/><link name="foot"/>', "link 'foot' is there twice"),
        ("</robot>", '<joint name="ankle" type="fixed"/></robot>', "joint 'ankle' is there twice"),
        ('<child link="foot"/>', '<child link="toe"/>', "joint 'ankle' has the child 'toe' (valid: the name of a link"),
        ('<parent link="trunk"/>', "", "joint 'ankle' has the parent 'None'"),
        ('<limit lower="-1" upper="1" effort="9" velocity="9"/>', "", "revolute joint 'ankle' has no limits"),
        ("</robot>", '<link name="hat"/></robot>', "'trunk' and 'hat' hang on no joint (valid: one root link)"),
        ("</robot>", '<joint name="loop" type="fixed"><parent link="trunk"/><child link="foot"/></joint></robot>',
         "link 'foot' hangs on two joints, 'ankle' and 'loop'"),
    ],
)  # fmt: skip
def test_what_would_be_left_out_is_named(old: str, new: str, told: str) -> None:
    assert told in refusal(old, new)


WORLD = """<link name="world"/>
  <joint name="free" type="floating"><parent link="world"/><child link="trunk"/></joint>
</robot>"""
ODOMETRY = """<link name="map"/>
  <joint name="odometry" type="fixed"><parent link="map"/><child link="world"/></joint>
</robot>"""


def as_read(urdf: str, folder: Path) -> str:
    file = folder / "robot.urdf"
    file.write_text(urdf)
    return read_urdf(file)


def test_a_world_over_which_the_trunk_floats_is_left_out(tmp_path: Path) -> None:
    found = parse_urdf(as_read(PLAIN.replace("</robot>", WORLD), tmp_path), FILE, floating=True)
    assert found == parse_urdf(PLAIN, FILE, floating=True)


@pytest.mark.parametrize(
    "world",
    [
        WORLD.replace('"world"/>', '"world"><inertial><mass value="1"/></inertial></link>', 1),
        WORLD.replace("</robot>", ODOMETRY),
    ],
)
def test_a_floating_joint_on_something_else_stays(world: str, tmp_path: Path) -> None:
    urdf = PLAIN.replace("</robot>", world)
    assert as_read(urdf, tmp_path) == urdf


def test_a_fixed_joint_may_have_an_axis_without_direction() -> None:
    """As SolidWorks writes them."""
    fixed = PLAIN.replace('type="revolute"', 'type="fixed"').replace('xyz="0 1 0"', 'xyz="0 0 0"')
    assert parse_urdf(fixed, FILE, floating=False).njoints == 1


def test_a_joint_that_no_tree_holds_is_told_with_its_file(tmp_path: Path) -> None:
    path = write_robot(tmp_path)
    urdf = load_robot(path).urdf_path
    urdf.write_text(urdf.read_text().replace('name="neck" type="revolute"', 'name="neck" type="planar"'))
    with pytest.raises(RobotError, match=rf"{urdf.name}: joint 'neck' is of type Planar") as caught:
        _ = load_robot(path).tree
    assert str(caught.value).count("neck") == 1


def test_a_robot_without_weight_is_refused(tmp_path: Path) -> None:
    path = write_robot(tmp_path)
    urdf = tmp_path / "biped.urdf"
    urdf.write_text(urdf.read_text().replace("<inertial>", "<!--").replace("</inertial>", "-->"))
    with pytest.raises(
        RobotError,
        match=r"robot\.yaml: urdf: its links weigh nothing \(valid: links with an <inertial>: contact "
        r"and delays follow from the robot's weight\)$",
    ):
        load_robot(path)


def test_joints_that_follow_others_follow_one_that_follows_none() -> None:
    text = """<robot name="r"><joint name="a"/>
      <joint name="b"><mimic joint="a" multiplier="-2" offset="0.1"/></joint>
      <joint name="c"><mimic joint="b" multiplier="3" offset="0.5"/></joint>
      <joint name="d"><mimic joint="e"/></joint><joint name="e"><mimic joint="d"/></joint></robot>"""
    assert following_joints(text) == {"b": ("a", -2.0, 0.1), "c": ("a", -6.0, pytest.approx(0.8))}
    assert not following_joints(PLAIN)


def test_a_factor_that_is_no_number_is_named() -> None:
    told = refusal("<limit", '<mimic joint="x" multiplier="-1,5"/><limit')
    assert "value '-1,5': multiplier of <mimic> in joint 'ankle' (valid: a number)" in told


@pytest.mark.parametrize(("said", "told"), [("", "unreadable"), ("no such axis\nat line 3", "no such axis")])
def test_of_what_pinocchio_refuses_its_first_words_are_told(
    said: str, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise RuntimeError(said)

    monkeypatch.setattr("plantar.robot.urdf.pin.buildModelFromXML", refuse)
    with pytest.raises(RobotError) as caught:
        parse_urdf(PLAIN, FILE, floating=False)
    assert str(caught.value) == f"robot.urdf: is not a readable URDF: {told}"

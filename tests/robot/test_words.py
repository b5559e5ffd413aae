"""What is said of a robot file, its marks, its URDF and its weight: whole lines, and small parts of the model."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import example_robots
from biped_robot import make_robot
from plantar.errors import RobotError
from plantar.notes import Note
from plantar.robot.guesses import Guess, guess_notes, naming_notes
from plantar.robot.identified_urdf import _about_centre, write_inertias
from plantar.robot.kinematics import KinematicTree
from plantar.robot.model import RobotModel, check_feet
from plantar.robot.schema import _log_names_differ, _near, _polygon_with_area, _within_a_turn
from plantar.robot.urdf import from_trunk, unknown_link
from plantar.robot.weighed import check_weight, weight_notes

FILE = Path("robot.yaml")


@pytest.mark.parametrize(
    ("guesses", "said"),
    [
        ([Guess("feet.left.bush", "", 0.02), Guess("feet.left.wrench", "", 0.02), Guess("imu", "", 0.03)],
         "the left foot's numbers depend on bush (± 20 mm) and wrench; all numbers depend on imu. The intervals allow "
         "for that; measure it for narrower ones, then delete the mark"),
        ([Guess("feet.right.sole.polygon", ""), Guess("feet", ""), Guess("feet.left.bush", "")],
         "the right foot's numbers depend on sole.polygon; the left foot's numbers depend on bush; all numbers depend "
         "on feet. Measure the soles first, for which the intervals do not allow, then delete the mark"),
        ([Guess("feet.right", "")],
         "all numbers depend on feet.right. The intervals allow for that; measure it for narrower ones, then delete "
         "the mark"),
    ],
)  # fmt: skip
def test_guesses_in_words(guesses: list[Guess], said: str) -> None:
    text = f"robot.yaml: marked GUESS and not measured: {said}"
    assert guess_notes("robot.yaml", guesses) == [Note("guessed_geometry", "warning", text)]


@pytest.mark.parametrize("key", ["joint_names", "joint_names.renamed"])
def test_guessed_names_in_words(key: str) -> None:
    text = "robot.yaml: joint_names is marked GUESS: which joint of the logs is which must be looked up, not guessed"
    assert naming_notes("robot.yaml", [Guess("imu", ""), Guess(key, "")]) == [
        Note("guessed_joint_names", "warning", text)
    ]
    assert naming_notes("robot.yaml", [Guess("joint_names_of", "")]) == []


def test_weights_in_words() -> None:
    """Half or twice the URDF's is the farthest; the balance may be off by 1.96 deviations."""
    text = (
        "robot.yaml: the robot was weighed as 66.12 kg, its URDF weighs 60 kg: masses and moments of inertia are taken "
        "as 1.1 times the URDF's"
    )
    assert weight_notes("robot.yaml", 66.12, 60.0, 0.04) == [Note("weighed", "info", text)]
    assert weight_notes("robot.yaml", 66.12, 60.0, 0.05) == weight_notes("robot.yaml", None, 60.0, 0.0) == []
    for mass in (30.0, 120.0, None):
        check_weight(FILE, mass, 60.0)
    valid = r"\(valid: what a balance says of this robot, in kg\)"
    message = rf"^robot\.yaml, value 29\.9: mass: the URDF weighs 60 kg {valid}$"
    with pytest.raises(RobotError, match=message):
        check_weight(FILE, 29.9, 60.0)


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        (pin.JointModelSpherical(), "Spherical: write it as three revolute joints"),
        (pin.JointModelSphericalZYX(), "SphericalZYX: write it as three revolute joints"),
        (pin.JointModelPlanar(), "Planar: write it as two prismatic joints and a revolute one"),
        (pin.JointModelTranslation(), "Translation: write it as three prismatic joints"),
        (pin.JointModelFreeFlyer(), "FreeFlyer: a free-flyer can only stand above the root link"),
    ],
)
def test_joints_of_several_coordinates_in_words(joint: Any, said: str) -> None:
    model = pin.Model()
    first = model.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), "hip")
    model.addJoint(first, joint, pin.SE3.Identity(), "shoulder")
    with pytest.raises(RobotError) as caught:
        KinematicTree.from_model(model)
    assert str(caught.value) == f"joint 'shoulder' is of type {said}"


def test_a_second_tree_beside_the_free_flyer_is_refused() -> None:
    model = pin.Model()
    model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")
    model.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), "hip")
    message = r"^a second tree stands beside the free-flyer \(valid: one root link\)$"
    with pytest.raises(RobotError, match=message):
        KinematicTree.from_model(model)


def test_a_robot_says_what_it_has(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    assert repr(robot) == "<RobotModel biped: floating base, feet left, right, IMU chest>"
    bare = replace(robot, imu=None, feet={}, base="fixed")
    assert repr(bare) == "<RobotModel biped: fixed base, feet none, no IMU>"
    with pytest.raises(
        RobotError, match=r"robot\.yaml: names no imu \(valid: imu: \{name: \.\.\., link: \.\.\.\}\)$"
    ):
        _ = bare.required_imu
    assert robot.required_imu is robot.imu


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_feet_are_those_of_a_biped(robot: RobotModel, count: int) -> None:
    feet = {f"foot {place}": robot.feet["left"] for place in range(count)}
    said = {
        0: "names no feet (valid: feet: {left: ..., right: ...})",
        3: "names 3 feet (valid: two: the feet of a biped)",
    }
    if count not in said:
        check_feet(replace(robot, feet=feet))
        return
    with pytest.raises(RobotError) as caught:
        check_feet(replace(robot, feet=feet, path=FILE))
    assert str(caught.value) == f"robot.yaml: {said[count]}"


def test_a_continuous_joint_is_its_cosine_and_sine() -> None:
    model = example_robots.model(example_robots.TIAGO)
    robot: Any = object.__new__(RobotModel)
    robot.__dict__.update(model=model, joint_names=tuple(model.names)[1:])
    angles = np.linspace(-2.0, 2.5, model.njoints - 1)
    q = robot.configuration(angles)
    assert q.shape == (model.nq,)
    circular = 0
    for name, angle in zip(robot.joint_names, angles, strict=True):
        joint = model.joints[model.getJointId(name)]
        expected = [angle] if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
        assert q[joint.idx_q : joint.idx_q + joint.nq].tolist() == pytest.approx(expected)
        circular += joint.nq == 2
    assert circular > 0


def test_an_unknown_link_is_told_with_those_that_it_may_be(robot: RobotModel) -> None:
    near = str(unknown_link("left_fot", robot.model, FILE))
    assert (
        near
        == "robot.yaml: link 'left_fot' is not in the URDF (valid: one of left_foot, left_sole, left_thigh)"
    )
    names = ", ".join(frame.name for frame in robot.model.frames[1:4])
    assert str(unknown_link("xyz", robot.model, FILE)) == (
        f"robot.yaml: link 'xyz' is not in the URDF (valid: a frame of the URDF, such as {names})"
    )


BOLTED = """<robot name="r"><link name="{world}"/><link name="trunk"><inertial/></link>
<joint name="base" type="{kind}"><parent link="{world}"/><child link="trunk"/></joint></robot>"""


@pytest.mark.parametrize(
    ("world", "kind", "joint", "cut"),
    [
        ("world", "floating", "floating", True), ("map", "floating", "floating", True),
        ("world", "fixed", "fixed", True), ("map", "fixed", "fixed", False), ("world", "fixed", "floating", False),
    ],
)  # fmt: skip
def test_a_bare_link_for_the_world_goes_with_its_joint(world: str, kind: str, joint: str, cut: bool) -> None:
    """On a fixed joint only one that is called so: another is a frame of the trunk's own."""
    urdf = BOLTED.format(world=world, kind=kind)
    found = ET.fromstring(from_trunk(urdf, joint))
    assert [link.get("name") for link in found.iterfind("link")] == ([world] * (not cut)) + ["trunk"]
    assert (found.find("joint") is None) == cut


def test_numbers_of_other_units_are_told() -> None:
    for check, right, wrong, said in (
        (_near, (0.0, -2.9, 1.0), (0.0, -3.01, 1.0), "-3.01 m away from the link's frame; are these millimetres?"),
        (_within_a_turn, (0.0, -6.28, 1.0), (1.0, 2.0, -90.0), "-90 rad is more than a turn; are these degrees?"),
        (_polygon_with_area, [(0.1, 0.05), (-0.1, 0.05), (0.0, -0.05)], [(0.1, 0.05), (-1.25, 0.05), (0.0, -0.05)],
         "a corner lies 1.25 m away; are these millimetres?"),
        (_polygon_with_area, [(0.1, 0.05), (0.0, -0.05), (-0.1, 0.05)], [(0.1, 0.0), (0.0, 0.0), (-0.1, 0.0)],
         "the polygon's area is 0 m²; corners go round the sole in order"),
    ):  # fmt: skip
        assert check(right) == right  # type: ignore[operator]
        with pytest.raises(ValueError) as caught:  # noqa: PT011
            check(wrong)  # type: ignore[operator]
        assert str(caught.value) == said
    names = {"renamed": {"a": "x", "b": "y", "c": "y"}}
    with pytest.raises(ValueError, match=r"^renamed gives two joints the log's name 'y'$"):
        _log_names_differ(names)


LUMPED = """<robot name="r">
<link name="base"><inertial><mass value="1"/></inertial></link>
<link name="heavy"><inertial><mass value="5"/></inertial></link>
<link name="light"><inertial><mass value="2"/></inertial></link>
<joint name="one" type="fixed"><parent link="base"/><child link="heavy"/><origin xyz="0.1 0 0"/></joint>
<joint name="two" type="fixed"><parent link="base"/><child link="light"/><origin xyz="0 0.2 0"/></joint></robot>"""


def test_the_heaviest_of_links_that_are_one_carries_it_and_the_others_are_named() -> None:
    root = ET.fromstring(LUMPED)
    model = pin.buildModelFromXML(LUMPED)
    body = np.array([4.0, 4 * 0.5, 0.0, 0.0, 0.1, 0.0, 1.2, 0.0, 0.0, 1.3])
    notes = write_inertias(root, model, {"base": body})
    text = "links whose inertia is now in a heavier link that they are fixed to: base, light"
    assert notes == (Note("export_lumped", "info", text),)
    assert [link.get("name") for link in root.iterfind("link") if link.find("inertial") is not None] == [
        "heavy"
    ]
    placed = root.find("link[@name='heavy']/inertial/origin")
    assert placed is not None
    assert [float(word) for word in str(placed.get("xyz")).split()] == pytest.approx([0.4, 0.0, 0.0])


@pytest.mark.parametrize(
    ("moments", "possible"),
    [((1.0, 1.0, 1.9), True), ((1.0, 1.0, 2.1), False), ((-0.1, 1.0, 1.0), False), ((1.0, 1.0, 2.0), True)],
)
def test_inertias_that_no_body_can_have_are_told(moments: tuple[float, float, float], possible: bool) -> None:
    root, model = ET.fromstring(LUMPED), pin.buildModelFromXML(LUMPED)
    body = np.array([4.0, 0, 0, 0, moments[0], 0, moments[1], 0, 0, moments[2]])
    notes = write_inertias(root, model, {"heavy": body})
    text = "'heavy': no body can have the identified inertia; simulators may refuse it"
    assert (Note("export_inertia", "warning", text) in notes) != possible


def test_an_inertia_moves_to_its_centre_and_into_the_carriers_axes() -> None:
    """2 kg at (0.5, 0, 0), beside moments about the centre of 1, 2 and 3: by Steiner 0.5 more about y and z."""
    body = np.array([2.0, 1.0, 0, 0, 1.0, 0, 2.5, 0, 0, 3.5])
    turn = pin.SE3(pin.exp3(np.array([0.0, 0.0, np.pi / 2])), np.array([0.0, 0.0, 7.0]))
    mass, centre, inertia = _about_centre(body, turn)
    assert mass == 2.0
    np.testing.assert_allclose(centre, [0.0, 0.5, 7.0], atol=1e-12)
    np.testing.assert_allclose(inertia, np.diag([2.0, 1.0, 3.0]), atol=1e-12)
    np.testing.assert_array_equal(_about_centre(np.zeros(10), pin.SE3.Identity())[1], np.zeros(3))

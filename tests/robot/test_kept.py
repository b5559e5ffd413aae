"""What is made of robot files and URDFs in which one thing is wrong, as it is kept: each refusal, or what it reads."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import fields
from pathlib import Path
from typing import Any

import yaml

from biped_robot import URDF, robot_entry
from damaged import damaged, damaged_xml, told
from kept_texts import assert_as_kept, described
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.urdf import following_joints, parse_urdf

KEPT = Path(__file__).parent / "kept"
MORE = {
    "mass": 60.5, "contact": None,
    "joints": {"neck": {"terms": ["viscous", "inertia"]}, "left_ankle_roll": {"passive": True}},
    "joint_names": {"prefix": "a/", "suffix": "_s", "renamed": {"neck": "head"}},
    "topics": {"imu": "/imu"}, "columns": {"time": "t"}, "uncertainty": {"wrench_gain": 0.02, "link_mass": 0.1},
}  # fmt: skip


def entry() -> dict[str, Any]:
    """With every key that there is."""
    made: dict[str, Any] = robot_entry() | {key: value for key, value in MORE.items() if value is not None}
    made["feet"]["left"] |= {"contact": "always"}
    return made


def lines_of(robot: RobotModel) -> list[str]:
    """All that is read, in lines."""
    skipped = ("path", "urdf_path", "urdf", "uncertainty")
    values = {each.name: getattr(robot, each.name) for each in fields(robot) if each.name not in skipped}
    more = {"uncertainty": vars(robot.uncertainty), "notes": robot.weight_notes, "mass": robot.urdf_mass}
    return described(values | more).splitlines()


def test_a_robot_file_with_one_thing_wrong_is_as_it_is_kept(tmp_path: Path) -> None:
    """Of what is read all the same, what differs from the whole one."""
    (tmp_path / "biped.urdf").write_text(URDF)
    file = tmp_path / "robot.yaml"

    def read(content: object) -> list[str]:
        file.write_text(yaml.dump(content, Dumper=yaml.CSafeDumper))
        return lines_of(load_robot(file))

    def changed(content: object) -> str:
        return ", ".join(line for line in read(content) if line not in whole)

    whole = read(entry())
    cases = [case for case in damaged(entry()) if "right" not in case[0]]
    lines = [f"{where}: {told(changed, content)}" for where, content in cases]
    text = "".join(f"{line}\n" for line in (*whole, *lines)).replace(str(tmp_path), "FOLDER")
    text = re.sub(r"Input should be .*|Field required", "", text)  # as the library of schemas words it
    assert_as_kept(text, KEPT / "robot_files.txt", share=1e-6)


SMALL = """<robot name="r"><link name="trunk"><inertial><origin xyz="0 0 .1" rpy="0 0 0.1"/><mass value="10"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><link name="foot"/><link name="toe"/>
<joint name="ankle" type="revolute"><parent link="trunk"/><child link="foot"/><origin xyz="0 0 -1" rpy="0 0 0"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="8"/><dynamics damping="1" friction="2"/></joint>
<joint name="knuckle" type="continuous"><parent link="foot"/><child link="toe"/><axis xyz="0 1 0"/>
<mimic joint="ankle" multiplier="2" offset="0.1"/></joint></robot>"""


def test_a_urdf_with_one_thing_wrong_is_as_it_is_kept() -> None:
    def read(text: str) -> str:
        model = parse_urdf(text, Path("r.urdf"), floating=True)
        masses = [round(each.mass, 4) for each in model.inertias]
        return f"{list(model.names)}, {masses}, {following_joints(text)}, {model.effortLimit.tolist()[6:]}"

    assert len(ET.fromstring(SMALL)) == 5
    lines = [f"{where}: {told(read, text)}" for where, text in [("whole", SMALL), *damaged_xml(SMALL)]]
    assert_as_kept("\n".join(lines) + "\n", KEPT / "urdfs.txt")

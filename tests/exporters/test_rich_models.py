"""A robot with joints, shapes and links of every kind, in each format that is made from its URDF: as they are kept."""

from __future__ import annotations

from pathlib import Path

import pytest

from export_robots import result, write_urdf
from kept_texts import assert_as_kept
from plantar.errors import ExportError
from plantar.exporters import export

KEPT = Path(__file__).parent / "kept"
OBJ = "v 0.1 0 0\nv 0 0.2 0\nv 0 0 -0.3\nv 0 0 0\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
INERTIAL = (
    '<inertial><origin xyz="0.01 0.02 0.03" rpy="0.1 0.2 0.3"/><mass value="{mass}"/>'
    '<inertia ixx="0.02" ixy="0.001" ixz="0.002" iyy="0.03" iyz="-0.003" izz="0.04"/></inertial>'
)
MORE = f"""
  <link name="arm">{INERTIAL.format(mass=1.5)}
    <visual><geometry><mesh filename="arm.dae"/></geometry></visual>
    <collision name="long"><origin xyz="0 0 -0.1" rpy="0 1.5 0"/>
      <geometry><cylinder radius="0.03" length="0.2"/></geometry></collision>
    <collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="slide">{INERTIAL.format(mass=0.4)}
    <collision><geometry><mesh filename="part.obj" scale="2 1 0.5"/></geometry></collision>
    <collision><geometry><mesh filename="gone.stl"/></geometry></collision></link>
  <link name="wheel">{INERTIAL.format(mass=0.3)}</link>
  <link name="camera"/>
  <link name="thumb">{INERTIAL.format(mass=0.05)}<visual/></link>
  <joint name="shoulder" type="revolute"><parent link="pelvis"/><child link="arm"/>
    <origin xyz="0.01 0.2 0.3" rpy="0.4 -0.1 0.2"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-1.5" upper="2.5" effort="40" velocity="6"/><dynamics damping="0.5" friction="0.2"/></joint>
  <joint name="lift" type="prismatic"><parent link="arm"/><child link="slide"/><origin xyz="0 0 -0.3"/>
    <limit lower="0" upper="0.1" effort="90" velocity="0.5"/><dynamics damping="3"/></joint>
  <joint name="spin" type="continuous"><parent link="slide"/><child link="wheel"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="7" velocity="20"/></joint>
  <joint name="mount" type="fixed"><parent link="wheel"/><child link="camera"/>
    <origin xyz="0 0 0.05" rpy="0 0.7 0"/></joint>
  <joint name="bend" type="revolute"><parent link="arm"/><child link="thumb"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="2" velocity="3"/><mimic joint="shoulder" multiplier="0.5" offset="0.1"/></joint>
"""


def write_rich(folder: Path, more: str = MORE) -> Path:
    path = write_urdf(folder / "rich.urdf")
    text = path.read_text()
    root = next(
        name for name in ("pelvis", "base", "torso", "trunk", "body") if f'<link name="{name}"' in text
    )
    path.write_text(text.replace("</robot>", f"{more.replace('pelvis', root)}</robot>"))
    (folder / "part.obj").write_text(OBJ)
    (folder / "arm.dae").write_text("")
    return path


@pytest.mark.parametrize("target", ["sdf", "urdf", "drake"])
def test_a_rich_robot_is_as_it_is_kept(target: str, tmp_path: Path) -> None:
    urdf = write_rich(tmp_path)
    out = tmp_path / "out.xml"
    notes = export(result(urdf), target, out)
    said = "".join(f"{note.severity} {note.code}: {note.text}\n" for note in notes)
    text = f"{out.read_text()}\n{said}".replace(str(tmp_path), "FOLDER")
    assert_as_kept(text, KEPT / f"rich_{target}.txt", share=1e-5)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('<link name="a"/><joint name="glide" type="planar"><parent link="pelvis"/><child link="a"/></joint>',
         "rich.urdf, value 'planar': joint 'glide' is of a type that is not carried over (valid: "
         "continuous, fixed, prismatic, revolute)"),
    ],
)  # fmt: skip
def test_a_joint_that_sdformat_has_not_is_refused(more: str, said: str, tmp_path: Path) -> None:
    urdf = write_rich(tmp_path, more)
    with pytest.raises(ExportError) as refused:
        export(result(urdf), "sdf", tmp_path / "out.sdf")
    assert str(refused.value).replace(f"{tmp_path}/", "") == said

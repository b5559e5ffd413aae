"""The bush in models of robots, each element whole: what a simulator reads of it, and nothing else."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

from export_robots import write_mjcf
from plantar.exporters import export

URDF_LIGHT = """<inertial><mass value="0.05" />
<inertia ixx="0.0001" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0001" /></inertial>"""
SDF_LIGHT = """<inertial><mass>0.05</mass><inertia><ixx>0.0001</ixx><ixy>0</ixy><ixz>0</ixz>
<iyy>0.0001</iyy><iyz>0</iyz><izz>0.0001</izz></inertia></inertial>"""
DRAKE = "http://drake.mit.edu"
ANKLE, FIRST, MIDDLE, SOLE = "left_ankle", "left_bush_z_link", "left_bush_pitch_link", "left_bush_sole"
TURN, CENTRE = "0 0 0.3", "0.01 0 -0.08"
CHAIN = [
    ("Z", "prismatic", (CENTRE, TURN), ANKLE, FIRST, "0 0 1", 0.05, 400, 40000),
    ("PITCH", "revolute", ("0 0 0", "0 0 0"), FIRST, MIDDLE, "0 1 0", 0.6, 24.27, 480),
    ("ROLL", "revolute", ("0 0 0", "0 0 0"), MIDDLE, SOLE, "1 0 0", 0.6, 28.15, 352),
]


def written(feet: dict[str, Any], target: str, folder: Path) -> ET.Element:
    export(feet, target, folder / "out.xml")
    return ET.parse(folder / "out.xml").getroot()


def same(found: ET.Element | None, wanted: str) -> None:
    """As XML, whatever the blanks between its elements."""
    assert found is not None
    other = ET.fromstring(f'<all xmlns:drake="{DRAKE}">{wanted}</all>')[0]
    one, two = (ET.canonicalize(ET.tostring(each), strip_text=True) for each in (found, other))
    assert one == two


@pytest.mark.parametrize(
    ("axis", "kind", "at", "parent", "child", "way", "reach", "damping", "stiffness"), CHAIN
)
def test_a_urdf_has_a_chain_of_joints_and_light_links(
    axis: str, kind: str, at: tuple[str, str], parent: str, child: str, way: str, reach: float,
    damping: float, stiffness: float, feet: dict[str, Any], tmp_path: Path,
) -> None:  # fmt: skip
    root, name = written(feet, "urdf", tmp_path), f"LLEG_BUSH_{axis}"
    same(
        root.find(f"joint[@name='{name}']"),
        f"""<joint name="{name}" type="{kind}"><origin xyz="{at[0]}" rpy="{at[1]}" />
        <parent link="{parent}" /><child link="{child}" /><axis xyz="{way}" />
        <limit lower="-{reach}" upper="{reach}" effort="100000" velocity="1000" />
        <dynamics damping="{damping}" friction="0" /></joint>""",
    )
    same(root.find(f"link[@name='{child}']/inertial"), URDF_LIGHT)
    same(
        root.find(f"gazebo[@reference='{name}']"),
        f"""<gazebo reference="{name}"><springStiffness>{stiffness}</springStiffness>
        <springReference>0</springReference><implicitSpringDamper>true</implicitSpringDamper></gazebo>""",
    )


@pytest.mark.parametrize("target", ["sdf", "drake"])
@pytest.mark.parametrize(
    ("axis", "kind", "at", "parent", "child", "way", "reach", "damping", "stiffness"), CHAIN
)
def test_an_sdformat_model_has_the_same_chain(
    axis: str, kind: str, at: tuple[str, str], parent: str, child: str, way: str, reach: float,
    damping: float, stiffness: float, target: str, feet: dict[str, Any], tmp_path: Path,
) -> None:  # fmt: skip
    """In Drake's its joints have no motors and no springs of their own."""
    model = written(feet, target, tmp_path).find("model")
    assert model is not None
    name = f"LLEG_BUSH_{axis}"
    spring = f"""<dynamics><damping>{damping}</damping><spring_reference>0</spring_reference>
    <spring_stiffness>{stiffness}</spring_stiffness></dynamics>"""
    same(
        model.find(f"joint[@name='{name}']"),
        f"""<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child><axis>
        <xyz>{way}</xyz><limit><lower>-{reach}</lower><upper>{reach}</upper>
        {"<effort>0</effort>" if target == "drake" else ""}</limit>
        {spring if target == "sdf" else ""}</axis></joint>""",
    )
    same(model.find(f"link[@name='{child}']/inertial"), SDF_LIGHT)
    same(model.find(f"link[@name='{child}']/pose"), f'<pose relative_to="{parent}">{at[0]} {at[1]}</pose>')


def test_a_bushing_of_drake_lies_between_ankle_and_sole(feet: dict[str, Any], tmp_path: Path) -> None:
    model = written(feet, "drake", tmp_path).find("model")
    assert model is not None
    same(
        model.find("frame[@name='left_bushing_A']"),
        f"""<frame name="left_bushing_A" attached_to="{ANKLE}">
        <pose relative_to="{ANKLE}">{CENTRE} {TURN}</pose></frame>""",
    )
    same(
        model.find(f"{{{DRAKE}}}linear_bushing_rpy"),
        f"""<drake:linear_bushing_rpy><drake:bushing_frameA>left_bushing_A</drake:bushing_frameA>
        <drake:bushing_frameC>{SOLE}</drake:bushing_frameC>
        <drake:bushing_torque_stiffness>352 480 0</drake:bushing_torque_stiffness>
        <drake:bushing_torque_damping>28.15 24.27 0</drake:bushing_torque_damping>
        <drake:bushing_force_stiffness>0 0 40000</drake:bushing_force_stiffness>
        <drake:bushing_force_damping>0 0 400</drake:bushing_force_damping></drake:linear_bushing_rpy>""",
    )


def test_a_sole_of_mujoco_hangs_on_three_springs(feet: dict[str, Any], tmp_path: Path) -> None:
    root = written(feet, "mjcf", tmp_path)
    sole = root.find(f".//body[@name='{SOLE}']")
    assert sole is not None
    usual = f'pos="{CENTRE}" ref="0" limited="false" frictionloss="0" springdamper="0 0" springref="0"'
    sine, cosine = "0.295520206661", "0.955336489126"
    for axis, kind, way, armature, stiffness, damping in (
        ("Z", "slide", "0 0 1", 0.4, 40000, 400),
        ("PITCH", "hinge", f"-{sine} {cosine} 0", 0.02427, 480, 24.27),
        ("ROLL", "hinge", f"{cosine} {sine} 0", 0.02815, 352, 28.15),
    ):
        same(
            sole.find(f"joint[@name='LLEG_BUSH_{axis}']"),
            f"""<joint name="LLEG_BUSH_{axis}" type="{kind}" axis="{way}" {usual} armature="{armature}"
            stiffness="{stiffness}" damping="{damping}" />""",
        )
    same(sole.find("inertial"), f'<inertial mass="0.05" pos="{CENTRE}" diaginertia="0.0001 0.0001 0.0001" />')
    apart = [each.get("body1") for each in root.findall("contact/exclude") if each.get("body2") == SOLE]
    assert sorted(map(str, apart)) == [ANKLE, "left_sensor", "left_shin", "left_sole"]


def test_a_sole_of_mujoco_touches_no_toe_that_its_ankle_did_not(feet: dict[str, Any], tmp_path: Path) -> None:
    """Bodies welded to the toe included; what hangs on the toe's own joint may be touched."""
    model = write_mjcf(tmp_path / "robot.xml")
    root = ET.parse(model).getroot()
    ankle = root.find(f".//body[@name='{ANKLE}']")
    assert ankle is not None
    above = ankle
    for name, jointed in (("toe", True), ("cap", False), ("nail", True)):
        above = ET.SubElement(above, "body", name=name, pos="0.05 0 0")
        if jointed:
            ET.SubElement(above, "joint", name=f"{name}_joint", axis="0 1 0")
        ET.SubElement(above, "geom", type="sphere", size="0.01")
    model.write_text(ET.tostring(root, encoding="unicode"))
    export(feet, "mjcf", tmp_path / "out.xml", model)
    written = ET.parse(tmp_path / "out.xml").getroot()
    apart = [each.get("body1") for each in written.findall("contact/exclude") if each.get("body2") == SOLE]
    assert {"toe", "cap", "left_shin"} <= set(apart)
    assert "nail" not in apart
